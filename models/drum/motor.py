"""A direct-current motor that takes turns with a drum."""

INTERVAL = 1e-3  # communication step [s]


class Motor:
    """Armature with resistance and inductance: L di/dt = U − R i − k ω, torque k i; a gear is in k."""

    resistance = 10.0  # [Ω]
    inductance = 0.1  # [H]
    constant = 0.2  # [N m/A, V s]
    voltage = 1.0  # when it is switched on [V]

    def __init__(self):
        self.current = 0.0
        self.given = self.lost = 0.0

    def supply(self, time):
        """Voltage at a time: off while the grains fall, then up within 50 ms [V]."""
        return self.voltage * min(max((time - 0.25) / 0.05, 0.0), 1.0)

    def step(self, time, speed):
        """One communication step at this angular velocity [rad/s], by the trapezoidal rule. Gives voltage and mean torque."""
        before, voltage = self.current, self.supply(time + 0.5 * INTERVAL)
        half = 0.5 * INTERVAL / self.inductance
        push = 2.0 * half * (voltage - self.constant * speed)
        self.current = (before * (1.0 - half * self.resistance) + push) / (1.0 + half * self.resistance)
        mean = 0.5 * (before + self.current)
        self.given += voltage * mean * INTERVAL
        self.lost += self.resistance * mean**2 * INTERVAL
        return voltage, self.constant * mean
