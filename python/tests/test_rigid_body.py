"""A rigid body with finite rotations: closed forms, its book, and units on it beside one unit that holds everything."""

from typing import ClassVar

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import ellipk

from cograin import (
    Coupling,
    Interface,
    Newton,
    Oscillator,
    Partners,
    Quadratic,
    QuasiNewton,
    RigidBody,
    Step,
    StepDiscarded,
    Structure,
    Tolerance,
    couple,
)
from cograin.base.rotation import quaternion, rotation_vector, secant, turn

# A dumbbell of two spheres, each bonded to a sphere that flies about with it. One group is free, or the outside moves
# its two ends.
DENSITY, RADIUS, HALF = 2000.0, 0.01, 0.1
BALL = DENSITY * 4.0 / 3.0 * np.pi * RADIUS**3  # mass of a sphere [kg]
TURNING = np.array([3.0, 1.0, 8.0])  # angular velocity at the start [rad/s]
SIDES = {"left": -1.0, "right": 1.0}
SCENE = f"""
gravity = [0.0, 0.0, -2.0]
[run]
step = 1.0e-4
[material.s]
density = {DENSITY!r}
"""
BONDS = """
[bond.b]
between = ["tips", "outer"]
create_distance = 0.0202
normal_stiffness = 1.0e6
tangential_stiffness = 4.0e5
"""


def spheres(name, places):
    """A set of spheres that move with the dumbbell at first."""
    rows = []
    for place in places:
        velocity = np.cross(TURNING, place)
        vectors = f"position = {list(place)}, velocity = {velocity.tolist()}"
        rows.append(f"{{ {vectors}, angular_velocity = {TURNING.tolist()}, radius = {RADIUS} }}")
    return f'[particles.{name}]\nmaterial = "s"\nlist = [ {", ".join(rows)} ]\n'


def dumbbell(sides, motion):
    """The scene of one side or both, with this motion of the ends."""
    tips = spheres("tips", [[side * HALF, 0.0, 0.0] for side in sides])
    outer = spheres("outer", [[side * (HALF + 2.0 * RADIUS), 0.0, 0.0] for side in sides])
    return SCENE + tips + outer + BONDS + f'[boundary.tip]\nparticles = {{ set = "tips" }}\nmotion = {{ {motion} }}\n'


SIX = '["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"]'
DIRECTIONS = [f"tip.{quantity}.{axis}" for quantity in ("displacement", "rotation") for axis in "xyz"]


def bar():
    """The body of the dumbbell: two spheres on a bar without mass."""
    own = 0.4 * BALL * RADIUS**2
    across = own + BALL * HALF**2
    body = RigidBody(
        2.0 * BALL,
        [2.0 * own, 2.0 * across, 2.0 * across],
        at=[[side * HALF, 0.0, 0.0] for side in SIDES.values()],
        gravity=[0.0, 0.0, -2.0],
    )
    body.place(angular_velocity=TURNING)
    return body


def march(body, force, length, count):
    """Steps under forces and moments of time."""
    for place in range(count):
        step = Step(place * length, (place + 1) * length, length)
        given = np.asarray(force(step.middle), dtype=float)
        body.advance(given, body.predict(given, step), step)
    return body


def test_a_body_begins_with_the_velocities_that_it_is_given():
    placed = RigidBody(2.0, [0.1, 0.2, 0.3], centre=[0.1, 0.0, 0.2])
    placed.place(velocity=[1.0, 2.0, 3.0], angular_velocity=[4.0, 5.0, 6.0])
    given = RigidBody(2.0, [0.1, 0.2, 0.3], centre=[0.1, 0.0, 0.2], velocity=[1, 2, 3], angular_velocity=[4, 5, 6])
    step = Step(0.0, 1e-3, 1e-3)
    assert np.array_equal(given.predict(np.zeros(6), step), placed.predict(np.zeros(6), step))
    assert np.allclose(given.velocity, [1.0, 2.0, 3.0]) and np.allclose(given.angular_velocity, [4.0, 5.0, 6.0])
    turning = RigidBody(2.0, 0.1, pivot=[0.0, 0.0, 1.0], angular_velocity=[0.0, 1.0, 0.0])
    assert np.allclose(turning.angular_velocity, [0.0, 1.0, 0.0])
    for named in (
        {"velocity": [1.0, 0.0]},
        {"angular_velocity": [np.nan] * 3},
        {"velocity": [1.0] * 3, "pivot": [0.0] * 3},
    ):
        with pytest.raises(ValueError, match=r"expected (three finite numbers|rotation and angular_velocity alone)"):
            RigidBody(1.0, 1.0, **named)


def test_a_free_top_follows_its_closed_form_in_second_order_and_loses_nothing():
    across, along, end = 2.0, 0.5, 6.0
    spin = np.array([1.2, 0.0, 4.0])
    momentum = np.array([across, across, along]) * spin
    # It turns about its axis, and with the axis about the angular momentum.
    exact = Rotation.from_rotvec(momentum * end / across) * Rotation.from_rotvec(
        [0.0, 0.0, spin[2] * (1.0 - along / across) * end]
    )
    errors = []
    for length in (2e-2, 1e-2):
        body = RigidBody(3.0, [across, across, along], velocity=[1.0, 2.0, 3.0], angular_velocity=spin)
        energy = body.energy
        march(body, lambda _: np.zeros(6), length, round(end / length))
        errors.append((Rotation.from_rotvec(body.rotation) * exact.inv()).magnitude())
        assert body.energy == pytest.approx(energy, rel=1e-13)
        assert np.array_equal(body.angular_momentum, momentum)
        assert body.position == pytest.approx(np.array([1.0, 2.0, 3.0]) * end)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.02)
    assert errors[1] < 2e-3


def test_a_rotation_counts_whole_turns():
    body = RigidBody(1.0, 1.0)
    body.place(angular_velocity=[0.0, 0.0, 2.0])
    march(body, lambda _: np.zeros(6), 0.1, 200)
    assert body.rotation == pytest.approx([0.0, 0.0, 40.0])
    assert body.displacement[3:] == pytest.approx([0.0, 0.0, 40.0])


def test_a_body_starts_with_the_velocities_that_it_is_given():
    about = {"centre": [0.1, 0.0, 0.0], "at": [[0.0, 0.2, 0.0]]}
    given = {"velocity": [1.0, 2.0, 3.0], "angular_velocity": [0.3, 0.0, -0.2]}
    started, placed = RigidBody(2.0, [1.0, 2.0, 3.0], **about, **given), RigidBody(2.0, [1.0, 2.0, 3.0], **about)
    placed.place(**given)
    assert started.velocity == pytest.approx(given["velocity"])
    assert started.angular_velocity == pytest.approx(given["angular_velocity"])
    assert [body.energy for body in (started, placed)] == [started.energy] * 2
    step = Step(0.0, 0.1, 0.1)
    assert np.array_equal(started.predict(np.zeros(6), step), placed.predict(np.zeros(6), step))
    with pytest.raises(ValueError, match="a body on a pivot only turns"):
        RigidBody(1.0, 1.0, pivot=[0.0, 0.0, 0.0], velocity=[1.0, 0.0, 0.0])
    with pytest.raises(ValueError, match="angular_velocity: expected"):
        RigidBody(1.0, 1.0, angular_velocity=[1.0, float("nan"), 0.0])


def test_a_body_on_a_pivot_swings_as_a_pendulum_does():
    high, moment = 2.5, 1.1  # highest angle [rad], moment of inertia about the pivot [kg m²]
    period = 4.0 * np.sqrt(moment / 9.81) * ellipk(np.sin(0.5 * high) ** 2)
    errors = []
    for count in (500, 1000):
        body = RigidBody(1.0, [0.1, 0.1, 0.01], centre=[0, 0, -1.0], pivot=[0, 0, 0], gravity=[0, 0, -9.81])
        body.place(rotation=[high, 0.0, 0.0])
        energy = body.energy
        march(body, lambda _: np.zeros(6), 0.25 * period / count, count)
        # A quarter of a period later it hangs straight down.
        errors.append(abs(body.rotation[0]))
        assert body.energy == pytest.approx(energy, abs=1e-12)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.02)
    assert errors[1] < 1e-4


def test_the_book_closes_with_arms_load_and_leftovers():
    def load(time):
        return [1.0, -2.0, 0.5 * time, 0.3, np.sin(time), -0.2]

    body = RigidBody(2.0, [0.3, 0.4, 0.5], at=[[0.2, 0, 0], [0, -0.3, 0.1]], gravity=[0, 0, -9.81], load=load)
    body.place(angular_velocity=[1.0, 3.0, -1.0])
    before, impulse, turned = body.energy, body.momentum, body.angular_momentum
    rng = np.random.default_rng(1)
    for place in range(300):
        step = Step(place * 1e-2, (place + 1) * 1e-2, 1e-2)
        force = rng.normal(size=12)
        body.advance(force, body.predict(force, step) + 1e-9 * rng.normal(size=12), step)
        impulse = impulse + 1e-2 * (force[:3] + force[6:9] + np.array(load(step.middle))[:3] + [0.0, 0.0, -19.62])
    assert body.correction != 0.0 and np.linalg.norm(body.rotation) > 1.0
    left = body.work + body.load_work + body.correction - (body.energy - before)
    assert abs(left) < 1e-12 * (abs(body.work) + abs(body.load_work))
    assert body.momentum == pytest.approx(impulse)
    assert np.linalg.norm(body.angular_momentum - turned) > 1.0


def test_its_compliance_is_that_of_its_differences():
    body = RigidBody(2.0, [0.3, 0.4, 0.5], at=[[0.2, 0, 0], [0, -0.3, 0.1]])
    body.place(angular_velocity=[1.0, 2.0, -1.0])
    step = Step(0.0, 1e-2, 1e-2)
    none = body.predict(np.zeros(12), step)
    columns = [(body.predict(1e-3 * row, step) - none) / 1e-3 for row in np.eye(12)]
    found = body.compliance(step)
    assert np.abs(found - np.array(columns).T).max() < 2e-3 * np.abs(found).max()


def test_a_turn_of_half_a_turn_in_a_step_is_refused():
    body = RigidBody(1.0, 1.0)
    body.place(angular_velocity=[0.0, 40.0, 0.0])
    with pytest.raises(StepDiscarded, match="turns it by half a turn or more"):
        body.predict(np.zeros(6), Step(0.0, 0.1, 0.1))


def test_what_is_no_body_is_refused_in_words():
    with pytest.raises(ValueError, match="mass: expected a finite number above 0, found 0"):
        RigidBody(0.0, 1.0)
    with pytest.raises(ValueError, match="no principal moment above the sum of the others, found 1, 1, 3"):
        RigidBody(1.0, [1.0, 1.0, 3.0])
    with pytest.raises(ValueError, match="principal moments above 0, found 0"):
        RigidBody(1.0, [1.0, 1.0, 0.0])
    with pytest.raises(ValueError, match="at: expected points of three finite numbers"):
        RigidBody(1.0, 1.0, at=[1.0, 2.0])
    with pytest.raises(ValueError, match="load: expected three forces and three moments, found 3 numbers"):
        RigidBody(1.0, 1.0, load=lambda _: [1.0, 2.0, 3.0]).predict(np.zeros(6), Step(0.0, 1.0, 1.0))
    with pytest.raises(ValueError, match="only turns; expected rotation and angular_velocity alone"):
        RigidBody(1.0, 1.0, pivot=[1, 0, 0]).place(velocity=[1.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def whole(packaged):
    """Where both ends of the dumbbell are after 0.4 s, by one unit that holds everything."""
    from cograin import Unit

    with Unit(packaged(dumbbell(SIDES.values(), f"free = {SIX}"))) as unit:
        while unit.time < 0.399:
            unit.step(1e-2)
        return np.array([unit[name] for name in DIRECTIONS])


def two_units(packaged, exchange, step, end=0.4):
    """The same by two units on one rigid body."""
    from cograin import Unit

    sides = [Unit(packaged(dumbbell([side], f"driven = {SIX}")), name=name) for name, side in SIDES.items()]
    try:
        body = bar()
        record = couple(
            Interface(sides[0], DIRECTIONS) + Interface(sides[1], DIRECTIONS), body, exchange, step=step, end=end
        )
        worked = sides[0]["tip.work"] + sides[1]["tip.work"]
    finally:
        for unit in sides:
            unit.close()
    return body, record, worked


@pytest.mark.parametrize("make", [QuasiNewton, lambda: Newton(keep=True)], ids=["quasi-newton", "newton"])
def test_two_units_on_one_body_move_as_one_unit_does(packaged, whole, make):
    errors = []
    for step in (4e-3, 2e-3):
        body, record, worked = two_units(packaged, make(), step)
        assert not record.unconverged
        assert abs(record.interface_energy) <= 1e-12 * record.exchanged_work
        assert body.work + worked == pytest.approx(0.0, abs=1e-12 * record.exchanged_work)
        off = Rotation.from_rotvec(body.rotation) * Rotation.from_rotvec(whole[3:]).inv()
        errors.append(np.linalg.norm(body.position - whole[:3]) / HALF + off.magnitude())
        # The record speaks of rotation vectors, as the units do.
        shown = [record[f"left.tip.rotation.{axis}"][-1] for axis in "xyz"]
        assert (Rotation.from_rotvec(shown) * Rotation.from_rotvec(body.rotation).inv()).magnitude() < 1e-6
        assert np.linalg.norm(body.rotation) > 1.5
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)
    assert errors[1] < 0.01


class Springs:
    """A side without a unit: springs and turning springs in all six directions of a boundary."""

    can_restore = keeps_itself = True
    has_derivatives = False
    work = None
    names: ClassVar = DIRECTIONS

    def __init__(self, stiffness):
        self.time, self.displacement, self.stiffness = 0.0, np.zeros(6), np.array(stiffness)
        self.before = self.displacement

    def turn(self, place):
        assert place == 3

    def force(self, kind):
        return -0.5 * self.stiffness * (self.before + self.displacement)

    def advance(self, displacement, step, kind):
        self.time, self.before, self.displacement = step.end, self.displacement, displacement
        return self.force(kind)

    def save(self):
        self.saved = self.time, self.before, self.displacement

    def restore(self):
        self.time, self.before, self.displacement = self.saved


def test_a_body_on_springs_swings_in_its_six_frequencies():
    mass, inertia, stiffness = 2.0, [0.3, 0.4, 0.5], [200.0, 300.0, 400.0, 10.0, 20.0, 30.0]
    body = RigidBody(mass, inertia)
    speeds = np.full(3, 1e-4)
    body.place(velocity=speeds, angular_velocity=speeds)
    record = couple(Springs(stiffness), body, QuasiNewton(), step=1e-3, end=0.5, progress=False)
    rates = np.sqrt(np.array(stiffness) / [mass, mass, mass, *inertia])
    exact = 1e-4 / rates * np.sin(rates * 0.5)
    assert record.rows[-1].displacement == pytest.approx(exact, abs=1e-4 * np.abs(exact).max())


def test_a_body_beside_an_oscillator_is_one_of_several_partners(packaged, opened):
    unit = opened(dumbbell([1.0], f"driven = {SIX}"), name="right")
    from conftest import DROP

    other = opened(DROP, name="other")
    body = RigidBody(BALL, 0.4 * BALL * RADIUS**2, at=[HALF, 0, 0], centre=[HALF, 0, 0])
    both = Interface(other, "floor.displacement.z") + Interface(unit, DIRECTIONS)
    partners = Partners(Oscillator(1.0, 1e4), body)
    record = couple(both, partners, QuasiNewton(), step=1e-3, end=0.1)
    assert partners.turning() == (4,)
    assert not record.unconverged and abs(record.interface_energy) <= 1e-12 * record.exchanged_work
    assert np.linalg.norm(body.rotation) > 0.1


def test_a_body_needs_all_rotations_of_a_boundary(opened):
    unit = opened(dumbbell([1.0], f"driven = {SIX}"))
    swapped = [*DIRECTIONS[3:], *DIRECTIONS[:3]]
    with pytest.raises(
        ValueError, match=r"a rigid body turns: expected rotation.x, .y and .z of a boundary here, found"
    ):
        couple(Interface(unit, swapped), RigidBody(1.0, 1.0), QuasiNewton(), step=1e-3, end=0.1)
    with pytest.raises(ValueError, match="the interface has 3 directions, the partner 6"):
        couple(Interface(unit, DIRECTIONS[:3]), RigidBody(1.0, 1.0), QuasiNewton(), step=1e-3, end=0.1)


@pytest.mark.parametrize("axes", ["xyz", "xy"])
@pytest.mark.parametrize("substeps", [1, 3])
def test_a_structure_with_large_rotations_takes_the_work_that_the_units_give(opened, axes, substeps):
    unit = opened(dumbbell([1.0], f"driven = {SIX}"))
    names = [f"tip.rotation.{axis}" for axis in axes]
    pull = np.array([0.5, 0.3, -0.4])[: len(axes)] * 1e-3
    springs = Structure(np.eye(len(axes)) * 1e-6, np.eye(len(axes)) * 1e-3, load=lambda _: pull)
    exchange = QuasiNewton(tolerance=Tolerance(relative=1e-8))
    record = couple(Interface(unit, names, substeps=substeps), springs, exchange, step=1e-3, end=0.3)
    assert np.linalg.norm(springs.displacement) > 0.3 and not record.unconverged
    assert abs(record.interface_energy) <= 1e-11 * record.exchanged_work
    # The columns are the unit's own.
    if substeps == 1:
        assert record["tip.mean_moment.x"][-1] == unit["tip.mean_moment.x"]


def test_a_rotation_beside_one_that_stands_takes_its_own_work(opened):
    unit = opened(dumbbell([1.0], f"driven = {SIX}"), inputs={"tip.rotation.y": 0.8, "tip.rotation.z": -0.4})
    spring = Oscillator(1e-6, 1e-3, load=lambda _: 5e-4)
    record = couple(Interface(unit, "tip.rotation.x"), spring, QuasiNewton(), step=1e-3, end=0.2)
    assert abs(spring.displacement[0]) > 0.3
    assert abs(record.interface_energy) <= 1e-11 * record.exchanged_work


def test_rotations_of_a_boundary_stand_in_one_interface(opened):
    unit = opened(dumbbell([1.0], f"driven = {SIX}"))
    with pytest.raises(ValueError, match=r"expected all of tip.rotation in one Interface, found it in two"):
        Interface(unit, "tip.rotation.x") + Interface(unit, "tip.rotation.y")
    with pytest.raises(ValueError, match=r"quadratic motion: expected displacements, found tip.rotation.x"):
        Coupling(Interface(unit, "tip.rotation.x"), Oscillator(1.0, 1.0), Quadratic(), 1e-3).advance()


def test_rotation_vectors_and_turns_belong_together():
    rng = np.random.default_rng(3)
    for _ in range(200):
        before, now = rng.normal(size=3), rng.normal(size=3)
        way = Rotation.from_rotvec(now) * Rotation.from_rotvec(before).inv()
        assert turn(before, now) == pytest.approx(way.as_rotvec(), abs=1e-13)
        assert secant(before, now) @ (now - before) == pytest.approx(way.as_rotvec(), abs=1e-13)
        far = rotation_vector(quaternion(before), near=before * 9.0)
        assert (Rotation.from_rotvec(far) * Rotation.from_rotvec(before).inv()).magnitude() < 1e-12
        assert abs(np.linalg.norm(far) - np.linalg.norm(before * 9.0)) <= np.pi + 1e-12
