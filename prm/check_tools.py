# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What a case reads out of the section `check` of a summary."""


def check_rows(summary):
    """{parameter: row of the check}"""
    return {row["parameter"]: row for row in summary["check"]}


def errors(row, key):
    """[(step, |difference/adjoint - 1|)] of one kind of differences, largest step first."""
    return sorted(((s["step"], float("inf") if s[key] is None else abs(s[key] / row["adjoint"] - 1.0))
                   for s in row["steps"]), reverse=True)


def worst_over_decades(row, key="replayed_central", decades=3):
    """The largest error over that many decades of step, in the decades where it is smallest."""
    points = errors(row, key)
    windows = [[e for step, e in points if top >= step >= top * 10.0**-decades * (1.0 - 1e-9)]
               for top, _ in points if points[-1][0] <= top * 10.0**-decades * (1.0 + 1e-9)]
    return min(max(window) for window in windows)


def best(row, key):
    return min(e for _, e in errors(row, key))


def table(rows, keys=("replayed_central", "free_central")):
    """A Markdown table of the errors of each row, as READMEs show it."""
    lines = ["| parameter | step | " + " | ".join(key.replace("_", " ") for key in keys) + " |",
             "| --- | --- |" + " --- |" * len(keys)]
    for name, row in rows.items():
        for step, _ in errors(row, keys[0]):
            cells = [f"{dict(errors(row, key))[step]:.1e}" for key in keys]
            lines.append(f"| {name} | {step:.0e} | " + " | ".join(cells) + " |")
    return "\n".join(lines)
