//! Runs of a cell: bits, the automatic step, variables, what is refused, what another scene takes over.

use super::scenes::{ROUGH, SMOOTH, cube, dense, gas, lattice, scene};
use crate::support::{DRIVEN, cell, read, spheres, start};
use cograin::lanes::Width;
use cograin::simulation::Simulation;

#[test]
fn bits_are_the_same_for_threads_lanes_and_after_save_and_restore() {
    let text = |threads: usize| dense(ROUGH, DRIVEN).replace("[run]", &format!("[run]\nthreads = {threads}"));
    let drive = |simulation: &mut Simulation, step: u32| {
        (0..6).for_each(|k| simulation.set_strain(k, f64::from(step) * [-0.01, 0.0, -0.02, 0.6, 0.01, -0.3][k]));
        simulation.advance(5e-4).unwrap();
    };
    let run = |threads: usize, width: Width, kept: bool| {
        let mut simulation = start(&text(threads));
        simulation.set_width(width);
        for step in 1..=6 {
            drive(&mut simulation, step);
            if kept && step == 3 {
                let state = simulation.state().clone();
                simulation = start(&text(threads));
                simulation.set_width(width);
                simulation.restore(&state).unwrap();
            }
        }
        let cell = simulation.state().cell.as_ref().unwrap();
        assert!(simulation.state().clock.rebuilds > 4 && cell.images.len() > 50);
        simulation.state().clone()
    };
    let first = run(1, Width::widest(), false);
    for (threads, width, kept) in [(3, Width::widest(), false), (1, Width::Least, false), (2, Width::widest(), true)] {
        assert!(run(threads, width, kept) == first, "{threads} threads, {width:?}, restored {kept}");
    }
}

#[test]
fn lengths_scaled_by_a_power_of_two_give_the_same_bits() {
    let run = |scale: f64| {
        let mut list = gas(40, 0.1, 1.0);
        for (place, radius, velocity) in &mut list {
            (*place, *radius) = (place.map(|part| scale * part), 2.2 * *radius * scale);
            *velocity = velocity.map(|part| scale * part);
        }
        // Pressures scale by the square of lengths, where densities and times stay.
        let rest = spheres(&list) + &cell(cube(0.1 * scale), DRIVEN);
        let text = scene(ROUGH[0], ROUGH[1], &rest).replace("1e7", &format!("{:?}", 1e7 * scale * scale));
        let mut simulation = start(&text.replace("[run]", "[run]\nmax_overlap = 0.3"));
        (0..6).for_each(|k| simulation.set_strain(k, [-0.05, 0.02, -0.05, 0.4, -0.05, 0.02][k]));
        simulation.advance(2e-3).unwrap();
        let cell = simulation.state().cell.as_ref().unwrap();
        (simulation.cell_stress().map(|part| part / (scale * scale)), cell.work / scale.powi(5), cell.images.len())
    };
    let unit = run(1.0);
    assert!(unit.2 > 10 && unit.0[0] < 0.0);
    assert_eq!(run(0.125), unit);
    assert_eq!(run(1024.0), unit);
}

#[test]
fn the_automatic_step_knows_images() {
    let automatic = |text: String| text.replace("step = 1e-5", "step = \"auto\"");
    for law in [SMOOTH, ROUGH] {
        let mut simulation = start(&automatic(dense(law, "motion = { shear = \"xz\" }")));
        simulation.set_strain(4, 0.3);
        simulation.advance(5e-3).unwrap();
        let clock = &simulation.state().clock;
        assert!(
            clock.step > 0.0 && clock.step < clock.stable && clock.stable < 1e-3,
            "{} {}",
            clock.step,
            clock.stable
        );
    }
    // One particle between its own images is as stiff as the same lattice of many.
    let stable = |counts| {
        let simulation = start(&automatic(lattice("sc", counts, 1.96e-3, 1e-3, "")));
        simulation.state().clock.stable
    };
    let (one, many) = (stable([1, 1, 1]), stable([4, 4, 4]));
    assert!(one <= many * (1.0 + 1e-9) && one > 0.4 * many, "{one} {many}");
}

#[test]
fn the_automatic_step_follows_a_strain_that_closes_all_contacts() {
    // At the start spheres hardly touch, and nothing is stiff.
    let more = "motion = { driven = [\"xx\", \"yy\", \"zz\"] }";
    for law in [SMOOTH, ROUGH] {
        let text = lattice("fcc", [3, 3, 3], 2.828_427e-3, 1e-3, more).replace("step = 1e-5", "step = \"auto\"");
        let mut simulation = start(&text.replace(SMOOTH[0], law[0]).replace(SMOOTH[1], law[1]));
        for step in 1..=10 {
            (0..3).for_each(|component| simulation.set_strain(component, -2e-3 * f64::from(step)));
            simulation.advance(1e-3).unwrap();
        }
        let energy = simulation.state().cell.as_ref().unwrap().work;
        let residual = simulation.physical_residual().unwrap();
        assert!(residual.abs() < 0.02 * energy, "{residual} of {energy}");
    }
}

#[test]
fn a_bonded_pair_that_is_sheared_is_not_said_to_gain_energy() {
    // The streaming motion is in no book: its energy made the error of a few steps look like a gain.
    let pair = spheres(&[([0.05, 0.05, 0.04], 0.004, [0.0; 3]), ([0.05, 0.05, 0.06], 0.004, [0.0; 3])]);
    let glue = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 0.03\nnormal_stiffness = 1e7\ntangential_stiffness = 4e6\n";
    let edges = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
    let text = scene(SMOOTH[0], SMOOTH[1], &format!("{pair}{glue}{}", cell(edges, "motion = { driven = [\"xz\"] }")));
    let mut simulation = start(&text.replace("step = 1e-5\n", ""));
    for share in 1..=50 {
        simulation.set_strain(4, 0.01 * f64::from(share) / 50.0);
        simulation.advance(0.002).unwrap();
    }
}

#[test]
fn variables_of_a_cell_are_its_inputs_and_what_it_answers() {
    let [law, pair] = SMOOTH;
    let more = "motion = { driven = [\"xx\"], servo = { yy = { stress = -1e3, max_rate = 1.0 } }, shear = \"xz\" }";
    let text = scene(law, pair, &(spheres(&[([0.5; 3], 0.1, [0.0; 3])]) + &cell(cube(1.0), more)));
    let interface = cograin::interface::Interface::of(&text.parse().unwrap());
    let names = |outputs: bool| -> Vec<String> {
        let (ins, outs) = (interface.inputs(), interface.outputs());
        let all: Vec<_> = if outputs { outs.collect() } else { ins.collect() };
        all.into_iter().map(|(_, it)| it.name.clone()).filter(|name| name.starts_with("cell.")).collect()
    };
    assert_eq!(names(false), ["cell.strain.xx", "cell.shear", "cell.target_stress.yy"]);
    let outputs = names(true);
    for name in [
        "cell.strain.yy",
        "cell.strain.zz",
        "cell.stress.xz",
        "cell.mean_stress.yz",
        "cell.conjugate_stress.xy",
        "cell.servo_error.yy",
        "cell.work",
        "cell.volume",
    ] {
        assert!(outputs.iter().any(|output| output == name), "{name} is missing in {outputs:?}");
    }
    assert_eq!(outputs.len(), 4 + 6 + 1 + 6 + 6 + 6 + 5);
}

#[test]
fn another_scene_takes_over_what_a_cell_has_come_to() {
    use cograin::simulation::Description;
    use std::sync::Arc;
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 0.02\nnormal_stiffness = 1e9\n\
                tangential_stiffness = 5e8\n";
    // At its start the second scene cuts springs of contacts that slide with the velocities of the end of a step.
    for (law, bond, tolerance) in [(SMOOTH, "", 1e-12), (ROUGH, "", 1e-3), (ROUGH, bond, 1e-3)] {
        let text = |motion: &str, end: &str| dense(law, &format!("{motion}\n{bond}")).replace("end = 1.0", end);
        let mut first = start(&text("motion = { shear = \"xz\" }", "end = 1.0"));
        for step in 1..=4 {
            first.set_strain(4, 0.3 * f64::from(step));
            first.advance(2e-3).unwrap();
        }
        first.advance(1e-5).unwrap();
        let from = Description::of(first.scene(), "first.toml", first.time());
        let second: Arc<cograin::scene::Scene> = Arc::new(text(DRIVEN, "end = 2.0").parse().unwrap());
        let (second, left) = Simulation::taken_over(second, first.state(), &from).unwrap();
        assert!(left.is_empty(), "{left:?}");
        let (before, after) = (first.state().cell.as_ref().unwrap(), second.state().cell.as_ref().unwrap());
        assert_eq!(after.strain, before.strain);
        assert_eq!(after.target, before.strain);
        assert_eq!(second.bonds().len(), first.bonds().len());
        assert_eq!(second.contact_count(), first.contact_count());
        let energies = [first.elastic_energy(), second.elastic_energy()];
        assert!((energies[1] - energies[0]).abs() < tolerance * energies[0], "{energies:?}");
    }
}

#[test]
fn what_a_cell_does_not_go_with_is_refused() {
    let [law, pair] = SMOOTH;
    let with = |more: &str, rest: &str| {
        let list = spheres(&[([0.5, 0.5, 0.5], 0.1, [0.0; 3])]);
        read(&scene(law, pair, &(list + rest + &cell(cube(1.0), more)))).err().unwrap_or_default()
    };
    let floor =
        "[boundary.floor]\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"\n";
    for (more, rest, words) in [
        ("", floor, "one that crosses them"),
        (
            "periodic = [\"x\", \"y\"]\nmotion = { driven = [\"xx\"] }",
            floor,
            "no boundary beside a [cell] that is deformed",
        ),
        ("periodic = [\"x\"]\nmotion = { driven = [\"xy\"] }", "", "xy, where the cell does not repeat"),
        ("motion = { driven = [\"xx\"], fixed = [\"xx\"] }", "", "xx twice"),
        ("motion = { shear = \"zx\" }", "", "expected \"xy\", \"xz\" or \"yz\", found \"zx\""),
        ("periodic = []", "", "at least one edge"),
        (
            "motion = { driven = [\"xx\"] }",
            "[force.push]\nparticles = { set = \"all\" }\nforce = [1.0, 0.0, 0.0]\n",
            "neither gravity nor [force]",
        ),
        ("", "[region.r]\nbox = [[-1e9, 0.0, 0.0], [1e9, 1.0, 1.0]]\n", "found one over 2000000000.0 edges along x"),
        (
            "",
            "[flow_meter.m]\npolygon = [[0.0, 0.0, 0.5], [11.0, 0.0, 0.5], [11.0, 1.0, 0.5]]\n",
            "found one over 11.0 edges along x",
        ),
        ("", "[domain]\nbox = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]\n", "no [domain] beside [cell]"),
    ] {
        let found = with(more, rest);
        assert!(found.contains(words), "{found}");
    }
    let close = spheres(&[([0.05, 0.5, 0.5], 0.1, [0.0; 3]), ([0.95, 0.5, 0.5], 0.1, [0.0; 3])]);
    let through = read(&scene(law, pair, &(close + &cell(cube(1.0), "")))).unwrap_err();
    assert!(through.contains("between particles 1 and 2 through a face of the cell"), "{through}");
    let narrow = scene(law, pair, &(spheres(&[([0.0; 3], 0.1, [0.0; 3])]) + &cell(cube(0.05), "")));
    assert!(read(&narrow).unwrap_err().contains("at least the largest radius"));
}
