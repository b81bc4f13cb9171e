"""What a run is held against: the mass balance, Beverloo's law, and what the controller's thresholds, gate and fall imply."""

import math

import numpy as np

GRAVITY, GRAIN, BULK = 9.81, 4e-3, 1450.0  # [m/s²], diameter of a grain [m], density of a bed at rest [kg/m³]
MOUTH, HOLE = 0.026, 0.02  # diameters of the mouth of the hopper and of the hole of the bin [m], as in scene.toml
DROP = 0.1 - 0.055  # from the mouth to where the mass counts as in the bin [m]


def beverloo(diameter):
    """Mass flow through an orifice after Beverloo, with C = 0.58 and k = 1.4 [kg/s]."""
    return 0.58 * BULK * math.sqrt(GRAVITY) * (diameter - 1.4 * GRAIN) ** 2.5


def fall(flow):
    """Time that grains take from the mouth to the bin, when so much flows [s]."""
    speed = flow / (BULK * 0.25 * math.pi * MOUTH**2)
    return (math.sqrt(speed**2 + 2.0 * GRAVITY * DROP) - speed) / GRAVITY


def bounds(options, stroke, inflow, outflow):
    """Where the mass in the bin turns: least and largest maximum, least and largest minimum [kg]."""
    falling, moving = fall(inflow), stroke / options.speed + options.interval
    highest = [options.high + (inflow - outflow) * time for time in (falling, falling + moving)]
    lowest = [options.low - outflow * time for time in (falling + moving, falling)]
    return highest, lowest


def period(turning, inflow, outflow):
    """Least and largest time from one maximum to the next, by these turning points [s]."""
    (least, most), (deep, shallow) = turning
    each = 1.0 / (inflow - outflow) + 1.0 / outflow
    return (least - shallow) * each, (most - deep) * each


def turns(rows):
    """Maxima and minima of the mass in the bin, as times [s] and masses [kg], after each change of the controller's mind."""
    changes = np.flatnonzero(np.diff(rows["wanted"])) + 1
    highest, lowest = [], []
    for begin, end in zip(changes[1:], changes[2:], strict=False):
        mass = rows["bin_filling.mass"][begin:end]
        shut = rows["wanted"][begin] == 0.0
        place = begin + int(mass.argmax() if shut else mass.argmin())
        (highest if shut else lowest).append((rows["time"][place], rows["bin_filling.mass"][place]))
    return np.array(highest).reshape(-1, 2), np.array(lowest).reshape(-1, 2)


def flows(rows):
    """Mean mass flows: out of the hopper while the gate is open, out of the bin while it is filled [kg/s]."""
    opened = rows["gate"][1:] > 0.999 * rows["gate"].max()
    filled = rows["bin_filling.mass"][1:] > 0.05
    length = np.diff(rows["time"])
    found = []
    for name, when in (("below_the_gate.mass", opened & filled), ("drain.mass", filled)):
        found.append(float(np.diff(rows[name])[when].sum() / max(length[when].sum(), 1e-300)))
    return found


def report(rows, options, stroke):
    """Prints the comparisons of the page; gives the bounds of the turning points [kg]."""
    start = rows["everything.mass"][0]
    left = rows["everything.mass"] - start - rows["feed.mass"] + rows["drain.mass"] + rows["spilt.mass"]
    print(
        f"mass: {start:.4f} kg at first + {rows['feed.mass'][-1]:.4f} fed in = {rows['everything.mass'][-1]:.4f} there",
        end="",
    )
    print(
        f" + {rows['drain.mass'][-1]:.4f} run out + {rows['spilt.mass'][-1]:.4f} spilt; largest error {np.abs(left).max():.1e} kg"
    )
    inflow, outflow = flows(rows)
    law = beverloo(MOUTH), beverloo(HOLE)
    print(f"hopper, gate open {inflow:.4f} kg/s, Beverloo {law[0]:.4f}; bin {outflow:.4f} kg/s, Beverloo {law[1]:.4f}")
    turning = bounds(options, stroke, *law)
    highest, lowest = turns(rows)
    for found, (low, high), name in zip((highest, lowest), turning, ("maxima", "minima"), strict=True):
        said = ", ".join(f"{1e3 * mass:.1f}" for mass in found[:, 1])
        print(
            f"{name} of the mass in the bin {said} g; {1e3 * low:.1f} to {1e3 * high:.1f} g by thresholds, gate and fall"
        )
    if len(highest) > 1:
        low, high = period(turning, *law)
        said = ", ".join(f"{time:.3f}" for time in np.diff(highest[:, 0]))
        print(f"from maximum to maximum {said} s; {low:.3f} to {high:.3f} s")
    return turning
