//! Flight through the faces of a cell, alone, in pairs and in chains.

use super::scenes::{ROUGH, SMOOTH, cube, scene};
use crate::support::{assert_all_near, cell, spheres, start};

#[test]
fn one_particle_flies_around_a_million_steps_without_drift() {
    let velocity = [7.3, -3.1, 5.7];
    let edges = [[0.1, 0.0, 0.0], [0.03, 0.08, 0.0], [-0.02, 0.025, 0.12]];
    let began = [0.01, 0.02, 0.03];
    // Its lists, and with them its place, are made anew as if it could touch something.
    let [law, pair] = SMOOTH;
    let mut simulation = start(&scene(law, pair, &(spheres(&[(began, 0.01, velocity)]) + &cell(edges, ""))));
    for _ in 0..10 {
        simulation.advance(1.0).unwrap();
    }
    let (state, time) = (simulation.state(), 10.0);
    assert_eq!(state.clock.steps, 1_000_000);
    let slot = state.particles.slot[0] as usize;
    assert_eq!(state.particles.velocity[slot][..3], velocity);
    let away = state.cell.as_ref().unwrap().edges_away[0];
    assert!(away.iter().all(|count| count.abs() > 100), "{away:?}");
    let place = [0, 1, 2].map(|axis: usize| {
        state.particles.position[slot][axis] + (0..3).map(|edge| away[edge] as f64 * edges[edge][axis]).sum::<f64>()
    });
    for axis in 0..3 {
        // Each step rounds a place in the cell by at most half a digit of its largest number, and the way is that of 10 s.
        let rounding = 1e6 * 0.5 * f64::EPSILON * 0.125 + 1e-13;
        let expected = began[axis] + velocity[axis] * time;
        assert!((place[axis] - expected).abs() < rounding, "{} {expected}", place[axis]);
    }
}

#[test]
fn a_pulse_goes_through_the_faces_at_the_speed_of_waves_in_a_chain() {
    // Mass points a apart joined by springs: each wave of wave number k turns by 2 √(s/m) sin(k a/2), long ones go at a √(s/m).
    let (count, radius) = (128, 1e-3);
    let (spacing, stiffness) = (2.0 * radius, 1e12 * std::f64::consts::PI * radius * radius);
    let mass = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let pulse = |site: i32| {
        let apart = f64::from((site - 20 + 64).rem_euclid(count) - 64);
        1e-4 * (-apart * apart / 72.0).exp()
    };
    let sites = (0..count).map(|site| ([spacing * f64::from(site), 0.0, 0.0], radius, [pulse(site), 0.0, 0.0]));
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 2.1e-3\nnormal_stiffness = 1e12\ntangential_stiffness = 4e11\n";
    let edges = [[spacing * f64::from(count), 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]];
    let rest = spheres(&sites.collect::<Vec<_>>()) + bond + &cell(edges, "periodic = [\"x\"]");
    let text = scene("", "", &rest).replace("[pair.glass.glass]\n\n", "");
    let speed = spacing * (stiffness / mass).sqrt();
    // Both halves of the pulse go half way round and meet there.
    let time = 0.5 * f64::from(count) * spacing / speed;
    let mut simulation = start(&text.replace("step = 1e-5", &format!("step = {:?}", time / 4000.0)));
    simulation.advance(time).unwrap();
    let particles = &simulation.state().particles;
    let found: Vec<f64> = particles.slot.iter().map(|&slot| particles.velocity[slot as usize][0]).collect();
    let turn = 2.0 * std::f64::consts::PI / f64::from(count);
    for site in 0..count {
        let mut expected = 0.0;
        for wave in 0..count {
            let rate = 2.0 * (stiffness / mass).sqrt() * (0.5 * turn * f64::from(wave)).sin().abs();
            let sum: f64 =
                (0..count).map(|other| pulse(other) * (turn * f64::from(wave * (site - other) % count)).cos()).sum();
            expected += sum / f64::from(count) * (rate * time).cos();
        }
        let found = found[site as usize];
        // The steps of velocity Verlet turn the shortest waves too fast by (rate · step)²/24: 2e-5 of a way of 64 sites.
        assert!((found - expected).abs() < 1e-3 * 1e-4, "{site}: {found} {expected}");
    }
    let top = (0..count).max_by(|a, b| found[*a as usize].total_cmp(&found[*b as usize])).unwrap();
    assert_eq!(top, 20 + 64);
    assert!(found[84] > 0.97e-4, "{}", found[84]);
}

#[test]
fn a_pair_that_drifts_through_the_faces_does_what_it_does_in_the_open() {
    let [law, pair] = ROUGH;
    let drift = [31.0, -17.0, 23.0];
    let list = [
        ([0.05, 0.02, 0.03], 0.01, drift),
        ([0.0695, 0.023, 0.031], 0.008, [0, 1, 2].map(|axis| drift[axis] + [-1.0, 0.4, -0.3][axis])),
    ];
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 0.03\nnormal_stiffness = 1e9\ntangential_stiffness = 5e8\n";
    let run = |periodic: bool, bond: &str| {
        let edges = [[0.09, 0.0, 0.0], [0.03, 0.08, 0.0], [-0.02, 0.03, 0.085]];
        let cell = if periodic { cell(edges, "") } else { String::new() };
        let text = scene(law, pair, &(spheres(&list) + bond + &cell)).replace("[run]", "[run]\nmax_overlap = 0.1");
        let mut simulation = start(&text);
        for _ in 0..40 {
            simulation.advance(1e-3).unwrap();
        }
        let particles = &simulation.state().particles;
        let slots: Vec<usize> = particles.slots().collect();
        let spins: Vec<f64> = slots.iter().flat_map(|&slot| particles.angular_velocity[slot][..3].to_vec()).collect();
        let velocities: Vec<f64> = slots.iter().flat_map(|&slot| particles.velocity[slot][..3].to_vec()).collect();
        let away = simulation
            .state()
            .cell
            .as_ref()
            .map_or(0, |cell| cell.edges_away.iter().flatten().map(|it| it.abs()).sum());
        (spins, velocities, away, simulation.elastic_energy())
    };
    for bond in ["", bond] {
        let (open, closed) = (run(false, bond), run(true, bond));
        assert!(closed.2 > 30, "only {} faces crossed", closed.2);
        assert_all_near(&closed.0, &open.0, 1e-7, "spins");
        assert_all_near(&closed.1, &open.1, 1e-9, "velocities");
        assert!((closed.3 - open.3).abs() <= 1e-6 * open.3.max(1e-12), "{} {}", closed.3, open.3);
    }
}

#[test]
fn gravity_along_an_edge_that_repeats_is_booked_and_a_probe_follows_the_fall() {
    let [law, pair] = SMOOTH;
    let probe = "[probe.grain]\nparticle = 1\n";
    let text = scene(law, pair, &(spheres(&[([0.5, 0.5, 0.5], 0.01, [0.0; 3])]) + probe + &cell(cube(0.6), "")));
    let mut simulation = start(&format!("gravity = [0.0, 0.0, -10.0]\n{text}"));
    simulation.advance(1.0).unwrap();
    assert!(simulation.state().cell.as_ref().unwrap().edges_away[0][2] < -5);
    let place = cograin::averages::sights(&simulation)[0].position[2];
    assert!((place - 0.5 + 5.0).abs() < 1e-9, "{place}");
    let kinetic = simulation.kinetic_energy();
    assert!(simulation.physical_residual().unwrap().abs() < 1e-9 * kinetic);
}

#[test]
fn one_particle_flies_on_for_many_periods() {
    let [law, pair] = SMOOTH;
    let velocity = [120.0, -75.0, 33.0];
    let text = scene(law, pair, &(spheres(&[([0.5, 0.5, 0.5], 0.01, velocity)]) + &cell(cube(1.0), "")));
    let mut simulation = start(&text);
    simulation.advance(1.0).unwrap();
    let state = simulation.state();
    let (slot, cell) = (state.particles.slot[0] as usize, state.cell.as_ref().unwrap());
    for axis in 0..3 {
        let place = state.particles.position[slot][axis] + cell.edges_away[0][axis] as f64;
        assert!((place - 0.5 - velocity[axis]).abs() < 1e-9, "{place}");
        assert!((-0.1..1.1).contains(&state.particles.position[slot][axis]));
    }
    assert_eq!(state.particles.velocity[slot][..3], velocity);
}

#[test]
fn bonds_that_are_made_at_any_time_are_made_across_the_faces() {
    let [law, pair] = ROUGH;
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate = \"always\"\ncreate_distance = 0.0215\nnormal_stiffness = 1e9\ntangential_stiffness = 5e8\n";
    let list = [
        ([0.03, 0.02, 0.03], 0.01, [1.5, 0.3, 0.1]),
        ([0.07, 0.022, 0.031], 0.008, [-0.5, 0.2, 0.0]),
        ([0.052, 0.06, 0.03], 0.009, [0.3, -0.8, 0.0]),
    ];
    // With contacts, and without any.
    for laws in [[law, pair], ["", ""]] {
        let run = |shift: [f64; 3], cell: &str| {
            let list: Vec<_> = list
                .iter()
                .map(|(place, radius, velocity)| ([0, 1, 2].map(|axis| place[axis] + shift[axis]), *radius, *velocity))
                .collect();
            let text = scene(laws[0], laws[1], &(spheres(&list) + bond + cell));
            let text = if laws[0].is_empty() { text.replace("[pair.glass.glass]\n\n", "") } else { text };
            let mut simulation = start(&text.replace("[run]", "[run]\nmax_overlap = 0.1"));
            simulation.advance(0.03).unwrap();
            let particles = &simulation.state().particles;
            let rows: Vec<f64> = particles.slots().flat_map(|slot| particles.velocity[slot][..3].to_vec()).collect();
            (rows, simulation.bonds().len())
        };
        let edges = cell([[0.2, 0.0, 0.0], [0.03, 0.15, 0.0], [-0.02, 0.03, 0.15]], "");
        let open = run([0.0; 3], "");
        assert_eq!(open.1, 2);
        for shift in [[0.15, 0.0, 0.0], [0.0, 0.12, 0.0], [0.14, -0.04, -0.03]] {
            let closed = run(shift, &edges);
            assert_eq!(closed.1, open.1);
            assert_all_near(&closed.0, &open.0, 1e-8, &format!("{shift:?}"));
        }
    }
}

#[test]
fn a_plane_along_the_edges_that_repeat_carries_the_weight() {
    let [law, pair] = ROUGH;
    let mut list = Vec::new();
    for place in 0..27 {
        let at = [place % 3, place / 3 % 3, place / 9].map(f64::from);
        list.push(([0.01 * at[0] + 0.0005 * at[2], 0.01 * at[1], 0.005 + 0.0101 * at[2]], 0.005, [0.0; 3]));
    }
    let floor =
        "[boundary.floor]\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"\n";
    let cell = cell(cube(0.03), "periodic = [\"x\", \"y\"]");
    let text = scene(law, pair, &(spheres(&list) + floor + &cell));
    let damping = "gravity = [0.0, 0.0, -9.81]\n[damping.all]\nlinear = 0.3\nangular = 0.3\ngravity_damped = false\napplied_forces_damped = false\n[run]";
    let mut simulation = start(&text.replace("[run]", damping));
    simulation.advance(0.5).unwrap();
    simulation.advance(0.2).unwrap();
    let weight = 27.0 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.005_f64.powi(3) * 9.81;
    assert_all_near(&[simulation.state().boundaries[0].mean_force[2]], &[-weight], 1e-3, "weight");
}
