"""The skin is a membrane of springs between the nodes of its mesh; its rim is held."""

import numpy as np
from cograin import Interface, Program, QuasiNewton, Structure, Unit, couple

MASS, TENSION = 2e-3, 400.0  # of a node [kg], of a spring between neighbours [N/m]

program = Program()
program.settle("scene.toml", "settled.checkpoint")
program.export("scene.toml", "plate.fmu", start="settled.checkpoint")
with Unit("plate.fmu") as bed:
    skin = bed.nodes("skin")
    places, count = skin.places, len(skin)
    joined = np.zeros((count, count), dtype=bool)
    for begin, end in ((0, 1), (1, 2), (2, 0)):  # the edges of its triangles
        joined[skin.triangles[:, begin], skin.triangles[:, end]] = True
    joined |= joined.T
    stiffness = TENSION * (np.diag(joined.sum(axis=1)) - joined)
    rim = (places[:, :2] <= places[:, :2].min(axis=0) + 1e-9) | (places[:, :2] >= places[:, :2].max(axis=0) - 1e-9)
    fixed = np.flatnonzero(rim.any(axis=1))
    membrane = Structure(np.full(count, MASS), stiffness, 0.02 * stiffness, fixed=fixed)
    lifts = [name for name in skin.names("displacement") if name.endswith(".z")]
    record = couple(Interface(bed, lifts), membrane, QuasiNewton(reuse=8), step=1e-3, end=0.1)
    print(record.summary)
    print(f"the middle sags by {-1e3 * skin.displacement[:, 2].min():.3f} mm")
record.save("coupled.csv")
