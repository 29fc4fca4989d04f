# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A page of headings, notes, tables, and pictures embedded as base64."""
import base64
import html
import io

import matplotlib.pyplot as plt

STYLE = """body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:70rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2.2rem;border-bottom:1px solid #ddd}
h3{font-size:1rem;margin:1.4rem 0 .2rem}img{max-width:100%}table{border-collapse:collapse;margin:.6rem 0}
td,th{padding:.15rem .8rem;border-bottom:1px solid #e6e6e6;text-align:left}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}th.group{padding-top:.9rem}
div.tables{display:flex;flex-wrap:wrap;column-gap:3rem}p.note{color:#666}.bad{color:#b03000;font-weight:bold}"""


class Document:
    def __init__(self, directory, name="report.html"):
        self.directory, self.name, self.body = directory, name, []
        self.pictures = directory / "pictures"
        self.pictures.mkdir(exist_ok=True)
        for old in self.pictures.glob("*.png"):
            old.unlink()

    def save(self, title):
        """Returns the path of the page."""
        path = self.directory / self.name
        path.write_text(f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{html.escape(title)}</title>'
                        f"<style>{STYLE}</style><h1>{html.escape(title)}</h1>\n" + "\n".join(self.body) + "</html>\n",
                        encoding="utf-8")
        return path

    def heading(self, text, level=2):
        self.body.append(f"<h{level}>{html.escape(text)}</h{level}>")

    def note(self, text):
        if text:
            self.body.append(f'<p class="note">{escaped(text)}</p>')

    def picture(self, name, figure, dpi="figure"):
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png", dpi=dpi)
        plt.close(figure)
        (self.pictures / f"{name}.png").write_bytes(buffer.getvalue())
        encoded = base64.b64encode(buffer.getvalue()).decode()
        self.body.append(f'<img alt="{html.escape(name)}" src="data:image/png;base64,{encoded}">')

    def table(self, header, rows):
        """A heading that starts with # is a column of numbers. A row that is a string heads those after it."""
        if rows:
            self.body.append(table(header, rows))

    def tables(self, titled):
        """Side by side where there is room: (title, header, rows)."""
        self.body.append('<div class="tables">' + "\n".join(
            f"<div><h3>{html.escape(title)}</h3>{table(header, rows)}</div>" for title, header, rows in titled) + "</div>")


def table(header, rows):
    numeric = [title.startswith("#") for title in header]

    def line(tag, cells):
        if isinstance(cells, str):
            return f'<tr><th class="group" colspan="{len(header)}">{escaped(cells)}</th></tr>'
        return "<tr>" + "".join(f'<{tag} class="n">{escaped(c)}</{tag}>' if n else f"<{tag}>{escaped(c)}</{tag}>"
                                for c, n in zip(cells, numeric)) + "</tr>"
    lines = [line("th", [title.lstrip("#") for title in header])] if any(title.strip("#") for title in header) else []
    lines += [line("td", row) for row in rows]
    return "<table>" + "\n".join(lines) + "</table>"


class Markup(str):
    """Text that is HTML already."""


def escaped(text):
    return text if isinstance(text, Markup) else html.escape(str(text))


def bad(text):
    return Markup(f'<span class="bad">{html.escape(str(text))}</span>')


def number(value, digits=6, sign=""):
    if value is None:
        return "–"
    return f"{value:{sign},}".replace(",", "\u2009") if isinstance(value, int) else f"{value:{sign}.{digits}g}"
