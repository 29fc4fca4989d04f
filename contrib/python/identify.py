#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Numbers of metal and friction from tests: those with which forgings agree best with measured forces and shapes.

    identify.py slow.prm=slow.csv fast.prm=fast.csv ring.prm --output results/identification

A test is a parameter file. Its Design/parameters are what is looked for: parameters of one name in several tests are one number.
What is measured of it is
- FILE.csv, the columns `stroke` [mm], by how much the dies have closed, and `force` [N] of the whole part, and perhaps `deviation` [N], the
  standard deviation of a force; without that column it is estimated from the scatter of neighbours;
- Optimisation/data and uncertainties of the parameter file, measured values of its objectives: a bore, a bulge.

A force curve is divided into windows; the mean force of each is a datum. `retroforge optimize` finds the parameters. Forgings there with smaller
elements and half the increments tell what the numerics change: the parameters are corrected by it, to first order, and the intervals take what
is left. doc/manual/hot_metal.md has the formulas.
"""
import argparse
import csv
import dataclasses
import json
import pathlib
import re
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import retroforge  # noqa: E402

WIDTH_95 = 1.959963984540054  # half the interval of a normal distribution, in deviations
OBJECTIVES = ("Objectives/names", "Optimisation/data", "Optimisation/uncertainties")


@dataclasses.dataclass
class Curve:
    """Forces of a press: stroke [mm], ascending, force [N] and its standard deviation [N], each (n)."""
    stroke: np.ndarray
    force: np.ndarray
    deviation: np.ndarray


@dataclasses.dataclass
class Datum:
    """A measured value of an objective of a test, of the model."""
    objective: str
    value: float
    deviation: float
    window: tuple = None  # from where to where [mm], of a mean force: strokes of the model


@dataclasses.dataclass
class Test:
    """A test: the settings of its case, what is measured of it, and of how much of the part the model is."""
    name: str
    settings: dict  # {"Section/name": text}
    curve: Curve
    copies_of_force: float  # force of the whole part over that of the model
    copies_of_stroke: float  # closing of the dies over the path of the leading one
    ends: np.ndarray  # strokes at which increments end [mm], of the model
    data: list


class Refused(Exception):
    """What is wrong with the tests or their files, as a user can mend it."""


def read_curve(path):
    """@throws Refused  for a file that is no force curve"""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader((line for line in file if not line.startswith("#")), skipinitialspace=True))
        columns = {name.strip(): np.array([float(row[name]) for row in rows]) for name in (rows[0] if rows else {})}
    except OSError as error:
        raise Refused(f"{path}: {error.strerror}") from error
    except (TypeError, ValueError, AttributeError) as error:
        raise Refused(f"{path}: a row has no number in each column ({error})") from error
    if not {"stroke", "force"} <= set(columns):
        raise Refused(f"{path}: has the columns {', '.join(columns) or 'none'}; `stroke' in mm and `force' in N are needed")
    order = np.argsort(columns["stroke"], kind="stable")
    stroke, force = columns["stroke"][order], columns["force"][order]
    if len(stroke) < 5 or not np.all(np.isfinite(force)) or not np.all(np.diff(stroke) > 0):
        raise Refused(f"{path}: a curve has five points at least, finite forces, and no stroke twice")
    deviation = columns["deviation"][order] if "deviation" in columns else np.full(len(force), scatter_of(stroke, force))
    if not np.all(deviation > 0):
        raise Refused(f"{path}: has no scatter; give a column `deviation' in N, as the accuracy of the load cell")
    return Curve(stroke, force, deviation)


def scatter_of(x, y):
    """Standard deviation of independent errors of y, from each point against the line through its neighbours: Gasser, Sroka and
    Jennen-Steinmetz, Biometrika 73 (1986)."""
    left = (x[2:] - x[1:-1]) / (x[2:] - x[:-2])
    beside = left * y[:-2] + (1 - left) * y[2:] - y[1:-1]
    return float(np.sqrt(np.mean(beside**2 / (1 + left**2 + (1 - left)**2))))


def windows_of(curve, ends, begin, n):
    """About n windows of equal length from stroke `begin` on, each of some increments that end at the strokes `ends`: [(from, to, mean
    force, its standard deviation)].

    A point stands for the curve from the middle between it and the one before to that between it and the next. One that stands in two
    windows counts in both with its parts; what their errors have in common is left out.
    """
    middle = 0.5 * (curve.stroke[1:] + curve.stroke[:-1])
    places = np.concatenate(([curve.stroke[0]], middle, [curve.stroke[-1]]))
    inside = ends[(ends >= max(begin, places[0]) * (1 - 1e-9)) & (ends <= places[-1] * (1 + 1e-9))]
    if len(inside) < 2:
        return []
    cuts = inside[np.unique([np.abs(inside - place).argmin() for place in np.linspace(inside[0], inside[-1], n + 1)])]
    windows = []
    for low, high in zip(cuts[:-1], cuts[1:]):
        part = np.maximum(np.minimum(places[1:], high) - np.maximum(places[:-1], low), 0)
        part = part / part.sum()
        windows.append((low, high, float(part @ curve.force), float(np.sqrt(part**2 @ curve.deviation**2))))
    return windows


def read_settings(path):
    """{"Section/name": text} of the parameter file that a run leaves."""
    settings, sections = {}, []
    for line in path.read_text(encoding="utf-8").splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("subsection "):
            sections.append(line[len("subsection "):].strip())
        elif line == "end":
            sections.pop()
        elif found := re.match(r"set\s+(.+?)\s*=\s*(.*)", line):
            settings["/".join([*sections, found.group(1)])] = found.group(2)
    return settings


def write_settings(path, settings):
    """A parameter file, each setting in sections of its own."""
    with open(path, "w", encoding="utf-8") as file:
        for name, value in settings.items():
            *sections, last = name.split("/")
            file.writelines(f"subsection {section}\n" for section in sections)
            file.write(f"  set {last} = {value}\n" + "end\n" * len(sections))


def pairs_of(text):
    """{name: number} of `NAME: NUMBER, NAME: NUMBER'."""
    return {name.strip(): float(value) for name, value in (pair.rsplit(":", 1) for pair in text.split(",") if pair.strip())}


def names_of(text):
    return [name.strip() for name in text.split(",") if name.strip()]


def prepare(case, measured, folder, options):
    """A test, forged once with the values it has: what the model is of the part is known then.  @throws Refused"""
    name = pathlib.Path(case).stem
    forging = retroforge.run(pathlib.Path(case).resolve(), {"Output/fields every": 0, "Output/record": False},
                             command="simulate", folder=folder / "start" / name)
    settings = read_settings(folder / "start" / name / "parameters.prm")
    whole = {key: value or 1.0 for key, value in (forging.summary.get("whole") or {}).items()}
    copies_of_force = whole.get("force_factor", 1.0)
    test = Test(name, settings, read_curve(measured) if measured else None, copies_of_force,
                whole.get("copies", 1.0) / copies_of_force, forging.history["stroke"], [])
    settings["Press/steps"] = str((folder / "start" / name / "history.csv").resolve())
    deviations = pairs_of(settings.get(OBJECTIVES[2], ""))
    test.data = [Datum(objective, value, deviations[objective]) for objective, value in pairs_of(settings.get(OBJECTIVES[1], "")).items()]
    if test.curve is not None:
        ends = test.copies_of_stroke * test.ends
        windows = windows_of(test.curve, ends, options.begin * ends[-1], options.windows)
        if not windows:
            raise Refused(f"{measured}: goes from {test.curve.stroke[0]:g} to {test.curve.stroke[-1]:g} mm, but the dies of {case} close in "
                          f"{len(ends)} increments from 0 to {ends[-1]:g} mm; two of them at least must lie within the curve")
        for i, (low, high, force, deviation) in enumerate(windows, 1):
            test.data.append(Datum(f"force {i}", force / copies_of_force, deviation / copies_of_force,
                                   (low / test.copies_of_stroke, high / test.copies_of_stroke)))
    if not test.data:
        raise Refused(f"{case}: nothing of it is measured; give it a force curve, {case}=FILE.csv, or Optimisation/data")
    return test


def settings_of(test):
    """The case of a test, with its data as objectives."""
    objectives = [datum.objective for datum in test.data]
    settings = {name: value for name, value in test.settings.items()
                if not name.startswith("Objective ") or name.split("/")[0].removeprefix("Objective ") in objectives}
    settings["Objectives/names"] = ", ".join(objectives)
    for datum in test.data:
        if datum.window:
            section = f"Objective {datum.objective}/"
            settings.update({section + "type": "mean effort", section + "by": "force", section + "window begin": datum.window[0],
                             section + "window end": datum.window[1]})
    for name in OBJECTIVES[1:]:
        settings[name] = ""
    return settings


def write_cases(tests, folder):
    """The parameter files of the tests, for `retroforge optimize` of the first one; returns its path.  @throws Refused"""
    sought = [names_of(test.settings["Design/parameters"]) for test in tests]
    for test, names in zip(tests[1:], sought[1:]):
        if missing := [name for name in names if name not in sought[0]]:
            raise Refused(f"{test.name}: looks for {', '.join(missing)}, which {tests[0].name} does not name in Design/parameters; "
                          "name them there, too, or begin with the test that names all")
    folder.mkdir(parents=True, exist_ok=True)
    for test in tests:
        settings = settings_of(test)
        if test is tests[0]:
            data = [(datum.objective + ("" if of is test else f" of {of.name}"), datum) for of in tests for datum in of.data]
            settings["Optimisation/data"] = ", ".join(f"{name}: {float(datum.value)!r}" for name, datum in data)
            settings["Optimisation/uncertainties"] = ", ".join(f"{name}: {float(datum.deviation)!r}" for name, datum in data)
            settings["Optimisation/operations"] = ", ".join(f"{other.name}.prm" for other in tests[1:])
            settings["Optimisation/confirmation"] = 0
            if settings["Optimisation/first step"] == "1":
                settings["Optimisation/first step"] = "5"
        write_settings(folder / f"{test.name}.prm", settings)
    return folder / f"{tests[0].name}.prm"


@dataclasses.dataclass
class Result:
    """What was found: of each parameter its value [in its unit], the standard deviation by errors of the data, what finer numerics
    change, and half of the 95 % interval; correlations of the errors (n, n); the sum of squared misfits, and data less parameters."""
    names: list
    units: list
    found: np.ndarray  # on the mesh of the search
    values: np.ndarray  # corrected by what finer numerics change
    deviations: np.ndarray
    numerics: np.ndarray
    half_widths: np.ndarray
    correlations: np.ndarray
    misfit: float
    freedom: int
    held: list  # parameters that are at a bound, and have no interval

    def disagrees(self):
        """Whether the misfit is beyond what errors of the given deviations make of it, as `retroforge optimize` judges."""
        return self.misfit > self.freedom + 3 * np.sqrt(2 * max(self.freedom, 1)) + 4


def evaluate(jacobian, misfits, change, sources, finer):
    """Parameters by one step of Gauss and Newton from those of the search, for data less what finer numerics change.

    jacobian, misfits and change are of each datum, in its deviations, `sources` says which have their numerics in common: a force curve, a
    bore. Returns (step, deviations, part of numerics, half widths, correlations, sum of squares). With elements `finer` times as large an
    error of first order falls to that part, so that finer/(1 - finer) times its change is left; what the sources leave adds up, so
    that two of them do not cancel by chance.  @throws Refused  where the data do not tell parameters apart
    """
    scales = np.linalg.norm(jacobian, axis=0)
    if not np.all(scales > 0) or np.linalg.cond(jacobian / scales) > 1e6:
        raise Refused("the data do not tell the parameters apart; look for fewer, or add a test: two speeds for m, a ring for friction")
    inverse = np.linalg.pinv(jacobian / scales) / scales[:, None]
    covariance = inverse @ inverse.T
    by_source = np.array([-inverse @ np.where(sources == source, change, 0) for source in np.unique(sources)])
    numerics = by_source.sum(axis=0)
    step = -inverse @ misfits + numerics
    deviations = np.sqrt(np.diag(covariance))
    misfit = float(np.sum((misfits + change + jacobian @ step)**2))
    left = finer / (1 - finer) * np.abs(by_source).sum(axis=0)
    return step, deviations, numerics, np.hypot(WIDTH_95 * deviations, left), covariance / np.outer(deviations, deviations), misfit


def finer_settings(test, finer, folder):
    """The numerics of a test with smaller elements, and each increment in two halves; None of a billet from a file, which has no finer mesh."""
    if test.settings["Billet/shape"] == "file":
        return None
    table = folder / f"{test.name}_halves.csv"
    halves = np.sort(np.concatenate((test.ends, test.ends - 0.5 * np.diff(test.ends, prepend=0))))
    table.write_text("stroke\n" + "".join(f"{float(end)!r}\n" for end in halves), encoding="utf-8")
    sizes = {name: float(test.settings[name]) for name in ("Billet/element size", "Remeshing/element size")}
    return {"Press/steps": table.resolve(), **{name: finer * size for name, size in sizes.items() if size > 0}}


def evaluate_at(tests, found, forgings, finest, finer):
    """The result where the search has ended.
    @param found  what optimisation.json has     @param forgings  with gradients there, of each test
    @param finest  with smaller elements and increments, or None"""
    free = [parameter for parameter in found["parameters"] if not parameter["at"]]
    if not free:
        raise Refused("all parameters are at their bounds")
    names = [parameter["name"] for parameter in free]
    rows, misfits, change, sources = [], [], [], []
    for test, forging, fine in zip(tests, forgings, finest):
        for datum in test.data:
            value, by = forging.objectives[datum.objective], forging.gradients[datum.objective]
            rows.append([by.get(parameter, 0.0) / datum.deviation for parameter in names])
            misfits.append((value - datum.value) / datum.deviation)
            sources.append(f"{test.name} {'' if datum.window else datum.objective}")
            change.append((fine.objectives[datum.objective] - value) / datum.deviation if fine else 0.0)
    step, deviations, numerics, widths, correlations, misfit = evaluate(*map(np.array, (rows, misfits, change, sources)), finer)
    best = np.array([parameter["best"] for parameter in free])
    return Result(names, [parameter["unit"] for parameter in free], best, best + step, deviations, numerics, widths, correlations, misfit,
                  len(rows) - len(free), [parameter for parameter in found["parameters"] if parameter["at"]])


def identify(cases, folder, options):
    """@param cases  [(parameter file, file of a force curve or None)]; returns (result, tests, forgings at the end).
    @throws Refused, retroforge.Error"""
    folder = pathlib.Path(folder)
    if folder.exists() and any(folder.iterdir()):
        raise Refused(f"{folder}: has results already; name another folder, or remove it")
    tests = [prepare(case, measured, folder, options) for case, measured in cases]
    first = write_cases(tests, folder / "tests")
    found = retroforge.optimize(first.resolve(), folder=folder / "search")
    if not found["converged"]:
        print(f"note: the search did not come to its end: {found['stop']}; begin with other values")
    forgings, finest = [], []
    for test in tests:
        best = (folder / "search" / ("best.prm" if test is tests[0] else f"best_{test.name}.prm")).resolve()
        forgings.append(retroforge.run(best, {"Output/record": False}, folder=folder / "fit" / test.name))
        smaller = finer_settings(test, options.finer, folder / "tests") if options.finer else None
        finest.append(smaller and retroforge.run(best, {"Output/record": False, **smaller}, command="simulate", folder=folder / "finer" / test.name))
        if options.finer and not smaller:
            print(f"note: {test.name} has a billet from a file, and no finer mesh: what numerics change there is not known")
    return evaluate_at(tests, found, forgings, finest, options.finer), tests, forgings


def as_table(result):
    lines = [f"{'':24}{'value':>12}{'95 %':>12}{'of it noise':>13}{'numerics':>11}"]
    lines += [f"{name:24}{value:12.6g} +-{width:9.3g}{WIDTH_95 * deviation:13.3g}{numerics:+11.2g}{' ' + unit if unit else ''}"
              for name, unit, value, width, deviation, numerics in zip(result.names, result.units, result.values, result.half_widths,
                                                                       result.deviations, result.numerics)]
    lines += [f"{parameter['name']:24}{parameter['best']:12.6g} {parameter['at']}: no interval" for parameter in result.held]
    lines += ["", "correlations"] + [f"{name:24}" + "".join(f"{r:8.3f}" for r in row[:i + 1])
                                     for i, (name, row) in enumerate(zip(result.names, result.correlations))]
    lines += ["", f"sum of squares {result.misfit:.4g}, about {result.freedom} expected"]
    if result.disagrees():
        lines.append("note: tests and model do not agree within the deviations, and intervals are not to be trusted: is the law of the metal "
                     "the right one, the friction the same in all tests, the metal as warm as said, the scatter independent?")
    return "\n".join(lines)


def as_json(result):
    entries = [{"name": name, "unit": unit, "value": value, "half_width_95": width, "deviation": deviation, "numerics": numerics,
                "on_mesh_of_search": on_mesh}
               for name, unit, value, width, deviation, numerics, on_mesh in
               zip(result.names, result.units, result.values.tolist(), result.half_widths.tolist(), result.deviations.tolist(),
                   result.numerics.tolist(), result.found.tolist())]
    return {"parameters": entries, "correlations": result.correlations.tolist(), "misfit": result.misfit, "freedom": result.freedom,
            "disagrees": bool(result.disagrees()), "held": [parameter["name"] for parameter in result.held]}


def force_curve(test, forging):
    """Strokes and forces of the whole part: the force of an increment is that in its middle."""
    end = forging.history["stroke"]
    return test.copies_of_stroke * (end - 0.5 * np.diff(end, prepend=0)), test.copies_of_force * forging.history["force"]


def draw(path, result, tests, forgings):
    """Measured forces, those of the fit, and under them their differences in deviations of the windows."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    drawn = [(test, forging) for test, forging in zip(tests, forgings) if test.curve is not None]
    if not drawn:
        return False
    figure, axes = pyplot.subplots(2, len(drawn), figsize=(1 + 3.2 * len(drawn), 4.8), squeeze=False, sharex="col",
                                   gridspec_kw={"height_ratios": [3, 1]})
    for (test, forging), (above, below) in zip(drawn, axes.T):
        above.plot(test.curve.stroke, test.curve.force / 1e3, ".", markersize=3, color="0.6", label="measured")
        strokes, forces = force_curve(test, forging)
        above.plot(strokes, forces / 1e3, color="C0", label="fitted")
        above.set_title(test.name)
        windows = [datum for datum in test.data if datum.window]
        middles = [test.copies_of_stroke * sum(datum.window) / 2 for datum in windows]
        below.plot(middles, [(datum.value - forging.objectives[datum.objective]) / datum.deviation for datum in windows], "o", markersize=3)
        below.axhline(0, color="C0", linewidth=1)
        below.set_xlabel("stroke [mm]")
        below.set_ylim(-4, 4)
    axes[0, 0].set_ylabel("force [kN]")
    axes[1, 0].set_ylabel("misfit / deviation")
    axes[0, 0].legend(fontsize="small")
    figure.suptitle(", ".join(f"{name} {value:.4g} ± {width:.2g}" for name, value, width in zip(result.names, result.values, result.half_widths)),
                    fontsize="small")
    figure.tight_layout()
    figure.savefig(path, dpi=90)
    pyplot.close(figure)
    return True


def parse_arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tests", nargs="+", metavar="CASE.prm[=FILE.csv]")
    parser.add_argument("--output", required=True, type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--windows", type=int, default=12, help="of each force curve (default: 12)")
    parser.add_argument("--begin", type=float, default=0.05, help="part of the stroke before the first window, in which dies and metal "
                                                                  "bed in (default: 0.05)")
    parser.add_argument("--finer", type=float, default=0.7, help="elements of the forgings that tell what numerics change, over those of "
                                                                 "the tests; 0 leaves it out (default: 0.7)")
    options = parser.parse_args(words)
    if options.windows < 1 or not 0 <= options.begin < 1 or not 0 <= options.finer < 1:
        parser.error("there is one window at least; --begin and --finer are parts, from 0 to below 1")
    options.cases = [(case, measured or None) for case, _, measured in (word.partition("=") for word in options.tests)]
    stems = [pathlib.Path(case).stem for case, _ in options.cases]
    if len(set(stems)) < len(stems):
        parser.error("the files of tests need different names")
    return options


def main():
    options = parse_arguments()
    try:
        result, tests, forgings = identify(options.cases, options.output, options)
    except (Refused, retroforge.Error) as error:
        raise SystemExit(f"identify.py: {error}") from error
    print(as_table(result))
    (options.output / "identification.json").write_text(json.dumps(as_json(result), indent=1) + "\n", encoding="utf-8")
    if draw(options.output / "identification.png", result, tests, forgings):
        print(options.output / "identification.png")


if __name__ == "__main__":
    main()
