//! Directional derivatives: differences of two steps from the same state, against the slopes of an earlier arithmetic and against
//! central differences by hand.

use cograin::interface::{Derivatives, Interface, Value};
use cograin::lanes::Width;
use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use cograin::state::State;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A scene with its files.
fn scene(text: &str, files: &[(&str, &str)]) -> Arc<Scene> {
    let files = files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec()));
    let source = Source { name: "scene.toml".into(), text: text.into(), files: files.collect::<BTreeMap<_, _>>() };
    Arc::new(Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}")))
}

/// A scene at time 0.
fn start(text: &str) -> Simulation {
    Simulation::new(scene(text, &[])).unwrap_or_else(|error| panic!("{error}"))
}

/// The boundary of this name.
fn named(simulation: &Simulation, name: &str) -> BoundaryIndex {
    let place = simulation.scene().boundaries.iter().position(|boundary| boundary.name == name);
    BoundaryIndex(place.expect("the scene has it") as u32)
}

/// Makes a communication step.
fn advance(simulation: &mut Simulation, length: f64) {
    simulation.advance_or_roll_back(length).unwrap_or_else(|error| panic!("{error}"));
}

/// Outputs of a boundary in which the derivatives of each kind stand side by side: forces, then moments.
fn loads(names: &[&str]) -> [Vec<String>; 2] {
    let of = |kinds: [&str; 2]| {
        let each = names.iter().flat_map(|name| kinds.map(|kind| format!("{name}.{kind}")));
        each.flat_map(|name| ["x", "y", "z"].map(|axis| format!("{name}.{axis}"))).collect()
    };
    [of(["force", "mean_force"]), of(["moment", "mean_moment"])]
}

/// Indices of variables.
fn indices(interface: &Interface, names: &[String]) -> Vec<usize> {
    names.iter().map(|name| interface.find(name).unwrap_or_else(|| panic!("{name} is not there"))).collect()
}

/// Derivatives of outputs by an input.
fn ask(simulation: &mut Simulation, outputs: &[String], input: &str) -> Vec<f64> {
    let interface = Interface::of(simulation.scene());
    let (outputs, input) = (indices(&interface, outputs), indices(&interface, &[input.to_owned()])[0]);
    interface
        .derivatives(simulation, &mut Derivatives::default(), (&outputs, &[(input, 1.0)]))
        .unwrap_or_else(|refusal| panic!("{refusal}"))
}

/// Largest distance of two rows of numbers over the largest of the second.
fn away(found: &[f64], expected: &[f64]) -> f64 {
    let most = expected.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    let apart = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs());
    let apart = apart.fold(0.0, |most: f64, part| if part > most || part.is_nan() { part } else { most });
    // What nothing moves has no derivative.
    if most == 0.0 && apart == 0.0 { 0.0 } else { apart / most }
}

/// Values of outputs.
fn read(simulation: &Simulation, outputs: &[String]) -> Vec<f64> {
    let interface = Interface::of(simulation.scene());
    indices(&interface, outputs).iter().map(|&index| interface.value(simulation, index).number()).collect()
}

/// Largest distance of the derivatives of outputs of one kind by an input from a central difference by hand: of a step of this length
/// \[s\], over the largest of them. Asking leaves the state as it is, to the bit.
fn distance(simulation: &mut Simulation, outputs: &[Vec<String>], input: &str, (length, change): (f64, f64)) -> f64 {
    let interface = Interface::of(simulation.scene());
    let index = indices(&interface, &[input.to_owned()])[0];
    let begin = simulation.state().clone();
    let given = interface.value(simulation, index).number();
    let mut at = |value: f64| {
        simulation.restore(&begin).unwrap_or_else(|fault| panic!("{fault}"));
        interface.set(simulation, index, Value::Real(value)).unwrap_or_else(|refusal| panic!("{refusal}"));
        advance(simulation, length);
        outputs.iter().map(|names| read(simulation, names)).collect::<Vec<_>>()
    };
    let (there, back) = (at(given + change), at(given - change));
    at(given);
    let before = simulation.state().clone();
    let mut most = 0.0_f64;
    for (names, (there, back)) in outputs.iter().zip(there.iter().zip(&back)) {
        let expected: Vec<f64> = there.iter().zip(back).map(|(there, back)| (there - back) / (2.0 * change)).collect();
        assert!(expected.iter().any(|part| *part != 0.0), "{input} changes none of {names:?}");
        let found = ask(simulation, names, input);
        assert!(before == *simulation.state(), "asking for {input} changed the state");
        most = most.max(away(&found, &expected));
    }
    most
}

/// Spheres between six planes of which the lid is driven, under a contact law.
fn box_of_spheres(law: &str, more: &str) -> String {
    let plane = |name: &str, point: [f64; 3], normal: [f64; 3], rest: &str| {
        format!("[boundary.{name}]\nmaterial = \"a\"\nplane = {{ point = {point:?}, normal = {normal:?} }}\n{rest}\n")
    };
    let walls = [
        plane("x_low", [0.0; 3], [1.0, 0.0, 0.0], ""),
        plane("x_high", [0.03122, 0.0, 0.0], [-1.0, 0.0, 0.0], ""),
        plane("y_low", [0.0; 3], [0.0, 1.0, 0.0], ""),
        plane("y_high", [0.0, 0.03121, 0.0], [0.0, -1.0, 0.0], ""),
        plane("floor", [0.0; 3], [0.0, 0.0, 1.0], ""),
        plane("lid", [0.0, 0.0, 0.0312], [0.0, 0.0, -1.0], "motion = { driven = [\"x\", \"z\"] }"),
    ]
    .concat();
    format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-6
threads = 1
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.4
rolling_friction = 0.1
rolling_viscous_damping = 0.3
cohesion_energy_density = 3.0e3
fluid_viscosity = 1.0e-3
critical_stokes_number = 10.0
maximum_restitution = 0.9
surface_energy = 0.05
damping_coefficient = 1.0e4
tangential_damping_ratio = 0.5
unloading_stiffness_ratio = 3.0
pull_off_force = 1.0e-3
STIFFNESS
{law}
[particles.bed]
material = "a"
lattice = {{ kind = "face_centred_cubic", origin = [0.005, 0.005, 0.005], counts = [2, 2, 2], spacing = 1.0e-2, radius = 5.01e-3 }}
{walls}
{more}
"#
    )
}

/// The box with the numbers that a normal model takes for stiffness and damping.
fn with_law(law: &str, more: &str) -> String {
    let (stiffness, damping) = if law.contains("hertz_stiffness") { ("1.0e7", "1.0e5") } else { ("5.0e3", "0.1") };
    let numbers = format!(
        "normal_stiffness = {stiffness}\ntangential_stiffness = {stiffness}\nnormal_damping = {damping}\n\
         tangential_damping = {damping}"
    );
    box_of_spheres(law, more).replace("STIFFNESS", &numbers)
}

/// A loaded, sheared box: the lid comes down, then goes aside.
fn loaded_by(text: &str) -> Simulation {
    let mut simulation = start(text);
    let lid = named(&simulation, "lid");
    for number in 1..=20 {
        simulation.set_input(lid, 2, -1.0e-4 * f64::from(number.min(10)) / 10.0);
        simulation.set_input(lid, 0, 3.0e-4 * f64::from((number - 5).max(0)) / 15.0);
        simulation.advance(2.0e-4).unwrap_or_else(|error| panic!("{error}"));
    }
    simulation
}

/// A block of bonded spheres between a glued floor and a driven grip.
const BONDED: &str = r#"
[run]
step = 2.0e-7
threads = 1
[material.ice]
youngs_modulus = 1.0e9
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.block]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [4, 3, 4], spacing = 2.02e-3, radius = 1.0e-3 }
[boundary.floor]
plane = { point = [0.0, 0.0, -1.0e-3], normal = [0.0, 0.0, 1.0] }
material = "ice"
[boundary.grip]
particles = { set = "block", box = [[-1.0, -1.0, 5.5e-3], [1.0, 1.0, 1.0]] }
motion = { driven = ["x", "z"] }
[bond.block]
LAW
between = ["block", "block"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[bond.block.breakage]
max_normal_stress = 4.0e8
max_shear_stress = 4.0e8
[bond.glue]
LAW
between = ["block", "floor"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
"#;

/// Dashpots of a bond law.
const DASHPOTS: &str =
    "damping.viscous = { normal_force = 0.1, tangential_force = 0.1, normal_torque = 0.1, tangential_torque = 0.1 }";

/// Pulls and shears a block.
fn pull(simulation: &mut Simulation) {
    let grip = named(simulation, "grip");
    for number in 1..=10 {
        simulation.set_input(grip, 2, 1.0e-6 * f64::from(number));
        simulation.set_input(grip, 0, 2.0e-6 * f64::from(number));
        simulation.advance(1.0e-5).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// Force, moment, mean force and mean moment of two boundaries by two inputs of the first.
type Recorded = [[[f64; 3]; 8]; 2];

/// Of grip and floor of a bonded block by `grip.displacement.x` and `.z`, as commit 3c39812 found by numbers with slopes.
#[rustfmt::skip]
const BLOCK: Recorded = [
    [
        [-1516333.648222877, 0.0, -20109.14520075565],
        [5.684341886080802e-14, 6411.065160920539, 1.2505552149377763e-12],
        [-1599886.0263286065, 0.0, -7574.048467177346],
        [-9.1532337265221e-15, 4694.165622393355, 1.4966872186050743e-12],
        [2407312.8852821197, 0.0, 15990.882827384252],
        [32.30158331131645, 5418.402219746005, -4862.772028269883],
        [224110.0850230244, 0.0, 10010.421031573356],
        [20.22105048377816, 2095.0800922313624, -452.70237174650936],
    ],
    [
        [-20498.568332838797, 0.0, -10321237.013694601],
        [-1.0459189070388675e-11, -5.274972903726393, 1.7319479184152442e-14],
        [-7591.848385212896, 0.0, -5084404.023912534],
        [-4.9760728870751316e-12, -7.177837917917982, 7.522316103347748e-15],
        [12174.85748685229, 0.0, 8862559.532058807],
        [17902.370254758793, -26872.832414829943, -24.59321212344162],
        [10921.551425358068, 0.0, 4769121.025897009],
        [9633.624472311954, -14459.301051276503, -22.061533879223305],
    ],
];

/// Of lid and floor of a bed without friction.
#[rustfmt::skip]
const BED: Recorded = [
    [
        [0.0, 0.0, 0.0],
        [0.0, 0.09216174511113415, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.040648340180849396, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
    ],
    [
        [0.0, 0.0, -52051.11232311064],
        [-738.3548394838697, 881.3992218723473, 0.0],
        [0.0, 0.0, -42857.240427510544],
        [-617.6070669745211, 719.6752644855669, 0.0],
        [0.0, 0.0, 0.034043343926658864],
        [0.0005301043103086985, -0.0005334812197026023, 0.0],
        [0.0, 0.0, 0.00634441389315441],
        [9.8818560930488e-5, -9.937972658818853e-5, 0.0],
    ],
];

/// Of lid and floor of a bed with friction and rolling friction.
#[rustfmt::skip]
const FRICTION: Recorded = [
    [
        [-36308.94504681258, -110.74824804097375, 73.37314637555644],
        [1.2712117971531331, 4.738047534979895, 576.4787503852147],
        [-33437.76689451767, -49.13875323587142, 22.921855077757854],
        [0.3955695659722012, 2.329133944854647, 534.1862114164226],
        [0.16241354432953292, 0.007513082805766834, 0.059308317563520736],
        [0.0005033637404058581, -0.0012833501101293125, -0.002540966434540003],
        [0.03169188732160792, 0.0015321761377970458, 0.011226541429248955],
        [9.538133995585698e-5, -0.00024439354162835185, -0.0004941160672264987],
    ],
    [
        [22209.743028501653, -53.069108816137714, -98318.94129725327],
        [-1544.9105026895681, 1444.396709266706, -346.3936475445141],
        [18621.667544792064, -73.74756537583679, -84887.73202253948],
        [-1333.352812811647, 1249.9540445942473, -290.3951242846396],
        [-0.19314929990139657, 0.004120224973096921, 0.6548627142788908],
        [0.010249046609476105, -0.010499695087515385, 0.0029093549535559675],
        [-0.037361572366766155, 0.0006564462771953126, 0.12395431199977953],
        [0.0019410372056608187, -0.001986062459402324, 0.0005623961572009159],
    ],
];

/// Largest distances of what is found from what was recorded.
fn from_recorded(mut simulation: Simulation, names: [&str; 2], recorded: &Recorded, length: f64) -> f64 {
    advance(&mut simulation, length);
    let before = simulation.state().clone();
    let mut most = 0.0_f64;
    for (input, rows) in ["x", "z"].iter().zip(recorded) {
        let input = format!("{}.displacement.{input}", names[0]);
        let of = |places: [usize; 4]| places.iter().flat_map(|&place| rows[place]).collect::<Vec<f64>>();
        for (outputs, places) in loads(&names).iter().zip([[0, 2, 4, 6], [1, 3, 5, 7]]) {
            let (found, expected) = (ask(&mut simulation, outputs, &input), of(places));
            most = most.max(away(&found, &expected));
        }
    }
    assert!(before == *simulation.state(), "asking changed the state");
    most
}

/// The scenes of the record.
fn recorded(run: &str) -> [f64; 3] {
    let with = |text: &str| text.replace("[run]", &format!("[run]\n{run}"));
    let block = {
        let law = format!("formulation = \"finite_rotation\"\n{DASHPOTS}");
        let mut simulation = start(&with(&BONDED.replace("LAW", &law)));
        pull(&mut simulation);
        simulation
    };
    let bed = loaded_by(&with(&with_law("[contact.touch.normal.hertz]", "")));
    let friction = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[contact.touch.rolling.epsd]";
    let friction = loaded_by(&with(&with_law(friction, "")));
    [
        from_recorded(block, ["grip", "floor"], &BLOCK, 1.0e-5),
        from_recorded(bed, ["lid", "floor"], &BED, 1.0e-4),
        from_recorded(friction, ["lid", "floor"], &FRICTION, 1.0e-4),
    ]
}

#[test]
fn differences_are_the_slopes_that_were_carried_through_the_steps() {
    let found = recorded("");
    assert!(found.iter().all(|it| *it < 1e-6), "{found:?}");
    let found = recorded("central_derivatives = true");
    assert!(found.iter().all(|it| *it < 1e-7), "central: {found:?}");
}

/// A scene whose inputs have gone to these values little by little.
fn led(scene: &Arc<Scene>, inputs: &[(&str, f64)], length: f64) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(scene)).unwrap_or_else(|error| panic!("{error}"));
    let interface = Interface::of(scene);
    for number in 1..=20 {
        for (name, value) in inputs {
            let input = indices(&interface, &[(*name).to_owned()])[0];
            let value = Value::Real(value * f64::from(number.min(10)) / 10.0);
            interface.set(&mut simulation, input, value).unwrap_or_else(|refusal| panic!("{refusal}"));
        }
        advance(&mut simulation, length);
    }
    simulation
}

/// The lid as a mesh of two triangles.
const SHEET: &str =
    "v -0.01 -0.01 0.0312\nv 0.05 -0.01 0.0312\nv 0.05 0.05 0.0312\nv -0.01 0.05 0.0312\nf 1 3 2\nf 1 4 3\n";

/// The box under a lid of this shape and motion.
fn under_lid(shape: &str) -> Arc<Scene> {
    let law = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]";
    let text = with_law(law, "").replace("[run]", "[run]\nmax_overlap = 0.5");
    let plane = "plane = { point = [0.0, 0.0, 0.0312], normal = [0.0, 0.0, -1.0] }";
    let changed =
        text.replace(&format!("{plane}\nmotion = {{ driven = [\"x\", \"z\"] }}"), &shape.replace("PLANE", plane));
    assert!(changed != text, "the lid is there");
    scene(&changed, &[("lid.obj", SHEET)])
}

/// A lid: its name, its lines in the scene, where its inputs stand, the one that is displaced, and how far.
type Case<'a> = (&'a str, &'a str, &'a [(&'a str, f64)], &'a str, f64);

#[test]
fn lids_of_every_kind_have_the_derivatives_of_their_differences() {
    let mesh = "mesh = { file = \"lid.obj\", sides = 2 }\nmotion = { driven = [\"z\"] }";
    let nodes = "mesh = { file = \"lid.obj\", sides = 2 }\nnodes = \"driven\"";
    let corners = [1, 2, 3, 4].map(|node| format!("lid.node[{node}].displacement.z"));
    let corners: Vec<(&str, f64)> = corners.iter().map(|name| (name.as_str(), -1.0e-4)).collect();
    let down = [("lid.displacement.z", -1.0e-4)];
    let tilted = [("lid.displacement.z", -1.0e-4), ("lid.rotation.y", 1.0e-3)];
    let heavy = "PLANE\nmass = 1.0e-3\nstiffness = { z = 300.0 }\ndamping = { z = 0.5 }\nmotion = { loaded = [\"z\"] }";
    let cases: [Case; 7] = [
        ("mesh", mesh, &down, "lid.displacement.z", 1.0e-10),
        ("nodes", nodes, &corners, "lid.node[2].displacement.z", 1.0e-10),
        ("turning plane", "PLANE\nmotion = { driven = [\"z\", \"rotation.y\"] }", &tilted, "lid.rotation.y", 1.0e-8),
        (
            "velocity",
            "PLANE\nmotion = { driven = [\"z\"], by = \"velocity\" }",
            &[("lid.velocity.z", -0.01)],
            "lid.velocity.z",
            1.0e-6,
        ),
        ("loaded", heavy, &[("lid.applied_force.z", -2.0)], "lid.applied_force.z", 1.0e-5),
        (
            "light",
            "PLANE\nmass = 1.0e-5\nmotion = { loaded = [\"z\"] }",
            &[("lid.applied_force.z", -2.0)],
            "lid.applied_force.z",
            1.0e-5,
        ),
        (
            "servo",
            "PLANE\nmotion = { servo = { z = { speed = 0.5 } } }",
            &[("lid.target_force.z", 2.0)],
            "lid.target_force.z",
            1.0e-5,
        ),
    ];
    let mut wrong = Vec::new();
    for (name, shape, inputs, input, change) in cases {
        let mut simulation = led(&under_lid(shape), inputs, 2.0e-4);
        let found = distance(&mut simulation, &loads(&["lid", "floor"]), input, (1.0e-4, change));
        if found.is_nan() || found > 1e-6 {
            wrong.push(format!("{name}: {found:e}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn groups_that_inputs_turn_or_forces_move_have_the_derivatives_of_their_differences() {
    let mut wrong = Vec::new();
    for (motion, inputs, input, change) in [
        (
            "{ driven = [\"x\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }",
            ["grip.displacement.x", "grip.rotation.y"],
            "grip.rotation.x",
            1.0e-6,
        ),
        ("{ driven = [\"x\", \"rotation.y\"] }", ["grip.displacement.x", "grip.rotation.y"], "grip.rotation.y", 1.0e-6),
        (
            "{ driven = [\"x\"], free = [\"z\", \"rotation.y\"] }",
            ["grip.displacement.x"; 2],
            "grip.displacement.x",
            1.0e-9,
        ),
        (
            "{ loaded = [\"x\", \"rotation.y\"] }",
            ["grip.applied_force.x", "grip.applied_moment.y"],
            "grip.applied_moment.y",
            1.0e-4,
        ),
    ] {
        // Without contacts, of which some would open or close.
        let text = BONDED.replace("LAW", "").replace("{ driven = [\"x\", \"z\"] }", motion);
        let text = text.replace("[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n", "");
        let mut simulation = led(&scene(&text, &[]), &inputs.map(|name| (name, 1.0e-5)), 1.0e-5);
        let found = distance(&mut simulation, &loads(&["grip", "floor"]), input, (1.0e-5, change));
        if found.is_nan() || found > 1e-6 {
            wrong.push(format!("{motion}: {found:e}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn energies_have_derivatives_and_a_direction_is_one_difference() {
    let central = |text: &str| text.replace("[run]", "[run]\ncentral_derivatives = true");
    let mut simulation = loaded_by(&central(&with_law("[contact.touch.normal.hertz]", "")));
    advance(&mut simulation, 1.0e-4);
    let energies = [vec!["energy.kinetic".to_owned(), "lid.work".to_owned()]];
    let found = distance(&mut simulation, &energies, "lid.displacement.z", (1.0e-4, 1.0e-9));
    assert!(found < 2e-6, "{found:e}");

    let interface = Interface::of(simulation.scene());
    let outputs = indices(&interface, &loads(&["lid", "floor"])[0]);
    let [x, z] = ["x", "z"].map(|axis| indices(&interface, &[format!("lid.displacement.{axis}")])[0]);
    let mut along = |direction: &[(usize, f64)]| {
        let mut known = Derivatives::default();
        let mut ask = || interface.derivatives(&mut simulation, &mut known, (&outputs, direction)).unwrap();
        let found = ask();
        assert_eq!(ask(), found, "what is known is told again");
        found
    };
    let parts = [along(&[(x, 1.0)]), along(&[(z, 1.0)])];
    let expected: Vec<f64> = parts[0].iter().zip(&parts[1]).map(|(x, z)| 0.5 * x - 2.0 * z).collect();
    let found = along(&[(x, 0.5), (z, -2.0)]);
    assert!(away(&found, &expected) < 2e-6, "{:e}", away(&found, &expected));
    assert_eq!(along(&[(x, 1.0), (z, -4.0)]), found.iter().map(|part| 2.0 * part).collect::<Vec<_>>());
    assert_eq!(along(&[(x, 0.0), (z, 0.0)]), vec![0.0; outputs.len()]);
}

#[test]
fn differences_are_the_same_in_every_lane_width_and_on_every_number_of_threads() {
    let law = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]";
    let of = |threads: usize, width: Width| {
        let text = with_law(law, "").replace("threads = 1", &format!("threads = {threads}"));
        let mut simulation = start(&text);
        simulation.set_width(width);
        let lid = named(&simulation, "lid");
        for number in 1..=4 {
            simulation.set_input(lid, 2, -2.0e-5 * f64::from(number));
            advance(&mut simulation, 1.0e-4);
        }
        ask(&mut simulation, &loads(&["lid", "floor"])[0], "lid.displacement.z")
    };
    let whole = of(1, Width::Least);
    assert!(whole.iter().any(|part| *part != 0.0), "nothing changes");
    for width in Width::ALL.into_iter().filter(|width| width.offered()) {
        assert_eq!(of(1, width), whole, "{width:?}");
    }
    assert_eq!(of(2, Width::widest()), whole);
}

#[test]
fn the_rate_of_a_pressed_spring_is_stiffness_times_velocity_and_0_before_the_first_step() {
    let mut simulation = start(&with_law("[contact.touch.normal.hooke_stiffness]", ""));
    let interface = Interface::of(simulation.scene());
    let rates = |simulation: &Simulation| {
        ["lid.force.z", "lid.mean_force.z"].map(|name| {
            let index = indices(&interface, &[name.to_owned()])[0];
            interface.rate(simulation, index).unwrap_or_else(|refusal| panic!("{refusal}"))
        })
    };
    assert_eq!(rates(&simulation), [0.0; 2]);
    let lid = named(&simulation, "lid");
    simulation.set_input(lid, 2, -1.0e-6);
    simulation.advance(4.0e-6).unwrap_or_else(|error| panic!("{error}"));
    // Eight spheres of 5 kN/m under the lid, at 0.25 m/s; they have hardly begun to move themselves.
    let (found, expected) = (rates(&simulation), 8.0 * 5.0e3 * 0.25);
    assert!(found.iter().all(|rate| (rate / expected - 1.0).abs() < 2e-3), "{found:?} N/s, not {expected} N/s");
    let saved = State::from_bytes(&simulation.state().to_bytes(0), 0).unwrap_or_else(|fault| panic!("{fault}"));
    simulation.restore(&saved).unwrap_or_else(|fault| panic!("{fault}"));
    assert_eq!(rates(&simulation), found, "a state keeps the rates");
}

/// A held sphere that presses on another one, in a domain that ends a little further on, with a displacement of 1 mm.
const NARROW: &str = r#"
[run]
step = 1.0e-6
max_overlap = 0.5
derivative_displacement = 1.0e7
[material.a]
density = 2500.0
[pair.a.a]
normal_stiffness = 5.0e3
normal_damping = 0.0
[contact.touch.normal.hooke_stiffness]
[particles.two]
material = "a"
list = [{ position = [0.0, 0.0, 0.0], radius = 5.0e-3 }, { position = [-9.9e-3, 0.0, 0.0], radius = 5.0e-3 }]
[boundary.held]
particles = { set = "two", box = [[-1.0e-3, -1.0, -1.0], [1.0, 1.0, 1.0]] }
motion = { driven = ["x", "y"] }
[boundary.post]
particles = { set = "two", box = [[-1.0, -1.0, -1.0], [-1.0e-3, 1.0, 1.0]] }
[domain]
box = [[-0.1, -5.0e-4, -0.1], [5.0e-4, 5.0e-4, 0.1]]
"#;

#[test]
fn a_displaced_step_that_fails_gives_way_to_the_other_side_and_where_both_fail_nothing_changes() {
    for run in ["", "central_derivatives = true\nderivative_displacement = 1.0e6"] {
        let text = match run {
            "" => NARROW.to_owned(),
            _ => NARROW.replace("derivative_displacement = 1.0e7", run),
        };
        let mut simulation = start(&text);
        advance(&mut simulation, 1.0e-4);
        let force = ["held.force.x".to_owned()];
        // The spring gives way: its force falls as the sphere goes away from the post.
        let found = ask(&mut simulation, &force, "held.displacement.x")[0];
        assert!((found / -5.0e3 - 1.0).abs() < 1e-6, "{found} N/m");
        let before = simulation.state().clone();
        let interface = Interface::of(simulation.scene());
        let [output, input] = ["held.force.x", "held.displacement.y"].map(|name| interface.find(name).unwrap());
        let refused = interface
            .derivatives(&mut simulation, &mut Derivatives::default(), (&[output], &[(input, 1.0)]))
            .expect_err("it leaves the domain on either side")
            .to_string();
        assert!(refused.contains("ends early on either side") && refused.contains("particle 1"), "{refused}");
        assert!(before == *simulation.state(), "the state is another one");
        advance(&mut simulation, 1.0e-4);
        assert!(ask(&mut simulation, &force, "held.displacement.x")[0] < 0.0);
    }
}

#[test]
fn questions_that_have_no_answer_are_refused() {
    let mut simulation = start(&with_law("[contact.touch.normal.hertz]", ""));
    let interface = Interface::of(simulation.scene());
    let mut refused = |output: &str, input: &str, share: f64| {
        let [output, input] = [output, input].map(|name| interface.find(name).expect("it is there"));
        interface
            .derivatives(&mut simulation, &mut Derivatives::default(), (&[output], &[(input, share)]))
            .expect_err("it has no answer")
            .to_string()
    };
    assert!(refused("lid.force.z", "lid.displacement.z", 1.0).contains("found none since"));
    assert!(refused("contacts.count", "lid.displacement.z", 1.0).contains("an output that changes continuously"));
    assert!(refused("lid.displacement.z", "lid.displacement.z", 1.0).contains("an output that changes continuously"));
    assert!(refused("lid.force.z", "lid.force.x", 1.0).contains("expected an input"));
    assert!(refused("lid.force.z", "lid.displacement.z", f64::NAN).contains("NaN"));
    let rate = interface.rate(&simulation, interface.find("contacts.count").expect("it is there"));
    assert!(rate.expect_err("a count has no rate").to_string().contains("contacts.count"));
}

/// Spheres that fall on a plate.
const RAIN: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-5
[material.a]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.3
[pair.a.a]
restitution = 0.5
friction = 0.4
[contact.all.normal.hertz]
[contact.all.tangential.history]
[boundary.floor]
material = "a"
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
motion = { driven = ["x", "z"] }
[region.cloud]
box = [[-0.01, -0.01, 0.005], [0.01, 0.01, 0.03]]
[insertion.feed]
region = "cloud"
material = "a"
sizes = { uniform = [0.001, 0.002] }
count_rate = 4000.0
velocity = [0.0, 0.0, -1.0]
scatter = 0.1
"#;

#[test]
fn who_asks_while_particles_come_goes_the_same_way_as_who_does_not() {
    let (mut asked, mut plain) = (start(RAIN), start(RAIN));
    let outputs = loads(&["floor"])[0].clone();
    for _ in 0..40 {
        advance(&mut asked, 5.0e-4);
        advance(&mut plain, 5.0e-4);
        let found = ask(&mut asked, &outputs, "floor.displacement.z");
        assert!(found.iter().all(|part| part.is_finite()));
        assert!(ask(&mut asked, &outputs, "feed.rate").iter().all(|part| part.is_finite()));
        assert!(asked.state() == plain.state());
    }
    assert!(asked.state().particles.len() > 50, "they came");
    let pressed = ask(&mut asked, &outputs, "floor.displacement.z");
    assert!(pressed.iter().any(|part| *part != 0.0), "they press on the floor");
}

/// A held sphere on a driven floor, and one beside it that overlaps by this [m].
fn beside(overlap: f64) -> Simulation {
    start(&format!(
        r#"
[run]
step = 1.0e-6
[material.glass]
youngs_modulus = 1.0e8
poissons_ratio = 0.3
density = 2500.0
[pair.glass.glass]
restitution = 1.0
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.two]
material = "glass"
list = [{{ position = [0.0, 0.0, 0.00999], radius = 0.01 }}, {{ position = [0.1, 0.0, {height:?}], radius = 0.01 }}]
[boundary.held]
particles = {{ set = "two", box = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]] }}
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "glass"
motion = {{ driven = ["x"] }}
[output]
near_switch = true
"#,
        height = 0.01 - overlap
    ))
}

#[test]
fn contacts_that_are_about_to_touch_or_to_slide_are_near_a_switch() {
    // A sphere sticks up to the way µ Fₙ/kₜ = µ δ (2 − ν)/(3 (1 − ν)) of the floor.
    let sticks = 0.5 * 1.0e-5 * 1.7 / (3.0 * 0.7);
    for (overlap, way, expected) in [
        (1.0e-5, 0.9 * sticks, 0),
        (1.0e-5, (1.0 - 2.0e-5) * sticks, 2),
        (1.0e-10, 0.0, 1),
        (-1.0e-10, 0.0, 1),
        (-1.0e-7, 0.0, 0),
    ] {
        let mut simulation = beside(overlap);
        let floor = named(&simulation, "floor");
        simulation.set_input(floor, 0, way);
        simulation.advance(1.0e-5).unwrap();
        simulation.advance(1.0e-5).unwrap();
        assert_eq!(simulation.contacts_near_switch(), expected, "overlap {overlap}, way {way}");
        let interface = Interface::of(simulation.scene());
        let output = interface.find("contacts.near_switch").expect("the scene asks for it");
        assert_eq!(interface.value(&simulation, output), Value::Integer(i32::try_from(expected).unwrap()));
    }
}
