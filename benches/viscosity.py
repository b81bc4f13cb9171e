"""Shear stress and temperature of smooth inelastic spheres that are sheared without end, beside kinetic theory.

    python benches/viscosity.py --program target/release/cograin       some five minutes

The cell of `motion.shear` holds a gas far from its walls; collisions take what the shear does. Two theories:

- C. K. K. Lun, S. B. Savage, D. J. Jeffrey & N. Chepurniy, J. Fluid Mech. 140 (1984) 223: viscosity of first order in
  the gradients, at any density; nearly elastic spheres.
- Grad's moments of Boltzmann's equation in uniform shear (J. T. Jenkins & M. W. Richman, J. Fluid Mech. 192, 1988, 313;
  A. Santos, V. Garzo & J. W. Dufty, Phys. Rev. E 69, 2004, 061303): any restitution, dilute; normal stresses differ.
"""

import argparse
import csv
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

DIAMETER, DENSITY, RATE = 2e-3, 2500.0, 100.0  # [m], [kg/m3], [1/s]

SCENE = """
[run]
step = {step!r}
end = {end!r}
threads = 1
[material.glass]
density = {density!r}
[pair.glass.glass]
normal_stiffness = {stiffness!r}
normal_damping = {damping!r}
[contact.touch.normal.hooke_stiffness]
[particles.gas]
material = "glass"
file = "gas.csv"
[cell]
edges = {edges}
motion = {{ shear = "xy" }}
[output]
history_interval = {interval!r}
columns = ["cell.mean_stress.xy", "cell.stress.*", "energy.kinetic"]
"""


class Flow(NamedTuple):
    """What a steady shear flow has, for density and diameter 1 and a shear of 1 a second."""

    temperature: float  # a third of the mean square of a velocity
    shear: float  # shear stress
    pressures: tuple  # normal stresses along the flow, across it and along the axis of the shear


def contact_value(solid):
    """Carnahan and Starling's pair distribution at contact."""
    return (1.0 - 0.5 * solid) / (1.0 - solid) ** 3


def lun(solid, restitution):
    """Lun et al. (1984): what the shear does is what collisions take."""
    eta, g = 0.5 * (1.0 + restitution), contact_value(solid)
    dilute = 5.0 * np.sqrt(np.pi) / 96.0
    bulk = 256.0 * dilute * solid**2 * g * eta / (5.0 * np.pi)
    viscosity = dilute / (eta * (2.0 - eta) * g)
    viscosity *= (1.0 + 1.6 * eta * solid * g) * (1.0 + 1.6 * eta * (3.0 * eta - 2.0) * solid * g)
    viscosity += 0.6 * bulk
    taken = 48.0 / np.sqrt(np.pi) * eta * (1.0 - eta) * solid**2 * g
    temperature = viscosity / taken
    pressure = solid * temperature * (1.0 + 4.0 * eta * solid * g)
    return Flow(temperature, viscosity * np.sqrt(temperature), (pressure,) * 3)


def grad(solid, restitution):
    """Grad's moments of Boltzmann's equation. Of the momentum P over the pressure, with rates over the collision rate:
    2 a Pxy + b (Pxx - 1) + c Pxx = 0, b (Pyy - 1) + c Pyy = 0, a Pyy + (b + c) Pxy = 0, 2 a Pxy + 3 c = 0."""
    b = 0.5 * (1.0 + restitution) * (1.0 - (1.0 - restitution) / 3.0)
    c = 5.0 / 12.0 * (1.0 - restitution**2)
    shear_rate = np.sqrt(1.5 * c / b) * (b + c)
    # The collision rate 16/5 n d^2 sqrt(pi T/m) with n = 6 solid/(pi d^3), and T here the square of a velocity.
    temperature = (5.0 * np.sqrt(np.pi) / (96.0 * solid * shear_rate)) ** 2
    across = b / (b + c)
    pressure = solid * temperature
    return Flow(
        temperature,
        pressure * shear_rate * b / (b + c) ** 2,
        (pressure * (3.0 - 2.0 * across), pressure * across, pressure * across),
    )


def simulated(program, folder, solid, restitution, *, count=500, strain=60.0, start=20.0, stiff=100.0, seed=1):
    """The same of a simulation: means from `start` to `strain`. A contact lasts 1/`stiff` of the time in which a sphere
    flies by its diameter, at the speed of Grad's solution."""
    expected = grad(solid, restitution)
    speed = np.sqrt(expected.temperature) * RATE * DIAMETER
    volume = count * np.pi / 6.0 * DIAMETER**3 / solid
    side = volume ** (1.0 / 3.0)
    random, per = np.random.default_rng(seed), int(np.ceil(count ** (1.0 / 3.0)))
    sites = np.stack(np.meshgrid(*[np.arange(per)] * 3), axis=-1).reshape(-1, 3)[random.permutation(per**3)[:count]]
    room = side / per - 1.001 * DIAMETER
    places = side / per * (sites + 0.5) + room * (random.random((count, 3)) - 0.5)
    velocity = random.normal(size=(count, 3))
    velocity -= velocity.mean(axis=0)
    velocity *= speed / np.sqrt((velocity**2).mean())
    columns = np.column_stack([places, np.full(count, DIAMETER / 2), velocity])
    np.savetxt(folder / "gas.csv", columns, "%.17g", ",", header="x,y,z,radius,vx,vy,vz", comments="")
    duration = DIAMETER / (speed * stiff)
    reduced = 0.5 * DENSITY * np.pi / 6.0 * DIAMETER**3
    logarithm = np.log(restitution)
    scene = SCENE.format(
        step=float(duration / 25.0),
        end=strain / RATE,
        density=DENSITY,
        stiffness=float(reduced * (np.pi**2 + logarithm**2) / duration**2),
        damping=float(-2.0 * logarithm / duration),
        edges=np.diag([side] * 3).tolist(),
        interval=0.1 / RATE,
    )
    (folder / "gas.toml").write_text(scene)
    (folder / "gas_inputs.csv").write_text(f"time,cell.shear\n0.0,0.0\n{strain / RATE!r},{strain!r}\n")
    command = [program, "run", "gas.toml", "-o", "gas", "--overwrite", "--quiet", "--inputs", "gas_inputs.csv"]
    subprocess.run([str(part) for part in command], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    with open(folder / "gas" / "history.csv") as file:
        rows = [row for row in csv.DictReader(file) if float(row["time"]) * RATE > start]
    mean = {name: np.mean([float(row[name]) for row in rows]) for name in rows[0]}
    scale = DENSITY * (RATE * DIAMETER) ** 2
    return Flow(
        2.0 / 3.0 * mean["energy.kinetic"] / (DENSITY * solid * volume) / (RATE * DIAMETER) ** 2,
        mean["cell.mean_stress.xy"] / scale,
        tuple(-mean[f"cell.stress.{name}"] / scale for name in ("xx", "yy", "zz")),
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--program", type=lambda path: Path(path).resolve(), default=Path("target/release/cograin").resolve()
    )
    options = parser.parse_args()
    print("solid  restitution            temperature  shear stress  normal stresses xx, yy, zz")
    with tempfile.TemporaryDirectory() as folder:
        for solid, restitution in ((0.05, 0.95), (0.05, 0.9), (0.05, 0.8), (0.1, 0.9), (0.2, 0.9)):
            found = simulated(options.program, Path(folder), solid, restitution)
            for name, flow in (
                ("simulated", found),
                ("Lun et al.", lun(solid, restitution)),
                ("Grad, dilute", grad(solid, restitution)),
            ):
                pressures = "  ".join(f"{pressure:9.4f}" for pressure in flow.pressures)
                print(f"{solid:5.2f}  {restitution:11.2f}  {name:12}", end="")
                print(f"  {flow.temperature:11.4f}  {flow.shear:12.4f}  {pressures}", flush=True)


if __name__ == "__main__":
    main()
