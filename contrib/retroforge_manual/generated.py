# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Pages that nobody writes: parameters and commands as the program tells them, and the news."""
import re
import subprocess

EXAMPLES = {"Die lower": "Die NAME", "Objective energy": "Objective NAME"}  # sections that stand for others
REPEATED = {"Die upper"}

ENTRY = re.compile(r"(?P<meaning>.*?)\s*Units: (?P<unit>.*?)\.\s*Allowed: (?P<allowed>.*?)\.\s*Default: (?P<default>.*)")


def entries(printed):
    """(section, name, comment) of each parameter in the output of --print-parameters; of subsections `A/B`."""
    path, comment = [], []
    for line in map(str.strip, printed.splitlines()):
        if line.startswith("#"):
            comment.append(line.lstrip("# "))
        elif line.startswith("subsection "):
            path.append(line.split(" ", 1)[1])
        elif line == "end":
            path.pop()
        elif line.startswith("set "):
            yield "/".join(path), line[4:].split("=", 1)[0].strip(), " ".join(comment)
            comment = []


def cell(text):
    """As it stands, in a table of Markdown."""
    return re.sub(r"`([^`']*)'", r"`\1`", text).replace("|", "\\|").replace("<", "\\<").replace(">", "\\>")


def parameters(printed):
    lines = ["# Parameters", "",
             "All sections of a parameter file, from `retroforge --print-parameters`. A scene sets what differs from the "
             "default. `Die NAME` and `Objective NAME` stand for one section for each name.", ""]
    last = None
    for section, name, comment in entries(printed):
        head, _, rest = section.partition("/")
        if head in REPEATED:
            continue
        section = EXAMPLES.get(head, head) + ("/" + rest if rest else "")
        if section != last:
            lines += ["", f"## {section}", "", "| name | default | unit | allowed | meaning |", "| --- | --- | --- | --- | --- |"]
            last = section
        found = ENTRY.fullmatch(comment)
        if not found:
            raise ValueError(f"{section}/{name}: the description has no unit, range or default: {comment}")
        texts = [cell(found[key]) for key in ("default", "unit", "allowed", "meaning")]
        lines.append(f"| `{name}` | " + " | ".join(texts) + " |")
    return "\n".join(lines) + "\n"


def commands(usage):
    return "# Commands\n\nFrom `retroforge --help`:\n\n```\n" + usage.rstrip() + "\n```\n"


def news(folder):
    """The newest first; each paragraph is a piece of news."""
    lines = ["# News", ""]
    files = sorted(folder.iterdir(), key=lambda path: path.name, reverse=True)
    date = None
    for path in files:
        day = path.name.partition("_")[0]
        if day != date:
            lines += [f"## {day[:4]}-{day[4:6]}-{day[6:]}", ""]
            date = day
        text = path.read_text(encoding="utf-8").strip()
        lines += [re.sub(r"(?m)^(New|Changed|Fixed):", r"\n**\1:**", text), ""]
    return "\n".join(lines)


def pages(root, program):
    """Path below the root -> text."""
    def said(option):
        return subprocess.run([program, option], capture_output=True, text=True, check=True).stdout
    return {"doc/manual/parameters.md": parameters(said("--print-parameters")),
            "doc/manual/commands.md": commands(said("--help")),
            "doc/manual/news.md": news(root / "doc/news")}
