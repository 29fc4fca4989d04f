# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The Markdown pages as Doxygen wants them: each with an identifier, links between them as references, pictures in one
folder, and the chapters of the contents as a tree."""
import html
import os
import pathlib
import re
import shutil

CONTENTS = "doc/manual/README.md"
CASES = "Cases"  # the chapter of all README.md below prm/

FENCE = re.compile(r"^\s*```")
CODE = re.compile(r"(`[^`]*`)")
HEADING = re.compile(r"^#.*`.*$", re.M)
CLASS = re.compile(r"(?<!\[)`(?P<name>[A-Z]\w+)`")
DECLARATION = re.compile(r"^  (?:class|struct) (\w+)(?: : .*)?\s*(?:\{.*)?$", re.M)
CODE_PAGES = ("doc/theory/", "doc/manual/tour", "doc/manual/extending")  # where a name in capitals is a class
LINK = re.compile(r"(?P<image>!?)\[(?P<text>[^\]]*)\]\((?P<target>[^)\s]+)\)")
ITEM = re.compile(r"- \[[^\]]*\]\((?P<target>[^)]*)\): (?P<note>.*)")


class PageError(Exception):
    """Where and what is wrong with a page."""


def identifier(path):
    return re.sub(r"\W", "_", path)


def outside_code(text, change):
    """Text with `change` made where no code stands."""
    lines, fenced = [], False
    for line in text.split("\n"):
        if FENCE.match(line):
            fenced = not fenced
        elif not fenced and not line.startswith("    "):
            line = "".join(part if part.startswith("`") else change(part) for part in CODE.split(line))
        lines.append(line)
    return "\n".join(lines)


def resolve(page, target):
    """Path below the root of what a link on a page leads to."""
    return os.path.normpath(os.path.join(os.path.dirname(page), target))


class Book:
    """All pages, by their paths below the root."""

    def __init__(self, root, generated):
        self.root = root
        paths = [root / "README.md", root / "CONTRIBUTING.md", *root.glob("doc/**/*.md"), *root.glob("prm/**/README.md")]
        self.texts = {str(path.relative_to(root)): path.read_text(encoding="utf-8") for path in sorted(paths)}
        self.texts.update(generated)
        headers = [path.read_text(encoding="utf-8") for path in root.glob("include/**/*.h")]
        self.classes = set(DECLARATION.findall("\n".join(headers)))

    def title(self, page):
        """Without code: the tree and headings show it as plain text."""
        return self.texts[page].split("\n", 1)[0].lstrip("# ").replace("`", "")

    def chapters(self):
        """Titles of the chapters, and of each the pages in order, with a note on each."""
        chapters = {}
        for part in self.texts[CONTENTS].split("\n## ")[1:]:
            title, _, rest = part.partition("\n")
            chapters[title] = {resolve(CONTENTS, item["target"]): item["note"] for item in ITEM.finditer(rest)}
        chapters[CASES] = {page: f"`{page.rpartition('/')[0]}`" for page in self.texts if page.startswith("prm/")}
        listed = [page for pages in chapters.values() for page in pages]
        for page in listed:
            if page not in self.texts:
                raise PageError(f"{CONTENTS}: lists {page}, which is no page")
            if listed.count(page) > 1:
                raise PageError(f"{CONTENTS}: lists {page} twice")
        for page in self.texts:
            if page not in listed and page != CONTENTS:
                raise PageError(f"{CONTENTS}: does not list {page}; give each page its place among the contents")
        return chapters

    def link(self, page, match, images):
        text, target = match["text"], match["target"].partition("#")[0]
        if "://" in match["target"] or not target:
            return match[0]
        path = resolve(page, target)
        if match["image"]:
            name = identifier(path.rpartition(".")[0]) + pathlib.Path(path).suffix
            try:
                shutil.copyfile(self.root / path, images / name)
            except OSError as error:
                raise PageError(f"{page}: the picture {path} cannot be read") from error
            return f"![{text}]({name})"
        if path in self.texts:
            shown = self.title(path) if re.fullmatch(r"[\w/.]+\.md", text) else text
            return f"[{shown}](@ref {identifier(path)})"
        if not (self.root / path).exists():
            raise PageError(f"{page}: the link to {target} leads nowhere")
        if path.endswith(".dot"):
            return f"\n@dotfile {pathlib.Path(path).name} \"{text}\"\n"
        plain = text.strip("`")
        return f"`{plain}`" if plain.rstrip("/").endswith(pathlib.Path(path).name) else f"{plain} (`{path}`)"

    def link_to_class(self, match):
        name = match["name"]
        return f"[{name}](@ref retroforge::{name})" if name in self.classes else match[0]

    def for_doxygen(self, page, images):
        title, _, rest = self.texts[page].partition("\n")
        if not title.startswith("# "):
            raise PageError(f"{page}: the first line is no title")
        rest = outside_code(rest, lambda part: LINK.sub(lambda match: self.link(page, match, images), part))
        rest = HEADING.sub(lambda match: match[0].replace("`", ""), rest)
        if page.startswith(CODE_PAGES):
            rest = CLASS.sub(self.link_to_class, rest)
        return f"# {self.title(page)} {{#{identifier(page)}}}\n{rest}"


def write(root, source, images, generated):
    """Pages of the repository at `root`, and generated ones (path -> text), to `source`; their pictures to `images`."""
    book = Book(root, generated)
    chapters = book.chapters()
    for page in book.texts:
        path = source / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(book.for_doxygen(page, images), encoding="utf-8")
    for number, (title, pages) in enumerate(chapters.items(), 1):  # Doxygen orders chapters by the names of their files
        tree = "".join(f"- @subpage {identifier(page)} – {note}\n" for page, note in pages.items())
        (source / f"chapter_{number}.md").write_text(f"# {title} {{#chapter_{number}}}\n\n{tree}", encoding="utf-8")


HREF = re.compile(r'(?:href|src|data)="([^"#?:]+)["#?]')  # no address with a scheme
SHOWN_AS_IT_IS = re.compile(r"<(pre|script|code|tt)\b.*?</\1>|<div class=\"fragment\">.*?</div><!-- fragment -->", re.S)
MARKUP = re.compile(r".{0,40}(?:\*\*|`|<tt>|\]\(#|\]\(\w+\.\w|@ref|@cite).{0,40}")


def complaints(folder):
    """Links of the website to files that are not there, and markup that its pages show."""
    names = {path.name for path in folder.iterdir()}
    found = set()
    for page in folder.glob("*.html"):
        text = page.read_text(encoding="utf-8")
        found |= {f"{page.name}: the link to {target} leads nowhere" for target in HREF.findall(text)
                  if target not in names and not (folder / target).exists()}
        plain = html.unescape(re.sub(r"<[^>]*>", "", SHOWN_AS_IT_IS.sub("", text)))
        found |= {f"{page.name}: shows markup: {shown.strip()}" for shown in MARKUP.findall(plain)}
    return sorted(found)
