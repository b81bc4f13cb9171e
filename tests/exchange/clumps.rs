//! Clumps that come and go: counted, booked, at their rates, and the same bits whoever works on them and wherever a run is taken up.

use crate::exchange::{MANY, begun};
use crate::support::{read, scene};
use cograin::lanes::Width;
use cograin::scene::Scene;
use cograin::simulation::{Description, Simulation};
use cograin::state::{Exchange, State};
use std::sync::Arc;

/// Two shapes of clumps.
const SHAPES: &str = r#"
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.002 }, { position = [0.003, 0.0, 0.0], radius = 0.002 }]
[clump.bent]
spheres = [
    { position = [0.0, 0.0, 0.0], radius = 0.002 },
    { position = [0.003, 0.0, 0.0], radius = 0.002 },
    { position = [0.003, 0.003, 0.0], radius = 0.0015 },
]
"#;

/// A feed of clumps and one of spheres that fall through a hole in a floor, with friction and rolling, both books kept.
fn falling(more: &str) -> String {
    format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
end = 0.3
step = 2.5e-5
seed = 7
[material.glass]
density = 2500.0
youngs_modulus = 1e6
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.6
friction = 0.4
rolling_friction = 0.1
[contact.all.normal.hertz]
[contact.all.tangential.history]
[contact.all.rolling.epsd2]
{SHAPES}
[boundary.floor]
disc = {{ centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = 0.04, hole = 0.015 }}
material = "glass"
[boundary.wall]
cylinder = {{ from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.1], radius = 0.03 }}
material = "glass"
[region.mouth]
cylinder = {{ from = [0.0, 0.0, 0.05], to = [0.0, 0.0, 0.08], radius = 0.025 }}
[region.bin]
box = [[-0.05, -0.05, -0.05], [0.05, 0.05, -0.02]]
[insertion.feed]
region = "mouth"
material = "glass"
sizes = {{ clump = ["pair", "bent"], by_number = [2, 1], uniform = [0.003, 0.0045] }}
count_rate = 1000.0
velocity = [0.0, 0.0, -0.3]
scatter = 0.1
[insertion.sand]
region = "mouth"
material = "glass"
sizes = {{ radius = 0.002 }}
count_rate = 500.0
velocity = [0.0, 0.0, -0.3]
[outlet.bottom]
region = "bin"
[flow_meter.hole]
polygon = [[0.02, 0.02, -0.01], [0.02, -0.02, -0.01], [-0.02, -0.02, -0.01], [-0.02, 0.02, -0.01]]
[output]
energy = true
losses = true
{more}
"#
    )
}

/// What is known of what comes and goes.
fn exchange(simulation: &Simulation) -> &Exchange {
    simulation.state().exchange.as_ref().unwrap()
}

/// Mass of all there is \[kg\], and momentum along z \[N s\].
fn there(simulation: &Simulation) -> [f64; 2] {
    let state = simulation.state();
    let loose = (0..state.particles.len()).filter(|&slot| state.particles.owner[slot] == 0);
    let rows = loose.map(|slot| state.particles.velocity[slot]).chain(state.clumps.velocity.iter().copied());
    rows.fold([0.0, 0.0], |[mass, momentum], row| [mass + row[3], momentum + row[3] * row[2]])
}

#[test]
fn clumps_and_spheres_that_come_and_go_are_counted_apart_and_booked() {
    let scene = scene(&falling(""));
    let mut simulation = begun(&scene, Width::widest());
    for _ in 0..25 {
        simulation.advance(0.01).unwrap();
        simulation.check(&simulation.state().clone()).unwrap();
    }
    let (state, known) = (simulation.state(), exchange(&simulation));
    let ([feed, sand], outlet) = ([known.feeds[0], known.feeds[1]], known.outlets[0]);
    // The rate is met: nothing that was due found no room.
    assert_eq!(feed.dropped, 0.0);
    assert!((feed.came.clumps as f64 - 250.0).abs() <= 2.0 && outlet.clumps > 20, "{feed:?} {outlet:?}");
    assert!(feed.came.count > 2 * feed.came.clumps && feed.came.count < 3 * feed.came.clumps, "{feed:?}");
    assert_eq!(sand.came.clumps, 0);
    assert_eq!(state.clumps.len() as u64, feed.came.clumps - outlet.clumps);
    assert_eq!(state.particles.len() as u64, feed.came.count + sand.came.count - outlet.count);
    let [mass, _] = there(&simulation);
    let came = feed.came.mass + sand.came.mass;
    assert!((mass - (came - outlet.mass)).abs() < 1e-12 * came, "{mass} kg there, {came} came, {outlet:?}");
    assert!((known.net.mass - mass).abs() < 1e-12 * came);
    let passed = known.meters[0];
    assert!(passed.clumps[0] >= outlet.clumps && passed.counts[0] >= outlet.count, "{passed:?}");
    let ledger = state.ledger.as_ref().unwrap();
    let residual = simulation.energy_residual().unwrap() / (ledger.turnover + known.net.turnover);
    assert!(residual.abs() < 1e-12, "{residual:e}");
    let physical = simulation.physical_residual().unwrap() / (ledger.turnover + known.net.turnover);
    assert!(physical.abs() < 2e-3, "{physical:e}");
    // Numbers of spheres and of clumps are used once.
    let mut numbers: Vec<u32> = state.particles.id.iter().map(|&index| simulation.number(index)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), state.particles.len());
    assert_eq!(u64::from(known.next_clump), feed.came.clumps);
    assert!(state.particles.slot.len() < (feed.came.count + sand.came.count) as usize, "places are taken again");
}

#[test]
fn the_bits_are_the_same_for_lanes_threads_and_wherever_a_run_is_taken_up() {
    let at = |threads: usize, width| {
        let scene = scene(&falling(MANY).replace("seed = 7", &format!("seed = 7\nthreads = {threads}")));
        let mut simulation = begun(&scene, width);
        let mut told = Vec::new();
        for _ in 0..8 {
            simulation.advance(0.02).unwrap();
            told.push(simulation.state().fingerprint());
        }
        assert!(exchange(&simulation).outlets[0].clumps > 3, "{:?}", exchange(&simulation).outlets);
        told
    };
    let right = at(1, Width::widest());
    assert_eq!(at(1, Width::Least), right);
    assert_eq!(at(3, Width::Four), right);
    let scene = scene(&falling(MANY));
    let mut simulation = begun(&scene, Width::widest());
    for place in 0..6 {
        simulation.advance(0.02).unwrap();
        let read = State::from_bytes(&simulation.state().to_bytes(1), 1).unwrap();
        let mut resumed = Simulation::resume(Arc::clone(&scene), read).unwrap();
        resumed.advance(0.02).unwrap();
        assert_eq!(resumed.state().fingerprint(), right[place + 1], "resumed after {} s", simulation.time());
    }
}

/// Clumps without contacts that fall freely through a domain which takes away what leaves it.
fn free(sizes: &str, amount: &str, more: &str) -> Arc<Scene> {
    scene(&format!(
        r#"
gravity = [0.0, 0.0, -10.0]
[run]
end = 1.0
step = 1e-4
[material.glass]
density = 2500.0
{SHAPES}
[region.mouth]
box = [[0.0, 0.0, 0.9], [1.0, 1.0, 1.0]]
[insertion.feed]
region = "mouth"
material = "glass"
sizes = {sizes}
{amount}
[domain]
box = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]
outside = "remove"
[output]
energy = true
{more}
"#
    ))
}

#[test]
fn what_falls_freely_is_there_as_long_as_the_fall_takes_and_goes_as_a_whole() {
    let scene = free("{ clump = \"bent\" }", "count_rate = 1000.0", "");
    let mut simulation = begun(&scene, Width::widest());
    simulation.advance(1.5).unwrap();
    let known = exchange(&simulation);
    assert!((known.feeds[0].came.clumps as f64 - 1500.0).abs() <= 6.0, "{:?}", known.feeds[0]);
    // A fall over 0.95 m takes 0.436 s in the mean; a domain is looked at after each half of a radius.
    let clumps = simulation.state().clumps.len() as u64;
    assert!((clumps as f64 / 1000.0 - 0.436).abs() < 0.01, "{clumps}");
    assert_eq!(known.outside.clumps, known.feeds[0].came.clumps - clumps);
    assert_eq!(known.outside.count, 3 * known.outside.clumps);
    assert_eq!(simulation.state().particles.len() as u64, 3 * clumps);
    let turnover = simulation.state().ledger.as_ref().unwrap().turnover;
    let residual = simulation.energy_residual().unwrap();
    assert!(residual.abs() < 1e-12 * turnover, "{residual:e} J of {turnover:e} J");
    let ([mass, momentum], net) = (there(&simulation), known.net);
    let weight = -10.0 * (mass * simulation.time() - net.mass_time);
    let rest = momentum - net.momentum[2] - weight;
    assert!(rest.abs() < 1e-12 * weight.abs(), "{rest:e} N s of {weight:e} N s");
}

#[test]
fn a_mass_comes_with_the_shares_and_scales_that_are_asked_for_turned_in_all_ways() {
    let sizes = "{ clump = [\"pair\", \"bent\"], by_mass = [1.0, 3.0], uniform = [0.004, 0.008] }";
    let scene = free(sizes, "mass = 8.0", "");
    let mut simulation = begun(&scene, Width::widest());
    simulation.advance(1e-3).unwrap();
    let (clumps, came) = (&simulation.state().clumps, exchange(&simulation).feeds[0].came);
    assert!(came.mass > 7.99 && came.mass <= 8.0, "{came:?}");
    let of = |shape: u32| (0..clumps.len()).filter(move |&clump| clumps.shape[clump] == shape);
    let mass = |shape: u32| of(shape).map(|clump| clumps.velocity[clump][3]).sum::<f64>();
    assert!((mass(0) / 8.0 - 0.25).abs() < 0.02, "{} kg of 8 kg are pairs", mass(0));
    for (shape, table) in (0..).zip(&scene.clump_shapes) {
        let radii = of(shape).map(|clump| clumps.scale[clump] * table.bounding_radius());
        let (sum, count) = radii.clone().fold((0.0, 0.0), |(sum, count), radius| (sum + radius, count + 1.0));
        assert!(radii.clone().all(|radius| radius > 0.004 - 1e-12 && radius < 0.008 + 1e-12));
        // The mean of so many, whose deviation is 0.004/√12.
        assert!((sum / count - 0.006).abs() < 4.0 * 0.00116 / f64::sqrt(count), "{} m", sum / count);
    }
    // Along each axis of all directions alike the mean square is 1/3, with a deviation of √(4/45).
    let count = clumps.len() as f64;
    let square = |axis: usize| {
        let along =
            |[w, x, y, z]: [f64; 4]| [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)];
        clumps.orientation.iter().map(|row| along(*row)[axis].powi(2)).sum::<f64>() / count
    };
    for axis in 0..3 {
        assert!((square(axis) - 1.0 / 3.0).abs() < 4.0 * 0.298 / count.sqrt(), "{} along {axis}", square(axis));
    }
    // No sphere of one overlaps one of another.
    let particles = &simulation.state().particles;
    let mut rows: Vec<_> = particles.position.iter().zip(&particles.owner).collect();
    rows.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    for (place, (one, owner)) in rows.iter().enumerate() {
        let near = rows[place + 1..].iter().take_while(|(other, _)| other[0] - one[0] < 0.016);
        for (other, _) in near.filter(|(_, other)| other != owner) {
            let apart = (0..3).map(|axis| (one[axis] - other[axis]).powi(2)).sum::<f64>().sqrt();
            assert!(apart >= one[3] + other[3], "{one:?} {other:?}");
        }
    }
}

#[test]
fn given_scales_and_orientations_are_those_of_what_comes() {
    let sizes = "{ clump = \"pair\", radius = 0.007 }";
    let scene = free(sizes, "count_rate = 100.0", "");
    let text = r#"orientation = [1.0, 0.0, 1.0, 0.0]"#;
    let turned = free(sizes, &format!("count_rate = 100.0\n{text}"), "");
    for (scene, is_given) in [(scene, false), (turned, true)] {
        let mut simulation = begun(&scene, Width::widest());
        simulation.advance(0.1).unwrap();
        let state = simulation.state();
        assert!(state.clumps.len() > 8);
        for clump in 0..state.clumps.len() {
            // Half the distance of the centres and the radius make 0.0035 m.
            assert!((state.clumps.scale[clump] - 2.0).abs() < 1e-14);
            let [a, b] = [0, 1].map(|place| {
                let sphere = state.clumps.spheres_of(clump)[place] as usize;
                state.particles.position[state.particles.slot[sphere] as usize]
            });
            let way = [0, 1, 2].map(|axis| (b[axis] - a[axis]) / 0.006);
            // A quarter turn about y takes x to −z.
            let along = (way[0].abs() + way[1].abs() < 1e-9) && (way[2] + 1.0).abs() < 1e-9;
            assert_eq!(along, is_given, "{way:?}");
        }
    }
}

#[test]
fn a_clump_goes_when_its_mass_centre_is_beyond_and_not_before() {
    let begin = |more: &str| {
        let text = format!(
            r#"
[run]
step = 1e-4
[material.a]
density = 1000.0
[clump.pair]
spheres = [{{ position = [0.0, 0.0, 0.0], radius = 0.1 }}, {{ position = [1.0, 0.0, 0.0], radius = 0.1 }}]
[particles.p]
material = "a"
clump = "pair"
list = [
    {{ position = [1.0, 0.0, 0.0], velocity = [-1.0, 0.0, 0.0], angular_velocity = [0.0, 2.0, 0.0] }},
    {{ position = [5.0, 0.0, 0.0] }},
]
[particles.q]
material = "a"
list = [{{ position = [8.0, 0.0, 0.0], radius = 0.1 }}]
{more}
[output]
energy = true
"#
        );
        begun(&scene(&text), Width::widest())
    };
    let outlet = "[outlet.west]\nbeyond = { point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }";
    let domain = "[domain]\nbox = [[0.0, -9.0, -9.0], [9.0, 9.0, 9.0]]\noutside = \"remove\"";
    for more in [outlet, domain] {
        let mut simulation = begin(more);
        let before = simulation.kinetic_energy();
        simulation.advance(0.95).unwrap();
        assert_eq!(simulation.state().clumps.len(), 2, "one sphere is beyond, the mass centre is not");
        // What moves by half of the smallest radius is looked at: 0.05 m.
        simulation.advance(0.15).unwrap();
        let state = simulation.state();
        assert_eq!((state.clumps.len(), state.particles.len()), (1, 3));
        assert_eq!(state.clumps.number, [1]);
        let owners: Vec<u32> = state.particles.slots().map(|slot| state.particles.owner[slot]).collect();
        assert_eq!(owners, [1, 1, 0], "the other clump is the first now");
        let known = exchange(&simulation);
        let told = if more == outlet { known.outlets[0] } else { known.outside };
        let mass = 2.0 * 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-3;
        assert!((told.clumps, told.count) == (1, 2) && (told.mass / mass - 1.0).abs() < 1e-13, "{told:?}");
        assert!((known.net.kinetic / -before - 1.0).abs() < 1e-12, "{} J went", known.net.kinetic);
        assert!((known.net.momentum[0] / mass - 1.0).abs() < 1e-12, "{:?} N s", known.net.momentum);
        let residual = simulation.energy_residual().unwrap();
        assert!(residual.abs() < 1e-12 * before, "{residual:e} J");
        simulation.advance(0.5).unwrap();
        simulation.check(&simulation.state().clone()).unwrap();
    }
}

#[test]
fn a_boundary_takes_a_whole_clump_away_when_a_sphere_has_come_through() {
    let text = falling("")
        .replace(", hole = 0.015", "")
        .replace("material = \"glass\"\n[boundary.wall]", "material = \"glass\"\noutside = \"remove\"\n[boundary.wall]")
        .replace("youngs_modulus = 1e6", "youngs_modulus = 3e3");
    let mut simulation = begun(&scene(&text), Width::widest());
    simulation.advance(0.15).unwrap();
    let (state, known) = (simulation.state(), exchange(&simulation));
    let passed = known.passed[0];
    assert!(passed.clumps > 3 && passed.count > 2 * passed.clumps, "{passed:?}");
    assert_eq!(state.clumps.len() as u64, known.feeds[0].came.clumps - passed.clumps);
    let turnover = state.ledger.as_ref().unwrap().turnover + known.net.turnover;
    let residual = simulation.energy_residual().unwrap() / turnover;
    assert!(residual.abs() < 1e-12, "{residual:e}");
}

#[test]
fn a_flow_meter_counts_a_clump_once_as_its_mass_centre_passes() {
    let meter =
        "[flow_meter.middle]\npolygon = [[-1.0, -1.0, 0.5], [-1.0, 2.0, 0.5], [2.0, 2.0, 0.5], [2.0, -1.0, 0.5]]";
    let mut simulation = begun(&free("{ clump = \"bent\" }", "mass = 0.05", meter), Width::widest());
    simulation.advance(0.4).unwrap();
    let (known, came) = (exchange(&simulation).meters[0], exchange(&simulation).feeds[0].came);
    assert!(came.clumps > 20, "{came:?}");
    assert_eq!((known.clumps, known.counts), ([came.clumps, 0], [came.count, 0]), "{known:?}");
    assert!((known.mass / came.mass - 1.0).abs() < 1e-12, "{known:?} {came:?}");
}

#[test]
fn clumps_that_came_in_one_scene_go_on_in_the_next() {
    let stage = |closed: bool| {
        let text =
            falling("").replace("count_rate = 1000.0", "mass = 0.02").replace("count_rate = 500.0", "mass = 1e-3");
        scene(&if closed { text.replace(", hole = 0.015", "") } else { text })
    };
    let (fill, open) = (stage(true), stage(false));
    let mut filled = begun(&fill, Width::widest());
    filled.advance(0.1).unwrap();
    assert!(filled.state().clumps.len() > 30);
    let from = Description::of(&fill, "fill.toml", filled.time());
    let (mut opened, left) = Simulation::taken_over(Arc::clone(&open), filled.state(), &from).unwrap();
    assert_eq!(left, Vec::<String>::new());
    assert_eq!(opened.state().clumps.number, filled.state().clumps.number);
    let (same, _) = Simulation::taken_over(Arc::clone(&fill), filled.state(), &from).unwrap();
    assert_eq!(same.contact_count(), filled.contact_count());
    assert!((opened.kinetic_energy() / filled.kinetic_energy() - 1.0).abs() < 1e-12);
    opened.check(&opened.state().clone()).unwrap();
    opened.advance(0.3).unwrap();
    assert!(exchange(&opened).outlets[0].clumps > 10, "{:?}", exchange(&opened).outlets);
    let from = Description::of(&open, "open.toml", opened.time());
    let (third, _) = Simulation::taken_over(Arc::clone(&open), opened.state(), &from).unwrap();
    assert_eq!(third.state().clumps.number, opened.state().clumps.number);
    assert_eq!(exchange(&third).next_clump, exchange(&opened).next_clump);
}

#[test]
fn clumps_that_cannot_have_come_are_refused() {
    let scene = scene(&falling(""));
    let mut simulation = begun(&scene, Width::widest());
    simulation.advance(0.05).unwrap();
    let right = simulation.state().clone();
    simulation.check(&right).unwrap();
    let refused = |change: fn(&mut State)| {
        let mut state = right.clone();
        change(&mut state);
        simulation.check(&state).unwrap_err().to_string()
    };
    let told = [
        refused(|state| state.clumps.scale[3] *= 1.001),
        refused(|state| state.clumps.scale[3] = 9.0),
        refused(|state| state.clumps.moments[3][1] *= 1.001),
        refused(|state| state.clumps.velocity[3][3] *= 1.001),
        refused(|state| state.clumps.shape[3] = 1 - state.clumps.shape[3]),
        refused(|state| state.clumps.shape[3] = 9),
        refused(|state| state.clumps.number.swap(2, 3)),
        refused(|state| state.clumps.spheres.swap(0, 5)),
        refused(|state| state.clumps.spheres[0] = u32::MAX),
        refused(|state| state.clumps.ends[3] += 1),
        refused(|state| *state.clumps.ends.last_mut().unwrap() -= 1),
        refused(|state| state.particles.owner[0] = 1000),
        refused(|state| state.exchange.as_mut().unwrap().next_clump = 1),
        refused(|state| state.exchange.as_mut().unwrap().feeds[0].kind = 2),
        refused(|state| state.exchange.as_mut().unwrap().feeds[0].orientation = [0.0; 4]),
    ];
    assert!(told.iter().all(|message| message.starts_with("invalid state, ")), "{told:?}");
}

#[test]
fn what_an_insertion_of_clumps_cannot_be_is_refused_in_words() {
    let right = falling("");
    let sizes = "{ clump = [\"pair\", \"bent\"], by_number = [2, 1], uniform = [0.003, 0.0045] }";
    let with = |sizes_now: &str| read(&right.replace(sizes, sizes_now)).expect_err(sizes_now);
    for (found, expected) in [
        (with("{ clump = \"pairs\" }"), "expected a clump of this scene, found \"pairs\"; the nearest is pair"),
        (with("{ clump = [] }"), "expected the name of a clump, or a list of such names"),
        (with("{ clump = 3 }"), "expected the name of a clump, or a list of such names"),
        (with("{ clump = [\"pair\", \"bent\"] }"), "by_number or by_mass = [..] gives the shares of the clumps"),
        (
            with("{ clump = [\"pair\", \"bent\"], by_number = [1] }"),
            "expected a share for each clump, found 2 clumps and 1 shares",
        ),
        (
            with("{ clump = [\"pair\", \"bent\"], by_number = [1, 2], radius = [1e-3, 2e-3, 3e-3] }"),
            "expected a radius for all, or for each clump, found 3 radii and 2 clumps",
        ),
        (with("{ clump = \"pair\", by_number = [1] }"), "missing; one of radius, uniform, normal"),
        (with("{ clump = \"pair\", radius = 0.03 }"), "too narrow for a clump within a sphere of radius 0.03 m"),
        (with("{ clumps = \"pair\" }"), "clump"),
    ] {
        assert!(found.contains(expected), "{found}\n{expected} expected");
    }
    let found = read(&right.replace("{ radius = 0.002 }", "{ radius = 0.002 }\norientation = \"random\""))
        .expect_err("spheres");
    assert!(found.contains("[insertion.sand] orientation"), "{found}");
    let unnamed = right.replacen("material = \"glass\"\nsizes = { clump", "sizes = { clump", 1);
    let found = read(&unnamed).expect_err("no material");
    assert!(found.contains("[insertion.feed] material: missing"), "{found}");
    // Where both clumps name it, the insertion need not.
    read(
        &unnamed
            .replace("]\n[clump.bent]", "]\nmaterial = \"glass\"\n[clump.bent]")
            .replace("[boundary.floor]", "material = \"glass\"\n[boundary.floor]"),
    )
    .expect("a material");
}
