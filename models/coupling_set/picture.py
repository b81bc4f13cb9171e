"""Error and interface energy against processor time, a column for each problem."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

COLOURS = {
    "Gauss–Seidel": "#b5482a",
    "Jacobi": "#c9a66b",
    "Verlet": "#2a7f4f",
    "fixed point": "#999999",
    "Aitken": "#8e44ad",
    "secant": "#1b6ca8",
    "secant, two at most": "#7fb3d5",
    "quasi-Newton": "#111111",
    "quadratic": "#e0218a",
    "Newton, differences": "#d17fa6",
    "CoSimulation, weak": "#6b4c2a",  # its strong ones fail, and are not drawn
}
MARKS = {"cograin": "o", "lammps": "s", "liggghts": "^", "yade": "v", "kratos": "D"}
TITLES = {"lammps": "LAMMPS", "liggghts": "LIGGGHTS", "yade": "YADE", "kratos": "Kratos"}
WIDE = 70.0  # ratio of the longest time to the shortest from which only powers of ten are marked
ROUNDING = 1e-17  # where an interface energy of nothing is drawn


def draw(path, columns, table):
    """Writes the picture as PNG."""
    rows = [dict(zip(columns, one, strict=True)) for one in table if not one[-1]]
    rows = [one for one in rows if one["exchange"] in COLOURS]
    problems = list(dict.fromkeys(one["problem"] for one in rows))
    figure, axes = plt.subplots(
        2, len(problems), figsize=(3.5 * len(problems), 7.2), squeeze=False, layout="constrained"
    )
    for column, problem in enumerate(problems):
        chosen = [one for one in rows if one["problem"] == problem]
        for line, key in enumerate(("error", "interface")):
            panel(axes[line, column], chosen, key)
        axes[0, column].set_title(problem)
        axes[1, column].set_xlabel("processor time [s]")
    axes[0, 0].set_ylabel("error against the closed form")
    axes[1, 0].set_ylabel("interface energy over exchanged work")
    figure.legend(handles=legend(rows), loc="outside lower center", ncols=6, frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def legend(rows):
    """A line for each exchange, and a mark for each program."""
    names = dict.fromkeys(one["exchange"] for one in rows)
    lines = [Line2D([], [], color=COLOURS[name], label=name) for name in COLOURS if name in names]
    programs = dict.fromkeys(one["program"] for one in rows)
    marks = [Line2D([], [], label=TITLES.get(program, program), **style(program, "black")) for program in programs]
    return [*lines, *marks]


def style(program, colour):
    """Full marks on lines for our own program, open ones on dots for the others."""
    own = program == "cograin"
    shape = {"color": colour, "marker": MARKS[program], "markersize": 4 if own else 6}
    return shape | {"linestyle": "-" if own else ":", "markerfacecolor": colour if own else "none", "linewidth": 1.2}


def panel(axes, rows, key):
    """One quantity of one problem; a line joins the steps of one program and exchange."""
    for program, name in dict.fromkeys((one["program"], one["exchange"]) for one in rows):
        line = [one for one in rows if (one["program"], one["exchange"]) == (program, name)]
        values = [max(abs(one[key]), ROUNDING) for one in line]
        axes.plot([one["processor"] for one in line], values, **style(program, COLOURS[name]))
    axes.set_xscale("log")
    axes.set_yscale("log")
    # Enough marks where the times span less than a power of ten, and none that run into one another.
    times = [one["processor"] for one in rows]
    marks = (1, 2, 5) if max(times) < WIDE * min(times) else (1,)
    axes.xaxis.set_major_locator(FixedLocator([mark * 10.0**power for power in range(-4, 4) for mark in marks]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda time, _: f"{time:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
