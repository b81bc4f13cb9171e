"""A testing machine as a unit of its own, made with pythonfmu: crosshead, frame of finite stiffness, platen with mass.

The crosshead goes down at constant speed; the frame, a spring with a dashpot, hands its motion to the platen, on which
the specimen pushes back. One step is the implicit midpoint rule under a constant force, which keeps the energy book to
rounding: work of drive and specimen = change of the energy stored + loss in the dashpot.
"""

import math

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

INPUTS = {"force": "force of the specimen on the platen, mean of the step, positive upwards [N]"}
PARAMETERS = {
    "speed": "of the crosshead, downwards [m/s]",
    "stiffness": "of the frame [N/m]",
    "mass": "of the platen [kg]",
    "damping_ratio": "of the platen on its frame [1]",
}
OUTPUTS = {
    "displacement": "of the platen at the step's end, positive upwards [m]",
    "velocity": "of the platen [m/s]",
    "crosshead": "displacement of the crosshead, positive upwards [m]",
    "drive_work": "work of the drive since the start [J]",
    "specimen_work": "work of the specimen's force since the start [J]",
    "energy": "elastic energy of the frame and kinetic energy of the platen [J]",
    "loss": "lost in the dashpot since the start [J]",
}


class Press(Fmi2Slave):
    """The machine."""

    author = "cograin"
    description = "A press of finite stiffness"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.speed = 0.1
        self.stiffness = 1.0e9
        self.mass = 20.0
        self.damping_ratio = 0.5
        self.force = 0.0
        for name in OUTPUTS:
            setattr(self, name, 0.0)
        for name, text in INPUTS.items():
            self.register_variable(Real(name, causality=Fmi2Causality.input, description=text))
        for name, text in PARAMETERS.items():
            kind = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
            self.register_variable(Real(name, description=text, **kind))
        for name, text in OUTPUTS.items():
            kind = {"causality": Fmi2Causality.output, "initial": Fmi2Initial.exact}
            self.register_variable(Real(name, description=text, **kind))

    def do_step(self, current_time, step_size):
        """One communication step under the force that was set."""
        half = 0.5 * step_size
        damping = 2.0 * self.damping_ratio * math.sqrt(self.stiffness * self.mass)
        stretch = self.crosshead - self.displacement
        drive = -self.speed
        # Midpoint rule: M (v̄ − v₀) 2/H = F + K (s + (ṡ − v̄) H/2) + C (ṡ − v̄), with the frame's stretch s.
        pull = self.force + self.stiffness * (stretch + half * drive) + damping * drive
        mean = (self.mass * self.velocity / half + pull) / (self.mass / half + half * self.stiffness + damping)
        frame = self.stiffness * (stretch + half * (drive - mean)) + damping * (drive - mean)

        self.drive_work += frame * drive * step_size
        self.specimen_work += self.force * mean * step_size
        self.loss += damping * (drive - mean) ** 2 * step_size
        self.displacement += mean * step_size
        self.crosshead += drive * step_size
        self.velocity = 2.0 * mean - self.velocity
        stretch = self.crosshead - self.displacement
        self.energy = 0.5 * (self.stiffness * stretch**2 + self.mass * self.velocity**2)
        return True
