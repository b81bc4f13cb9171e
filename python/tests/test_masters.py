"""Exchanges at scales of every size, and at forces that jump."""

from typing import ClassVar

import numpy as np
import pytest
from conftest import DROP

from cograin import (
    Aitken,
    CouplingStopped,
    FixedPoint,
    GaussSeidel,
    Interface,
    Jacobi,
    Newton,
    Oscillator,
    QuasiNewton,
    Secant,
    StepControl,
    Structure,
    Tolerance,
    Verlet,
    couple,
)

FLOOR = "floor.displacement.z"
ENDS = ["left.displacement.x", "right.displacement.x"]
REPEATED = {
    "fixed point": FixedPoint,
    "aitken": Aitken,
    "secant": Secant,
    "quasi-newton": QuasiNewton,
    "newton": lambda: Newton("differences"),
}


class Contact:
    """A side without a unit: a spring of power 1.5 that is met at a distance, by the mean of both ends of a step."""

    names: ClassVar = ["wall.displacement.z"]
    work = None
    can_restore = keeps_itself = True
    has_derivatives = False

    def __init__(self, stiffness, gap):
        self.time, self.displacement, self.before = 0.0, np.zeros(1), np.zeros(1)
        self.stiffness, self.gap = stiffness, gap

    def at(self, place):
        overlap = np.maximum(place - self.gap, 0.0)
        return -self.stiffness * overlap * np.sqrt(overlap)

    def force(self, kind):
        return 0.5 * (self.at(self.before) + self.at(self.displacement))

    def advance(self, displacement, step, kind):
        self.before, self.displacement, self.time = self.displacement, displacement, step.end
        return self.force(kind)

    def save(self):
        self.saved = self.time, self.displacement, self.before

    def restore(self):
        self.time, self.displacement, self.before = self.saved


class Latch(Contact):
    """Particles whose mean force jumps by this much where their place at the end of a step passes the gap."""

    def force(self, kind):
        return np.where(self.displacement > self.gap, -self.stiffness, 0.0)


def meets(exchange, power, step=2.0**-10, end=2.0**-5):
    """A plate flies against the spring; lengths and times are scaled by 2 to this power, masses by its cube."""
    length, mass = 2.0**power, 2.0 ** (3 * power)
    # stiffness is force over length^1.5; powers of two are even for this
    side = Contact(1e7 * mass / length**2 * 2.0 ** (-0.5 * power) * 2.0 ** (0.5 * power) / length**0.5, 1e-3 * length)
    plate = Oscillator(0.1 * mass, 1e3 * mass / length**2)
    plate.place(velocity=0.5)
    return couple(side, plate, exchange, step=step * length, end=end * length, progress=False)


@pytest.mark.parametrize("make", REPEATED.values(), ids=REPEATED)
def test_a_scene_of_any_size_takes_the_same_evaluations_to_the_same_bits(make):
    here = meets(make(), 0)
    assert here["wall.mean_force.z"].min() < -1.0 and here["evaluations"].max() > 1
    for power in (-30, -20, 6, 20):
        there = meets(make(), power)
        assert np.array_equal(there["evaluations"], here["evaluations"])
        assert np.array_equal(there["wall.displacement.z"] * 2.0**-power, here["wall.displacement.z"])
        assert np.array_equal(there["wall.mean_force.z"] * 2.0 ** (-2 * power), here["wall.mean_force.z"])


def test_a_micron_scene_is_as_exact_as_a_large_one(opened):
    """Units in which everything is a millionth: an absolute tolerance accepted every first trial."""
    small = DROP.replace("0.06]", "0.06e-6]").replace("0.05 }", "0.05e-6 }")
    small = small.replace("normal_stiffness = 1.0e5", "normal_stiffness = 1.0e-1").replace("1.0e-5", "1.0e-11")
    small = small.replace("-9.81", "-9.81e6")
    ends = []
    for tolerance in (None, Tolerance(relative=1e-10)):
        plate = Oscillator(1e-18, 1e-2)
        side = Interface(opened(small), FLOOR)
        record = couple(side, plate, Secant(tolerance=tolerance), step=1e-9, end=1.2e-7)
        assert record["floor.mean_force.z"].min() < 0.0
        ends.append(record["floor.mean_force.z"])
    assert np.abs(ends[1] - ends[0]).max() <= 1e-5 * np.abs(ends[1]).max()


def test_a_long_way_before_the_contact_does_not_loosen_the_tolerance():
    ends = []
    for tolerance in (None, Tolerance(relative=1e-9)):
        side, plate = Contact(1e10, 0.5), Oscillator(1.0, 0.0)
        plate.place(velocity=1.0)
        record = couple(side, plate, Secant(tolerance=tolerance), step=1e-3, end=0.6, progress=False)
        ends.append(record["wall.mean_force.z"])
    assert np.abs(ends[1] - ends[0]).max() <= 1e-3 * np.abs(ends[1]).max()


def test_limits_that_are_given_stand_alone():
    assert Tolerance().relative == 1e-6 and Tolerance(1e-9).relative is None
    with pytest.raises(ValueError, match="expected numbers above 0, found nan"):
        Tolerance(float("nan"))


def test_sides_that_stand_apart_are_refused_however_small_they_are(opened):
    unit = opened(DROP, inputs={FLOOR: 1e-10})
    with pytest.raises(ValueError, match="the interface stands at"):
        couple(Interface(unit, FLOOR), Oscillator(1.0, 1.0), Secant(), step=1e-3, end=0.1)


@pytest.mark.parametrize("make", [Secant, QuasiNewton, Aitken, lambda: Newton("differences")])
def test_a_force_that_jumps_is_survived_with_the_defaults(make):
    # No displacement has the force between 0 and 5 N that would hold the spring at the gap.
    plate = Oscillator(0.0, 1e3, load=lambda time: 3.0)
    record = couple(Latch(5.0, 1e-3), plate, make(), step=1e-3, end=0.02, progress=False)
    assert len(record) == 20 and len(record.unconverged) == 20
    assert "the particles' force jumps" in record.summary
    assert record["refusals"].sum() == 0
    # What is kept is at the jump, as near as numbers are.
    assert record["wall.displacement.z"] == pytest.approx(np.full(20, 1e-3), rel=1e-9)


@pytest.mark.parametrize("make", [Secant, QuasiNewton])
def test_a_partner_with_mass_gets_through_a_jump_by_shorter_steps(make):
    plate = Oscillator(1.0, 0.0, load=lambda time: 3.0)
    record = couple(Latch(5.0, 1e-3), plate, make(), step=1e-2, end=0.08, progress=False)
    assert record["time"][-1] == pytest.approx(0.08)
    # It is pressed against the jump and stays there, within the way that the load takes it in a step.
    assert abs(plate.displacement[0] - 1e-3) <= 3.0 * 1e-2**2
    assert record["evaluations"].sum() < 100 * len(record)


class Stiff(Contact):
    """Three springs of power 1.5, ten thousand times as stiff as what they meet."""

    names: ClassVar = [f"{name}.displacement.x" for name in "abc"]

    def __init__(self):
        super().__init__(1e7, np.array([1e-3, -1e-3, 2e-3]))
        self.displacement = self.before = np.zeros(3)

    def force(self, kind):
        return self.at(self.displacement) - self.at(np.zeros(3))


def test_a_stiff_side_in_several_directions_is_solved_or_said_not_to_be():
    frame = np.array([[2e3, -5e2, 0.0], [-5e2, 2e3, -5e2], [0.0, -5e2, 2e3]])

    def run(exchange):
        partner = Structure(0.0, frame, load=lambda time: np.array([3.0, 2.0, 1.0]) * min(1.0, time / 5e-3))
        record = couple(Stiff(), partner, exchange, step=1e-3, end=0.02, progress=False)
        assert max((row.residual for row in record.unconverged), default=0.0) < 1e-4
        return record

    assert not run(Newton("differences")).unconverged
    try:
        run(QuasiNewton())
    except CouplingStopped as told:
        assert "displacements differ by" in str(told)


class Bed(Contact):
    """Contacts of a plate with a bed, with friction: as many as the plate has nodes, each of its own stiffness."""

    def __init__(self, count, stiffness):
        super().__init__(stiffness, 0.0)
        rng = np.random.default_rng(0)
        self.stiffness = stiffness * rng.uniform(0.3, 3.0, count)
        self.gap = rng.uniform(-2e-4, 1e-4, count)
        self.names = [f"plate.mapped[{number}]" for number in range(3 * count)]
        self.displacement = self.before = np.zeros(3 * count)

    def at(self, displacement):
        moved = displacement.reshape(-1, 3)
        pressed = np.maximum(0.0, -moved[:, 2] - self.gap)
        found = np.zeros_like(moved)
        found[:, 2] = self.stiffness * (pressed / 1e-4) ** 1.5 * 1e-4
        sheared = -0.5 * (self.stiffness * (pressed > 0.0))[:, None] * moved[:, :2]
        size = np.maximum(np.linalg.norm(sheared, axis=1), 1e-300)
        found[:, :2] = sheared * np.minimum(1.0, 0.3 * found[:, 2] / size)[:, None]
        return found.ravel()

    def force(self, kind):
        return self.at(self.displacement)


@pytest.mark.parametrize("stiffness", [1e3, 1e4])
def test_a_light_block_of_elements_takes_no_more_evaluations_than_with_aitken(stiffness):
    skfem = pytest.importorskip("skfem")
    from skfem.helpers import dot
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = skfem.MeshHex.init_tensor(*[np.linspace(0.0, 0.1, 4)] * 2, np.linspace(0.0, 0.05, 3))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex1()))
    elastic = skfem.asm(linear_elasticity(*lame_parameters(1e6, 0.3)), basis)
    mass = 50.0 * skfem.asm(skfem.BilinearForm(lambda u, v, w: dot(u, v)), basis)
    below, above = np.flatnonzero(mesh.p[2] < 1e-9), np.flatnonzero(mesh.p[2] > 0.05 - 1e-9)
    at, load = basis.nodal_dofs[:, below].T.ravel(), np.zeros(basis.N)
    load[at[2::3]] = -2.0

    def evaluations(exchange):
        block = Structure(mass, elastic, 2e-4 * elastic, at=at, fixed=basis.nodal_dofs[:, above].ravel(),
                          load=lambda time: load * np.sin(150.0 * time))  # fmt: skip
        record = couple(Bed(len(below), stiffness), block, exchange, step=1e-3, end=0.01, progress=False)
        assert not record.unconverged
        return record["evaluations"]

    several, one = evaluations(QuasiNewton()), evaluations(Aitken())
    assert several.mean() <= one.mean() and several.max() <= one.max()


@pytest.mark.parametrize("exchange", [Jacobi, GaussSeidel])
def test_an_exchange_that_makes_energy_says_so(drop, exchange, caplog):
    def run(mass, chosen):
        drop.reset()
        caplog.clear()
        plate = Oscillator(mass, 1e4)
        plate.place(velocity=0.05)
        return couple(Interface(drop, FLOOR), plate, chosen, step=1e-3, end=0.1, progress=False)

    # A tenth of the ball's mass.
    record = run(0.13, exchange())
    assert "the exchange made" in record.summary and "the exchange made" in caplog.text
    assert "do not trust the motion" in record.remark
    for quiet in (run(0.13, Secant()), run(100.0, Verlet())):
        assert not quiet.remark and "the exchange made" not in quiet.summary and not caplog.records


def test_a_jump_can_stop_a_run_or_be_accepted():
    plate = Oscillator(0.0, 1e3, load=lambda time: 3.0)
    with pytest.raises(CouplingStopped, match="force jumps"):
        couple(Latch(5.0, 1e-3), plate, Secant(), step=1e-3, end=0.02, control=StepControl(unconverged="stop"))
    with pytest.raises(ValueError, match="unconverged: expected 'shorten', 'accept' or 'stop', found 'ignore'"):
        StepControl(unconverged="ignore")


def test_two_units_on_one_degree_of_freedom(opened):
    one, other = opened(DROP, name="one"), opened(DROP, name="other")
    body = Structure(2.0, 1e4, at=[[1.0, 1.0]])
    record = couple(Interface(one, FLOOR) + Interface(other, FLOOR), body, QuasiNewton(), step=1e-3, end=0.15)
    assert not record.unconverged and record.exchanged_work > 0.1
    assert abs(record.interface_energy) <= 1e-12 * record.exchanged_work
    apart = record[f"one.{FLOOR}"] - record[f"other.{FLOOR}"]
    assert np.abs(apart).max() <= 1e-5 * np.abs(record[f"one.{FLOOR}"]).max()
    book = body.work + body.correction - body.energy
    assert abs(book) <= 1e-12 * record.exchanged_work
    # The same as one unit of its own on half of the structure.
    half = couple(Interface(opened(DROP), FLOOR), Oscillator(1.0, 5e3), Secant(), step=1e-3, end=0.15)
    assert record[f"one.{FLOOR}"] == pytest.approx(half[FLOOR], rel=1e-4, abs=1e-7)
