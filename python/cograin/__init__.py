"""Couples units of grains with structures and with other units.

A `Unit` is a ``.fmu``. An `Interface` names the displacements of units that are coupled, and the forces that respond. A
`Partner` is the other side: an `Oscillator`, a `Modal` model, a `Structure` of finite elements, a `RigidBody`, a
`HeatCapacity`, a flow of `cograin.fluid`, a `UnitPartner`. An `Exchange` says how both sides agree on a communication
step: `GaussSeidel`, `Jacobi` and `Verlet` are explicit; `FixedPoint`, `Aitken`, `Secant`, `QuasiNewton` and `Newton`
repeat the step; `Quadratic` is of fourth order.
`couple` runs both sides and returns a `Record`.

The nodes of a mesh that the outside moves are arrays, `Nodes`; a `Mapping` joins them with the nodes of another mesh.
`Cells` are those of a grid.

Forces are those *of the particles on the boundary*. SI units, radians.

A marble falls on a table, a mass on a spring:

>>> from cograin import Interface, Oscillator, Program, Secant, Unit, couple
>>> program = Program()
>>> print(program("new", "drop"), end="")  # a scene to start from
drop: a marble on a table that an outside program lifts
next: cograin check drop/scene.toml
      cograin run drop/scene.toml -o drop/out
      cd drop && python couple.py
>>> with Unit(program.export("drop/scene.toml", "drop.fmu")) as marble:
...     table = Oscillator(mass=0.1, stiffness=1e4)  # [kg], [N/m]
...     record = couple(Interface(marble, "table.displacement.z"), table, Secant(), step=1e-4, end=0.06)
>>> len(record), record.unconverged
(600, [])
>>> bool(record["table.displacement.z"].min() < -1e-4)  # the marble has hit it
True

`cograin.results` reads what runs leave, `cograin.plot` draws it, `cograin.study` makes many runs, `cograin.precice`
joins units to preCICE. `cograin.ssp` packs several into one system (SSP).
"""

from cograin.base.program import Program, ProgramError
from cograin.exchanges.coupling import Coupling, CouplingStopped, StepControl, couple
from cograin.exchanges.exchange import Exchange, GaussSeidel, Jacobi, Side, Verlet
from cograin.exchanges.implicit import Aitken, FixedPoint, Implicit, Newton, QuasiNewton, Secant
from cograin.exchanges.quadratic import Quadratic
from cograin.exchanges.record import Record, Row
from cograin.exchanges.tolerance import Tolerance
from cograin.heat import HeatCapacity
from cograin.partners.partner import KickedPartner, Partner, Partners, UnitPartner
from cograin.partners.rigid_body import RigidBody
from cograin.partners.step import Force, Outcome, Step
from cograin.partners.structure import Modal, Oscillator, Structure
from cograin.units.cells import Cells
from cograin.units.interface import Interface, stiffness
from cograin.units.mapping import Mapping
from cograin.units.nodes import Nodes
from cograin.units.unit import State, StepDiscarded, Unit, UnitError

__all__ = [
    "Aitken",
    "Cells",
    "Coupling",
    "CouplingStopped",
    "Exchange",
    "FixedPoint",
    "Force",
    "GaussSeidel",
    "HeatCapacity",
    "Implicit",
    "Interface",
    "Jacobi",
    "KickedPartner",
    "Mapping",
    "Modal",
    "Newton",
    "Nodes",
    "Oscillator",
    "Outcome",
    "Partner",
    "Partners",
    "Program",
    "ProgramError",
    "Quadratic",
    "QuasiNewton",
    "Record",
    "RigidBody",
    "Row",
    "Secant",
    "Side",
    "State",
    "Step",
    "StepControl",
    "StepDiscarded",
    "Structure",
    "Tolerance",
    "Unit",
    "UnitError",
    "UnitPartner",
    "Verlet",
    "couple",
    "stiffness",
]
