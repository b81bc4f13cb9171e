"""Temperatures and heat flows are exchanged as displacements and forces are: the same heat on both sides."""

from types import SimpleNamespace

import numpy as np
import pytest

from cograin import (
    CouplingStopped,
    GaussSeidel,
    HeatCapacity,
    Interface,
    Mapping,
    Quadratic,
    QuasiNewton,
    Secant,
    Structure,
    Verlet,
    couple,
)

#: Of the particles behind each boundary: capacity [J/K], conductance to the boundary [W/K], temperature at first [K].
CAPACITY, CONDUCTANCE, WARM, COLD = 2.0, 3.0, 400.0, 300.0


class Heated:
    """A stand-in for a unit: bodies of one temperature, each behind a boundary that the outside heats."""

    name, can_restore, has_derivatives, has_variable_steps = "bed", True, False, True

    def __init__(self, boundaries):
        self.count, self.time = len(boundaries), 0.0
        names = [
            (f"{each}.{last}", causality)
            for last, causality in (("temperature", "input"), ("heat_flow", "output"), ("mean_heat_flow", "output"))
            for each in boundaries
        ]
        names += [(f"{each}.work", "output") for each in boundaries]
        self.variables = {
            name: SimpleNamespace(name=name, causality=kind, type="Real", unit="") for name, kind in names
        }
        self.values = dict.fromkeys(self.variables, 0.0)
        self.values.update({f"{each}.temperature": COLD for each in boundaries})
        self.boundaries, self.stands = boundaries, np.full(self.count, COLD)
        self.inside = np.full(self.count, WARM)
        self._answer(np.zeros(self.count))

    def variable(self, name):
        return self.variables[name]

    def get(self, names):
        return np.array([self.values[name] for name in names])

    def set(self, names, values):
        self.values.update(zip(names, values, strict=True))

    def _answer(self, mean):
        for place, each in enumerate(self.boundaries):
            self.values[f"{each}.heat_flow"] = CONDUCTANCE * (self.inside[place] - self.stands[place])
            self.values[f"{each}.mean_heat_flow"] = mean[place]

    def step(self, length, until):
        """The boundary's temperature is a ramp; 500 small steps of the midpoint rule."""
        end = self.get([f"{each}.temperature" for each in self.boundaries])
        small, begin, given = length / 500, self.stands, np.zeros(self.count)
        for number in range(500):
            middle = begin + (end - begin) * ((number + 0.5) / 500)
            flow = CONDUCTANCE * (self.inside - middle) / (1.0 + 0.5 * small * CONDUCTANCE / CAPACITY)
            self.inside = self.inside - small * flow / CAPACITY
            given += small * flow
        self.stands, self.time = end, until
        self._answer(given / length)

    def save(self, into=None):
        return dict(self.values), self.stands, self.inside, self.time

    def restore(self, state):
        values, self.stands, self.inside, self.time = state
        self.values = dict(values)


def closed_form(time, capacity=4.0):
    """Temperature of a capacity that takes the heat of the particles alone."""
    rate = CONDUCTANCE * (1.0 / CAPACITY + 1.0 / capacity)
    return COLD + (WARM - COLD) * CAPACITY / (CAPACITY + capacity) * (1.0 - np.exp(-rate * time))


def heated(exchange, step, capacity=4.0, count=1, **named):
    """Both sides after a second, and the record."""
    bed = Heated([f"wall{number}" for number in range(count)])
    plate = HeatCapacity(np.full(count, capacity), start=COLD, **named)
    names = [f"{each}.temperature" for each in bed.boundaries]
    return bed, plate, couple(Interface(bed, names), plate, exchange, step=step, end=1.0)


@pytest.mark.parametrize(("exchange", "count"), [(Secant, 1), (QuasiNewton, 1), (QuasiNewton, 3)])
def test_a_capacity_follows_the_closed_form_in_second_order_and_loses_no_heat(exchange, count):
    errors = []
    for step in (0.1, 0.05):
        bed, plate, record = heated(exchange(), step, count=count)
        errors.append(np.abs(plate.temperature - closed_form(1.0)).max())
        given = CAPACITY * float((WARM - bed.inside).sum())
        assert plate.heat == pytest.approx(given, rel=1e-12) and plate.stored == pytest.approx(given, rel=1e-12)
        assert not record.unconverged and abs(record.interface_energy) <= 1e-12 * record.exchanged_work
        assert record.exchanged_work == pytest.approx(given, rel=1e-12), "in joules"
        flows = sum(record[f"{each}.mean_heat_flow"] @ record["length"] for each in bed.boundaries)
        assert flows == pytest.approx(given, rel=1e-12)
    assert 3.5 < errors[0] / errors[1] < 4.5


def test_a_light_capacity_is_carried_by_a_repeated_exchange_alone():
    _, plate, record = heated(Secant(), 0.05, capacity=1e-3)
    # It swings about the temperature of the particles, by no more than it began with.
    assert np.abs(plate.temperature - WARM).max() <= WARM - COLD and not record.unconverged
    with pytest.raises(CouplingStopped, match="expected 0 K or above, found -"):
        heated(GaussSeidel(), 0.05, capacity=1e-3)


def test_the_ambient_takes_what_the_conductance_lets_through():
    alone = HeatCapacity(2.0, 3.0, start=350.0, ambient=300.0, load=lambda time: 6.0)
    bed = Heated(["wall"])
    bed.inside = np.full(1, 350.0)
    bed.values["wall.temperature"], bed.stands = 350.0, np.full(1, 350.0)
    bed._answer(np.zeros(1))
    couple(Interface(bed, "wall.temperature"), alone, Secant(), step=0.05, end=30.0)
    assert alone.temperature == pytest.approx([302.0], rel=1e-6), "6 W through 3 W/K"
    assert alone.load_heat == pytest.approx(180.0)
    assert alone.lost == pytest.approx(180.0 + 48.0 * (2.0 + CAPACITY), rel=1e-6)


def test_a_structure_of_first_order_is_the_same():
    first = Structure(0.0, [[1.0, -1.0], [-1.0, 1.0]], [2.0, 5.0], at=[0])
    second = HeatCapacity([2.0, 5.0], [[1.0, -1.0], [-1.0, 1.0]], at=[0])
    for partner in (first, second):
        partner.place([300.0, 310.0])
        bed = Heated(["wall"])
        couple(Interface(bed, "wall.temperature"), partner, Secant(), step=0.1, end=1.0)
    assert first.position == pytest.approx(second.temperature, rel=1e-6), "as near as both sides agree"


def test_temperatures_of_another_mesh_reach_the_nodes_and_no_heat_is_lost_on_the_way():
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    points = np.array([[0.2, 0.1, 0.0], [0.9, 0.4, 0.1], [0.5, 0.5, 0.0]])
    mapping = Mapping(corners, [[0, 1, 2], [0, 2, 3]], points)
    assert mapping.temperature(300.0 + corners @ [10.0, 20.0, 0.0]) == pytest.approx(300.0 + points @ [10.0, 20.0, 0.0])
    flows = np.array([1.0, -2.0, 5.0])
    assert mapping.heat_flow(flows).sum() == pytest.approx(flows.sum(), rel=1e-15)
    with pytest.raises(ValueError, match=r"temperatures of the nodes: expected an array of \(4,\), found \(3,\)"):
        mapping.temperature(flows)

    nodes = Heated([f"wall.node[{number}]" for number in range(1, 4)])
    plate = HeatCapacity(np.full(4, 1.0), 3.0 * np.eye(4) - 0.75, start=COLD, ambient=COLD)
    names = [f"{each}.temperature" for each in nodes.boundaries]
    record = couple(Interface(nodes, names, through=mapping.shares), plate, QuasiNewton(), step=0.05, end=1.0)
    given = CAPACITY * float((WARM - nodes.inside).sum())
    assert plate.heat == pytest.approx(given, rel=1e-12) and plate.stored + plate.lost == pytest.approx(given)
    assert record.exchanged_work == pytest.approx(given, rel=1e-12) and not record.unconverged
    assert nodes.stands == pytest.approx(mapping.temperature(plate.temperature), rel=1e-6)


def test_nodes_of_several_temperatures_are_no_start_of_another_mesh():
    nodes = Heated(["wall.node[1]", "wall.node[2]"])
    nodes.values["wall.node[2].temperature"] = 310.0
    with pytest.raises(ValueError, match="expected a unit of one temperature at the start"):
        Interface(nodes, ["wall.node[1].temperature", "wall.node[2].temperature"], through=np.eye(2))


@pytest.mark.parametrize(
    ("exchange", "said"), [(Quadratic, "quadratic motion: expected displacements"), (Verlet, "mass")]
)
def test_exchanges_of_second_order_in_motion_are_refused(exchange, said):
    with pytest.raises(ValueError, match=said):
        heated(exchange(), 0.1)


def test_small_heats_do_not_drown_in_the_temperature_that_all_have():
    chain = 1e3 * (np.diag([1.0, 2.0, 1.0]) - np.diag([1.0, 1.0], 1) - np.diag([1.0, 1.0], -1))
    plate = HeatCapacity([2.0, 3.0, 4.0], chain, start=300.0, at=[0], load=lambda time: [0.0, 0.0, 1e-9])
    bed = Heated(["wall"])
    bed.inside = np.full(1, COLD)
    bed._answer(np.zeros(1))
    couple(Interface(bed, "wall.temperature"), plate, Secant(), step=0.05, end=1.0)
    assert plate.load_heat == pytest.approx(1e-9, rel=1e-12) and abs(plate.lost) < 1e-12 * plate.load_heat
    with pytest.raises(ValueError, match="heat has none"):
        plate.place(velocity=1.0)
    plate.place(310.0)
    assert (plate.stored, plate.heat, plate.load_heat) == (0.0, 0.0, 0.0) and plate.displacement == [310.0]
