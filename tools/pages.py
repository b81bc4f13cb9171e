"""Gathers the pages of the book into a folder, and looks at the links of the built book.

    tools/pages.py gather FOLDER    the pages of the tree, a page for each law, the table of contents
    tools/pages.py check FOLDER     whether links of the built pages lead to a page and an anchor, and stars are symbols

The page of a law is the doc comment of its type in `src/laws`: one sentence, the equation, the symbols, when it holds,
the source. A file holds a law if it names one (`const NAME`), or documents a type with a table of symbols.
"""

import html
import posixpath
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LAWS = ROOT / "src" / "laws"
GATHERED = [
    "*.md",
    "LICENSE-*",
    "CITATION.cff",
    "docs/**",
    "python/README.md",
    "examples/*.py",
    "examples/*.ipynb",
    "models/*/*.md",
    "models/*/*.png",
]
"""What of the tree is in the book, as patterns of `git ls-files`."""
ROOMS = {
    "bond/breakage": ("Breakage of bonds", "[bond.<name>.breakage.{}]"),
    "bond/damping": ("Damping of bonds", "[bond.<name>.damping.{}]"),
    "bond/formulation": ("Formulations of bonds", 'formulation = "{}"'),
    "drag": ("Drag of fluids", "[fluid.<name>.drag.{}]"),
    "lift": ("Lift in fluids", "[fluid.<name>.lift.{}]"),
    "contact/cohesion": ("Cohesion", "[contact.<name>.cohesion.{}]"),
    "contact/heat": ("Heat", "[contact.<name>.heat.{}]"),
    "contact/normal": ("Normal force", "[contact.<name>.normal.{}]"),
    "contact/rolling": ("Rolling resistance", "[contact.<name>.rolling.{}]"),
    "contact/tangential": ("Friction", "[contact.<name>.tangential.{}]"),
}
"""Title of each room of laws, and how a scene writes a law of it. A room that is not here has its folder as title."""


def documented(text):
    """Each documented item of a Rust file: its doc comment without marks, and the first line of the item."""
    comment = []
    for line in map(str.strip, text.splitlines()):
        if line.startswith("///"):
            comment.append(line[3:].removeprefix(" "))
        elif comment and not line.startswith("#["):
            yield re.sub(r"\[(`[^`]+`)\](\([^)]*\))?", r"\1", "\n".join(comment)), line
            comment = []


def law_of(path):
    """The names of the law that a file holds and its doc comment; None if it holds none."""
    text = path.read_text(encoding="utf-8")
    types = [comment for comment, item in documented(text) if re.match(r"pub(\(\w+\))? struct (?!Keys)", item)]
    names = re.findall(r"const NAME: &'static str = \"(\w+)\"", text)
    if not names:
        types = [comment for comment in types if "| symbol" in comment]
    if not types or path.stem in ("none", "fixtures"):
        return None
    rows = path.with_name("mod.rs").read_text(encoding="utf-8")
    names = names or [row.lower() for row in re.findall(rf"^ +(\w+): {path.stem}::", rows, re.MULTILINE)]
    return names or [path.stem], types[0]


def keys_of(path):
    """The keys that a scene writes for the law of a file, as a table; nothing if it has none. Laws may share keys."""
    text = path.read_text(encoding="utf-8")
    other = re.search(r"type Keys = (\w+)::Keys;", text) or re.search(r"use super::(\w+)::(?:\{[^}]*)?\bKeys\b", text)
    text = path.with_name(f"{other[1]}.rs").read_text(encoding="utf-8") if other else text
    declared = re.search(r"pub struct Keys \{\n(.*?)^\}", text, re.MULTILINE | re.DOTALL)
    rows = ["", "## Keys", "", "| key | meaning | default |", "|---|---|---|"]
    for comment, item in documented(declared[1]) if declared else []:
        if "<Gone>" in item:
            continue
        key, default = re.match(r'pub (?:r#)?(\w+): [^=]*(?:= "(.*)")?,$', item).groups("")
        rows.append(f"| `{key}` | {' '.join(comment.split())} | {default.replace(chr(92) + chr(34), chr(34))} |")
    return "\n".join([*rows, ""]) if declared else ""


def write_code(folder):
    """Writes a page that leads to what `cargo doc` writes; returns its line in the table of contents."""
    text = "# The code\n\n`cargo doc` writes a page for each item: [the library](code/cograin/index.html).\n"
    (folder / "code.md").write_text(text, encoding="utf-8")
    return "- [The code](code.md)"


def write_laws(folder):
    """Writes a page for each law and one for each room; returns their lines in the table of contents."""
    rooms = {}
    for path in sorted(LAWS.rglob("*.rs")):
        law = law_of(path)
        if law:
            rooms.setdefault(path.parent.relative_to(LAWS).as_posix(), []).append((path, *law))
    contents = []
    for room, laws in rooms.items():
        title, written = ROOMS.get(room, (room, "{}"))
        place = folder / "laws" / room
        place.mkdir(parents=True)
        contents.append(f"- [{title}](laws/{room}/index.md)")
        overview = [f"# {title}", "", "| law | |", "|---|---|"]
        for path, names, comment in laws:
            title, page, sentence = ", ".join(names), f"{path.stem}.md", comment.partition("\n\n")[0]
            scene = " ".join(f"`{written.format(name)}`" for name in names)
            code = f"Code: `{path.relative_to(ROOT).as_posix()}`"
            (place / page).write_text(f"# {title}\n\n{scene}\n\n{comment}\n{keys_of(path)}\n{code}\n", encoding="utf-8")
            contents.append(f"  - [{title}](laws/{room}/{page})")
            overview.append(f"| [{title}]({page}) | {' '.join(sentence.split())} |")
        (place / "index.md").write_text("\n".join([*overview, ""]), encoding="utf-8")
    return contents


def pages_of(pattern, line):
    """Lines of the table of contents for the pages of a pattern, with their headings."""
    pages = {path: path.read_text(encoding="utf-8").partition("\n")[0] for path in sorted(ROOT.glob(pattern))}
    return [line.format(heading.lstrip("# "), path.relative_to(ROOT).as_posix()) for path, heading in pages.items()]


def gather(folder):
    """Fills the folder from which the book is built."""
    shutil.rmtree(folder, ignore_errors=True)
    patterns = [f":(glob){pattern}" for pattern in GATHERED]
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", *patterns]
    for name in subprocess.run(listed, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\0")[:-1]:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, folder / name)
    below = {
        "- [Decisions](docs/decisions/README.md)": pages_of("docs/decisions/[0-9]*.md", "  - [{}]({})"),
        "# Laws": ["", *write_laws(folder)],
        "- [Contributing](CONTRIBUTING.md)": [write_code(folder)],
        "# Models": ["", *pages_of("models/*/readme.md", "- [{}]({})")],
    }
    contents = []
    for line in (ROOT / "docs" / "SUMMARY.md").read_text(encoding="utf-8").splitlines():
        # Links of the committed page count from docs/, those of the book's from the root.
        line = re.sub(r"\]\((.*)\)", lambda link: f"]({posixpath.normpath(f'docs/{link[1]}')})", line)
        contents += [line, *below.get(line, [])]
    (folder / "SUMMARY.md").write_text("\n".join([*contents, ""]), encoding="utf-8")


def check(folder):
    """What is wrong in the built pages: links that lead nowhere, and stars of symbols (E*²) taken for emphasis."""
    texts = {page.resolve(): page.read_text(encoding="utf-8") for page in folder.rglob("*.html")}
    anchors = {page: set(re.findall(r'\bid="([^"]*)"', text)) for page, text in texts.items()}
    broken = []
    for page, text in sorted(texts.items()):
        main = text.partition("<main>")[2].partition("</main>")[0]
        name = page.relative_to(folder.resolve())
        broken += [
            f"{name}: write \\* in front of {taken}" for taken in re.findall(r"<em>([^A-Za-zÀ-ÿΑ-ω<][^<]*)", main)
        ]
        for link in map(html.unescape, re.findall(r'(?:href|src)="(?!\w+:)([^"]*)"', main)):
            target, _, anchor = link.partition("#")
            place = (page.parent / target).resolve() if target else page
            if place.is_relative_to(folder.resolve() / "code"):  # written by `cargo doc`
                continue
            if not place.exists() or (anchor and anchor not in anchors.get(place, {anchor})):
                broken.append(f"{name}: {link} leads nowhere")
    return broken


if __name__ == "__main__":
    task, place = sys.argv[1], Path(sys.argv[2])
    if task == "gather":
        gather(place)
    elif broken := check(place):
        sys.exit("\n".join(broken))
