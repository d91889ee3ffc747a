// Where a dragged control takes its marker: a table from the mode to what a pointer's ray does.
//
// A grip is in the marker's header frame: `position` and `turn` of the marker, `point` where it is
// held, unit vectors `axis` of the control, `towards` the viewer, `right` and `up` of the view,
// `moved` since the last event, px, and the size of a `pixel`, m. `aid` are the two ends of a line
// that helps.

import * as THREE from "../vendor/three.module.min.js";

const FLAT = 0.03; // of a plane or an axis that is seen from its edge or end: 2 degrees
const FARTHEST = 1e4; // m
const LINE = 100; // m, each way
const PER_PIXEL = 2 * Math.PI / 300; // rad
const PIXEL = 0.001; // m, where a control's plane does not tell
const SHORT = 1e-6; // m

/** Where a ray meets the plane through a point; null where it does so too flatly or far away. */
function meet(ray, point, normal) {
  const slope = ray.direction.dot(normal);
  if (Math.abs(slope) < FLAT) return null;
  const far = point.clone().sub(ray.origin).dot(normal) / slope;
  return far > 0 && far < FARTHEST ? ray.at(far, new THREE.Vector3()) : null;
}

function moveAxis(grip, ray) {
  const { axis, point } = grip;
  const slope = axis.dot(ray.direction);
  const rest = 1 - slope * slope;
  if (rest < FLAT * FLAT) return;
  const gap = point.clone().sub(ray.origin);
  const along = (slope * gap.dot(ray.direction) - gap.dot(axis)) / rest;
  if (gap.addScaledVector(axis, along).dot(ray.direction) < 0 || Math.abs(along) > FARTHEST) return;
  shift(grip, axis.clone().multiplyScalar(along));
  grip.aid = [-LINE, LINE].map((far) => point.clone().addScaledVector(axis, far));
}

/** Marker and hand, by a vector in m. */
function shift(grip, by) {
  grip.position.add(by);
  grip.point.add(by);
}

function movePlane(grip, ray, normal = grip.axis) {
  const there = meet(ray, grip.point, normal);
  if (there) shift(grip, there.sub(grip.point));
}

/** A grip's `pixel`, by the ray so many pixels below the pointer, in the control's plane. */
export function sizeOfPixel({ axis, point }, ray, pixels) {
  const below = meet(ray, point, axis);
  return below ? below.distanceTo(point) / pixels : PIXEL;
}

/** Away from the viewer where the pointer goes up or right. */
function moveAway(grip, ray) {
  const { moved: { x, y }, pixel, point } = grip;
  const away = point.clone().sub(ray.origin);
  const far = away.length() + pixel * (Math.abs(x) > Math.abs(y) ? x : -y);
  if (far < SHORT || far > FARTHEST) return;
  shift(grip, away.setLength(far).add(ray.origin).sub(point));
}

function move3D(grip, ray, { shiftKey }) {
  if (shiftKey) moveAway(grip, ray);
  else movePlane(grip, ray, grip.towards);
  return shiftKey;
}

/** Turn about the axis after the pointer; where that is now, in m from the axis. */
function turnAfter(grip, ray) {
  const { axis, point, position } = grip;
  const centre = position.clone().addScaledVector(axis, point.clone().sub(position).dot(axis));
  const before = point.clone().sub(centre);
  const after = meet(ray, centre, axis)?.sub(centre);
  if (!after || after.length() < SHORT || before.length() < SHORT) return null;
  const angle = Math.atan2(before.clone().cross(after).dot(axis), before.dot(after));
  grip.turn.premultiply(new THREE.Quaternion().setFromAxisAngle(axis, angle));
  before.applyAxisAngle(axis, angle);
  point.copy(centre).add(before);
  grip.aid = [centre, centre.clone().add(after)];
  return { before, after };
}

function rotateAxis(grip, ray) {
  turnAfter(grip, ray);
}

/** As on a string: it turns until it points to the hand, and then follows. */
function moveRotate(grip, ray) {
  const found = turnAfter(grip, ray);
  if (found) shift(grip, found.after.sub(found.before));
}

function rotate3D({ turn, right, up, towards, moved: { x, y } }, ray, { shiftKey }) {
  const about = (axis, pixels) => turn.premultiply(
    new THREE.Quaternion().setFromAxisAngle(axis, PER_PIXEL * pixels));
  if (shiftKey) {
    about(towards, Math.abs(y) > Math.abs(x) ? -y : -x);
  } else {
    about(right, y);
    about(up, x);
  }
  return true;
}

const moveRotate3D = (grip, ray, event) => (event.ctrlKey ? rotate3D : move3D)(grip, ray, event);

/** By interaction mode: `(grip, ray, event)` changes the grip, and says whether only how far the
 * pointer goes counts, not where it is. */
export const DRAGS = {
  3: moveAxis, 4: (grip, ray) => movePlane(grip, ray), 5: rotateAxis, 6: moveRotate, 7: move3D,
  8: rotate3D, 9: moveRotate3D,
};
