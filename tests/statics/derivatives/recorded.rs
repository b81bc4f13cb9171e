//! Derivatives beside slopes that an earlier program carried through its steps.

use super::scenes::{BONDED, DASHPOTS, advance, ask, away, loaded_by, loads, pull, start, with_law};
use cograin::simulation::Simulation;

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
