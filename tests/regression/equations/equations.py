# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The residual of one element, pressing and rubbing on a die, from the equations of doc/theory/equations.md; numbers of equations are those of
the page. Compared with what the program finds of the same input, to 1e-12 of the largest entry; and the functional of the page is differentiated
by complex steps, which must give the residual, too.
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
    return 1. if t.real <= 0 else 0. if t.real >= 1 else 1 - 10 * t**3 + 15 * t**4 - 6 * t**5


def gradients(X):
    """g_c and |T|, (13)"""
    return np.linalg.inv(np.column_stack([np.ones(4), X]))[1:].T, np.linalg.det(X[1:] - X[0]) / 6


class Law:
    def __init__(self, case):
        self.K, self.m, self.e_0 = case["K"], case["m"], case["e_0"]

    def chi(self, eps):
        return 2 * np.sum(eps * eps) + 3 * self.e_0**2

    def stress(self, eps):
        """(2)"""
        return 2 * self.K * self.chi(eps)**((self.m - 1) / 2) * eps

    def potential(self, eps):
        return self.K / (self.m + 1) * self.chi(eps)**((self.m + 1) / 2)


    def flow_stress(self, e):
        return np.sqrt(3) * self.K * (3 * (e**2 + self.e_0**2))**(self.m / 2)


class Unknowns:
    def __init__(self, W):
        self.V, self.beta, self.P = (np.array(W[part]) for part in ("V", "beta", "P"))

    def __iter__(self):
        return iter((("V", self.V), ("beta", self.beta), ("P", self.P)))


class Mini:
    """P1+/P1"""

    def __init__(self, case, law):
        self.law = law
        self.g, self.volume = gradients(np.array(case["X"]))

    def rates(self, W):
        L = sum(np.outer(W.V[c], self.g[c]) for c in range(4))
        return L, [sym(L + 4 * np.outer(W.beta[0], self.g[a])) for a in range(4)]

    def functional(self, W):
        """(14)"""
        L, eps = self.rates(W)
        return self.volume * (sum(map(self.law.potential, eps)) / 4 - W.P.mean() * np.trace(L) + W.beta[0] @ (W.P @ self.g) / 4)

    def residual(self, W):
        """(15)"""
        g, volume = self.g, self.volume
        L, eps = self.rates(W)
        s = [self.law.stress(e) for e in eps]
        return {"V": [volume / 4 * sum(s) @ g[c] - volume * W.P.mean() * g[c] for c in range(4)],
                "beta": [volume * sum(s[a] @ g[a] for a in range(4)) + volume / 4 * W.P @ g],
                "P": [volume / 4 * (W.beta[0] @ g[c] - np.trace(L)) for c in range(4)]}


class Quadratic:
    """P2/P1"""

    def __init__(self, case, law):
        self.law = law
        self.g, self.volume = gradients(np.array(case["X"]))
        self.node = {(c, c): c for c in range(4)}
        for k, (c, d) in enumerate(case["middles"]):
            self.node[c, d] = self.node[d, c] = 4 + k

    def gradient(self, W, a):
        U = [4 * sum(POINTS[a, d] * W.V[self.node[c, d]] for d in range(4)) - W.V[c] for c in range(4)]
        return sum(np.outer(U[c], self.g[c]) for c in range(4))

    def functional(self, W):
        """(16)"""
        L = [self.gradient(W, a) for a in range(4)]
        return self.volume / 4 * sum(self.law.potential(sym(L[a])) - POINTS[a] @ W.P * np.trace(L[a]) for a in range(4))

    def residual(self, W):
        """(17)"""
        g, volume = self.g, self.volume
        L = [self.gradient(W, a) for a in range(4)]
        S = [volume / 4 * (self.law.stress(sym(L[a])) - POINTS[a] @ W.P * np.eye(3)) for a in range(4)]
        V = np.zeros((10, 3))
        for c in range(4):
            V[c] = sum((4 * POINTS[a, c] - 1) * S[a] @ g[c] for a in range(4))
        for c, d in EDGES:
            V[self.node[c, d]] = 4 * sum(POINTS[a, d] * S[a] @ g[c] + POINTS[a, c] * S[a] @ g[d] for a in range(4))
        return {"V": V, "beta": [], "P": [-volume / 4 * sum(POINTS[a, c] * np.trace(L[a]) for a in range(4)) for c in range(4)]}


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

    def w(self, point, delta):
        """(27)"""
        n, v_d, before = self.n[point], np.array(self.case["die"]["velocity"]), self.case["V before"]
        coming = np.mean([before[k] for k in point], axis=0) - v_d if before else v_d
        r = coming @ n / np.linalg.norm(v_d)
        r = max(r, 0) if before else r
        return ramp_01(delta / (self.case["width"] * np.sqrt(self.case["c_s"]**2 + (1 - self.case["c_s"]**2) * r**2)))

    def bulging(self, edge):
        """g of (28)"""
        ends = [self.delta[k,] for k in edge]
        return 1 - self.w(edge, 4 * (sum(ends) / 2 - self.delta[edge]))

    def level(self):
        """(22)"""
        own = dict(self.delta)
        chords = [edge for edge in EDGES if all(point in own for point in (edge, (edge[0],), (edge[1],)))]
        b = {m: (own[m[:1]] + own[m[1:]]) / 2 - own[m] for m in chords}
        c = {m: ramp_01((abs(b[m]) / np.linalg.norm(self.X[m[0]] - self.X[m[1]]) - 0.06) / 0.09) for m in chords}
        for v in range(4):
            around = [m for m in chords if v in m]
            if around:
                self.delta[v,] -= sum(self.w(m, own[m]) * c[m] * b[m] for m in around) / (
                    0.25 + sum(self.w(m, own[m]) for m in around))
        for m in chords:
            ends = self.delta[m[:1]], self.delta[m[1:]]
            self.delta[m] += self.w(m[:1], ends[0]) * self.w(m[1:], ends[1]) * c[m] * (sum(ends) / 2 - own[m])
            self.smooth[m] = c[m] == 1.

    def touch(self):
        """(28)"""
        self.touching = {}
        for point, delta in self.delta.items():
            free = 1 - self.w(point, delta)
            if not self.quadratic and len(point) == 1:
                for edge in EDGES:
                    if edge in self.delta and point[0] in edge:
                        free *= 1 - self.bulging(edge) * self.w(edge, self.delta[edge])
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

    def kinematics(self, V):
        """u_k and h_k of (25)"""
        u = {point: sum(part * V[k] for k, part in self.nodes(point)) - self.case["die"]["velocity"] for point in self.delta}
        return u, {point: u[point] @ self.n[point] - self.approach(delta) for point, delta in self.delta.items()}

    def decide(self, V):
        """What is pressed, and areas."""
        _, h = self.kinematics(V)
        self.is_pressed, self.S, self.Sf = self.pressed(h), *self.areas()
        return {"pressed": any(self.is_pressed.values()), "free": not all(self.is_pressed.values()), "inside": min(self.delta.values()) < 0,
                "rubbing": any(self.Sf.values()), "edges": any(len(point) == 2 for point in self.delta),
                "pulled": any(self.is_pressed[point] and h[point] < 0 for point in h), "partly sharp": not all(self.smooth.values())}

    def terms(self, V):
        """(point, its normal, h if it is pressed, slip, |slip|^2 + v_0^2)"""
        u, h = self.kinematics(V)
        for point in self.delta:
            n = self.n[point]
            slip = u[point] - u[point] @ n * n
            yield point, n, h[point] * self.is_pressed[point], slip, slip @ slip + self.case["v_0"]**2

    def potential(self, V):
        """The sum over k of (30)"""
        rho, alpha, K, m = (self.case[name] for name in ("rho", "alpha", "K", "m"))
        return sum(rho * self.S[point] / 2 * h**2 + alpha * K * self.Sf[point] / (m + 1) * r**((m + 1) / 2)
                   for point, _, h, _, r in self.terms(V))

    def forces(self, V):
        """f_k of (25)"""
        rho, alpha, K, m = (self.case[name] for name in ("rho", "alpha", "K", "m"))
        return {point: rho * self.S[point] * h * n + alpha * K * self.Sf[point] * r**((m - 1) / 2) * slip
                for point, n, h, slip, r in self.terms(V)}


class Equations:
    def __init__(self, case):
        self.W, self.contact = Unknowns(case["W"]), Contact(case)
        self.element = (Quadratic if self.contact.quadratic else Mini)(case, Law(case))
        self.seen = self.contact.decide(self.W.V)

    def residual(self):
        """(31)"""
        R = self.element.residual(self.W)
        for point, force in self.contact.forces(self.W.V).items():
            for k, part in self.contact.nodes(point):
                R["V"][k] = R["V"][k] + part * force
        return R

    def rates(self):
        if self.contact.quadratic:
            return [sym(self.element.gradient(self.W, a)) for a in range(4)]
        return self.element.rates(self.W)[1]

    def objectives(self):
        """(38a) to (38d); sigma_1 by (38b), and by eigenvalues"""
        rates, law = self.rates(), self.element.law
        s = sum(map(law.stress, rates)) / 4
        s = s - np.trace(s) / 3 * np.eye(3)
        e = sum(np.sqrt(2 / 3 * np.sum(eps * eps)) for eps in rates) / 4
        J_2 = np.sum(s * s) / 2
        x = 3 * np.sqrt(3) / 2 * np.linalg.det(s) / J_2**1.5
        sigma_1 = 2 * np.sqrt(J_2 / 3) * np.cos(np.arccos((1 - 1e-4) * x) / 3) - self.W.P.mean()
        sigma_0 = law.flow_stress(e)
        y, w = sigma_1 / sigma_0, 0.02
        t = y / w + 1 / 2
        g = 0. if t < 0 else y if t > 1 else w * (t**3 - t**4 / 2)
        contact, (S, _), v_0 = self.contact, self.contact.areas(), self.contact.case["v_0"]
        work = sum(contact.case["rho"] * S[point] * h * (np.sqrt(r) - v_0) for point, _, h, _, r in contact.terms(self.W.V))
        faces = dict.fromkeys(range(4), 0.)
        for face in contact.case["faces"]:
            x = contact.X[face]
            for k in face:
                faces[k] += np.linalg.norm(np.cross(x[1] - x[0], x[2] - x[0])) / 6
        area = sum(contact.touching[point] * faces[point[0]] for point in contact.delta if len(point) == 1)
        self.principal = np.linalg.eigvalsh(s)[2] - self.W.P.mean(), sigma_1, np.sqrt(3 * J_2)
        return {"shear": np.sqrt(J_2), "sigma_1": sigma_1, "sigma_0": sigma_0, "damage": g * e, "wear": [work, area]}

    def gradient_of_functional(self):
        """Of (30), at fixed contacts"""
        tiny, W = 1e-30, Unknowns({name: part.astype(complex) for name, part in self.W})
        R = {name: np.zeros(part.shape) for name, part in self.W}
        for name, part in W:
            for i in np.ndindex(part.shape):
                part[i] += tiny * 1j
                R[name][i] = (self.element.functional(W) + self.contact.potential(W.V)).imag / tiny
                part[i] -= tiny * 1j
        return R


def main():
    printed = subprocess.run([os.path.abspath(sys.argv[1])], env=ENVIRONMENT, capture_output=True, text=True, timeout=600, check=True)
    errors, seen, principal, tensions = {}, {}, [], set()
    for i, case in enumerate(map(json.loads, printed.stdout.splitlines())):
        equations = Equations(case)
        found = {"R": equations.residual()}
        if i % 5 == 0:
            found["grad Pi"] = equations.gradient_of_functional()
        name = f"{case['pair']}, {'cap' if 'vertices' in case['die'] else 'plane'}, layer {case['l']}, m = {case['m']}"
        of_objectives = equations.objectives()
        principal.append(equations.principal)
        y = of_objectives["sigma_1"] / of_objectives["sigma_0"] / 0.02
        tensions.add(0. if y < -0.5 else 1. if y > 0.5 else 0.5)
        for part, values in case["objectives"].items():
            error = np.abs(np.array(values) - of_objectives[part]).max() / max(np.abs(values).max(), 1e-3)
            errors[name, "objectives", part] = max(errors.get((name, "objectives", part), 0.), error)
        for what, of in found.items():
            for part, values in ((part, np.array(values)) for part, values in case["R"].items() if values):
                error = np.abs(values - np.array(of[part])).max() / np.abs(values).max()
                errors[name, what, part] = max(errors.get((name, what, part), 0.), error)
        for what, has in equations.seen.items():
            seen.setdefault((case["pair"], "vertices" in case["die"]), set()).update([what] if has else [])
    judge("sigma_1 is rounded by less than 0.0028 of the equivalent stress, and never smaller by 2e-5 of it",
          all(-2e-5 * size < rounded - exact < 2.8e-3 * size for exact, rounded, size in principal), principal)
    judge("tension, and none, and between", {0., 0.5, 1.} == tensions, tensions)
    for (name, what, part), error in errors.items():
        judge(f"{name}: {what}, {part}, {error:.1e}", error < BAR)
    judge("all kinds of cases", len(errors) == 2 * (2 * 2 * 2 * 3 + 2 * 2 * 2 * 2) + 2 * 2 * 2 * 2 * 5, len(errors))
    for (pair, curved), found in seen.items():
        wanted = {"pressed", "free", "inside", "rubbing"} | ({"edges"} if curved or pair == "P2/P1" else set())
        wanted |= {"pulled"} if pair == "P2/P1" else set()
        wanted |= {"partly sharp"} if pair == "P2/P1" and curved else set()
        judge(f"{pair}, {'cap' if curved else 'plane'}: {', '.join(sorted(wanted))}", wanted <= found, found)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
