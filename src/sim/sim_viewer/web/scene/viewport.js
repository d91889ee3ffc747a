// The picture: camera, background, and drawing when there is something new.

import { OrbitControls } from "../vendor/OrbitControls.js";
import * as THREE from "../vendor/three.module.min.js";
import { skyDome } from "./sky.js";

const NEAR = 0.02; // m
const FAR = 400; // m
const OWN_BACKGROUND = new THREE.Color(0.7, 0.7, 0.7); // Gazebo's
const SLOW_MS = 100; // between pictures where the processor draws them, at least
const SLOWEST_MS = 2000;
const COARSE = [0.5, 1]; // pixels of such a picture for one of the page, while something moves
const QUICK_MS = 80; // that such a picture may take; it gets coarser or finer accordingly
const STILL_MS = 400; // after which it is drawn once more, as finely as
const FINE_MS = 250; // allow
const FINE = Math.min(devicePixelRatio, 2); // of a graphics card
const BREATH = 2; // times a picture's own time, left to fingers, mice and other programs
const BEHIND = new THREE.Vector3(-1.6, -1.2, 1.1); // from where a model is looked at, in its sizes

const NARROW = 6; // degrees
const STEEPEST = 1.57; // rad
const CLOSEST = 200; // how much nearer than it stands the camera still draws things
const FLOOR = new THREE.Plane(new THREE.Vector3(0, 0, 1));

THREE.ColorManagement.enabled = false;
THREE.Object3D.DEFAULT_UP.set(0, 0, 1);

function drawnByProcessor() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class Viewport {
  constructor(parent, root) {
    this.root = root;
    const slow = drawnByProcessor();
    this._slow = slow;
    this._renderer = this._newRenderer(false);
    this._pause = slow ? SLOW_MS : 0;
    this._coarse = COARSE[0];
    this._took = FINE_MS; // ms, the last such picture
    this._setRatio(slow ? this._coarse : FINE);
    parent.append(this._renderer.domElement);
    this._scene = new THREE.Scene();
    this._scene.background = OWN_BACKGROUND;
    this._dome = skyDome();
    this._grid = new THREE.GridHelper(10, 10, 0x777777, 0x999999); // m, cells of 1 m
    this._grid.rotation.x = Math.PI / 2;
    this._scene.add(this._dome, this._grid, root);
    this._camera = new THREE.PerspectiveCamera(50, 1, NEAR, FAR);
    this._controls = new OrbitControls(this._camera, this._renderer.domElement);
    this._controls.addEventListener("change", () => this.draw());
    this._controls.addEventListener("start", () => (this.touched = true));
    this._controls.maxPolarAngle = Math.PI / 2; // never below the ground
    this.touched = false; // whether the person has moved the camera
    this._camera.position.set(-3, -3, 2.5);
    this._sizes = new ResizeObserver(() => this._fit(parent));
    this._sizes.observe(parent);
    this._fit(parent);
    this._waiting = false;
    this._last = 0;
    this._whenDrawn = [];
    this._rays = new THREE.Raycaster();
  }

  get canvas() {
    return this._renderer.domElement;
  }

  /** The scene as another camera sees it, into a canvas; one sees through where nothing is. */
  drawInto(canvas, camera) {
    this._beside ??= this._newRenderer(true); // one for all: browsers allow few
    this._beside.setSize(canvas.width, canvas.height, false);
    const { background } = this._scene;
    this._scene.background = null;
    this._beside.render(this._scene, camera);
    this._scene.background = background;
    const flat = canvas.getContext("2d");
    flat.clearRect(0, 0, canvas.width, canvas.height);
    flat.drawImage(this._beside.domElement, 0, 0);
  }

  _newRenderer(alpha) {
    const made = new THREE.WebGLRenderer({ antialias: !this._slow, alpha });
    made.outputColorSpace = THREE.LinearSRGBColorSpace;
    return made;
  }

  /** Resolves when the next picture is drawn. */
  drawn() {
    this.draw();
    return new Promise((resolve) => this._whenDrawn.push(resolve));
  }

  /** Have `listener()` called when the camera has moved, until the result is called. */
  onMove(listener) {
    this._controls.addEventListener("change", listener);
    return () => this._controls.removeEventListener("change", listener);
  }

  /** How the camera is turned: it looks along -z, with y up. */
  get turn() {
    return this._camera.quaternion;
  }

  get movable() {
    return this._controls.enabled;
  }

  /** Whether dragging moves the camera. */
  set movable(wanted) {
    this._controls.enabled = wanted;
  }

  /** Where the ray through an event's pixel meets something solid, or else the floor; or null. */
  pick(event, solid = true) {
    const hit = solid && this.hit(event, this.root);
    return hit?.point ?? this.ray(event).intersectPlane(FLOOR, new THREE.Vector3());
  }

  /** The ray through an event's pixel. */
  ray(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    this._camera.updateMatrixWorld(); // it may have moved since the last picture
    this._rays.setFromCamera(new THREE.Vector2(2 * (event.clientX - left) / width - 1,
      1 - 2 * (event.clientY - top) / height), this._camera);
    return this._rays.ray.clone();
  }

  /** What that ray meets first of an object and those in it, as three.js has it; or undefined. */
  hit(event, object) {
    this.ray(event);
    return this._rays.intersectObject(object)[0];
  }

  /** Look at a place in m from `distance` m, by yaw and pitch in rad as rviz's Orbit has them. */
  orbit(place, distance, yaw, pitch) {
    this._camera.near = Math.max(NEAR, distance / CLOSEST);
    this._camera.updateProjectionMatrix();
    const flat = distance * Math.cos(Math.min(pitch, STEEPEST));
    this._controls.target.set(...place);
    this._camera.position.set(place[0] + flat * Math.cos(yaw), place[1] + flat * Math.sin(yaw),
      place[2] + distance * Math.sin(pitch));
    this._controls.update();
    this.draw();
  }

  /** Look straight down from so far that heights hardly count, as rviz's TopDownOrtho. */
  lookDown(x, y, height) {
    this._camera.fov = NARROW;
    this.orbit([x, y, 0], height / 2 / Math.tan(NARROW * Math.PI / 360), -Math.PI / 2, STEEPEST);
  }

  /** This place in m becomes the one that is looked at, or takes the camera along from `last`. */
  focus(place, last = this._controls.target.toArray()) {
    this.shift(new THREE.Vector3(...place).sub(new THREE.Vector3(...last)));
    this.draw();
  }

  /** Soon; however often it is called, one picture. */
  draw() {
    if (this._waiting || this._closed) return;
    this._waiting = true;
    const left = this._pause - (performance.now() - this._last);
    if (left > 0) setTimeout(() => requestAnimationFrame(() => this._render()), left);
    else requestAnimationFrame(() => this._render());
  }

  /** `ground`: whether the scene has one; else a grid is drawn. */
  setBackground(colour, sky, ground) {
    this._grid.visible = !ground;
    this._scene.background = colour ? new THREE.Color(...colour.slice(0, 3)) : OWN_BACKGROUND;
    this._dome.visible = sky;
    this.draw();
  }

  /** Look at a sphere from behind and above, or straight down. */
  lookAt(ball, down = false) {
    const upright = (this._camera.fov / 2) * Math.PI / 180;
    const across = Math.atan(Math.tan(upright) * this._camera.aspect);
    const reach = Math.max(ball.radius, 0.1) / Math.sin(Math.min(upright, across));
    const from = down ? new THREE.Vector3(-0.001, 0, 1) : BEHIND.clone().normalize();
    this._controls.target.copy(ball.center);
    this._camera.position.copy(ball.center).addScaledVector(from, reach);
    this._controls.update();
    this.draw();
  }

  /** Camera and what it looks at, by a vector in m. */
  shift(by) {
    this._camera.position.add(by);
    this._controls.target.add(by);
    this._controls.update();
  }

  close() {
    this._closed = true;
    clearTimeout(this._still);
    this._sizes.disconnect();
    this._controls.dispose();
    for (const renderer of [this._renderer, this._beside]) {
      renderer?.dispose();
      renderer?.forceContextLoss();
    }
  }

  _fit(parent) {
    const { clientWidth, clientHeight } = parent;
    if (!clientWidth || !clientHeight) return;
    this._renderer.setSize(clientWidth, clientHeight);
    this._camera.aspect = clientWidth / clientHeight;
    this._camera.updateProjectionMatrix();
    this.draw();
  }

  _setRatio(ratio) {
    if (ratio !== this._renderer.getPixelRatio()) this._renderer.setPixelRatio(ratio);
  }

  _render() {
    this._waiting = false;
    if (this._closed) return;
    this._last = performance.now();
    if (this._slow) this._setRatio(this._coarse);
    this._renderer.render(this._scene, this._camera);
    this._whenDrawn.splice(0).forEach((resolve) => resolve());
    if (!this._slow) return;
    this._breathe(this._last);
    clearTimeout(this._still);
    this._still = setTimeout(() => this._refine(), STILL_MS + this._pause);
  }

  /** Nothing has moved for a while. */
  _refine() {
    if (this._closed || this._waiting) return;
    this._setRatio(Math.min(FINE, this._coarse * Math.sqrt(FINE_MS / this._took)));
    this._renderer.render(this._scene, this._camera);
  }

  /** The browser asks for the frame after next when this one is drawn. */
  _breathe(began) {
    requestAnimationFrame(() => requestAnimationFrame(() => {
      const took = this._took = Math.max(performance.now() - began, 1);
      const wanted = this._coarse * Math.sqrt(QUICK_MS / took);
      this._coarse = Math.min(Math.max((3 * this._coarse + wanted) / 4, COARSE[0]), COARSE[1]);
      this._pause = Math.min(Math.max(SLOW_MS, (1 + BREATH) * took), SLOWEST_MS);
    }));
  }
}
