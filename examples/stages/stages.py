"""What lid and bottom feel at the end of each stage."""

import csv

AREA = 0.02 * 0.02

for stage in ("1_prepare", "2_consolidate", "3_shear", "4_unload"):
    with open(f"{stage}/history.csv") as file:
        last = list(csv.DictReader(file))[-1]
    pressure, normal, shear = (
        float(last[name]) / AREA / 1e3 for name in ("lid.force.z", "bottom.force.z", "bottom.force.x")
    )
    time = float(last["time"])
    print(f"{stage:14} t = {time:.2f} s  lid {pressure:7.2f} kPa, bottom {-normal:7.2f} kPa, shear {-shear:6.2f} kPa")
