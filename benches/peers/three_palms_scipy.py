#!/usr/bin/env python3
"""Peer for `three_palms_timing`: contact conditions along the motion of the measured forces, solved by scipy.optimize.least_squares, vectorised with NumPy.

Usage: three_palms_scipy.py LOG STARTS REPEATS

LOG is a sensor log with truth. STARTS is a text file, one start a line:
    known   p (3) v (3) w (3) rotation vector (3)   mass, moments (3)
    unknown p (3) v (3) w (3)                       mass, inertia tensor (6: xx xy xz yy yz zz, world axes at the start)
Prints a line for each start: processor ms of the fastest repeat, largest errors of position, velocity (m, m/s) and angular
velocity (rad/s) over the log, relative error of the mass.

Position, velocity and angular momentum are affine in the unknowns, their integrals are computed once (cubic splines through
all samples); the orientation is integrated by Runge-Kutta steps of order 4 over two samples at a time. All the columns of
the Jacobian are differences, and the perturbed motions are integrated side by side in one array: the only loop in Python
runs over time.
"""
import sys
import time

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares

GRAVITY = np.array([0.0, 0.0, -9.81])


def cross_matrices(v):
    out = np.zeros(v.shape[:-1] + (3, 3))
    x, y, z = v[..., 0], v[..., 1], v[..., 2]
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -z, y, -x
    out[..., 1, 0], out[..., 2, 0], out[..., 2, 1] = z, -y, x
    return out


def exponential(v):
    """Rotation matrices of rotation vectors."""
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    k = cross_matrices(v)
    safe = np.where(angle > 1e-8, angle, 1.0)
    a = np.where(angle > 1e-8, np.sin(safe) / safe, 1.0)
    b = np.where(angle > 1e-8, (1.0 - np.cos(safe)) / safe**2, 0.5)
    return np.eye(3) + a * k + b * (k @ k)


class Log:
    """What the sensors say, and the integrals of the contact wrench."""

    def __init__(self, path):
        with open(path) as file:
            names = file.readline().strip().split(",")
        data = np.loadtxt(path, delimiter=",", skiprows=1)
        column = lambda *wanted: np.stack([data[:, names.index(w)] for w in wanted], axis=-1)
        self.t = data[:, names.index("t")] - data[0, names.index("t")]
        self.n = np.stack([column(f"nx_{i}", f"ny_{i}", f"nz_{i}") for i in (1, 2, 3)], axis=1)
        # t1 is horizontal, t2 points up, t1 = t2 x n.
        up = np.array([0.0, 0.0, 1.0])
        t2 = up - self.n * self.n[..., 2:3]
        t2 /= np.linalg.norm(t2, axis=-1, keepdims=True)
        t1 = np.cross(t2, self.n)
        s = np.stack([column(f"s1_{i}", f"s2_{i}") for i in (1, 2, 3)], axis=1)
        self.c = s[..., :1] * t1 + s[..., 1:] * t2
        f = column("f_1", "f_2", "f_3")
        self.truth = [column(*w) for w in (("cmx", "cmy", "cmz"), ("vx", "vy", "vz"), ("wx", "wy", "wz"))]
        force = f[..., None] * self.n
        total, torque = force.sum(axis=1), np.cross(self.c, force).sum(axis=1)
        spline = CubicSpline(self.t, np.concatenate([total, torque, self.t[:, None] * total], axis=1))
        once = spline.antiderivative()
        self.impulse, self.angular, self.first = np.split(once(self.t), 3, axis=1)
        self.travel = spline.antiderivative(2)(self.t)[:, :3]
        self.coupling = CubicSpline(self.t, np.cross(self.travel, total)).antiderivative()(self.t)
        fall = np.cross(0.5 * GRAVITY * self.t[:, None] ** 2, total)
        self.falling = CubicSpline(self.t, fall).antiderivative()(self.t)
        self.n_cross_c = np.cross(self.n, self.c)

    def motion(self, p, v, L, inverse_mass):
        """Position, velocity and angular momentum for a batch of starts: arrays (batch, time, 3)."""
        t = self.t[:, None]
        velocity = v[:, None] + GRAVITY * t + inverse_mass[:, None, None] * self.impulse
        position = p[:, None] + v[:, None] * t + 0.5 * GRAVITY * t**2 + inverse_mass[:, None, None] * self.travel
        momentum = (
            L[:, None]
            + self.angular
            - self.falling
            - inverse_mass[:, None, None] * self.coupling
            - np.cross(p[:, None], self.impulse)
            - np.cross(v[:, None], self.first)
        )
        return position, velocity, momentum

    def turning(self, R, inverse_inertia, momentum):
        """Angular velocities (batch, time, 3), Runge-Kutta over pairs of samples; samples between by a cubic spline."""
        def rate(R, L):
            w = (R @ (inverse_inertia @ (np.swapaxes(R, -1, -2) @ L[..., None])))[..., 0]
            return w, cross_matrices(w) @ R
        count = len(self.t)
        nodes = list(range(0, count - 2, 2))
        w, k1 = rate(R, momentum[:, 0])
        even = [w]
        for k in nodes:
            h = self.t[k + 2] - self.t[k]
            middle = momentum[:, k + 1]
            k2 = rate(R + 0.5 * h * k1, middle)[1]
            k3 = rate(R + 0.5 * h * k2, middle)[1]
            k4 = rate(R + h * k3, momentum[:, k + 2])[1]
            R = R + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
            w, k1 = rate(R, momentum[:, k + 2])
            even.append(w)
        known = np.stack(even, axis=1)
        at = self.t[: 2 * len(nodes) + 1 : 2]
        return CubicSpline(at, known, axis=1)(self.t[: 2 * len(nodes) + 1])

    def residuals(self, position, velocity, w):
        used = w.shape[1]
        n, nc = self.n[:used], self.n_cross_c[:used]
        arm = nc[None] - np.cross(n[None], position[:, :used, None])
        e = np.einsum("kia,bka->bki", n, velocity[:, :used]) - np.einsum("bka,bkia->bki", w, arm)
        return e.reshape(len(w), -1)


def unpack_known(x, body):
    R = exponential(x[:, 9:12]) @ body["R"]
    inertia = np.diag(body["moments"])
    inverse = np.broadcast_to(np.diag(1.0 / np.asarray(body["moments"])), (len(x), 3, 3))
    L = (R @ inertia @ np.swapaxes(R, -1, -2) @ x[:, 6:9, None])[..., 0]
    return x[:, :3], x[:, 3:6], L, np.full(len(x), 1.0 / body["mass"]), R, inverse


def unpack_unknown(x, _):
    """Unknowns: p, v, w, log mass, logarithms of the diagonal of the inertia's Cholesky factor, and its other entries."""
    factor = np.zeros((len(x), 3, 3))
    for j in range(3):
        factor[:, j, j] = np.exp(x[:, 10 + j])
    factor[:, 1, 0], factor[:, 2, 0], factor[:, 2, 1] = x[:, 13], x[:, 14], x[:, 15]
    inertia = factor @ np.swapaxes(factor, -1, -2)
    R = np.broadcast_to(np.eye(3), (len(x), 3, 3))
    L = (inertia @ x[:, 6:9, None])[..., 0]
    return x[:, :3], x[:, 3:6], L, np.exp(-x[:, 9]), R, np.linalg.inv(inertia)


def solve(log, start, unpack, body):
    def trajectory(x):
        p, v, L, inverse_mass, R, inverse = unpack(x, body)
        position, velocity, momentum = log.motion(p, v, L, inverse_mass)
        return position, velocity, log.turning(R, inverse, momentum)

    def residuals(x):
        return log.residuals(*trajectory(x[None]))[0]

    step = 1e-6

    def jacobian(x):
        # Central differences: forward ones limit the accuracy.
        batch = np.concatenate([x + step * np.eye(len(x)), x - step * np.eye(len(x))])
        e = log.residuals(*trajectory(batch))
        return ((e[: len(x)] - e[len(x) :]) / (2.0 * step)).T

    found = least_squares(residuals, start, jacobian, method="lm", xtol=1e-12, ftol=1e-12, gtol=1e-12)
    return found, trajectory(found.x[None])


def main():
    path, starts, repeats = sys.argv[1], sys.argv[2], int(sys.argv[3])
    log = Log(path)
    for line in open(starts):
        kind, *numbers = line.split()
        x = np.array([float(v) for v in numbers])
        if kind == "known":
            start = np.concatenate([x[:9], np.zeros(3)])
            body = {"R": exponential(x[9:12]), "mass": x[12], "moments": x[13:16]}
            unpack = unpack_known
        else:
            xx, xy, xz, yy, yz, zz = x[10:16]
            factor = np.linalg.cholesky(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
            entries = [factor[1, 0], factor[2, 0], factor[2, 1]]
            start = np.concatenate([x[:9], [np.log(x[9])], np.log(np.diag(factor)), entries])
            body, unpack = None, unpack_unknown
        best = np.inf
        for _ in range(repeats):
            begun = time.process_time()
            found, (position, velocity, w) = solve(log, start, unpack, body)
            best = min(best, time.process_time() - begun)
        used = w.shape[1]
        errors = [
            np.max(np.linalg.norm(mine[0][:used] - true[:used], axis=-1))
            for mine, true in zip((position, velocity, w), log.truth)
        ]
        mass = abs(np.exp(found.x[9]) - 1.0) if kind == "unknown" else 0.0
        print(f"{1e3 * best:.3f} {errors[0]:.3e} {errors[1]:.3e} {errors[2]:.3e} {mass:.3e}")


if __name__ == "__main__":
    main()
