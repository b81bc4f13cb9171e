"""Error and interface energy against processor time, a column for each problem."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
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
ROUNDING = 1e-17  # where an interface energy of nothing is drawn


def draw(path, columns, table):
    """Writes the picture as PNG."""
    rows = [dict(zip(columns, one, strict=True)) for one in table if not one[-1]]
    rows = [one for one in rows if one["exchange"] in COLOURS]
    problems = list(dict.fromkeys(one["problem"] for one in rows))
    figure, axes = plt.subplots(
        2, len(problems), figsize=(4.2 * len(problems), 7.6), squeeze=False, layout="constrained"
    )
    for column, problem in enumerate(problems):
        chosen = [one for one in rows if one["problem"] == problem]
        for line, key in enumerate(("error", "interface")):
            panel(axes[line, column], chosen, key)
        axes[0, column].set_title(problem)
        axes[1, column].set_xlabel("processor time [s]")
    axes[0, 0].set_ylabel("error against the closed form")
    axes[1, 0].set_ylabel("interface energy over exchanged work")
    handles, labels = {}, []
    for each in axes.flat:
        for handle, label in zip(*each.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    labels = list(handles)
    figure.legend([handles[label] for label in labels], labels, loc="outside lower center", ncols=5, frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def panel(axes, rows, key):
    """One quantity of one problem; a line joins the steps of one program and exchange."""
    for program, name in dict.fromkeys((one["program"], one["exchange"]) for one in rows):
        line = [one for one in rows if (one["program"], one["exchange"]) == (program, name)]
        style = {"color": COLOURS[name], "marker": MARKS[program], "linestyle": "-" if program == "cograin" else ":"}
        label = name if program == "cograin" else f"{program}, {name}"
        values = [max(abs(one[key]), ROUNDING) for one in line]
        axes.plot([one["processor"] for one in line], values, label=label, markersize=4, linewidth=1.2, **style)
    axes.set_xscale("log")
    axes.set_yscale("log")
    # Enough marks where the times span less than a power of ten, and none that run into one another.
    axes.xaxis.set_major_locator(FixedLocator([mark * 10.0**power for power in range(-4, 4) for mark in (1, 2, 5)]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda time, _: f"{time:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
