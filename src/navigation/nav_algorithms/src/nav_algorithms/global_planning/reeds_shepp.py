"""Shortest curves of a car between two poses without obstacles: arcs of one radius and straights.

J. Reeds and L. Shepp, "Optimal paths for a car that goes both forwards and backwards" (1990),
sections 8.1 to 8.11; L. Dubins (1957) for cars that only drive forwards. Lengths are in turning
radii; a word is up to five pieces (signed length, curvature of -1, 0 or 1), left turns positive.
"""

from __future__ import annotations

import numpy as np

from nav_algorithms.compiled import compiled

WORDS, PIECES = 64, 5  # the most words for one pair of poses, and the most pieces of a word
HALF = np.pi / 2


@compiled("f8(f8)")
def _wrap(angle):
    """Within [-pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


@compiled("UniTuple(f8, 2)(f8, f8, f8, f8, f8)")
def _tau_omega(u, v, xi, eta, phi):
    """First and last arc of a word of four arcs, Reeds and Shepp 8.7 and 8.8."""
    delta = _wrap(u - v)
    a, b = np.sin(u) - np.sin(delta), np.cos(u) - np.cos(delta) - 1.0
    first = np.arctan2(eta * a - xi * b, xi * a + eta * b)
    if 2.0 * (np.cos(delta) - np.cos(v) - np.cos(u)) + 3.0 < 0.0:
        first += np.pi
    tau = _wrap(first)
    return tau, _wrap(tau - u + v - phi)


@compiled("i8(f8[:,:,::1], i8, i8, b1, b1, b1, f8, f8, f8, f8, f8, f8, f8, f8, f8, f8)")
def _put(words, count, pieces, flip, mirror, backward, l0, l1, l2, l3, l4, c0, c1, c2, c3, c4):
    """Add a word, undoing the symmetry under which it was found."""
    sign, side = -1.0 if flip else 1.0, -1.0 if mirror else 1.0
    lengths, curvatures = (l0, l1, l2, l3, l4), (c0, c1, c2, c3, c4)
    words[count] = 0.0
    for n in range(pieces):
        to = pieces - 1 - n if backward else n
        words[count, to, 0] = sign * lengths[n]
        words[count, to, 1] = side * curvatures[n]
    return count + 1


@compiled("i8(f8[:,:,::1], i8, f8, f8, f8, b1, b1)")
def _straight_in_the_middle(words, count, x, y, phi, flip, mirror):
    """8.1, 8.2 and 8.11: arc, straight, arc; also with a quarter-circle arc on both sides of it."""
    xi, eta = x - np.sin(phi), y - 1.0 + np.cos(phi)
    t, u = np.arctan2(eta, xi), np.hypot(xi, eta)
    v = _wrap(phi - t)
    if t >= 0.0 and v >= 0.0:
        count = _put(words, count, 3, flip, mirror, False, t, u, v, 0., 0., 1., 0., 1., 0., 0.)
    xi, eta = x + np.sin(phi), y - 1.0 - np.cos(phi)
    square = xi * xi + eta * eta
    if square >= 4.0:
        u = np.sqrt(square - 4.0)
        t = _wrap(np.arctan2(eta, xi) + np.arctan2(2.0, u))
        v = _wrap(t - phi)
        if t >= 0.0 and v >= 0.0:
            count = _put(words, count, 3, flip, mirror, False, t, u, v, 0., 0.,
                         1., 0., -1., 0., 0.)
        u = 4.0 - np.sqrt(square - 4.0)
        if u <= 0.0:
            t = _wrap(np.arctan2((4.0 - u) * xi - 2.0 * eta, -2.0 * xi + (u - 4.0) * eta))
            v = _wrap(t - phi)
            if t >= 0.0 and v >= 0.0:
                count = _put(words, count, 5, flip, mirror, False, t, -HALF, u, -HALF, v,
                             1., -1., 0., 1., -1.)
    return count


@compiled("i8(f8[:,:,::1], i8, f8, f8, f8, b1, b1)")
def _four_arcs(words, count, x, y, phi, flip, mirror):
    """8.7 and 8.8."""
    xi, eta = x + np.sin(phi), y - 1.0 - np.cos(phi)
    square = xi * xi + eta * eta
    rho = 0.25 * (2.0 + np.sqrt(square))
    if rho <= 1.0:
        u = np.arccos(rho)
        t, v = _tau_omega(u, -u, xi, eta, phi)
        if t >= 0.0 and v <= 0.0:
            count = _put(words, count, 4, flip, mirror, False, t, u, -u, v, 0.,
                         1., -1., 1., -1., 0.)
    rho = (20.0 - square) / 16.0
    if 0.0 <= rho <= 1.0:
        u = -np.arccos(rho)
        t, v = _tau_omega(u, u, xi, eta, phi)
        if t >= 0.0 and v >= 0.0:
            count = _put(words, count, 4, flip, mirror, False, t, u, u, v, 0.,
                         1., -1., 1., -1., 0.)
    return count


@compiled("i8(f8[:,:,::1], i8, f8, f8, f8, b1, b1, b1)")
def _three_arcs_or_a_quarter(words, count, x, y, phi, flip, mirror, backward):
    """8.3, 8.4, 8.9 and 8.10; `backward` reverses the order of the pieces."""
    if backward:
        x, y = x * np.cos(phi) + y * np.sin(phi), x * np.sin(phi) - y * np.cos(phi)
    xi, eta = x - np.sin(phi), y - 1.0 + np.cos(phi)
    rho, theta = np.hypot(xi, eta), np.arctan2(eta, xi)
    if rho <= 4.0:
        u = -2.0 * np.arcsin(0.25 * rho)
        t = _wrap(theta + 0.5 * u + np.pi)
        v = _wrap(phi - t + u)
        if t >= 0.0 and u <= 0.0:
            count = _put(words, count, 3, flip, mirror, backward, t, u, v, 0., 0.,
                         1., -1., 1., 0., 0.)
    if rho >= 2.0:
        r = np.sqrt(rho * rho - 4.0)
        u, t = 2.0 - r, _wrap(theta + np.arctan2(r, -2.0))
        v = _wrap(phi - HALF - t)
        if t >= 0.0 and u <= 0.0 and v <= 0.0:
            count = _put(words, count, 4, flip, mirror, backward, t, -HALF, u, v, 0.,
                         1., -1., 0., 1., 0.)
    xi, eta = x + np.sin(phi), y - 1.0 - np.cos(phi)
    rho, t = np.hypot(xi, eta), np.arctan2(xi, -eta)
    u, v = 2.0 - rho, _wrap(t + HALF - phi)
    if t >= 0.0 and u <= 0.0 and v <= 0.0:
        count = _put(words, count, 4, flip, mirror, backward, t, -HALF, u, v, 0.,
                     1., -1., 0., -1., 0.)
    return count


@compiled("i8(f8[:,:,::1], f8, f8, f8)")
def reeds_shepp(words, x, y, phi):
    """Write all words from the origin to (x, y, phi), x and y in radii, into (WORDS, PIECES, 2).

    Returns how many. Pieces (length, curvature): negative lengths are driven backwards.
    """
    count = 0
    for flip in (False, True):
        for mirror in (False, True):
            fx, fp = (-x, -phi) if flip else (x, phi)
            fy = -y if mirror else y
            if mirror:
                fp = -fp
            count = _straight_in_the_middle(words, count, fx, fy, fp, flip, mirror)
            count = _four_arcs(words, count, fx, fy, fp, flip, mirror)
            count = _three_arcs_or_a_quarter(words, count, fx, fy, fp, flip, mirror, False)
            count = _three_arcs_or_a_quarter(words, count, fx, fy, fp, flip, mirror, True)
    return count


@compiled("i8(f8[:,:,::1], f8, f8, f8)")
def dubins(words, x, y, phi):
    """As `reeds_shepp`, for a car without reverse gear: no length is negative."""
    count = 0
    full = 2 * np.pi
    for mirror in (False, True):
        fy, fp = (-y, -phi) if mirror else (y, phi)
        xi, eta = x - np.sin(fp), fy - 1.0 + np.cos(fp)
        rho, theta = np.hypot(xi, eta), np.arctan2(eta, xi)
        t = theta % full
        count = _put(words, count, 3, False, mirror, False, t, rho, (fp - t) % full, 0., 0.,
                     1., 0., 1., 0., 0.)
        if rho <= 4.0:
            u = full - 2.0 * np.arcsin(0.25 * rho)
            t = (theta + 0.5 * u) % full
            count = _put(words, count, 3, False, mirror, False, t, u, (fp - t + u) % full, 0., 0.,
                         1., -1., 1., 0., 0.)
        xi, eta = x + np.sin(fp), fy - 1.0 - np.cos(fp)
        square = xi * xi + eta * eta
        if square >= 4.0:
            u = np.sqrt(square - 4.0)
            t = (np.arctan2(eta, xi) + np.arctan2(2.0, u)) % full
            count = _put(words, count, 3, False, mirror, False, t, u, (t - fp) % full, 0., 0.,
                         1., 0., -1., 0., 0.)
    return count
