"""Units of FMI 3.0: valid, with the bits of the same unit of FMI 2.0, and fields that are read in one call."""

import re
import shutil
import subprocess
import time
from pathlib import Path

import fmpy
import fmpy.fmi3
import numpy as np
import pytest
from conftest import ROOT, given
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from lxml import etree

SCHEMAS = Path(fmpy.__file__).parent / "schema" / "fmi3"


class Slave3:
    """fmpy's own slave of a unit of FMI 3.0, by names of variables; each value is a flat list."""

    def __init__(self, path, folder, name="unit", start=True):
        fmpy.extract(str(path), str(folder))
        self.description = fmpy.read_model_description(str(folder))
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self.said = []
        identifier = self.description.coSimulation.modelIdentifier
        self.slave = fmpy.fmi3.FMU3Slave(
            guid=self.description.guid, unzipDirectory=str(folder), modelIdentifier=identifier, instanceName=name
        )
        self.slave.instantiate(logMessage=lambda *said: self.said.append(said[-1].decode()))
        self.time = 0.0
        if start:
            self.slave.enterInitializationMode(startTime=0.0)
            self.slave.exitInitializationMode()

    def named(self, causality, kind="Float64"):
        """Names of the variables of a causality and type, in the order of their references."""
        return [
            name for name, variable in self.variables.items() if (variable.causality, variable.type) == (causality, kind)
        ]

    def references(self, names):
        """Value references of variables."""
        return [self.variables[name].valueReference for name in names]

    def size(self, names):
        """Number of elements of variables."""
        return sum(int(np.prod(self.variables[name].shape or (1,))) for name in names)

    def get(self, *names):
        """Elements of variables, one after the other."""
        return self.slave.getFloat64(self.references(names), self.size(names))

    def set(self, name, values):
        """Sets the elements of a variable."""
        self.slave.setFloat64(self.references([name]), values)

    def step(self, displacement, interval):
        """As `conftest.Slave.step`."""
        for name in self.named("input"):
            # Of an array the quantity is the last part of the name; of a single component the one before.
            whole = name if not self.variables[name].shape else f"{name}.all"
            self.set(name, [given(whole, displacement)] * self.size([name]))
        assert self.slave.doStep(self.time, interval) == (False, False, False, pytest.approx(self.time + interval))
        self.time += interval
        return self.get(*self.named("output"))

    def close(self):
        """Ends and frees it."""
        self.slave.terminate()
        self.slave.freeInstance()


@pytest.fixture(scope="session")
def unit3(cograin, tmp_path_factory):
    """Packages a model by FMI 3.0, once a session, and gives the path of its unit."""
    packaged = {}

    def package(model):
        if model not in packaged:
            path = packaged[model] = tmp_path_factory.mktemp(model) / f"{model}.fmu"
            cograin("export", ROOT / "models" / model / "scene.toml", "--fmi", "3", "-o", path)
        return packaged[model]

    return package


@pytest.fixture
def slave3(tmp_path_factory):
    """Opens units of FMI 3.0; closes them after the test."""
    opened = []

    def opening(path, name="unit"):
        opened.append(Slave3(path, tmp_path_factory.mktemp("unpacked"), name))
        return opened[-1]

    yield opening
    for each in opened:
        each.close()


#: What a type of the standard's header is in ours.
C_TYPES = {
    "fmi3Instance": "Component",
    "fmi3InstanceEnvironment": "Environment",
    "fmi3FMUState": "StateHandle",
    "fmi3ValueReference": "Reference",
    "fmi3String": "Text",
    "fmi3Boolean": "Boolean",
    "fmi3Clock": "Boolean",
    "fmi3Binary": "Binary",
    "fmi3Byte": "u8",
    "fmi3Status": "Status",
    "fmi3IntervalQualifier": "c_int",
    "fmi3DependencyKind": "c_int",
    "fmi3LogMessageCallback": "Option<LogFunction>",
    "fmi3IntermediateUpdateCallback": "Option<UpdateFunction>",
    "fmi3ClockUpdateCallback": "Option<UpdateFunction>",
    "fmi3LockPreemptionCallback": "*const c_void",
    "fmi3UnlockPreemptionCallback": "*const c_void",
    "size_t": "usize",
    "void": "",
    "const char*": "Text",
    **{f"fmi3Float{bits}": f"f{bits}" for bits in (32, 64)},
    **{f"fmi3Int{bits}": f"i{bits}" for bits in (8, 16, 32, 64)},
    **{f"fmi3UInt{bits}": f"u{bits}" for bits in (8, 16, 32, 64)},
}


def in_rust(declared):
    """A parameter of the header as a type of ours."""
    constant, kind, pointer, _, array = re.fullmatch(r"(const )?(\w+) *(\*?) *(\w*)(\[\])?", declared).groups()
    return (("*const " if constant else "*mut ") if pointer or array else "") + C_TYPES[kind]


def standard_signatures():
    """Parameters and result of each function of the header that fmpy brings along."""
    header = (Path(fmpy.__file__).parent / "c-code" / "fmi3FunctionTypes.h").read_text()
    found = {}
    for result, name, inner in re.findall(r"typedef ([\w ]+\*?)\s*(fmi3\w+)TYPE\s*\(([^)]*)\)", header):
        parameters = [" ".join(parameter.split()) for parameter in inner.split(",")]
        found[name] = ([in_rust(it) for it in parameters if it != "void"], C_TYPES[result.strip()])
    return found


def our_signatures():
    """Parameters and result of each function in our sources."""
    types = lambda text: [it.split(": ")[-1].strip() for it in text.split(",") if it.strip()]
    found = {}
    for name in ("lib.rs", "v3/mod.rs", "v3/values.rs", "v3/absent.rs"):
        text = (ROOT / "fmu" / "src" / name).read_text().replace("$crate::types::", "").replace("$crate::v3::", "")
        text = text.replace("::core::option::", "")
        for function, inner, result in re.findall(r'extern "C" fn (fmi3\w+)\(([^{]*?)\)(?: -> (\w+))? {', text):
            found[function] = (types(inner), result)
        for function, inner in re.findall(r"^        (fmi3\w+)\(([^)]*)\);?$", text, re.MULTILINE):
            found[function] = (["Component", *types(inner)], "Status")
        for element, get, set_ in re.findall(r'^    "\w+" (\w+): (fmi3\w+) (fmi3\w+);', text, re.MULTILINE):
            for function, pointer in ((get, "*mut"), (set_, "*const")):
                given = ["Component", "*const Reference", "usize", f"{pointer} {element}", "usize"]
                found[function] = (given, "Status")
    return found


def test_every_function_has_the_parameters_and_the_result_of_the_standard():
    standard, ours = standard_signatures(), our_signatures()
    assert len(standard) == 75 and ours.keys() == standard.keys()
    assert {name: ours[name] for name in standard} == standard


def valid_terminals(folder):
    """The terminals of an unpacked unit, which the schema of FMI 3.0 has checked."""
    terminals = etree.parse(folder / "terminalsAndIcons" / "terminalsAndIcons.xml")
    etree.XMLSchema(etree.parse(SCHEMAS / "fmi3TerminalsAndIcons.xsd")).assertValid(terminals)
    return terminals


def test_the_unit_is_valid_and_its_terminals_name_its_variables(unit3, model, tmp_path):
    assert not validate_fmu(str(unit3(model)))
    fmpy.extract(str(unit3(model)), str(tmp_path))
    known = {variable.name for variable in fmpy.read_model_description(str(tmp_path)).modelVariables}
    members = valid_terminals(tmp_path).findall(".//TerminalMemberVariable")
    assert members and {member.get("variableName") for member in members} <= known


def test_steps_have_the_bits_of_fmi_2(unit, unit3, model, course, slave, slave3):
    old, new = slave(unit(model)), slave3(unit3(model))
    for step in range(1, min(course.steps, 4) + 1):
        displacement = course.displacement(step)
        assert new.step(displacement, course.interval) == old.step(displacement, course.interval), f"step {step}"


def test_a_state_of_one_edition_continues_in_the_other(unit, unit3, slave, slave3):
    old, new = slave(unit("piston")), slave3(unit3("piston"))
    for step in range(1, 6):
        old.step(1e-6 * step, 1e-3)
    state = old.slave.getFMUstate()
    there = new.slave.deserializeFMUState(bytes(old.slave.serializeFMUstate(state)))
    for _ in range(2):
        new.slave.setFMUState(there)
        old.slave.setFMUstate(state)
        new.time = old.time = 5e-3
        assert [new.step(2e-6, 1e-3) for _ in range(4)] == [old.step(2e-6, 1e-3) for _ in range(4)]
    new.slave.freeFMUState(there)
    old.slave.freeFMUstate(state)


def test_derivatives_have_the_bits_of_fmi_2(unit, unit3, slave, slave3):
    old, new = slave(unit("piston")), slave3(unit3("piston"))
    for step in range(1, 40):
        assert new.step(2e-5 * step, 1e-3) == old.step(2e-5 * step, 1e-3)
    axes, force = [f"piston.force.{axis}" for axis in "xyz"], new.references(["piston.force"])
    references = [old.reference(name) for name in axes]
    known = "piston.displacement.z"
    before = old.slave.getDirectionalDerivative(references, [old.reference(known)], [1.0])
    found = new.slave.getDirectionalDerivative(force, new.references([known]), [1.0], nSensitivity=3)
    assert found == list(before) and found[2] != 0.0
    values = (fmpy.fmi3.fmi3Float64 * 3)()
    new.slave.fmi3GetOutputDerivatives(
        new.slave.component, (fmpy.fmi3.fmi3ValueReference * 1)(*force), 1, (fmpy.fmi3.fmi3Int32 * 1)(1), values, 3
    )
    rates = [old.slave.getRealOutputDerivatives([reference], [1])[0] for reference in references]
    assert list(values) == rates and any(rates)


def test_fmpy_simulates_it_by_itself(unit, unit3):
    names = {"2": ["lid.force.z", "lid.work"], "3": ["lid.force", "lid.work"]}
    names = {edition: [name.replace("lid", "piston") for name in given] for edition, given in names.items()}
    old = fmpy.simulate_fmu(str(unit("piston")), stop_time=0.02, output_interval=1e-3, output=names["2"])
    new = fmpy.simulate_fmu(str(unit3("piston")), stop_time=0.02, output_interval=1e-3, output=names["3"])
    assert new["piston.force"].shape == (len(old), 3)
    assert new["piston.force"][:, 2].tolist() == old["piston.force.z"].tolist()
    assert new["piston.work"].tolist() == old["piston.work"].tolist()


def test_texts_counts_and_the_time_are_read(unit3, tmp_path):
    slave = Slave3(unit3("piston"), tmp_path / "unpacked", start=False)
    frames = tmp_path / "frames"
    text = slave.references(["run.frames"])
    assert slave.slave.getString(text) == [""]
    slave.slave.setString(text, [str(frames)])
    slave.slave.enterInitializationMode(startTime=0.0)
    slave.slave.exitInitializationMode()
    slave.step(1e-6, 1e-3)
    assert slave.get("time") == [1e-3]
    assert slave.slave.getInt32(slave.references(["contacts.count"]))[0] >= 0
    slave.close()
    assert list(frames.glob("*.vtu"))


def test_wrong_calls_are_refused_in_words_and_the_unit_goes_on(unit3, slave3):
    slave = slave3(unit3("piston"))
    with pytest.raises(FMICallException):
        slave.set("piston.force", [0.0, 0.0, 0.0])
    assert slave.said[-1].startswith("fmi3SetFloat64: piston.force.x is an output")
    with pytest.raises(FMICallException):
        slave.slave.getFloat64(slave.references(["piston.force"]), 1)
    assert "values: expected 3 elements, as many as the variables have, found 1" in slave.said[-1]
    with pytest.raises(FMICallException):
        slave.slave.enterEventMode()
    assert slave.said[-1] == "fmi3EnterEventMode: expected a unit with event mode; this one has none"
    slave.step(1e-6, 1e-3)


def test_another_edition_is_refused(cograin, tmp_path):
    scene = ROOT / "models" / "piston" / "scene.toml"
    said = cograin("export", scene, "--fmi", "1", "-o", tmp_path / "unit.fmu", status=2)
    assert "expected 2 or 3, found 1" in said and not (tmp_path / "unit.fmu").exists()


SKIN = """
[run]
step = 1.0e-5
[material.glass]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.3
[contact.touch.normal.hertz]
[particles.bed]
material = "glass"
list = [{ position = [0.0, 0.0, 0.00199], radius = 0.002 }]
[boundary.skin]
material = "glass"
mesh = { file = "skin.obj" }
nodes = "driven"
"""


def skin(folder, side):
    """A scene with a flat mesh of so many nodes along each edge."""
    grid = 0.02 * np.linspace(-1.0, 1.0, side)
    lines = [f"v {x:.17g} {y:.17g} 0.0" for x in grid for y in grid]
    for i in range(side - 1):
        for j in range(side - 1):
            a, b = i * side + j + 1, (i + 1) * side + j + 1
            lines += [f"f {a} {b} {b + 1}", f"f {a} {b + 1} {a + 1}"]
    (folder / "skin.obj").write_text("\n".join(lines) + "\n")
    (folder / "skin.toml").write_text(SKIN)
    return folder / "skin.toml"


def test_a_mesh_is_three_fields_and_a_short_description(cograin, slave, slave3, tmp_path):
    side = 60
    scene, new, old = skin(tmp_path, side), tmp_path / "new.fmu", tmp_path / "old.fmu"
    cograin("export", scene, "--fmi", "3", "-o", new)
    begun = time.perf_counter()
    description = fmpy.read_model_description(str(new), validate=True)
    assert time.perf_counter() - begun < 1.0, "an importer reads it at once"
    shapes = {variable.name: variable.shape for variable in description.modelVariables}
    assert [shapes[f"skin.node.{name}"] for name in ("displacement", "force", "mean_force")] == [(side * side, 3)] * 3
    fields = slave3(new)
    assert (Path(fields.slave.unzipDirectory) / "modelDescription.xml").stat().st_size < 30_000
    assert valid_terminals(Path(fields.slave.unzipDirectory)).find(".//*[@variableName='skin.node.force']") is not None

    cograin("export", skin(tmp_path, 7), "-o", old)
    cograin("export", skin(tmp_path, 7), "--fmi", "3", "-o", new, "--overwrite")
    fields, scalars = slave3(new), slave(old)
    nodes, pressed = scalars.unit.nodes("skin"), 0.0
    for step in range(1, 6):
        moved = 1e-6 * step * np.cos(np.arange(147.0)).reshape(49, 3)
        nodes.displacement = moved
        fields.set("skin.node.displacement", moved.ravel())
        scalars.unit.step(2e-4)
        fields.slave.doStep(2e-4 * (step - 1), 2e-4)
        assert fields.get("skin.node.force") == nodes.force.ravel().tolist()
        pressed = max(pressed, np.abs(nodes.force).max())
    assert pressed > 0.0


GRID = """
[grid.field]
box = [[-0.02, -0.02, 0.0], [0.02, 0.02, 0.04]]
counts = [20, 20, 20]
outputs = ["porosity", "velocity", "stress", "count"]
"""


def test_a_grid_of_8000_cells_is_four_fields_in_a_short_description(cograin, slave3, tmp_path):
    scene = skin(tmp_path, 3)
    scene.write_text(scene.read_text() + GRID)
    cograin("export", scene, "--fmi", "3", "-o", tmp_path / "grid.fmu")
    begun = time.perf_counter()
    description = fmpy.read_model_description(str(tmp_path / "grid.fmu"), validate=True)
    assert time.perf_counter() - begun < 1.0, "an importer reads it at once"
    shapes = {variable.name: variable.shape for variable in description.modelVariables}
    expected = {"porosity": (8000,), "velocity": (8000, 3), "stress": (8000, 6), "count": (8000,)}
    assert {name: shapes[f"field.cell.{name}"] for name in expected} == expected
    fields = slave3(tmp_path / "grid.fmu")
    assert (Path(fields.slave.unzipDirectory) / "modelDescription.xml").stat().st_size < 30_000
    porosity = np.array(fields.get("field.cell.porosity"))
    grain = 4.0 / 3.0 * np.pi * 0.002**3
    assert (1.0 - porosity).sum() * 0.002**3 == pytest.approx(grain, rel=1e-9)
    assert sum(fields.slave.getInt32(fields.references(["field.cell.count"]), 8000)) == 1


def test_the_cells_of_a_fluid_are_arrays_with_the_bits_of_fmi_2(unit, unit3, slave, slave3):
    old, new = slave(unit("settling")), slave3(unit3("settling"))
    cells, vectors = old.unit.cells("syrup"), ("velocity", "pressure_gradient", "mean_drag", "mean_pressure_force")
    expected = dict.fromkeys((*vectors, "mean_solid_flux"), (10, 3)) | {"porosity": (10,), "drag_coefficient": (10,)}
    assert {name: new.variables[f"syrup.cell.{name}"].shape for name in expected} == expected
    for step in range(1, 4):
        for quantity, size in (("velocity", 1e-3), ("pressure_gradient", 1e4)):
            given = size * step * np.cos(np.arange(30.0) + size).reshape(10, 3)
            cells[quantity] = given
            new.set(f"syrup.cell.{quantity}", given.ravel())
        old.unit.step(1e-3)
        new.slave.doStep(1e-3 * (step - 1), 1e-3)
        for quantity in expected:
            assert new.get(f"syrup.cell.{quantity}") == cells[quantity].ravel().tolist(), f"{quantity} in step {step}"
    assert np.abs(cells["mean_drag"]).min() > 0.0


def test_a_host_in_c_gets_the_same_digits(unit, unit3, slave, tmp_path):
    compiler = shutil.which("cc")
    assert compiler, "a C compiler is needed to try a host in C"
    program = tmp_path / "host"
    source = Path(__file__).parent / "fmi3_host.c"
    subprocess.run([compiler, "-std=c99", "-Wall", "-Werror", "-O1", source, "-o", program, "-ldl"], check=True)
    old, folder = slave(unit("piston")), tmp_path / "unpacked"
    fmpy.extract(str(unit3("piston")), str(folder))
    description = fmpy.read_model_description(str(folder))
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    library = folder / "binaries" / "x86_64-linux" / f"{description.coSimulation.modelIdentifier}.so"
    given = [library, folder / "resources/", description.guid, reference["piston.displacement.z"], reference["piston.force"]]
    done = subprocess.run([program, *map(str, given), "20", "1e-3", "1e-6"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rows = [[float(value) for value in line.split()] for line in done.stdout.splitlines()]
    expected = []
    for step in range(1, 21):
        old.step(1e-6 * step, 1e-3)
        expected.append(old.get("piston.force.x", "piston.force.y", "piston.force.z"))
    assert rows == expected and any(map(any, rows))
