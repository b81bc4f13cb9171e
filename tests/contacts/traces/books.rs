//! Impacts account for all that is lost; traces are part of the state.

use super::{GRAINS, assert_close, closed, lost, sum, traces};
use crate::support::{scene_with, start};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::State;

/// A cloud that falls on a floor and beside a turning drum, a rectangle and a free plate.
fn cloud() -> String {
    let mut list = String::new();
    for place in 0..125_u32 {
        let position = [place % 5, place / 5 % 5, place / 25].map(|part| 1.2e-3 + 2.3e-3 * f64::from(part));
        let velocity = [place % 7, place % 5, place % 3].map(|part| 0.2 * (f64::from(part) - 2.0));
        list += &format!("{{ position = {position:?}, radius = 1e-3, velocity = {velocity:?} }},\n");
    }
    let law = GRAINS.replace("step = 1.0e-6", "step = 1.0e-5").replace("[run]", "gravity = [0.5, 0.0, -9.81]\n[run]");
    let law = law.replace("friction = 0.5", "friction = 0.5\nrolling_friction = 0.1");
    format!(
        "{law}[contact.touch.rolling.cdt]\n[output]\nimpacts = {{ histogram = {{ bins_per_decade = 10 }}, events = true }}\n\
         [particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n\
         [boundary.floor]\nrectangle = {{ corner = [-1e-3, -1e-3, 0], edges = [[14e-3, 0, 0], [0, 14e-3, 0]] }}\nmaterial = \"stone\"\n\
         motion = {{ prescribed = {{ \"rotation.z\" = 20.0 }} }}\n[boundary.floor.wear.archard]\ncoefficient = 1e-12\n\
         [boundary.shell]\ncylinder = {{ from = [5.8e-3, 5.8e-3, -1e-3], to = [5.8e-3, 5.8e-3, 40e-3], radius = 8e-3, infinite = true }}\n\
         material = \"stone\"\nmotion = {{ prescribed = {{ \"rotation.z\" = -10.0 }} }}\n\
         [boundary.shell.wear.finnie]\nflow_stress = 1e9\n[boundary.ground]\nplane = {{ point = [0, 0, -0.5e-3], normal = [0, 0, 1] }}\nmaterial = \"stone\"\n"
    )
}

/// What open impacts have lost so far, as their contacts remember it \[J\].
fn open(simulation: &Simulation) -> f64 {
    let (state, scene) = (simulation.state(), simulation.scene());
    let place = scene.law(0).history_places().impact.expect("impacts are remembered");
    let lists = state.contacts.iter().map(|list| (&list.history, list.flags.len()));
    let walls = state.walls.iter().map(|list| (&list.history, list.flags.len()));
    let of = |(history, count): (&cograin::state::History, usize)| -> f64 {
        (0..count).map(|entry| history.get(entry)[place]).map(|row| row[0] + row[1]).sum()
    };
    lists.chain(walls).map(of).sum()
}

#[test]
fn closed_and_open_impacts_lost_what_the_book_tells() {
    let mut simulation = start(&cloud());
    for _ in 0..4 {
        simulation.advance(5e-3).unwrap();
        let (closed, open, lost) = (closed(&simulation), open(&simulation), lost(&simulation));
        assert!(closed > 0.0 && open != 0.0, "{closed:e} J closed, {open:e} J open");
        assert_close(closed + open, lost, 1e-11);
    }
    let ended = traces(&simulation).ended();
    assert!(ended > 200, "{ended} impacts");
    for boundary in [0, 1] {
        let wear = sum(&simulation, boundary, |facets| &facets.wear);
        assert!(wear > 0.0, "boundary {boundary}: {wear:e} m³");
    }
}

#[test]
fn traces_have_the_same_bits_for_any_threads_and_lanes() {
    let run = |threads: usize, width: Width| {
        let mut simulation = start(&cloud().replace("[run]\n", &format!("[run]\nthreads = {threads}\n")));
        simulation.set_width(width);
        simulation.advance(12e-3).unwrap();
        simulation.state().fingerprint()
    };
    let first = run(1, Width::Least);
    assert_eq!(run(2, Width::widest()), first);
    assert_eq!(run(3, Width::Least), first);
}

#[test]
fn a_state_saved_amid_impacts_goes_on_with_the_same_bits() {
    let mut simulation = start(&cloud());
    simulation.advance(8e-3).unwrap();
    assert!(open(&simulation) != 0.0);
    let scene = simulation.scene().clone();
    let bytes = simulation.state().to_bytes(scene.fingerprint);
    let state = State::from_bytes(&bytes, scene.fingerprint).unwrap();
    let mut resumed = Simulation::resume(scene, state).unwrap();
    for simulation in [&mut simulation, &mut resumed] {
        simulation.advance(4e-3).unwrap();
    }
    assert_eq!(simulation.state().fingerprint(), resumed.state().fingerprint());
}

#[test]
fn bodies_four_times_as_heavy_and_stiff_lose_four_times_as_much_to_the_last_bit() {
    let scaled = cloud()
        .replace("density = 2500.0", "density = 10000.0")
        .replace("youngs_modulus = 5.0e7", "youngs_modulus = 20.0e7")
        .replace("coefficient = 1e-12", "coefficient = 0.25e-12")
        .replace("flow_stress = 1e9", "flow_stress = 4e9");
    let [one, four] = [cloud(), scaled].map(|text| {
        let mut simulation = start(&text);
        simulation.advance(8e-3).unwrap();
        simulation
    });
    let energies =
        |it: &Simulation| -> Vec<f64> { traces(it).boundaries.iter().flat_map(|it| it.normal.clone()).collect() };
    assert_eq!(energies(&four), energies(&one).iter().map(|energy| 4.0 * energy).collect::<Vec<_>>());
    let lost = |it: &Simulation| -> Vec<[f64; 2]> { traces(it).impacts.iter().map(|it| it.record.lost).collect() };
    assert_eq!(lost(&four), lost(&one).iter().map(|lost| lost.map(|it| 4.0 * it)).collect::<Vec<_>>());
    // 0.25e-12 is not a quarter of 1e-12 to the last bit of the decimal text: it is one to rounding.
    assert_close(sum(&four, 0, |facets| &facets.wear), sum(&one, 0, |facets| &facets.wear), 1e-15);
    assert_close(sum(&four, 1, |facets| &facets.wear), sum(&one, 1, |facets| &facets.wear), 1e-15);
}

#[test]
fn a_scene_that_asks_for_nothing_remembers_nothing() {
    let asked = cloud();
    let text = asked.replace("[output]\nimpacts = { histogram = { bins_per_decade = 10 }, events = true }\n", "");
    let text = text.replace("[boundary.floor.wear.archard]\ncoefficient = 1e-12\n", "");
    let text = text.replace("[boundary.shell.wear.finnie]\nflow_stress = 1e9\n", "");
    let scene = scene_with(&text, Default::default());
    assert_eq!(scene.law(0).history_places().impact, None);
    let [mut plain, mut asked] = [start(&text), start(&asked)];
    plain.advance(5e-3).unwrap();
    asked.advance(5e-3).unwrap();
    assert!(plain.state().traces.is_none() && plain.state().losses.is_none());
    assert_eq!(plain.state().particles, asked.state().particles);
}

#[test]
fn an_impact_ends_where_its_particle_goes() {
    let text = format!(
        "{GRAINS}[output]\nimpacts = {{ events = true }}\n[particles.all]\nmaterial = \"stone\"\nlist = [\n\
         {{ position = [0, 0, 0.99e-3], radius = 1e-3, velocity = [3.0, 0.0, 0.0] }},\n]\n{}\
         [region.gap]\nbox = [[0.5e-3, -5e-3, -5e-3], [9e-3, 5e-3, 5e-3]]\n[outlet.end]\nregion = \"gap\"\n",
        super::FLOOR
    );
    let text = text.replace("[run]", "gravity = [0.0, 0.0, -5000.0]\n[run]");
    let mut simulation = start(&text);
    simulation.advance(2e-3).unwrap();
    assert_eq!((simulation.state().particles.len(), traces(&simulation).ended()), (0, 1));
    assert_close(closed(&simulation), lost(&simulation), 1e-12);
}
