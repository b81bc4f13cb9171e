"""A hull presses down the edge of floating ice until it breaks: drives the unit, holds its forces against theory."""

import argparse
import csv
import subprocess
import time
from pathlib import Path

import numpy as np
from cograin import Program, Unit
from floating import Strip

HERE = Path(__file__).resolve().parent
OUTPUTS = ["hull.force.x", "hull.force.z", "hull.mean_force.x", "hull.mean_force.z", "sea.mean_force.z", "hull.work"]
BOOK = ["energy.kinetic", "energy.residual"]
COLUMNS = ["time", "hull.displacement.x", *OUTPUTS, *BOOK, "bonds.intact", "bonds.broken"]

FRAME_INTERVAL = 0.1  # of the run that leaves frames [s], as in scene.toml


def arguments():
    """What the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--output", type=Path, default=Path("out/ice_beam"), help="folder of all results")
    parser.add_argument("--speed", type=float, default=0.02, help="of the hull [m/s]")
    parser.add_argument("--end", type=float, default=9.0, help="simulated time [s]")
    parser.add_argument("--interval", type=float, default=0.02, help="communication step [s]")
    parser.add_argument("--no-frames", action="store_true", help="leave out the second run, that of the picture")
    return parser.parse_args()


def step(ice, end, interval, displacement):
    """Moves the hull there during a communication step; gives a row of COLUMNS."""
    ice["hull.displacement.x"] = displacement
    ice.step(interval)
    bonds = [ice[name] for name in COLUMNS[-2:]]
    return [end, displacement, *ice.get(OUTPUTS + BOOK), *bonds]


def framed(options):
    """Starts a run of the same course that leaves frames and broken bonds."""
    course = options.output / "course.csv"
    course.write_text(f"time,hull.displacement.x\n{options.end!r},{options.speed * options.end!r}\n")
    command = [options.program, "run", HERE / "scene.toml", "--inputs", course, "-o", options.output / "frames"]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def report(strip, rows):
    """Prints what the run is held against; gives the last row before the first bond breaks."""
    table = np.array(rows)
    advance, vertical, horizontal = table[:, 1], table[:, 5], -table[:, 4]
    whole = table[:, -1] == 0
    peak = int(np.argmin(whole)) - 1
    expected, _, place = strip.breaking()
    print(f"\ncharacteristic length 1/λ {1.0 / strip.wave_number:.2f} m; an endless beam breaks {place:.1f} m from the edge")
    if whole.all() or peak < 0:
        print(f"no bond broke until t = {table[-1, 0]:g} s" if whole.all() else "the edge broke at first touch")
        return None
    print("\nvertical force where the first bond breaks [N]")
    print(f"  measured {vertical[peak]:.0f}, beam theory {expected:.0f}: {vertical[peak] / expected - 1.0:+.1%}")
    print(f"  Croasdale's 0.68 σ b (ρ g h⁵/E)^¼, which leaves out the horizontal force: {strip.croasdale():.0f}")
    print(f"  horizontal over vertical {horizontal[peak] / vertical[peak]:.4f}, of a sliding hull {strip.push:.4f}")

    part = (vertical > 0.3 * vertical[peak]) & (np.arange(len(table)) <= peak)
    slope = np.polyfit(advance[part], vertical[part], 1)[0]
    stiffness = 1.0 / strip.advance(1.0, strip.push)
    print("vertical force for each metre of the hull's way, from 0.3 of the peak on [N/m]")
    print(f"  measured {slope:.0f}, beam theory {stiffness:.0f}: {slope / stiffness - 1.0:+.1%}")

    stress, _ = strip.worst(vertical[peak], horizontal[peak])
    print("flexural strength, from the peak by the beam formula [Pa]")
    print(f"  {stress:.4g}; bonds {strip.bond_strength:.4g}: ratio {stress / strip.bond_strength:.4f}, ", end="")
    print(f"of the lattice {strip.strength_ratio:.4f}")

    residual, work = np.abs(table[:, 9]).max(), table[-1, 7]
    print(f"books: work of the hull {work:.3f} J, largest residual of the energy book {residual:.1e} J")
    return peak


def cracks(folder, strip):
    """When and where bonds along the strip broke first [s, m], in the order of time; places are columns of spheres."""
    spacing, found = strip.thickness / strip.layers, {}
    columns = round(strip.length / spacing) + 1
    for row in csv.DictReader((folder / "breakage.csv").open()):
        one, two = ((int(row[name]) - 1) % columns for name in ("id1", "id2"))
        if one != two:
            found.setdefault((0.5 * (one + two) + 0.5) * spacing, float(row["time"]))
    return [(when, place) for place, when in found.items()]


def main():
    options = arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    began, strip = time.monotonic(), Strip()
    frames = None if options.no_frames else framed(options)
    path = options.output / "ice_beam.fmu"
    ice, rows = Unit(Program(options.program).export(HERE / "scene.toml", path)), []
    for count in range(1, round(options.end / options.interval) + 1):
        end = count * options.interval
        rows.append(step(ice, end, options.interval, options.speed * end))
        if count % 50 == 0:
            print(f"t = {end:.2f} s: {rows[-1][5]:8.0f} N down on the edge, {rows[-1][-1]} bonds broken", flush=True)
    ice.close()
    with open(options.output / "couple.csv", "w", newline="") as text:
        csv.writer(text).writerows([COLUMNS, *rows])
    peak = report(strip, rows)
    if frames is not None and frames.wait() == 0 and peak is not None:
        from picture import draw

        found = cracks(options.output / "frames", strip)
        print("cracks: " + ", ".join(f"{place:.1f} m at {when:.4f} s" for when, place in found))
        draw(options.output, strip, np.array(rows), peak, FRAME_INTERVAL, found)
    print(f"\n{options.output / 'couple.csv'} written; {time.monotonic() - began:.0f} s in all")


if __name__ == "__main__":
    main()
