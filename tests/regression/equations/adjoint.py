# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The adjoint equations of doc/theory/equations.md, (40) to (47), on a whole run that is programmed from the page, too: one mini element between
two planes, three increments of a scheme of three stages. Partial derivatives are complex steps of the functions of the page; what the adjoint makes of them
must be the derivative of the run, a complex step of all of it."""
import os
import sys

import numpy as np

sys.path[:0] = [os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."), os.path.dirname(os.path.abspath(__file__))]
from equations import Law, Mini, Unknowns, ramp_01  # noqa: E402
from whole_runs import failures, judge  # noqa: E402

BAR = 1e-10
TINY = 1e-30
A, B = [[], [0.5], [-1., 2.]], [1 / 6, 2 / 3, 1 / 6]  # Kutta's scheme of third order
STROKES = (0.05, 0.1, 0.05)
C_TAU, L, RAMP, SIZES = 2., 0.12, 0.25, [12, 3, 4]
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
NORMALS = np.array([[0.1, -0.05, -1.], [-0.05, 0.1, 1.]])
NORMALS /= np.sqrt((NORMALS**2).sum(axis=1))[:, None]
LEADING = 1
GIVEN = {"X_0": [0., 0., 0., 2., 0.1, -0.05, 0.6, 1.8, 0.1, 0.9, 0.6, 1.5], "x_die": [0., 0., -0.02, 0., 0., 1.6],
         "v_die": [0.02, 0.01, 0.1, 0.1, -0.05, -1.], "K": [1.7], "m": [0.4], "e_0": [0.2], "rho": [30.], "v_0": [0.1], "alpha": [0.4]}


def derivative(f, x):
    """Of a scalar, or of an array along the first axis."""
    x = np.array(x, dtype=complex)
    rows = []
    for i in range(x.size):
        x[i] += TINY * 1j
        rows.append(np.imag(f(x)) / TINY)
        x[i] -= TINY * 1j
    return np.array(rows)


class Page:
    """Functions of the page, of anything that may be complex. W is flat: V, beta, P; c is delta and ramp of each corner and die, and tau."""

    def __init__(self, given, theta=1.):
        self.given = {name: np.array(values) for name, values in given.items()}
        for name in ("K", "m", "e_0", "rho", "v_0", "alpha"):
            setattr(self, name, self.given[name][0])
        self.x_die, self.v_die = (self.given[name].reshape(2, 3) for name in ("x_die", "v_die"))
        self.theta = theta
        self.speed = np.sqrt(self.v_die[LEADING] @ self.v_die[LEADING])

    def changed(self, name, values):
        return Page({**self.given, name: values}, self.theta)

    def contact(self, X, t, dt):
        """C of (36), planes of 4.1"""
        X = X.reshape(4, 3)
        delta = np.array([NORMALS[d] @ (self.x_die[d] + t * self.v_die[d] - X[k]) for k in range(4) for d in range(2)])
        return np.concatenate([delta, [ramp_01(gap / RAMP) for gap in delta], [C_TAU * dt]])

    def element(self, W, Y):
        V, beta, P = np.split(W, np.cumsum(SIZES)[:-1])
        return Mini({"X": Y.reshape(4, 3)}, Law({"K": self.K, "m": self.m, "e_0": self.e_0})), Unknowns(
            {"V": V.reshape(4, 3), "beta": beta.reshape(1, 3), "P": P})

    def approach(self, delta, tau):
        """(23), (24)"""
        asinh = np.arcsinh(delta / L)
        return L / tau * (asinh if delta.real >= 0 else asinh / np.sqrt(1 + (asinh / (2 * self.theta))**2))

    def terms(self, W, Y, c):
        """Of each corner and die: k, n, h, slip, slip^2 + v_0^2, S, S^f of (25), (29)"""
        x, ramps, V = Y.reshape(4, 3), c[8:16].reshape(4, 2), W[:12].reshape(4, 3)
        S, Sf = np.zeros(4, dtype=complex), np.zeros((4, 2), dtype=complex)
        for face in FACES:
            v = np.cross(x[face[1]] - x[face[0]], x[face[2]] - x[face[0]])
            third = np.sqrt(v @ v) / 6
            for k in face:
                S[k] += third
                Sf[k] += third * ramps[face[0]] * ramps[face[1]] * ramps[face[2]]
        for k in range(4):
            for d, n in enumerate(NORMALS):
                u = V[k] - self.v_die[d]
                slip = u - u @ n * n
                yield k, n, u @ n - self.approach(c[2 * k + d], c[16]), slip, slip @ slip + self.v_0**2, S[k], Sf[k, d]

    def residual(self, W, Y, c):
        """(31)"""
        element, unknowns = self.element(W, Y)
        R = element.residual(unknowns)
        V = np.array(R["V"], dtype=complex)
        for k, n, h, slip, r, S, Sf in self.terms(W, Y, c):
            V[k] += self.rho * S * (h if h.real > 0 else 0.) * n + self.alpha * self.K * Sf * r**((self.m - 1) / 2) * slip
        return np.concatenate([V.ravel(), np.ravel(R["beta"]), R["P"]])

    def power(self, W, Y, c):
        """(38)"""
        element, unknowns = self.element(W, Y)
        deformation = sum(np.sum(element.law.stress(eps) * eps) for eps in element.rates(unknowns)[1])
        return element.volume / 4 * deformation + sum(self.alpha * self.K * Sf * r**((self.m - 1) / 2) * (slip @ slip)
                                                      for _, _, _, slip, r, _, Sf in self.terms(W, Y, c))

    def strain_rate(self, W, Y):
        element, unknowns = self.element(W, Y)
        return sum(np.sqrt(2 / 3 * np.sum(eps * eps)) for eps in element.rates(unknowns)[1]) / 4

    def equilibrium(self, W, Y, c):
        """Newton's method, whose tangents are of real parts: imaginary ones, which are derivatives, converge with them."""
        real = Page({name: np.real(values) for name, values in self.given.items()}, self.theta)
        for _ in range(60):
            R = self.residual(W, Y, c)
            if np.abs(R.real).max() < 1e-13 and np.abs(R.imag).max() < 1e-13 * TINY:
                break
            tangent = derivative(lambda w: real.residual(w, np.real(Y), np.real(c)), np.real(W)).T
            step = np.linalg.solve(tangent, -R)
            scale = 1.
            while scale > 1e-3 and np.abs(R.real).max() > 1e-6 and np.linalg.norm(
                    self.residual(W + scale * step, Y, c).real) > np.linalg.norm(R.real):
                scale /= 2
            W = W + scale * step
        return W if np.any(np.imag(W)) else np.real(W)


class Stage:
    def __init__(self, Y, W):
        self.Y, self.W, self.M = Y, W, W[:12]


class Increment:
    def __init__(self, page, X, s, ds, guesses):
        self.X, self.s, self.ds, self.stages = X, s, ds, []
        self.dt, self.t = ds / page.speed, s / page.speed  # (35)
        self.c = page.contact(X, self.t, self.dt)
        for a, guess in zip(A, guesses):
            Y = X + self.dt * sum((a_sr * stage.M for a_sr, stage in zip(a, self.stages)), np.zeros(12))
            self.stages.append(Stage(Y, page.equilibrium(guess, Y, self.c)))


WEIGHTS = {"energy": 1., "q": 0.7, "X": np.cos(np.arange(12.))}  # of the objective


def run(page, guesses=None):
    """(36), (37): the objective, and the increments"""
    X, s, q, energy, increments = page.given["X_0"], 0., 0., 0., []
    for i, ds in enumerate(STROKES):
        start = [np.concatenate([np.tile([0., 0., -0.3], 4), np.zeros(7)])] * 3
        now = Increment(page, X, s, ds, guesses[i] if guesses else start)
        for b, stage in zip(B, now.stages):
            X = X + now.dt * b * stage.M
            q = q + now.dt * b * page.strain_rate(stage.W, stage.Y)
            energy = energy + now.dt * b * page.power(stage.W, stage.Y, now.c)
        increments.append(now)
        s += ds
    return WEIGHTS["energy"] * energy + WEIGHTS["q"] * q + WEIGHTS["X"] @ X, increments


def adjoint(page, increments):
    """dPhi by (40) to (47): {name of the given: derivative}"""
    G, q_bar = WEIGHTS["X"], WEIGHTS["q"]
    found = {name: np.zeros(values.size) for name, values in page.given.items()}
    for at in reversed(increments):
        dt, F = at.dt, WEIGHTS["energy"] * at.dt
        led_to, Y_bar, c_bar, dt_bar = {}, {}, np.zeros(17), 0.
        for s in reversed(range(3)):
            stage, b = at.stages[s], B[s]
            led_to[s] = b * G + sum(A[r][s] * Y_bar[r] for r in range(s + 1, 3))
            M_bar = dt * led_to[s]  # (40)

            def taken(W, Y, c, by=page, b=b):
                """What the objective takes from the stage."""
                return b * (F * by.power(W, Y, c) + dt * q_bar * by.strain_rate(W, Y))

            rhs = derivative(lambda W: taken(W, stage.Y, at.c), stage.W)
            rhs[:12] += M_bar
            tangent = derivative(lambda W: page.residual(W, stage.Y, at.c), stage.W)  # transposed
            lam = np.linalg.solve(tangent, -rhs)  # (41)
            Y_bar[s] = derivative(lambda Y: taken(stage.W, Y, at.c) + lam @ page.residual(stage.W, Y, at.c), stage.Y)  # (42)
            c_bar += derivative(lambda c: taken(stage.W, stage.Y, c) + lam @ page.residual(stage.W, stage.Y, c), at.c)  # (43)
            dt_bar += led_to[s] @ stage.M + b * q_bar * page.strain_rate(stage.W, stage.Y)
            dt_bar += b * WEIGHTS["energy"] * np.real(page.power(stage.W, stage.Y, at.c))  # dF/d(dt)
            for name in set(found) - {"X_0"}:
                def of_law(x, name=name):
                    by = page.changed(name, x)
                    return taken(stage.W, stage.Y, at.c, by) + lam @ by.residual(stage.W, stage.Y, at.c)
                found[name] += derivative(of_law, page.given[name])
        dt_bar += C_TAU * c_bar[16]  # (47)
        x_bar = derivative(lambda x: c_bar @ page.changed("x_die", x).contact(at.X, at.t, dt), page.given["x_die"]).reshape(2, 3)
        found["x_die"] += x_bar.ravel()
        v_bar = at.t * x_bar
        v_bar[LEADING] -= page.v_die[LEADING] / page.speed**3 * (at.ds * dt_bar + at.s * np.sum(x_bar * page.v_die))
        found["v_die"] += v_bar.ravel()
        G = G + sum(Y_bar.values()) + derivative(lambda X: c_bar @ page.contact(X, at.t, dt), at.X)  # (44)
    found["X_0"] = G
    return found


def main():
    page = Page(GIVEN)
    _, increments = run(page)
    guesses = [[stage.W for stage in at.stages] for at in increments]
    largest = max(np.abs(page.residual(stage.W, stage.Y, at.c)).max() for at in increments for stage in at.stages)
    judge(f"equilibrium, {largest:.1e}", largest < 1e-12)
    pressed = {(i, d, h.real > 0) for i, at in enumerate(increments) for stage in at.stages
               for j, (_, _, h, *_) in enumerate(page.terms(stage.W, stage.Y, at.c)) for d in [j % 2]}
    judge("each die presses, and not everywhere", len(pressed) == 4 * len(STROKES), pressed)
    for name, values in adjoint(page, increments).items():
        expected = derivative(lambda x, name=name: run(page.changed(name, x), guesses)[0], page.given[name])
        error = np.abs(values - expected).max() / np.abs(expected).max()
        judge(f"dPhi/d{name}, {error:.1e}", error < BAR, (values, expected))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
