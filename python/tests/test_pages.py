"""The book has a page for each law, its links are looked at, and all that states a version states the same."""

import importlib.util
import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def pages():
    spec = importlib.util.spec_from_file_location("pages", ROOT / "tools" / "pages.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_contact_sub_model_has_a_page_with_equation_symbols_and_source(pages, tmp_path):
    pages.gather(tmp_path)
    contents = (tmp_path / "SUMMARY.md").read_text(encoding="utf-8")
    files = [path for path in (ROOT / "src" / "laws" / "contact").glob("*/*.rs") if path.stem != "none"]
    named = [path for path in files if "const NAME: &'static str = " in path.read_text(encoding="utf-8")]
    assert len(named) > 10
    for path in named:
        page = f"laws/contact/{path.parent.name}/{path.stem}.md"
        text = (tmp_path / page).read_text(encoding="utf-8")
        assert f"({page})" in contents
        assert all(part in text for part in ("```text\n", "| symbol", "Source: ")), page


def test_links_of_the_table_of_contents_lead_to_pages(pages, tmp_path):
    pages.gather(tmp_path)
    links = re.findall(r"\]\((.*?)\)", (tmp_path / "SUMMARY.md").read_text(encoding="utf-8"))
    assert [link for link in links if not (tmp_path / link).exists()] == []
    assert len(links) == len(set(links)) > 100


def test_links_that_lead_nowhere_and_stars_taken_for_emphasis_are_told(pages, tmp_path):
    page = '<main><h1 id="top">T</h1><a href="#top"></a><a href="b.html#no"></a><img src="c.png"><em>²/E</em></main>'
    (tmp_path / "a.html").write_text(page, encoding="utf-8")
    (tmp_path / "b.html").write_text('<main><a href="a.html#top"></a></main>', encoding="utf-8")
    told = ["a.html: write \\* in front of ²/E", "a.html: b.html#no leads nowhere", "a.html: c.png leads nowhere"]
    assert pages.check(tmp_path) == told


def test_crate_wheel_and_citation_state_one_version():
    crate = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]["version"]
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    citation = re.search(r"^version: (.*)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE)[1]
    assert (wheel, citation) == (crate, crate)


def test_every_page_of_the_documentation_is_in_the_table_of_contents(pages, tmp_path):
    pages.gather(tmp_path)
    contents = (tmp_path / "SUMMARY.md").read_text(encoding="utf-8")
    written = [path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md") if path.stem != "SUMMARY"]
    assert [page for page in written if f"({page})" not in contents] == []
