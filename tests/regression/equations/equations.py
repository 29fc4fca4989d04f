# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The residual of one element, pressing and rubbing on a die, from the equations of doc/theory/equations.md; numbers of equations are those of
the page. Compared with what the program finds of the same input, to 1e-12 of the largest entry.
Usage: equations.py PRINT_RESIDUALS"""
import itertools
import json
import os
import subprocess
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ENVIRONMENT, failures, judge  # noqa: E402

BAR = 1e-12
EDGES = list(itertools.combinations(range(4), 2))
POINTS = np.full((4, 4), (5 - np.sqrt(5)) / 20) + np.sqrt(5) / 5 * np.eye(4)  # row a has the coordinates of point a


def sym(L):
    return (L + L.T) / 2


def unit(v):
    return v / np.linalg.norm(v)


def ramp_01(t):
    """(27)"""
    return 1. if t <= 0 else 0. if t >= 1 else 1 - 10 * t**3 + 15 * t**4 - 6 * t**5


def gradients(X):
    """g_c and |T|, (13)"""
    return np.linalg.inv(np.column_stack([np.ones(4), X]))[1:].T, np.linalg.det(X[1:] - X[0]) / 6


class Law:
    def __init__(self, case):
        self.K, self.m, self.e_0 = case["K"], case["m"], case["e_0"]

    def stress(self, eps):
        """(2)"""
        chi = 2 * np.sum(eps * eps) + 3 * self.e_0**2
        return 2 * self.K * chi**((self.m - 1) / 2) * eps


def mini_residual(X, W, law):
    """(14), (15)"""
    g, volume = gradients(X)
    V, beta, P = np.array(W["V"]), np.array(W["beta"][0]), np.array(W["P"])
    L = sum(np.outer(V[c], g[c]) for c in range(4))
    s = [law.stress(sym(L + 4 * np.outer(beta, g[a]))) for a in range(4)]
    return {"V": [volume / 4 * sum(s) @ g[c] - volume * P.mean() * g[c] for c in range(4)],
            "beta": [volume * sum(s[a] @ g[a] for a in range(4)) + volume / 4 * P @ g],
            "P": [volume / 4 * (beta @ g[c] - np.trace(L)) for c in range(4)]}


def quadratic_residual(X, W, law, middles):
    """(16), (17)"""
    g, volume = gradients(X)
    node = {(c, c): c for c in range(4)}
    for k, (c, d) in enumerate(middles):
        node[c, d] = node[d, c] = 4 + k
    V, P = np.array(W["V"]), np.array(W["P"])
    L = [sum(np.outer(4 * sum(POINTS[a, d] * V[node[c, d]] for d in range(4)) - V[c], g[c]) for c in range(4)) for a in range(4)]
    S = [volume / 4 * (law.stress(sym(L[a])) - POINTS[a] @ P * np.eye(3)) for a in range(4)]
    R = np.zeros((10, 3))
    for c in range(4):
        R[c] = sum((4 * POINTS[a, c] - 1) * S[a] @ g[c] for a in range(4))
    for c, d in EDGES:
        R[node[c, d]] = 4 * sum(POINTS[a, d] * S[a] @ g[c] + POINTS[a, c] * S[a] @ g[d] for a in range(4))
    return {"V": R, "beta": [], "P": [-volume / 4 * sum(POINTS[a, c] * np.trace(L[a]) for a in range(4)) for c in range(4)]}


class Plane:
    curved = False

    def __init__(self, die):
        self.x, self.n = np.array(die["point"]), np.array(die["normal"])

    def gap(self, X):
        return self.n @ (self.x - X), self.n


class Surface:
    """Of smooth facets, none of its edges sharp."""
    curved = True

    def __init__(self, die):
        self.x, self.triangles = np.array(die["vertices"]), die["triangles"]
        total = np.zeros_like(self.x)
        for t in self.triangles:
            for i in range(3):
                u, v = self.x[t[(i + 1) % 3]] - self.x[t[i]], self.x[t[(i + 2) % 3]] - self.x[t[i]]
                total[t[i]] += np.cross(u, v) / (u @ u * (v @ v))  # (18)
        self.n = np.array([unit(n) for n in total])

    def foot(self, t, X):
        """Coordinates of (19), by Newton's method."""
        x, n = self.x[t], self.n[t]
        y = np.array([1 / 3, 1 / 3, 0.])  # l_1, l_2, xi
        for _ in range(8):
            l = np.array([1 - y[0] - y[1], y[0], y[1]])
            J = np.column_stack([x[1] - x[0] + y[2] * (n[1] - n[0]), x[2] - x[0] + y[2] * (n[2] - n[0]), l @ n])
            y = y - np.linalg.solve(J, l @ x + y[2] * (l @ n) - X)
        return np.array([1 - y[0] - y[1], y[0], y[1]])

    def gap(self, X):
        nearest = sorted(self.triangles, key=lambda t: np.linalg.norm(self.x[t].mean(axis=0) - X))
        t, l = next((t, l) for t, l in ((t, self.foot(t, X)) for t in nearest) if l.min() >= -1e-12)
        x, n = l @ self.x[t], unit(-(l @ self.n[t]))
        lifted = x + sum(l[a] * ((self.x[t[a]] - x) @ self.n[t[a]]) * self.n[t[a]] for a in range(3)) / 2
        return (lifted - X) @ n, n  # (20)


class Contact:
    """4., of the contact points: (0,) ... are nodes, (0, 1) ... middles of edges."""

    def __init__(self, case):
        self.case, self.X = case, np.array(case["X"])
        self.quadratic = case["pair"] == "P2/P1"
        self.middles = [tuple(sorted(middle)) for middle in case["middles"]]
        self.die = Surface(case["die"]) if "vertices" in case["die"] else Plane(case["die"])
        seen = {point: self.die.gap(self.X[list(point)].mean(axis=0) - case["die"]["displacement"])
                for point in [(k,) for k in range(4)] + EDGES}
        self.n = {point: n for point, (_, n) in seen.items()}
        self.delta = {point: delta for point, (delta, _) in seen.items() if delta <= case["reach"]}
        self.decide_points({point: delta for point, (delta, _) in seen.items()})
        self.smooth = dict.fromkeys(EDGES, True)
        if self.quadratic and self.die.curved:
            self.level()
        self.touch()

    def decide_points(self, everywhere):
        """Which middles are points; both ends of those of linear velocities are, however far."""
        if self.quadratic:
            return
        delta = dict(self.delta)
        for edge in EDGES:
            ends = [self.delta.get((k,), np.inf) for k in edge]
            length = np.linalg.norm(self.X[edge[0]] - self.X[edge[1]])
            if not (self.die.curved and edge in self.delta and self.delta[edge] < sum(ends) / 2 - 1e-6 * length):
                delta.pop(edge, None)
            else:
                delta.update({(k,): everywhere[(k,)] for k in edge})
        self.delta = delta

    def w(self, delta):
        return ramp_01(delta / self.case["b"])

    def level(self):
        """(22)"""
        own = dict(self.delta)
        chords = [edge for edge in EDGES if all(point in own for point in (edge, (edge[0],), (edge[1],)))]
        b = {m: (own[m[:1]] + own[m[1:]]) / 2 - own[m] for m in chords}
        c = {m: ramp_01((abs(b[m]) / np.linalg.norm(self.X[m[0]] - self.X[m[1]]) - 0.06) / 0.09) for m in chords}
        for v in range(4):
            around = [m for m in chords if v in m]
            if around:
                self.delta[v,] -= sum(self.w(own[m]) * c[m] * b[m] for m in around) / (0.25 + sum(self.w(own[m]) for m in around))
        for m in chords:
            ends = self.delta[m[:1]], self.delta[m[1:]]
            self.delta[m] += self.w(ends[0]) * self.w(ends[1]) * c[m] * (sum(ends) / 2 - own[m])
            self.smooth[m] = c[m] == 1.

    def touch(self):
        """(28)"""
        self.touching = {}
        for point, delta in self.delta.items():
            free = 1 - self.w(delta)
            if not self.quadratic and len(point) == 1:
                for edge in EDGES:
                    if edge in self.delta and point[0] in edge:
                        free *= 1 - self.w(self.delta[edge])
            self.touching[point] = 1 - free

    def areas(self):
        """S and S^f of (29)"""
        S, Sf = dict.fromkeys(self.delta, 0.), dict.fromkeys(self.delta, 0.)
        for face in self.case["faces"]:
            x = self.X[face]
            area = np.linalg.norm(np.cross(x[1] - x[0], x[2] - x[0])) / 2
            corners = [(k,) for k in face]
            sides = [tuple(sorted((face[i], face[(i + 1) % 3]))) for i in range(3)]
            for points, part in ((corners, 1 / 12 if self.quadratic else 1 / 3),
                                 (sides, 1 / 4 if self.quadratic else self.case["kappa"] / 3)):
                for point in points:
                    if point in S:
                        S[point] += part * area
            triangles = [(corners[i], sides[i], sides[i - 1]) for i in range(3)] + [sides] if self.quadratic else [corners]
            for triangle in triangles:
                weight = np.prod([self.touching.get(point, 0.) for point in triangle])
                for point in triangle if weight > 0 else ():
                    Sf[point] += (1 / 12 if self.quadratic else 1 / 3) * weight * area
        return S, Sf

    def approach(self, delta):
        """(23), (24)"""
        l, tau = self.case["l"], self.case["tau"]
        if l == 0:
            return delta / tau
        A = np.arcsinh(delta / l)
        return l / tau * A if delta >= 0 else l / tau * A / np.sqrt(1 + (A / (2 * self.case["theta"]))**2)

    def nodes(self, point):
        """Velocity nodes of a point, and the part of each."""
        if len(point) == 1:
            return [(point[0], 1.)]
        return [(4 + self.middles.index(point), 1.)] if self.quadratic else [(k, 0.5) for k in point]

    def pressed(self, h):
        pressed = {point: h[point] > 0 for point in h}
        if self.quadratic:
            for v in range(4):
                around = [edge for edge in EDGES if v in edge]
                if (v,) in h and all(edge in h and pressed[edge] and self.smooth[edge] for edge in around):
                    pressed[v,] = True
        return pressed

    def forces(self, V):
        """f_k of (25)"""
        case, (S, Sf) = self.case, self.areas()
        u = {point: sum(part * V[k] for k, part in self.nodes(point)) - case["die"]["velocity"] for point in self.delta}
        h = {point: u[point] @ self.n[point] - self.approach(delta) for point, delta in self.delta.items()}
        pressed, forces = self.pressed(h), {}
        for point, n in ((point, self.n[point]) for point in self.delta):
            slip = u[point] - u[point] @ n * n
            forces[point] = (case["rho"] * S[point] * h[point] * pressed[point] * n + case["alpha"] * case["K"] * Sf[point] *
                             (slip @ slip + case["v_0"]**2)**((case["m"] - 1) / 2) * slip)
        self.seen = {"pressed": any(pressed.values()), "free": not all(pressed.values()), "inside": min(self.delta.values()) < 0,
                     "rubbing": any(Sf.values()), "edges": any(len(point) == 2 for point in self.delta),
                     "pulled": any(pressed[point] and h[point] < 0 for point in h),
                     "partly sharp": not all(self.smooth.values())}
        return forces


def residual(case):
    """(31), and what of contact it has seen"""
    X, W, law = np.array(case["X"]), case["W"], Law(case)
    contact = Contact(case)
    R = quadratic_residual(X, W, law, contact.middles) if contact.quadratic else mini_residual(X, W, law)
    V = np.array(W["V"])
    for point, force in contact.forces(V).items():
        for k, part in contact.nodes(point):
            R["V"][k] = R["V"][k] + part * force
    return R, contact.seen


def main():
    printed = subprocess.run([os.path.abspath(sys.argv[1])], env=ENVIRONMENT, capture_output=True, text=True, timeout=600, check=True)
    errors, seen = {}, {}
    for case in map(json.loads, printed.stdout.splitlines()):
        R, of_contact = residual(case)
        name = f"{case['pair']}, {'cap' if 'vertices' in case['die'] else 'plane'}, layer {case['l']}, m = {case['m']}"
        for part, values in case["R"].items():
            if values:
                error = np.abs(np.array(values) - np.array(R[part])).max() / np.abs(np.array(values)).max()
                errors[name, part] = max(errors.get((name, part), 0.), error)
        for what, has in of_contact.items():
            seen.setdefault((case["pair"], "vertices" in case["die"]), set()).update([what] if has else [])
    for (name, part), error in errors.items():
        judge(f"{name}: R^{part}, {error:.1e}", error < BAR)
    judge("all kinds of cases", len(errors) == 2 * 2 * 2 * 3 + 2 * 2 * 2 * 2, len(errors))
    for (pair, curved), found in seen.items():
        wanted = {"pressed", "free", "inside", "rubbing"} | ({"edges"} if curved or pair == "P2/P1" else set())
        wanted |= {"pulled"} if pair == "P2/P1" else set()
        wanted |= {"partly sharp"} if pair == "P2/P1" and curved else set()
        judge(f"{pair}, {'cap' if curved else 'plane'}: {', '.join(sorted(wanted))}", wanted <= found, found)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
