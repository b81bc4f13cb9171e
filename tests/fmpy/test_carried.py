"""What a unit carries beside its library: units of names, an experiment by which an importer checks itself, a picture."""

import csv
import io
import zipfile

import pytest
from cograin import Unit
from cograin.results import unit_of

REFERENCE = "extra/org.fmi-standard.fmi-ls-ref/"


def table(archive, name):
    """Heading and rows of a table of the reference experiment."""
    rows = list(csv.reader(io.StringIO(archive.read(REFERENCE + name).decode())))
    return rows[0], rows[1:]


def test_a_name_tells_the_unit_of_its_variable(unit, model):
    with Unit(unit(model)) as opened:
        for name, variable in opened.variables.items():
            # A rate counts mass or particles: the scene says which.
            if variable.causality != "parameter" and not name.endswith(".rate"):
                assert unit_of(name) == (variable.unit or "1"), name


def test_an_importer_that_repeats_the_experiment_gets_its_numbers(unit, model):
    with zipfile.ZipFile(unit(model)) as archive:
        (_, *inputs), given = table(archive, "inputs.csv")
        (_, *outputs), results = table(archive, "results.csv")
    with Unit(
        unit(model), inputs={name: float(value) for name, value in zip(inputs, given[0][1:], strict=True)}
    ) as opened:
        length = float(results[1][0])
        for row, (time, *values) in zip(given, results, strict=True):
            if float(time) > 0.0:
                opened.set(inputs, map(float, row[1:]))
                opened.step(length)
            found = [
                str(opened[name]) if opened.variables[name].type == "Integer" else opened[name] for name in outputs
            ]
            wanted = [
                value if opened.variables[name].type == "Integer" else float(value)
                for name, value in zip(outputs, values, strict=True)
            ]
            assert found == wanted, f"at {time} s"


def test_every_related_file_is_in_the_unit(unit, model):
    from posixpath import join, normpath
    from xml.etree import ElementTree

    with zipfile.ZipFile(unit(model)) as archive:
        manifest = ElementTree.fromstring(archive.read(REFERENCE + "fmi-ls-manifest.xml"))
        names = set(archive.namelist())
        for related in manifest:
            assert normpath(join(REFERENCE, related.get("source"))) in names
        assert {"documentation/licenses/license.txt", "documentation/licenses/third_party.txt", "model.png"} <= names


def test_the_picture_shows_something(unit, model):
    image = pytest.importorskip("PIL.Image")
    with zipfile.ZipFile(unit(model)) as archive:
        picture = image.open(io.BytesIO(archive.read("model.png")))
    colours = picture.convert("RGB").getcolors(maxcolors=1 << 20)
    white = sum(count for count, colour in colours if colour == (255, 255, 255))
    assert len(colours) > 8 and white < 0.98 * picture.width * picture.height
