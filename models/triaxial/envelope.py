"""Runs the test for several seeds and pressures, and draws stress and volume over strain and the envelope of Mohr and Coulomb."""

import argparse
import csv
import subprocess
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
SIDE = 0.02  # of the cube [m]
WAY = 0.16e-3  # of a plate until the sand bears the pressure, with a margin [m]
STRAIN = 0.055  # along z at the end


def times(speed):
    """When the plates along z begin to close, and the end [s], of plates of this speed [m/s]."""
    start = WAY / speed
    return start, start + STRAIN * SIDE / (2.0 * speed)


def inputs(path, pressure, speed):
    """The course of the plates along z at a pressure [Pa]."""
    force = pressure * SIDE**2
    start, end = times(speed)
    rows = [(0.0, force), (start, force), (start + 1e-4, 1e6), (end, 1e6)]
    lines = [f"{time},{-force},{force}" for time, force in rows]
    path.write_text("\n".join(["time,z_low.target_force.z,z_high.target_force.z", *lines]) + "\n")


def run(options, folder, seed, pressure):
    """One test; gives the rows of its history by their names."""
    folder.mkdir(parents=True, exist_ok=True)
    inputs(folder / "input.csv", pressure, options.speed)
    end = times(options.speed)[1]
    settings = [f"run.seed={seed}", f"run.end={end!r}", f"output.history_interval={1e-6 / options.speed!r}"]
    for axis in "xyz":
        for side, sign in (("low", -1), ("high", 1)):
            servo = f"boundary.{axis}_{side}.motion.servo.{axis}"
            settings += [f"{servo}.target={sign * pressure * SIDE**2!r}", f"{servo}.speed={options.speed!r}"]
    command = [
        options.program,
        "run",
        HERE / "scene.toml",
        "--overwrite",
        "--inputs",
        folder / "input.csv",
        "-o",
        folder / "out",
    ]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run([*map(str, command)], check=True, capture_output=True)
    return history(folder / "out" / "history.csv")


def history(path):
    """The columns of a history by their names."""
    rows = list(csv.reader(path.open()))
    return dict(zip(rows[0], np.array(rows[1:], dtype=float).T, strict=True))


def stresses(columns):
    """Side lengths [m] and principal stresses [Pa] along x, y, z: force over the present area, mean of both plates."""
    sides = [SIDE + columns[f"{a}_high.displacement.{a}"] - columns[f"{a}_low.displacement.{a}"] for a in "xyz"]
    forces = [0.5 * (columns[f"{a}_high.force.{a}"] - columns[f"{a}_low.force.{a}"]) for a in "xyz"]
    volume = sides[0] * sides[1] * sides[2]
    return sides, [force * side / volume for force, side in zip(forces, sides, strict=True)]


def curve(columns, start):
    """Axial strain, stress ratio, volumetric strain and both stresses [Pa] from when the plates begin to close."""
    sides, (x, y, z) = stresses(columns)
    begun = np.searchsorted(columns["time"], start)
    height, volume = sides[2][begun], np.prod([side[begun] for side in sides])
    strain = 1.0 - sides[2][begun:] / height
    lateral = 0.5 * (x + y)[begun:]
    axial = z[begun:]
    swelling = np.prod([side[begun:] for side in sides], axis=0) / volume - 1.0
    return strain, axial / lateral, swelling, axial, lateral


def servo_errors(columns, start, rows, force):
    """Largest r.m.s. and largest error of a lateral plate's force in this many rows from a time on, as shares of the target."""
    begun = np.searchsorted(columns["time"], start) + 1
    sides = [(f"{axis}_{side}.force.{axis}", sign) for axis in "xy" for side, sign in (("low", -1), ("high", 1))]
    errors = [sign * columns[name][begun : begun + rows] / force - 1.0 for name, sign in sides]
    return max(np.sqrt(np.mean(error**2)) for error in errors), max(np.abs(error).max() for error in errors)


def envelope(peaks):
    """Cohesion [Pa] and angle [°] of the line (s₁ − s₃)/2 = c cos φ + (s₁ + s₃)/2 sin φ through the peaks."""
    mean, half = np.array([(a + b, a - b) for a, b in peaks]).T / 2.0
    slope, offset = np.polyfit(mean, half, 1)
    angle = np.arcsin(slope)
    return offset / np.cos(angle), np.degrees(angle)


def picture(path, curves, peaks, line):
    """Stress ratio and volume over strain, and the circles of the peaks."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12, 3.8), layout="constrained")
    pressures = sorted({pressure for pressure, _ in curves})
    for (pressure, seed), (strain, ratio, swelling, *_) in curves.items():
        colour = f"C{pressures.index(pressure)}"
        left.plot(100 * strain, ratio, colour, lw=0.8, label=f"{pressure / 1e3:.0f} kPa" if seed == 1 else None)
        middle.plot(100 * strain, 100 * swelling, colour, lw=0.8)
    left.legend(loc="lower right", frameon=False)
    left.set(xlabel="axial strain [%]", ylabel="axial over lateral stress")
    middle.set(xlabel="axial strain [%]", ylabel="growth of volume [%]")
    turn = np.linspace(0.0, np.pi, 60)
    for axial, lateral in peaks:
        radius = (axial - lateral) / 2e3
        right.plot((axial + lateral) / 2e3 + radius * np.cos(turn), radius * np.sin(turn), "0.6", lw=0.6)
    cohesion, angle = line
    most = max(axial for axial, _ in peaks) / 1e3
    right.plot([0.0, most], [cohesion / 1e3, cohesion / 1e3 + most * np.tan(np.radians(angle))], "C3")
    right.set(xlabel="normal stress [kPa]", ylabel="shear stress [kPa]", aspect="equal")
    figure.savefig(path, dpi=110)


def main():
    """Reads the command line and does it all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="target/release/cograin")
    parser.add_argument("--output", type=Path, default=Path("out/triaxial"))
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--speed", type=float, default=2e-3, help="of the plates, at most [m/s]")
    parser.add_argument("--pressures", type=float, nargs="+", default=[25e3, 50e3, 100e3], help="[Pa]")
    options = parser.parse_args()
    curves, peaks = {}, []
    start = times(options.speed)[0]
    print("pressure [kPa]  seed  peak ratio  peak angle [°]  strain there [%]  r.m.s. and largest error of the servos [%]")
    for pressure in options.pressures:
        for seed in range(1, options.seeds + 1):
            folder = options.output / f"{pressure / 1e3:.0f}_{seed}"
            columns = run(options, folder, seed, pressure)
            found = curve(columns, start)
            strain, ratio, _, axial, lateral = found
            # The mean of five rows: single impacts are no peak.
            smooth = np.convolve(ratio, np.ones(5) / 5.0, "valid")
            top = int(smooth.argmax())
            peaks.append((axial[top : top + 5].mean(), lateral[top : top + 5].mean()))
            angle = np.degrees(np.arcsin((smooth[top] - 1.0) / (smooth[top] + 1.0)))
            mean, most = servo_errors(columns, start, top + 2, pressure * SIDE**2)
            print(
                f"{pressure / 1e3:14.0f}  {seed:4}  {smooth[top]:10.3f}  {angle:14.2f}  "
                f"{100 * strain[top + 2]:16.2f}  {100 * mean:10.2f}  {100 * most:10.2f}"
            )
            curves[pressure, seed] = found
    if len(options.pressures) < 2:
        return  # no line through the peaks of one pressure
    line = envelope(peaks)
    print(f"line through all peaks: cohesion {line[0]:.0f} Pa, angle {line[1]:.2f}°")
    options.output.mkdir(parents=True, exist_ok=True)
    picture(options.output / "triaxial.png", curves, peaks, line)


if __name__ == "__main__":
    main()
