"""How beam and grains exchange displacement and force: implicit with rollback, or explicit to see it fail."""

from dataclasses import dataclass, field

import fmpy
from fmpy.fmi2 import FMU2Slave


class Grains:
    """The unit of the grains, driven by the height of its floor."""

    def __init__(self, path):
        description = fmpy.read_model_description(path)
        self.folder = fmpy.extract(path)
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.unit = FMU2Slave(
            guid=description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="grains",
        )
        self.unit.instantiate()
        self.unit.setupExperiment(startTime=0.0)
        self.unit.enterInitializationMode()
        self.unit.exitInitializationMode()
        self.time = 0.0
        self.height = 0.0
        self.saved = None

    def read(self, *names):
        """Values of outputs, by name."""
        return self.unit.getReal([self.references[name] for name in names])

    def step(self, height, interval):
        """Moves the floor to this height during the next interval; gives the mean force of the grains on it."""
        self.unit.setReal([self.references["floor.displacement.z"]], [height])
        self.unit.doStep(currentCommunicationPoint=self.time, communicationStepSize=interval)
        self.time += interval
        self.height = height
        return self.read("floor.mean_force.z")[0]

    def save(self):
        """Remembers the present state."""
        if self.saved is not None:
            self.unit.freeFMUstate(self.saved[0])
        self.saved = (self.unit.getFMUstate(), self.time, self.height)

    def restore(self):
        """Goes back to the remembered state."""
        self.unit.setFMUstate(self.saved[0])
        _, self.time, self.height = self.saved

    def interface_stiffness(self, interval, displacement=1e-6):
        """Force per displacement with which the grains resist a ramp of one interval, from the present state [N/m]."""
        self.save()
        at_rest = self.step(self.height, interval)
        self.restore()
        moved = self.step(self.height + displacement, interval)
        self.restore()
        return (at_rest - moved) / displacement


@dataclass
class Exchange:
    """What one communication step came to."""

    height: float  # of the floor at its end, as the unit has it [m]
    force: float  # of the grains on the floor, mean of the step [N]
    evaluations: int  # of the unit
    mismatch: float  # between the floor of the unit and the middle of the beam [m]


@dataclass
class Implicit:
    """Repeats each step from the saved state until both sides agree on displacement and mean force.

    With a ramp inside the step and its mean force the impulse and the work that leave one side are those which enter
    the other. The correction is Newton's with a secant slope, which is Aitken's relaxation in one dimension.
    """

    interval: float  # [s]
    stiffness: float  # of the grains over one interval; refined by the secants [N/m]
    tolerance: float = 1e-9  # [m]
    limit: int = 12  # evaluations a step
    forces: list = field(default_factory=list)  # of the last two steps [N]

    def exchange(self, beam, grains, other_force):
        """One communication step; `other_force` is what else acts on the middle [N]."""
        grains.save()
        guess = 2.0 * self.forces[-1] - self.forces[-2] if len(self.forces) > 1 else self.forces[-1]
        height = beam.predict(guess + other_force)
        tried = []
        for evaluations in range(1, self.limit + 1):
            force = grains.step(height, self.interval)
            mismatch = beam.predict(force + other_force) - height
            tried.append((height, force))
            if abs(mismatch) <= self.tolerance:
                break
            self.refine(tried)
            height += mismatch / (1.0 + beam.step_compliance * self.stiffness)
            grains.restore()
        else:
            raise RuntimeError(
                f"t = {grains.time:.4f} s: {self.limit} evaluations left a mismatch of {mismatch:.1e} m; "
                f"a shorter interval than {self.interval:g} s would help"
            )
        beam.advance(force + other_force)
        self.forces = [*self.forces[-1:], force]
        return Exchange(tried[-1][0], force, evaluations, mismatch)

    def refine(self, tried):
        """Takes the slope of the last two evaluations, where they are far enough apart to tell."""
        if len(tried) > 1 and abs(tried[-1][0] - tried[-2][0]) > 10.0 * self.tolerance:
            slope = -(tried[-1][1] - tried[-2][1]) / (tried[-1][0] - tried[-2][0])
            self.stiffness = max(slope, 0.0)


@dataclass
class Explicit:
    """Gives the beam the mean force of the step before: one evaluation a step, and no agreement."""

    interval: float  # [s]
    force: float  # of the last step [N]

    def exchange(self, beam, grains, other_force):
        """One communication step; `other_force` is what else acts on the middle [N]."""
        beam.advance(self.force + other_force)
        force = grains.step(beam.deflection, self.interval)
        mismatch = beam.step_compliance * (force - self.force)
        self.force = force
        return Exchange(beam.deflection, force, 1, mismatch)
