"""Three element tests of the same sand: isotropic and triaxial compression, simple shear at constant volume."""

from cograin import Program, Unit

PRESSURE, STEP = 5e4, 1e-3  # [Pa], [s]
SIDE = "{ stress = -5e4, max_rate = 5.0 }"
MOTIONS = {
    "isotropic": f"{{ servo = {{ xx = {SIDE}, yy = {SIDE}, zz = {SIDE} }} }}",
    "triaxial": f'{{ driven = ["zz"], servo = {{ xx = {SIDE}, yy = {SIDE} }} }}',
    "simple_shear": '{ shear = "xz" }',
}

program = Program()
program.settle("scene.toml", "sand.checkpoint")
for name, motion in MOTIONS.items():
    start = ("--from", "sand.checkpoint", "--set", f"cell.motion={motion}")
    program("export", "scene.toml", *start, "-o", f"{name}.fmu", "--overwrite")


def stress(unit, component):
    """A stress, pressure positive [kPa]; the mean of the last step."""
    return -unit[f"cell.mean_stress.{component}"] / 1e3


def volume(unit):
    """The logarithm of the volume over that of the scene."""
    return sum(unit[f"cell.strain.{name}"] for name in ("xx", "yy", "zz"))


with Unit("isotropic.fmu") as sand:
    print("isotropic: pressure [kPa],volumetric strain,contacts of a grain")
    begin = volume(sand)
    for step in range(1, 41):
        for name in ("xx", "yy", "zz"):
            sand[f"cell.target_stress.{name}"] = -PRESSURE * (1.0 + 0.1 * step)
        sand.step(STEP)
        if step % 10 == 0:
            pressure = sum(stress(sand, name) for name in ("xx", "yy", "zz")) / 3.0
            print(f"{pressure:.1f},{volume(sand) - begin:.5f},{sand['cell.coordination']:.2f}")

with Unit("triaxial.fmu") as sand:
    print("triaxial: axial strain,axial stress over lateral,volumetric strain")
    begin, axial = volume(sand), sand["cell.strain.zz"]
    for step in range(1, 101):
        sand["cell.strain.zz"] = axial - 1e-3 * step
        sand.step(STEP)
        if step % 10 == 0:
            ratio = 2.0 * stress(sand, "zz") / (stress(sand, "xx") + stress(sand, "yy"))
            print(f"{1e-3 * step:.3f},{ratio:.3f},{volume(sand) - begin:.5f}")

with Unit("simple_shear.fmu") as sand:
    print("simple shear: shear,shear stress [kPa],normal stress [kPa],their ratio")
    for step in range(1, 101):
        sand["cell.shear"] = 2e-3 * step
        sand.step(STEP)
        if step % 10 == 0:
            normal, shear = stress(sand, "zz"), -stress(sand, "xz")
            print(f"{2e-3 * step:.3f},{shear:.2f},{normal:.2f},{shear / normal:.3f}")
