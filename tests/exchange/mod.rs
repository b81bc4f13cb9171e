//! Particles that come and go: counted, booked, and the same bits whoever works on them and wherever a run is taken up.

pub(crate) mod bonds;
mod clumps;

use crate::support::scene;
use cograin::lanes::Width;
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use cograin::state::State;
use std::sync::Arc;

/// A feed of spheres of several sizes that fall through a hole in a floor, with friction and rolling, both books kept.
fn falling(more: &str) -> String {
    format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
end = 0.3
step = 1e-5
seed = 7
[material.glass]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.6
friction = 0.4
rolling_friction = 0.1
[contact.all.normal.hertz]
[contact.all.tangential.history]
[contact.all.rolling.epsd2]
[boundary.floor]
disc = {{ centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = 0.04, hole = 0.012 }}
material = "glass"
[boundary.wall]
cylinder = {{ from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.1], radius = 0.03 }}
material = "glass"
[region.mouth]
cylinder = {{ from = [0.0, 0.0, 0.06], to = [0.0, 0.0, 0.08], radius = 0.025 }}
[region.bin]
box = [[-0.05, -0.05, -0.05], [0.05, 0.05, -0.02]]
[insertion.feed]
region = "mouth"
material = "glass"
sizes = {{ uniform = [0.0015, 0.003] }}
count_rate = 4000.0
velocity = [0.0, 0.0, -0.3]
scatter = 0.1
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

/// Spheres aside that touch nothing: with them there are enough for several threads.
pub(crate) const MANY: &str = r#"
[particles.many]
material = "glass"
lattice = { kind = "simple_cubic", radius = 0.002, spacing = 0.006, counts = [13, 13, 12], origin = [0.1, 0.0, 0.0] }
"#;

/// What is known of particles that come and go.
fn exchange(simulation: &Simulation) -> &cograin::state::Exchange {
    simulation.state().exchange.as_ref().unwrap()
}

/// A simulation of a scene with this lane width.
pub(crate) fn begun(scene: &Arc<Scene>, width: Width) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(scene)).unwrap();
    simulation.set_width(width);
    simulation
}

#[test]
fn what_comes_and_goes_is_counted_and_booked() {
    let scene = scene(&falling(""));
    let mut simulation = begun(&scene, Width::widest());
    for _ in 0..30 {
        simulation.advance(0.01).unwrap();
    }
    let (state, known) = (simulation.state(), exchange(&simulation));
    let (feed, outlet) = (known.feeds[0], known.outlets[0]);
    assert!(feed.came.count > 300 && outlet.count > 100, "{feed:?} {outlet:?}");
    assert_eq!(state.particles.len() as u64, feed.came.count - outlet.count);
    let mass: f64 = state.particles.velocity.iter().map(|row| row[3]).sum();
    assert!((mass - (feed.came.mass - outlet.mass)).abs() < 1e-12 * feed.came.mass);
    assert!((known.net.mass - mass).abs() < 1e-12 * feed.came.mass);
    let passed = known.meters[0];
    assert!(passed.counts[0] >= outlet.count && passed.counts[1] < 10, "{passed:?}");
    // Energy: residual of the book of forces over all that was turned over.
    let ledger = state.ledger.as_ref().unwrap();
    let residual = simulation.energy_residual().unwrap() / (ledger.turnover + known.net.turnover);
    assert!(residual.abs() < 1e-12, "{residual:e}");
    let physical = simulation.physical_residual().unwrap() / (ledger.turnover + known.net.turnover);
    assert!(physical.abs() < 2e-3, "{physical:e}");
    // Numbers are those that came, each once.
    let mut numbers: Vec<u32> = state.particles.id.iter().map(|&index| simulation.number(index)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), state.particles.len());
    assert_eq!(u64::from(known.next), feed.came.count + 1);
    // Memory follows the largest number there was.
    assert!(state.particles.slot.len() < feed.came.count as usize);
}

#[test]
fn the_bits_are_the_same_for_every_lane_width_and_wherever_a_run_is_taken_up() {
    let scene = scene(&falling(""));
    let fingerprints = |width| {
        let mut simulation = begun(&scene, width);
        (0..12)
            .map(|_| {
                simulation.advance(0.01).unwrap();
                simulation.state().fingerprint()
            })
            .collect::<Vec<_>>()
    };
    let right = fingerprints(Width::widest());
    for width in [Width::Least, Width::Four] {
        assert_eq!(fingerprints(width), right, "{width:?}");
    }
    let mut simulation = begun(&scene, Width::widest());
    let mut saved = Vec::new();
    for (place, right) in right.iter().enumerate() {
        simulation.advance(0.01).unwrap();
        assert_eq!(simulation.state().fingerprint(), *right);
        if place % 4 == 3 {
            saved.push((place, simulation.state().to_bytes(1), simulation.state().clone()));
        }
    }
    for (place, bytes, state) in saved {
        let read = State::from_bytes(&bytes, 1).unwrap();
        let mut resumed = Simulation::resume(Arc::clone(&scene), read).unwrap();
        simulation.restore(&state).unwrap();
        for right in &right[place + 1..] {
            resumed.advance(0.01).unwrap();
            simulation.advance(0.01).unwrap();
            assert_eq!((resumed.state().fingerprint(), simulation.state().fingerprint()), (*right, *right));
        }
    }
}

#[test]
fn threads_leave_the_bits_as_they_are() {
    let threads = |count: usize| {
        let scene = scene(&falling(MANY).replace("seed = 7", &format!("seed = 7\nthreads = {count}")));
        let mut simulation = begun(&scene, Width::widest());
        simulation.advance(0.08).unwrap();
        simulation.state().fingerprint()
    };
    let right = threads(1);
    assert_eq!([2, 3].map(threads), [right; 2]);
}

/// Spheres that fall freely through a domain which takes away what leaves it, without contacts.
const FREE: &str = r#"
gravity = [0.0, 0.0, -10.0]
[run]
end = 1.0
step = 1e-4
[material.glass]
density = 2500.0
[region.mouth]
box = [[0.0, 0.0, 0.9], [1.0, 1.0, 1.0]]
[insertion.feed]
region = "mouth"
material = "glass"
sizes = { radius = 0.005 }
count_rate = 1000.0
[domain]
box = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]
outside = "remove"
[output]
energy = true
"#;

/// What momentum along z differs from that which came less what went and the impulse of the weight, over the larger of these.
fn momentum_residual(simulation: &Simulation) -> f64 {
    let (state, net) = (simulation.state(), exchange(simulation).net);
    let momentum: f64 = state.particles.velocity.iter().map(|row| row[3] * row[2]).sum();
    let mass: f64 = state.particles.velocity.iter().map(|row| row[3]).sum();
    let weight = simulation.scene().gravity[2] * (mass * simulation.time() - net.mass_time);
    (momentum - net.momentum[2] - weight) / weight.abs().max(net.momentum[2].abs())
}

#[test]
fn what_leaves_the_domain_goes_and_what_falls_freely_is_there_as_long_as_the_fall_takes() {
    let scene = scene(FREE);
    let mut simulation = begun(&scene, Width::widest());
    assert!(simulation.state().particles.is_empty());
    simulation.advance(2.0).unwrap();
    let known = exchange(&simulation);
    assert!((known.feeds[0].came.count as f64 - 2000.0).abs() <= 6.0, "{:?}", known.feeds[0]);
    // A fall over 0.95 m takes 0.436 s in the mean; a domain is looked at after each half of a radius.
    let there = simulation.state().particles.len() as f64;
    assert!((there / 1000.0 - 0.436).abs() < 0.01, "{there}");
    assert_eq!(known.outside.count, known.feeds[0].came.count - simulation.state().particles.len() as u64);
    let ledger = simulation.state().ledger.as_ref().unwrap();
    let residual = simulation.energy_residual().unwrap() / ledger.turnover;
    assert!(residual.abs() < 1e-12, "{residual:e}");
    assert!(momentum_residual(&simulation).abs() < 1e-12, "{:e}", momentum_residual(&simulation));
}

#[test]
fn a_rate_that_is_given_acts_in_the_next_communication_step() {
    let scene = scene(FREE);
    let mut simulation = begun(&scene, Width::widest());
    let interface = cograin::interface::Interface::of(&scene);
    let rate = interface.find("feed.rate").unwrap();
    let count = |simulation: &Simulation| exchange(simulation).feeds[0].came.count;
    let mut before = 0;
    for (given, right) in [(1000.0, 100), (3000.0, 300), (0.0, 0), (500.0, 50)] {
        interface.set(&mut simulation, rate, cograin::interface::Value::Real(given)).unwrap();
        simulation.advance(0.1).unwrap();
        let came = count(&simulation) - before;
        // An insertion is tried every 50 time steps of 0.1 ms; what was due before comes then.
        assert!(came.abs_diff(right) <= 16, "{came} at {given}");
        before += came;
    }
    let refused = interface.check(rate, -1.0).unwrap_err().to_string();
    assert_eq!(refused, "feed.rate: expected a number of 0.0 or above, found -1.0");
}

#[test]
fn a_rate_holds_where_nothing_touches_and_time_steps_are_long() {
    // Tries every fifty time steps alone let 34 of the 60 come that were due, without a word.
    let text = "[run]\nend = 1.0\n[material.glass]\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\ndensity = 2500.0\n\
                [pair.glass.glass]\nrestitution = 0.7\n[contact.touch.normal.hertz]\n\
                [particles.one]\nmaterial = \"glass\"\nlist = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }]\n\
                [region.box]\nbox = [[0.1, 0.1, 0.1], [0.3, 0.3, 0.3]]\n\
                [insertion.feed]\nregion = \"box\"\nmaterial = \"glass\"\nsizes = { radius = 0.004 }\ncount_rate = 298.0\n";
    let mut simulation = begun(&scene(text), Width::widest());
    for number in 1..=10 {
        simulation.advance(0.02).unwrap();
        let (came, due) = (exchange(&simulation).feeds[0].came.count as f64, 298.0 * 0.02 * f64::from(number));
        assert!(came <= due && came > due - 12.0, "{came} of {due}");
    }
}

#[test]
fn a_step_that_fails_gives_back_the_rates_and_what_was_there() {
    let scene = scene(FREE);
    let mut simulation = begun(&scene, Width::widest());
    for place in 0..10 {
        simulation.set_insertion_rate(0, 100.0 * f64::from(place));
        simulation.advance_or_roll_back(0.013).unwrap();
    }
    let right = simulation.state().fingerprint();
    let stop = Arc::new(std::sync::atomic::AtomicBool::new(true));
    simulation.stop_when(&stop);
    simulation.advance_or_roll_back(0.013).unwrap_err();
    assert_eq!(simulation.state().fingerprint(), right);
}

#[test]
fn a_mass_comes_as_soon_as_there_is_room_and_nothing_overlaps() {
    let text = FREE
        .replace("count_rate = 1000.0", "mass = 2.0")
        .replace("radius = 0.005", "radius = [0.004, 0.008], by_mass = [1.0, 3.0]")
        .replace("gravity = [0.0, 0.0, -10.0]", "gravity = [0.0, 0.0, 0.0]")
        .replace("[[0.0, 0.0, 0.9], [1.0, 1.0, 1.0]]", "[[0.0, 0.0, 0.8], [0.2, 0.2, 1.0]]");
    let scene = scene(&text);
    let mut simulation = begun(&scene, Width::widest());
    simulation.advance(0.01).unwrap();
    let known = exchange(&simulation).feeds[0];
    assert!(known.came.mass > 1.9 && known.came.mass <= 2.0, "{known:?}");
    let rows = &simulation.state().particles.position;
    for (place, one) in rows.iter().enumerate() {
        for other in &rows[..place] {
            let apart = (0..3).map(|axis| (one[axis] - other[axis]).powi(2)).sum::<f64>().sqrt();
            assert!(apart >= one[3] + other[3]);
        }
    }
    let small = rows.iter().filter(|row| row[3] == 0.004).count() as f64 * 0.004_f64.powi(3);
    let large = rows.iter().filter(|row| row[3] == 0.008).count() as f64 * 0.008_f64.powi(3);
    assert!((small / (small + large) - 0.25).abs() < 0.05, "{}", small / (small + large));
}

#[test]
fn a_state_that_cannot_be_is_refused() {
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
        refused(|state| state.particles.numbers[0] = state.particles.numbers[1]),
        refused(|state| state.particles.free.push(0)),
        refused(|state| state.particles.position[0][3] *= 3.0),
        refused(|state| state.exchange = None),
        refused(|state| state.exchange.as_mut().unwrap().feeds.clear()),
        refused(|state| state.exchange.as_mut().unwrap().feeds[0].owed = f64::NAN),
        refused(|state| state.exchange.as_mut().unwrap().next = 1),
    ];
    assert!(told.iter().all(|message| message.starts_with("invalid state, ")), "{told:?}");
}

/// The scene of [`falling`] that fills a closed bed, then opens its hole: `stage` is `"fill"` or `"open"`.
fn stage(stage: &str) -> Arc<Scene> {
    let text = falling("").replace("count_rate = 4000.0", "mass = 0.01");
    let hole = if stage == "fill" { "" } else { ", hole = 0.012" };
    scene(&text.replace(", hole = 0.012", hole))
}

#[test]
fn what_came_in_one_scene_goes_on_in_the_next() {
    use cograin::simulation::Description;
    let (fill, open) = (stage("fill"), stage("open"));
    let mut filled = begun(&fill, Width::widest());
    filled.advance(0.1).unwrap();
    let reached = filled.state();
    let from = Description::of(&fill, "fill.toml", filled.time());
    let (mut opened, left) = Simulation::taken_over(Arc::clone(&open), reached, &from).unwrap();
    assert_eq!(left, Vec::<String>::new());
    let numbers = |simulation: &Simulation| {
        let ids = simulation.state().particles.id.iter();
        let mut numbers: Vec<u32> = ids.map(|&index| simulation.number(index)).collect();
        numbers.sort_unstable();
        numbers
    };
    assert_eq!(numbers(&opened), numbers(&filled));
    assert_eq!(opened.contact_count(), filled.contact_count());
    assert_eq!(exchange(&opened).next, exchange(&filled).next);
    assert_eq!(exchange(&opened).feeds[0].owed, exchange(&filled).feeds[0].owed, "what is still to come of the mass");
    opened.check(&opened.state().clone()).unwrap();
    opened.advance(0.3).unwrap();
    assert!(exchange(&opened).outlets[0].count > 10, "{:?}", exchange(&opened).outlets);
    // What has gone stays away in a third stage, and no number comes again.
    let from = Description::of(&open, "open.toml", opened.time());
    let (third, _) = Simulation::taken_over(Arc::clone(&open), opened.state(), &from).unwrap();
    assert_eq!(numbers(&third), numbers(&opened));
}

#[test]
#[ignore = "takes half a minute"]
fn a_hundred_thousand_come_and_go() {
    let scene = scene(&FREE.replace("count_rate = 1000.0", "count_rate = 60000.0").replace("0.005", "0.001"));
    let mut simulation = begun(&scene, Width::widest());
    let mut most = 0;
    for _ in 0..200 {
        simulation.advance(0.01).unwrap();
        most = most.max(simulation.state().particles.len());
    }
    let (known, state) = (exchange(&simulation), simulation.state());
    let ledger = state.ledger.as_ref().unwrap();
    let residual = simulation.energy_residual().unwrap() / ledger.turnover;
    let mass: f64 = state.particles.velocity.iter().map(|row| row[3]).sum();
    let lost = (known.net.mass - mass) / known.feeds[0].came.mass;
    println!(
        "{:?} came, {:?} went, {most} at most, {} places",
        known.feeds[0].came,
        known.outside,
        state.particles.slot.len()
    );
    let momentum = momentum_residual(&simulation);
    println!("energy {residual:e}, mass {lost:e}, momentum {momentum:e}");
    assert!(known.outside.count > 90_000 && residual.abs() < 1e-12 && lost.abs() < 1e-12 && momentum.abs() < 1e-11);
    assert!(state.particles.slot.len() < most + 5000);
}
