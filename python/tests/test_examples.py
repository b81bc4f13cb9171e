"""The examples of ``help(cograin)`` and of its modules run."""

import ast
import doctest
import importlib
import json
import os
import pkgutil

import pytest
from conftest import ROOT

import cograin


def test_every_example_gives_what_it_says(program, tmp_path, monkeypatch):
    # The command that the examples find is the one of the tests.
    monkeypatch.setenv("PATH", f"{program.path.resolve().parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setattr("sysconfig.get_path", lambda name: str(tmp_path))
    monkeypatch.chdir(tmp_path)
    names = [
        module.name for module in pkgutil.walk_packages(cograin.__path__, "cograin.") if "__main__" not in module.name
    ]
    tried = 0
    for name in ["cograin", *names]:
        done = doctest.testmod(importlib.import_module(name))
        assert done.failed == 0, name
        tried += done.attempted
    assert tried > 8


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.ipynb")), ids=lambda path: path.stem)
def test_every_notebook_runs_and_shows_something(path, program, tmp_path, monkeypatch):
    pytest.importorskip("pandas")
    monkeypatch.setenv("PATH", f"{program.path.resolve().parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setattr("sysconfig.get_path", lambda name: str(tmp_path))
    monkeypatch.chdir(tmp_path)
    book = json.loads(path.read_text(encoding="utf-8"))
    values, shown = {}, 0
    for cell in book["cells"]:
        assert not cell.get("outputs"), "kept without outputs"
        if cell["cell_type"] == "code":
            shown += show(ast.parse("".join(cell["source"])), values)
    assert shown > 3


def show(cell, values):
    """Runs a cell; whether its last expression gives what a notebook shows as more than text."""
    last = cell.body[-1]
    if not isinstance(last, ast.Expr):
        exec(compile(cell, "cell", "exec"), values)
        return False
    exec(compile(ast.Module(cell.body[:-1], []), "cell", "exec"), values)
    found = eval(compile(ast.Expression(last.value), "cell", "eval"), values)
    page = found._repr_html_() if hasattr(found, "_repr_html_") else None
    assert page or found is None or hasattr(found, "savefig") or repr(found)
    return bool(page) or hasattr(found, "savefig")
