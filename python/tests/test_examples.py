"""The examples of ``help(cograin)`` and of its modules run."""

import doctest
import importlib
import os
import pkgutil

import cograin


def test_every_example_gives_what_it_says(program, tmp_path, monkeypatch):
    # The command that the examples find is the one of the tests.
    monkeypatch.setenv("PATH", f"{program.path.resolve().parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setattr("sysconfig.get_path", lambda name: str(tmp_path))
    monkeypatch.chdir(tmp_path)
    names = [f"cograin.{module.name}" for module in pkgutil.iter_modules(cograin.__path__)]
    tried = 0
    for name in ["cograin", *names]:
        done = doctest.testmod(importlib.import_module(name))
        assert done.failed == 0, name
        tried += done.attempted
    assert tried > 8
