//! Particles that go where bonds hold them: their bonds go with them, counted by themselves, and every book knows.

use crate::exchange::begun;
use crate::support::scene;
use cograin::lanes::Width;
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use cograin::state::State;
use std::sync::Arc;

/// A bonded block that flies into an outlet, strikes a plane beside it, and breaks in part; a second one, bonded to a plane that
/// pulls it apart, in a domain that takes away what leaves it. Both books are kept.
pub(crate) fn torn(formulation: &str, contact: &str, damping: &str, more: &str) -> String {
    format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
end = 0.01
step = 1e-6
[material.rock]
density = 2500.0
youngs_modulus = 1e8
poissons_ratio = 0.25
[pair.rock.rock]
restitution = 0.6
friction = 0.4
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.block]
material = "rock"
lattice = {{ kind = "face_centred_cubic", radius = 0.001, spacing = 0.00199, box = [[0.0, 0.0, 0.0], [0.012, 0.008, 0.008]] }}
velocity = [0.0, 3.0, -4.0]
[particles.rod]
material = "rock"
lattice = {{ kind = "simple_cubic", radius = 0.001, spacing = 0.0021, origin = [-0.02, -0.021, 0.013], counts = [4, 2, 2] }}
velocity = [0.0, -4.0, 0.0]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.5, 0.0, 1.0] }}
material = "rock"
[boundary.end]
plane = {{ point = [-0.021, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }}
material = "rock"
motion = {{ prescribed = {{ x = -0.2 }} }}
[bond.glue]
formulation = "{formulation}"
contact = "{contact}"
between = ["block", "block"]
create_distance = 0.00205
radius_multiplier = 0.8
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
{damping}
[bond.glue.breakage]
max_normal_stress = 1.0e6
max_shear_stress = 1.0e6
[bond.rod]
formulation = "{formulation}"
contact = "{contact}"
between = ["rod", "rod"]
create_distance = 0.0022
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
[bond.foot]
formulation = "{formulation}"
contact = "{contact}"
between = ["rod", "end"]
create_distance = 0.0022
normal_stiffness = 1.0e9
tangential_stiffness = 4.0e8
[region.bin]
box = [[-0.001, 0.009, -1.0], [1.0, 1.0, 1.0]]
[outlet.side]
region = "bin"
[domain]
box = [[-1.0, -0.0212, -1.0], [1.0, 1.0, 1.0]]
outside = "remove"
[output]
energy = true
losses = true
{more}
"#
    )
}

/// Bonds of all laws: living, made, broken, removed.
fn bonds(simulation: &Simulation) -> [u64; 4] {
    let lists = &simulation.state().bonds;
    [
        lists.iter().map(|list| list.first.len() as u64).sum(),
        lists.iter().map(|list| list.made).sum(),
        lists.iter().map(|list| list.broken).sum(),
        lists.iter().map(|list| list.removed).sum(),
    ]
}

/// Damping of the first law.
pub(crate) const DAMPED: &str = "[bond.glue.damping.viscous]\nnormal_force = 0.1\ntangential_force = 0.1\n";

#[test]
fn bonds_go_with_their_particles_and_the_books_close() {
    for (formulation, contact, damping) in [
        ("incremental", "parallel", ""),
        ("finite_rotation", "without_normal", DAMPED),
        ("finite_rotation", "none", DAMPED),
    ] {
        let name = format!("{formulation} {contact} {damping:?}");
        closes(&scene(&torn(formulation, contact, damping, "")), &name);
    }
}

/// Runs a scene and checks counts and books.
fn closes(scene: &Arc<Scene>, name: &str) {
    let mut simulation = begun(scene, Width::widest());
    let mut told = 0;
    for _ in 0..15 {
        simulation.advance(1e-4).unwrap();
        told += simulation.state().breaks.len() as u64;
    }
    let [living, made, broken, removed] = bonds(&simulation);
    assert!(removed > 20 && broken > 0 && living > 0, "{name}: {living} {made} {broken} {removed}");
    assert_eq!((living + broken + removed, told), (made, broken), "{name}");
    let (state, net) = (simulation.state(), &simulation.state().exchange.as_ref().unwrap().net);
    assert!(
        state.exchange.as_ref().unwrap().outside.count > 0 && state.exchange.as_ref().unwrap().outlets[0].count > 5
    );
    let turnover = state.ledger.as_ref().unwrap().turnover + net.turnover;
    let residual = simulation.energy_residual().unwrap() / turnover;
    assert!(residual.abs() < 1e-12, "{name}: {residual:e}");
    let physical = simulation.physical_residual().unwrap() / turnover;
    assert!(physical.abs() < 1e-3, "{name}: {physical:e}");
    assert!(net.elastic != 0.0);
    // Elastic energy that goes is none that broken bonds release.
    let ends = |bond: usize, list: &cograin::state::BondList| [list.first[bond], *list.second.get(bond).unwrap_or(&0)];
    for list in &state.bonds {
        assert!(
            (0..list.first.len())
                .all(|bond| ends(bond, list).iter().all(|&slot| (slot as usize) < state.particles.len()))
        );
    }
}

#[test]
fn what_a_stretched_bond_holds_goes_to_the_last_joule() {
    // Two spheres without contacts move apart, and the outlet takes one of them. Their bond is made on the way: nothing loads them at the
    // beginning, where a force would be worth the second order of the step.
    let text = |step: f64| {
        format!(
            r#"
[run]
step = {step:?}
[material.rock]
density = 2500.0
[particles.one]
material = "rock"
list = [{{ position = [0.0, 0.0, 0.0], radius = 0.001 }}]
[particles.other]
material = "rock"
list = [{{ position = [0.002, 0.0, 0.0], radius = 0.001, velocity = [1.0, 0.0, 0.0] }}]
[bond.glue]
formulation = "finite_rotation"
between = ["one", "other"]
create_distance = 0.0021
create = {{ time = 1.0e-6 }}
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
[bond.glue.damping.viscous]
normal_force = 0.1
[outlet.right]
beyond = {{ point = [0.00205, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }}
[output]
energy = true
losses = true
"#
        )
    };
    let residual = |step: f64| {
        let mut simulation = begun(&scene(&text(step)), Width::widest());
        simulation.advance(1.0e-3).unwrap();
        assert_eq!((bonds(&simulation), simulation.state().particles.len()), ([0, 1, 0, 1], 1));
        let net = simulation.state().exchange.as_ref().unwrap().net;
        assert!(net.elastic < 0.0);
        simulation.physical_residual().unwrap().abs() / net.turnover
    };
    let [coarse, fine] = [2e-7, 1e-7].map(residual);
    assert!(coarse < 1e-10 && fine < 1e-10, "{coarse:e} {fine:e}");
}

#[test]
fn the_bits_are_the_same_for_any_width_and_number_of_threads_and_wherever_a_run_is_taken_up() {
    let with = |threads: usize| {
        let text = torn("finite_rotation", "without_normal", DAMPED, "");
        scene(
            &text
                .replace("[run]", &format!("[run]\nthreads = {threads}"))
                .replace("[0.012, 0.008, 0.008]", "[0.012, 0.016, 0.016]")
                .replace("[-0.001, 0.009, -1.0]", "[-0.001, 0.014, -1.0]"),
        )
    };
    let fingerprints = |threads: usize, width: Width| -> Vec<u64> {
        let mut simulation = begun(&with(threads), width);
        let steps = (0..5).map(|_| {
            simulation.advance(1e-4).unwrap();
            simulation.state().fingerprint()
        });
        steps.collect()
    };
    let right = fingerprints(1, Width::widest());
    assert_eq!(fingerprints(3, Width::widest()), right);
    assert_eq!(fingerprints(1, Width::Least), right);
    let one = with(1);
    let mut simulation = begun(&one, Width::widest());
    (0..3).for_each(|_| simulation.advance(1e-4).unwrap());
    let (bytes, state) = (simulation.state().to_bytes(1), simulation.state().clone());
    assert!(state.bonds[0].removed > 0);
    simulation.advance(1e-4).unwrap();
    simulation.restore(&state).unwrap();
    let mut resumed = Simulation::resume(one, State::from_bytes(&bytes, 1).unwrap()).unwrap();
    for right in &right[3..] {
        simulation.advance(1e-4).unwrap();
        resumed.advance(1e-4).unwrap();
        assert_eq!((simulation.state().fingerprint(), resumed.state().fingerprint()), (*right, *right));
    }
}

#[test]
fn what_gets_behind_a_plane_that_an_outlet_names_goes_with_the_plane_where_it_is() {
    // Without contact laws particles do not feel the plane, which moves up towards them.
    let text = r#"
[run]
step = 1e-4
[material.rock]
density = 2500.0
[particles.row]
material = "rock"
lattice = { kind = "simple_cubic", radius = 0.001, origin = [0.0, 0.0, 0.001], counts = [1, 1, 10] }
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "rock"
motion = { driven = ["z"] }
[outlet.below]
beyond = "floor"
"#;
    let mut simulation = begun(&scene(text), Width::widest());
    for (place, left) in [(0.0, 10), (0.0009, 10), (0.0011, 9), (0.0071, 6), (0.002, 6)] {
        simulation.set_input(cograin::quantity::BoundaryIndex(0), 2, place);
        simulation.advance(0.01).unwrap();
        assert_eq!(simulation.state().particles.len(), left, "floor at {place}");
    }
}

#[test]
fn what_is_pressed_through_a_plane_goes_instead_of_stopping_the_run() {
    let text = |outlet: &str| {
        format!(
            r#"
[run]
step = 1e-6
allow_unstable = true
[material.rock]
density = 2500.0
youngs_modulus = 1e5
poissons_ratio = 0.25
[pair.rock.rock]
restitution = 0.9
[contact.touch.normal.hertz]
[particles.bullet]
material = "rock"
list = [{{ position = [0.0, 0.0, 0.005], radius = 0.001, velocity = [0.0, 0.0, -100.0] }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "rock"
{outlet}
"#
        )
    };
    let mut stopped = begun(&scene(&text("")), Width::widest());
    assert!(stopped.advance(1e-4).is_err());
    let mut simulation = begun(&scene(&text("[outlet.below]\nbeyond = \"floor\"\n")), Width::widest());
    simulation.advance(1e-4).unwrap();
    assert!(simulation.state().particles.is_empty());
}
