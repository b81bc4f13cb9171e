"""Every example of docs/recipes.md runs by the commands that stand there."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "recipes.md").read_text(encoding="utf-8")
COMMANDS = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FOLDER = re.compile(r"\(\.\./(examples/\w+)\)")
SECTIONS = dict(part.split("\n", 1) for part in PAGE.split("\n## ")[1:])

# Recipes whose commands run, with a number or a word that must be in what they print.
RECIPES = {
    ("Stages: prepare, consolidate, shear, unload",): r"3_shear .* shear +8\.\d+ kPa",
    ("A heap of discs",): r"392 particles, 4\d\d contacts on average",
}


def test_every_recipe_with_commands_is_run():
    told = {name for names in RECIPES for name in names}
    written = {name for name, text in SECTIONS.items() if COMMANDS.search(text)}
    assert told == written


@pytest.mark.parametrize("names", RECIPES, ids=lambda names: names[0])
def test_recipe(names, request, tmp_path):
    program = ROOT / request.config.getoption("--program")
    said = ""
    for name in names:
        shutil.copytree(ROOT / FOLDER.search(SECTIONS[name])[1], tmp_path, dirs_exist_ok=True)
        for command in COMMANDS.search(SECTIONS[name])[1].splitlines():
            words = shlex.split(command)
            words[0] = {"cograin": str(program), "python": sys.executable}[words[0]]
            environment = {**os.environ, "PYTHONPATH": str(ROOT / "python")}
            done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
            assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"
            said += done.stdout
    assert re.search(RECIPES[names], said), said
