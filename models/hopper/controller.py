"""A bang-bang controller with its slide gate as a unit of its own, made with pythonfmu.

Opens the gate when the mass in the bin is below `low` and shuts it above `high`; between them it leaves it alone. The
gate goes at constant speed; `position` is where it is at the end of the communication step.
"""

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

INPUTS = {"mass": "in the bin [kg]"}
PARAMETERS = {
    "low": "mass below which the gate is opened [kg]",
    "high": "mass above which it is shut [kg]",
    "speed": "of the gate [m/s]",
    "stroke": "of the gate, from shut to open [m]",
    "begin": "time before which the gate stays shut [s]",
}
OUTPUTS = {"position": "of the gate at the step's end, 0 is shut [m]", "wanted": "1 while the gate is to be open [1]"}


class Controller(Fmi2Slave):
    """Controller and drive of the gate."""

    author = "cograin"
    description = "A bang-bang controller of a slide gate"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.low, self.high = 0.065, 0.070
        self.speed, self.stroke, self.begin = 0.5, 0.05, 0.2
        self.mass = self.position = self.wanted = 0.0
        for name, text in INPUTS.items():
            self.register_variable(Real(name, causality=Fmi2Causality.input, description=text))
        for name, text in PARAMETERS.items():
            kind = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
            self.register_variable(Real(name, description=text, **kind))
        for name, text in OUTPUTS.items():
            kind = {"causality": Fmi2Causality.output, "initial": Fmi2Initial.exact}
            self.register_variable(Real(name, description=text, **kind))

    def do_step(self, current_time, step_size):
        """Looks at the mass, decides, and moves the gate for one communication step."""
        if self.mass > self.high or current_time < self.begin:
            self.wanted = 0.0
        elif self.mass < self.low:
            self.wanted = 1.0
        way = self.speed * step_size
        target = self.wanted * self.stroke
        self.position += min(max(target - self.position, -way), way)
        return True
