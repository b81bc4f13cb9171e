"""Pictures of a run: ``python -m cograin.plot OUT``.

``OUT`` is the folder of ``cograin run``, or the CSV file of a coupled run's record. Each function here gives a figure
of matplotlib, so that a script can change and save it:

    from cograin.plot import history, packing
    from cograin.results import Run
    run = Run("out")
    packing(run.frames[-1], by="velocity").savefig("packing.png")
    history(run.history, ["lid.force.z"], over="lid.displacement.z").savefig("force.svg")

Colours are told apart with any colour vision, and in print by their lightness or the kind of line.
"""

from cograin.plot.command import draw, main
from cograin.plot.facets import facets
from cograin.plot.sections import section
from cograin.plot.space import animation, cracks, force_chains, packing
from cograin.plot.tables import energy, history

__all__ = ["animation", "cracks", "draw", "energy", "facets", "force_chains", "history", "main", "packing", "section"]
