"""The grains as a participant of preCICE: settles and exports the bed of models/plate, then follows the plate."""

import argparse
import csv
from pathlib import Path

from cograin import Program, Unit
from cograin.precice import Surface, participate

HERE = Path(__file__).resolve().parent


def export(program, folder):
    """The settled bed on the coarse skin as a unit."""
    scene, settled = HERE.parent / "plate" / "scene.toml", folder / "settled.checkpoint"
    program.settle(scene, settled)
    return program.export(scene, folder / "grains.fmu", start=settled)


def run(participant, path):
    """Takes part until the end; a row for each time window, and where the skin stands at last."""
    with Unit(path) as unit:
        table = participate(
            participant, [Surface(unit, "skin", "Grains-Mesh")], watch=["skin.mean_force.z", "skin.work"]
        )
        return table, unit.nodes("skin").displacement


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="cograin", help="the cograin command")
    parser.add_argument("--config", default=HERE / "precice-config.xml", help="configuration of preCICE")
    parser.add_argument("--output", type=Path, default=Path("out/precice_plate"), help="folder of all results")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    path = export(Program(options.program), options.output)
    import precice

    table, _ = run(precice.Participant("Grains", str(options.config), 0, 1), path)
    with open(options.output / "grains.csv", "w", newline="") as text:
        csv.writer(text).writerows([list(table), *zip(*table.values(), strict=True)])


if __name__ == "__main__":
    main()
