"""The published bulk processes in small: a ball into a bed, a silo, a drum, each within what its seeds scatter."""

import sys

import pytest
from conftest import ROOT

from cograin import Program

for name in ("impact", "silo", "drum"):
    sys.path.insert(0, str(ROOT / "models" / f"bulk_{name}"))

import drum  # noqa: E402
import impact  # noqa: E402
import silo  # noqa: E402


@pytest.fixture(scope="module")
def program(request):
    """The command."""
    return Program(ROOT / request.config.getoption("--program"))


def scene_of(model):
    """The scene of a model."""
    return ROOT / "models" / f"bulk_{model}" / "scene.toml"


SOFT = {"material.m1.youngs_modulus": 1e8, "material.steel.youngs_modulus": 1e8}
SHORT = {"run.seed": 1, "run.threads": 1, "run.safety": 0.8}


def small_impact(program, folder, seed):
    """Height of a ball of 8 mm that hits 2,000 grains at 1 m/s, 14 ms after it is some 1 mm above them [m]."""
    side, top = 0.02, -0.071
    given = SHORT | SOFT | {"run.seed": seed, "particles.ball.list.1.radius": 0.004}
    given |= {
        "particles.grains.packing.box": [[-side, -side, -0.0902431], [side, side, top]],
        "particles.grains.packing.count": 2000,
    }
    for wall, point in {
        "left": [-side, 0.0, 0.0],
        "right": [side, 0.0, 0.0],
        "front": [0.0, -side, 0.0],
        "back": [0.0, side, 0.0],
    }.items():
        given[f"boundary.{wall}.plane.point"] = point
    without = {key: value for key, value in given.items() if "ball" not in key}
    start = impact.bed(program, scene_of("impact"), folder, without, soft=1e7, fall=0.13)
    _, height, *_ = impact.drop(program, start, folder / "run", given, end=0.014, ball=(-0.0745, 1.0))
    return height[-1]


def small_silo(program, folder, seed, orifice):
    """Grains per second through an orifice of this radius [m] out of a silo of 60 mm."""
    cone = 0.03 - orifice
    foot = cone - 0.0554222
    given = SHORT | {"run.seed": seed, "material.m1.youngs_modulus": 1e7, "material.steel.youngs_modulus": 1e7}
    given |= {
        "boundary.wall.revolution.profile": [[orifice, 0.0], [0.03, cone], [0.03, 0.37]],
        "boundary.lid.disc.radius": 0.014,
    }
    given |= {
        "particles.grains.packing.cylinder.from": [0.0, 0.0, foot],
        "particles.grains.packing.cylinder.to": [0.0, 0.0, foot + 0.05],
    }
    given |= {"particles.grains.packing.cylinder.radius": 0.03, "particles.grains.packing.solid_fraction": 0.5}
    start = silo.filled(program, scene_of("silo"), folder, given, stages=(None,))
    time, out = silo.emptied(program, scene_of("silo"), folder / "run", start, given, 0.3)
    return silo.rate(time, out, 0.1)


def small_drum(program, folder, seed):
    """Grains of both kinds in the quarter of a drum of 60 mm, each tenth of a second."""
    given = SHORT | {"run.seed": seed, "material.m1.youngs_modulus": 1e7, "material.m2.youngs_modulus": 5e6}
    given |= {"material.steel.youngs_modulus": 1e7, "boundary.drum.cylinder.radius": 0.03}
    given |= {"boundary.drum.cylinder.from": [0.0, -0.006, 0.0], "boundary.drum.cylinder.to": [0.0, 0.006, 0.0]}
    given |= {"particles.large.packing.box": [[-0.025, -0.006, -0.0155], [0.025, 0.006, 0.0]]}
    given |= {"particles.large.packing.solid_fraction": 0.435}
    given |= {
        "particles.small.packing.box": [[-0.025, -0.006, 0.0], [0.025, 0.006, 0.0155]],
        "particles.small.packing.count": 450,
    }
    start = drum.filled(program, scene_of("drum"), folder, given, stages=(1.0,))
    _, small, large = drum.turned(program, scene_of("drum"), folder / "run", start, given, 0.6)
    return small, large


def test_a_bed_stops_a_ball(program, tmp_path):
    height = small_impact(program, tmp_path, 1)
    # Seeds 1 to 4: -83.02, -82.82, -82.83, -82.56 mm; it would have fallen to -89.46 mm.
    assert -83.5e-3 < height < -82.1e-3, f"{1e3 * height:.2f} mm"


def test_a_silo_runs_out_with_the_power_of_beverloo(program, tmp_path):
    narrow, wide = (small_silo(program, tmp_path / str(orifice), 1, orifice) for orifice in (0.009, 0.012))
    # Beverloo: (D - 1.4 d)^2.5. Some hundred grains fall in the time, of two packings.
    expected = ((6.0 - 1.4) / (4.5 - 1.4)) ** 2.5
    assert abs(wide / narrow / expected - 1.0) < 0.2, f"{wide:.0f} and {narrow:.0f} grains per second"


def test_a_drum_carries_grains_around(program, tmp_path):
    small, large = small_drum(program, tmp_path, 1)
    # Seeds 1 to 4: 163, 175, 167, 171 and 255, 277, 285, 291 of 450 small ones; 10, 6, 6, 7 of 120 large ones. The scatter of the
    # second is 16, and the bounds lie 2.5 of it about the mean.
    assert 145 < small[3] < 195 and 237 < small[6] < 317 and 4 < large[6] < 14, f"{small}, {large}"
