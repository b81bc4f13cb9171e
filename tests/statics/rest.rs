//! Newton's method leads to where time steps end.

use super::scenes::bonded;
use crate::support::start;
use cograin::simulation::Simulation;
use cograin::statics::{Motionless, come_to_rest};
use cograin_sparse::factorise;

/// A bonded beam of spheres along z that is fixed at its lower end, under a weight across it; with this motion of its upper end, if it is
/// to be a group.
fn leaning(counts: [u32; 3], upper: Option<&str>) -> String {
    let text = bonded(counts).replace("[boundary.bottom]", "gravity_damped = true\n\n[boundary.bottom]");
    let text = format!("gravity = [9.81, 0.0, -3.0]\n{text}");
    match upper {
        Some(motion) => text.replace("{ driven = [\"x\", \"z\"] }", motion),
        None => text[..text.find("[boundary.top]").unwrap()].to_owned(),
    }
}

#[test]
fn newtons_method_leads_a_beam_to_where_time_steps_leave_it() {
    let guided = "{ driven = [\"z\"], free = [\"x\", \"y\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }";
    for (counts, upper) in [([1, 1, 6], None), ([2, 2, 4], None), ([1, 1, 6], Some(guided))] {
        let mut simulation = start(&leaning(counts, upper));
        let begun = simulation.state().clone();
        let mut ratios = Vec::new();
        let iterations = come_to_rest(&mut simulation, 1e-7, factorise, &mut |ratio| {
            ratios.push(ratio);
            true
        })
        .unwrap();
        assert!(iterations <= 6 && ratios.len() == iterations + 1, "{iterations} iterations, {ratios:?}");
        let unbalanced = simulation.undamped_unbalanced_force();
        assert!(unbalanced < 1e-6, "{unbalanced}");
        let places = |simulation: &Simulation| -> Vec<[f64; 3]> {
            let particles = &simulation.state().particles;
            let rows = particles.slot.iter().map(|slot| particles.position[*slot as usize]);
            rows.map(|[x, y, z, _]| [x, y, z]).collect()
        };
        let by_newton = places(&simulation);
        simulation.restore(&begun).unwrap();
        let before = places(&simulation);
        simulation.damp_rest(0.7);
        simulation.advance(0.1).unwrap();
        let by_steps = places(&simulation);
        let way = |from: &[[f64; 3]], to: &[[f64; 3]]| {
            let parts = from.as_flattened().iter().zip(to.as_flattened());
            parts.fold(0.0_f64, |most, (from, to)| most.max((to - from).abs()))
        };
        let (off, all) = (way(&by_steps, &by_newton), way(&before, &by_steps));
        assert!(off < 1e-4 * all, "{off} of {all}");
    }
}

#[test]
fn newtons_method_leaves_what_has_no_rest_as_it_was_and_says_why() {
    let dust = "[particles.dust]\nmaterial = \"ice\"\nlist = [{ position = [1.0, 0.0, 0.0], radius = 0.01 }]\n";
    let weak = "[bond.neck.breakage]\nmax_normal_stress = 5.0e3\n";
    for (more, expected) in [(dust, "can move without a load"), (weak, "break")] {
        let text = leaning([1, 1, 5], None);
        let text = match more == dust {
            true => text.replace("[bond.neck]", &format!("{dust}[bond.neck]")),
            false => text.replace("[damping.all]", &format!("{weak}[damping.all]")),
        };
        let mut simulation = start(&text);
        let begun = simulation.state().clone();
        let error: Motionless = come_to_rest(&mut simulation, 1e-7, factorise, &mut |_| true).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
        assert_eq!(*simulation.state(), begun);
    }
}
