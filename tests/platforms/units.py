"""Units as `platforms.py` steps them: what their description says, and courses for the host in C."""

import csv
import math
import zipfile
from xml.etree import ElementTree

EXPERIMENT = "extra/org.fmi-standard.fmi-ls-ref"
#: Communication steps of the swing, and how long it takes to come back.
STEPS, PERIOD = 40, 8


class Variable:
    """A real variable of either edition: a value, or in FMI 3.0 an array of them."""

    def __init__(self, element):
        self.name = element.get("name")
        self.causality = element.get("causality")
        self.reference = element.get("valueReference")
        real = element if element.tag == "Float64" else element.find("Real")
        self.nominal = float(real.get("nominal", 0.0))
        counts = [int(dimension.get("start")) for dimension in element.iter("Dimension")]
        self.columns = [self.name] if not counts else [f"{self.name}[{it}]" for it in range(math.prod(counts))]
        start = [float(word) for word in (real.get("start") or "0").split()]
        self.start = start * len(self.columns) if len(start) == 1 else start

    def values(self, share):
        """Its values, displacements with a share of a thousandth of their usual magnitude."""
        moved = "displacement" in self.name.split(".")
        return [repr(start + (share * 0.001 * self.nominal if moved else 0.0)) for start in self.start]


class Unit:
    """What its description says."""

    def __init__(self, path, folder):
        self.path, self.folder = path, folder
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        description = ElementTree.parse(folder / "modelDescription.xml").getroot()
        self.edition = int(description.get("fmiVersion")[0])
        self.token = description.get("guid") or description.get("instantiationToken")
        elements = description.find("ModelVariables")
        reals = [it for it in elements if it.tag == "Float64" or it.find("Real") is not None]
        variables = [Variable(it) for it in reals if it.get("causality") in ("input", "output")]
        self.inputs = [it for it in variables if it.causality == "input"]
        self.outputs = [it for it in variables if it.causality == "output"]
        self.columns = ["time", *(column for it in self.outputs for column in it.columns)]
        self.results = self.table("results.csv") if (folder / EXPERIMENT).is_dir() else []
        step = description.find("DefaultExperiment").get("stepSize")
        #: Length of a communication step [s].
        self.length = float(self.results[1]["time"] if self.results else step)

    def table(self, name):
        """Rows of a table of the experiment that the unit carries."""
        with (self.folder / EXPERIMENT / name).open() as text:
            return list(csv.DictReader(text))

    def course(self, rows):
        """The text for the host."""
        references = [it.reference for it in self.inputs + self.outputs]
        values = [value for row in rows for value in row]
        counts = [number for side in (self.inputs, self.outputs) for number in (len(side), values_of(side))]
        return " ".join(map(str, [*counts, len(rows) - 1, repr(self.length), *references, *values]))

    def at_rest(self):
        """The experiment that the unit carries."""
        return self.course([[row[it.name] for it in self.inputs] for row in self.table("inputs.csv")])

    def swing(self):
        """Every displacement goes to and fro by a thousandth of its usual magnitude; other inputs stay."""
        shares = [(PERIOD / 2 - abs(step % PERIOD - PERIOD / 2)) / (PERIOD / 2) for step in range(STEPS + 1)]
        return self.course([[value for it in self.inputs for value in it.values(share)] for share in shares])


def values_of(variables):
    """How many values they have together."""
    return sum(len(it.columns) for it in variables)


def differences(names, ours, theirs):
    """The first place where two lists of rows part, in words; nothing where they are the same."""
    for step, (one, other) in enumerate(zip(ours, theirs, strict=True)):
        for name, value, found in zip(names, one, other, strict=True):
            if float(value) != float(found):
                return f"step {step}, {name}: expected {value}, found {found}"
    return None
