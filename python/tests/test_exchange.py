"""Exchanges: agreement, order, energy between both sides, and what becomes of steps that cannot be made."""

from typing import ClassVar

import numpy as np
import pytest

from cograin import (
    Aitken,
    Coupling,
    CouplingStopped,
    FixedPoint,
    GaussSeidel,
    Interface,
    Jacobi,
    Newton,
    Oscillator,
    QuasiNewton,
    Secant,
    Step,
    StepControl,
    StepDiscarded,
    Structure,
    Tolerance,
    UnitPartner,
    Verlet,
    couple,
    stiffness,
)

FLOOR = "floor.displacement.z"
ENDS = ["left.displacement.x", "right.displacement.x"]
REPEATED = {
    "fixed point": lambda: FixedPoint(),
    "aitken": lambda: Aitken(),
    "secant": lambda: Secant(),
    "quasi-newton": lambda: QuasiNewton(),
    "newton": lambda: Newton("differences"),
}


def falls(unit, exchange, step=1e-3, end=0.15, **named):
    """A sphere of 1.3 kg falls 1 cm on a plate of 1 kg on a spring."""
    plate = Oscillator(1.0, 1e4)
    return plate, couple(Interface(unit, FLOOR), plate, exchange, step=step, end=end, **named)


@pytest.mark.parametrize("exchange", REPEATED)
def test_impulse_and_work_are_the_same_on_both_sides_of_a_repeated_step(drop, exchange):
    plate, record = falls(drop, REPEATED[exchange]())
    assert record.exchanged_work > 0.1
    assert not record.unconverged and record["residual"].max() <= 1e-9
    assert abs(record.interface_energy) <= 1e-12 * record.exchanged_work
    assert drop["floor.work"] + plate.work == pytest.approx(0.0, abs=1e-12 * record.exchanged_work)
    # The book of everything, but for the discretisation of the contact and what the tolerance left.
    mass, fallen = drop["ball.mass"], drop["ball.displacement.z"]
    ball = 0.5 * mass * drop["ball.velocity.z"] ** 2 + mass * 9.81 * fallen + drop["energy.elastic"]
    assert abs(ball + plate.energy) <= 1e-4 * mass * 9.81 * 0.01


def test_every_repeated_exchange_finds_the_same_motion(opened):
    from conftest import DROP

    ends = [falls(opened(DROP), make())[1][FLOOR] for make in REPEATED.values()]
    for found in ends[1:]:
        assert np.abs(found - ends[0]).max() <= 1e-4 * np.abs(ends[0]).max()


def test_explicit_exchanges_say_the_energy_that_they_make(drop):
    _, record = falls(drop, GaussSeidel())
    assert record.interface_energy > 0.01 * record.exchanged_work
    drop.reset()
    _, lagging = falls(drop, Jacobi())
    assert lagging.interface_energy > 2.0 * record.interface_energy
    drop.reset()
    _, verlet = falls(drop, Verlet())
    assert abs(verlet.interface_energy) < 0.1 * record.interface_energy


def errors(opened, make, steps):
    """Error of a two-mass oscillator with each step, against the eigenmodes of its masses and springs."""
    from conftest import CHAIN

    found = []
    for step in steps:
        unit = opened(CHAIN)
        wall, end = Structure([1.0, 1.0], [0.0, 30.0]), 0.96
        wall.place(velocity=[0.0, 0.01])
        coupling = Coupling(Interface(unit, ENDS), wall, make(), step)
        coupling.run(end)
        area = np.pi * 0.05**2
        one, other = 5026.548245743668 * area, 10053.096491487338 * area
        matrix = np.array([[one, -one, 0.0], [-one, one + other, -other], [0.0, -other, other + 30.0]])
        squares, modes = np.linalg.eigh(matrix)
        rates = np.sqrt(np.maximum(squares, 1e-300))
        exact = modes @ (np.where(squares > 1e-9, np.sin(rates * end) / rates, end) * (modes.T @ [0.0, 0.0, 0.01]))
        found.append(abs(wall.displacement[1] - exact[2]))
    return found


def test_staggered_is_first_order_verlet_and_implicit_are_second_order_in_two_directions(opened):
    steps = (8e-3, 4e-3)
    first = errors(opened, GaussSeidel, steps)
    assert first[0] / first[1] == pytest.approx(2.0, rel=0.15)
    for make in (Verlet, lambda: QuasiNewton(tolerance=Tolerance(1e-13))):
        second = errors(opened, make, steps)
        assert second[0] / second[1] == pytest.approx(4.0, rel=0.15)
        assert second[1] < 0.1 * first[1]


def test_newton_needs_two_evaluations_where_the_particles_answer_linearly(chain):
    wall = Structure([1.0, 1.0], [0.0, 30.0])
    wall.place(velocity=[0.0, 0.01])
    record = couple(Interface(chain, ENDS), wall, Newton("differences", perturbation=1e-6), step=4e-3, end=0.2)
    # Two more in the first step, for the derivative.
    assert record["evaluations"][0] <= 4
    assert record["evaluations"][1:].max() <= 2


@pytest.mark.parametrize("keep", [False, True])
def test_newton_takes_the_derivatives_of_the_units_in_several_directions(chain, keep):
    wall = Structure([1.0, 1.0], [0.0, 30.0])
    wall.place(velocity=[0.0, 0.01])
    exchange = Newton(keep=keep)
    record = couple(Interface(chain, ENDS), wall, exchange, step=4e-3, end=0.2)
    assert not record.unconverged
    assert record["evaluations"].max() <= 2
    # The chain is linear: one derivative serves all steps.
    assert exchange.derivatives == (1 if keep else (record["evaluations"] - 1).sum())


def test_a_derivative_of_a_unit_is_that_of_its_differences(chain):
    interface = Interface(chain, ENDS)
    place, step = np.array([1e-4, -2e-4]), Step(0.0, 4e-3, 4e-3)
    interface.save()
    base = interface.advance(place, step, "mean")
    found = interface.derivative("mean")
    for direction in range(2):
        interface.restore()
        moved = place + 1e-6 * np.eye(2)[direction]
        difference = (interface.advance(moved, step, "mean") - base) / 1e-6
        assert found[:, direction] == pytest.approx(difference, rel=1e-5, abs=1e-6 * np.abs(found).max())


def test_a_unit_whose_boundary_a_servo_moves_has_derivatives(served):
    assert served.has_derivatives
    served.step(1e-3)
    assert np.isfinite(served.derivative(["floor.force.z"], ["floor.target_force.z"])).all()


@pytest.mark.parametrize("mass", [1e-3, 0.0])
def test_the_bracketed_secant_carries_a_partner_without_mass(drop, mass):
    plate = Oscillator(mass, 1e4)
    # A plate without mass has no motion of its own to go out from: let it stand under the sphere at rest.
    record = couple(Interface(drop, FLOOR), plate, Secant(), step=1e-3, end=0.1)
    assert not record.unconverged
    assert abs(record.interface_energy) <= 1e-12 * record.exchanged_work


def test_fixed_point_does_not_carry_it_and_the_run_ends_with_the_reason(drop):
    control = StepControl(halvings=1)
    with pytest.raises(
        CouplingStopped, match=r"30 evaluations: displacements differ by .* the shortest|the shortest"
    ) as told:
        couple(Interface(drop, FLOOR), Oscillator(1e-3, 1e3), FixedPoint(), step=1e-3, end=0.1, control=control)
    assert len(told.value.record) > 40


def test_a_plate_that_runs_through_the_particles_ends_the_run_with_the_units_reason(drop):
    plate = Oscillator(1e9, 0.0)
    plate.place(velocity=60.0)
    coupling = Coupling(Interface(drop, FLOOR), plate, GaussSeidel(), 1e-3, control=StepControl(halvings=2))
    with pytest.raises(CouplingStopped, match=r"halved 2 times.*went through boundary floor"):
        coupling.run(0.01)
    assert drop.time == coupling.time == 1e-3


class Spring:
    """A side without a unit: a spring that discards steps longer than it likes for a while."""

    names: ClassVar = ["spring.displacement.z"]
    work = None
    can_restore = keeps_itself = True
    has_derivatives = False

    def __init__(self, longest):
        self.time, self.displacement, self.longest = 0.0, np.zeros(1), longest

    def force(self, kind):
        return -100.0 * self.displacement

    def advance(self, displacement, step, kind):
        if step.length > self.longest and 0.25 <= step.begin < 0.4375:
            raise StepDiscarded("spring: too long", "too long", self.time)
        self.time, self.displacement = step.end, displacement
        return self.force(kind)

    def save(self):
        self.saved = self.time, self.displacement

    def restore(self):
        self.time, self.displacement = self.saved


def test_a_discarded_step_is_made_shorter_and_the_grid_of_the_steps_is_met_again():
    plate = Oscillator(1.0, 0.0)
    plate.place(velocity=1.0)
    record = couple(Spring(0.02), plate, GaussSeidel(), step=0.125, end=1.0, progress=False)
    times = record["time"].tolist()
    assert set(np.arange(1, 9) * 0.125) <= set(times)
    assert times[:3] == [0.125, 0.25, 0.265625]
    assert record["length"][-1] == 0.125 and record["refusals"][2] == 3


def test_a_repeated_trial_that_is_discarded_is_taken_nearer():
    class Narrow(Spring):
        """It gives a number only near to where it stands."""

        def advance(self, displacement, step, kind):
            if abs(displacement[0] - self.displacement[0]) > 0.01:
                raise StepDiscarded("spring: too far", "too far", self.time)
            return super().advance(displacement, step, kind)

    # Without the force of the spring the plate would go more than a metre in the first step; with it, 8 mm.
    plate = Oscillator(1e-3, 0.0, load=lambda time: 0.4)
    record = couple(Narrow(1.0), plate, Secant(), step=0.125, end=1.0, progress=False)
    assert record["refusals"].sum() > 0 and not record.unconverged


def test_step_control_keeps_the_energy_of_an_explicit_exchange_small(drop):
    _, coarse = falls(drop, GaussSeidel())
    drop.reset()
    control = StepControl(energy=2e-5)
    _, fine = falls(drop, GaussSeidel(), control=control)
    assert abs(fine.interface_energy) < 0.3 * abs(coarse.interface_energy)
    lengths = fine["length"]
    assert lengths.min() < 1e-3 and lengths[:30].max() == 1e-3
    # Every multiple of the given length is met.
    assert set(np.arange(1, 151) * 1e-3) <= set(fine["time"])


def test_units_and_boundaries_are_coupled_together(opened):
    from conftest import DROP

    one, other = opened(DROP, name="one"), opened(DROP, name="other")
    both = Interface(one, FLOOR) + Interface(other, FLOOR)
    assert both.names == [f"one.{FLOOR}", f"other.{FLOOR}"]
    plates = Structure([1.0, 2.0], [[2e4, -1e4], [-1e4, 2e4]])
    record = couple(both, plates, QuasiNewton(), step=1e-3, end=0.1, watch=["one.ball.velocity.z", "other.floor.work"])
    assert not record.unconverged and record.exchanged_work > 0.1
    assert abs(record.interface_energy) <= 1e-12 * record.exchanged_work
    assert record["other.floor.work"][-1] == other["floor.work"]


def test_substeps_of_a_ramp_change_nothing_but_rounding(opened):
    from conftest import DROP

    plate, _ = falls(opened(DROP), Secant())
    parts = Oscillator(1.0, 1e4)
    record = couple(Interface(opened(DROP), FLOOR, substeps=4), parts, Secant(), step=1e-3, end=0.15)
    assert parts.displacement == pytest.approx(plate.displacement, rel=1e-4)
    assert abs(record.interface_energy) <= 1e-12 * record.exchanged_work


def test_another_unit_is_a_partner_that_is_tried_and_taken_back(opened):
    """A group with a free axis stands for the unit of another tool: what it is given is no force, but goes by name."""
    from conftest import CHAIN

    unit, step = opened(CHAIN), Step(0.0, 1e-2, 1e-2)
    partner = UnitPartner(
        unit, force=ENDS[0], displacement="free.displacement.x", compliance="differences", perturbation=1e-3
    )
    found = partner.predict(np.array([1e-3]), step)
    assert partner.predict(np.array([2e-3]), step) == pytest.approx(2.0 * found, rel=1e-6)
    assert partner.compliance(step)[0, 0] == pytest.approx(found[0] / 1e-3, rel=1e-9)
    partner.advance(np.array([1e-3]), found, step)
    assert partner.displacement == found and unit.time == 1e-2
    # A step that was tried and is then made shorter begins where the last one ended.
    half = Step(1e-2, 1.5e-2, 5e-3)
    partner.predict(np.array([1e-3]), Step(1e-2, 2e-2, 1e-2))
    partner.advance(np.array([1e-3]), partner.predict(np.array([1e-3]), half), half)
    assert unit.time == 1.5e-2


def test_both_sides_have_to_begin_at_the_same_place(drop):
    plate = Oscillator(1.0, 1e4)
    plate.place(1e-3)
    with pytest.raises(ValueError, match=r"the interface stands at \[0.\], the partner at \[0.001\]"):
        Coupling(Interface(drop, FLOOR), plate, GaussSeidel(), 1e-3)


def test_tolerances_of_force_and_energy_are_said_in_words():
    tolerance = Tolerance(displacement=None, force=1e-3, energy=1e-6)
    said = tolerance.open(np.array([1e-5]), np.array([2.0]), lambda: np.array([[1e-3]]))
    assert (
        said == "forces differ by 1.0e-02 N, 0.001 N is allowed; 2.0e-05 J are between both sides, 1e-06 J are allowed"
    )
    assert not tolerance.open(np.array([1e-9]), np.array([2.0]), lambda: np.array([[1e-3]]))
    with pytest.raises(ValueError, match="expected numbers above 0, found 0"):
        Tolerance(displacement=0.0)


def test_a_secant_refuses_several_directions(chain):
    with pytest.raises(ValueError, match="a secant is for one direction, the interface has 2"):
        couple(Interface(chain, ENDS), Structure([1.0, 1.0], [1.0, 1.0]), Secant(), step=1e-3, end=0.1)


def test_names_of_other_units_have_to_be_said(drop):
    with pytest.raises(ValueError, match="name forces and mean_forces"):
        Interface(drop, "floor")


def test_stiffness_of_the_interface_is_that_of_the_springs(chain):
    found = stiffness(Interface(chain, ENDS), 1e-4)
    area = np.pi * 0.05**2
    # Over one time step the free mass stands still; the mean of a ramp is half of its end.
    assert found == pytest.approx(0.5 * area * np.array([5026.548245743668, 10053.096491487338]), rel=1e-3)


def test_a_record_is_a_table_with_a_header(drop, tmp_path):
    _, record = falls(drop, Secant(), watch=["ball.velocity.z"], progress=True)
    record.save(tmp_path / "record.csv")
    lines = (tmp_path / "record.csv").read_text().splitlines()
    assert lines[0].endswith("floor.displacement.z,floor.mean_force.z,ball.velocity.z")
    assert len(lines) == 151 and "evaluations a step" in record.summary
    with pytest.raises(KeyError, match="the record has time, length"):
        record["speed"]


def test_watched_values_are_the_same_read_together_or_one_by_one(drop):
    names = ["ball.velocity.z", "floor.work"]
    _, together = falls(drop, Secant(), end=0.06, watch=[*names, names[0]])
    assert together.names[-2:] == names and len(together.rows[0].watched) == 2
    drop.reset()
    # A whole number is among them, so each is read by itself.
    _, single = falls(drop, Secant(), end=0.06, watch=["contacts.count", *names])
    assert single["contacts.count"].max() == 1.0
    for name in names:
        assert np.array_equal(together[name], single[name]) and np.ptp(single[name]) > 0.0


def test_the_end_is_a_whole_number_of_steps(drop):
    with pytest.raises(ValueError, match=r"expected a whole number of steps of 0\.001 s, found 10\.5 up to 0\.0105 s"):
        falls(drop, Secant(), step=1e-3, end=0.0105)
