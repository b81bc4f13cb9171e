//! Single impacts, from touch to parting.

use super::{FLOOR, GRAINS, SHEET, after, assert_close, closed, lost, mass, sheet, sum, traces};
use crate::support::Files;
use cograin::simulation::Simulation;
use cograin::state::{Impact, ImpactBin};

/// Each impact is told.
const EVENTS: &str = "[output]\nimpacts = { events = true }\n";

/// Impacts of the last communication step, of a simulation that has made one.
fn impacts(simulation: &Simulation) -> &[Impact] {
    &traces(simulation).impacts
}

/// Two spheres that meet head on at 2 m/s.
fn head_on(restitution: f64) -> Simulation {
    let law = GRAINS.replace("restitution = 0.5", &format!("restitution = {restitution:?}"));
    let law = law.replace("step = 1.0e-6", "step = 1.0e-7");
    let text = format!(
        "{law}{EVENTS}[particles.all]\nmaterial = \"stone\"\nlist = [\n\
         {{ position = [0, 0, 0], radius = 1e-3, velocity = [2.0, 0.0, 0.0] }},\n\
         {{ position = [2.001e-3, 0, 0], radius = 1e-3 }},\n]\n"
    );
    after(&text, Files::new(), 1e-3)
}

#[test]
fn an_impact_of_two_spheres_loses_what_restitution_takes() {
    for restitution in [0.3, 0.8] {
        let simulation = head_on(restitution);
        let [Impact { record, partner, .. }] = impacts(&simulation) else { panic!("one impact") };
        assert_eq!(partner.map(|it| it.index), Some(1));
        // As far as the time step reaches the restitution.
        let loss = 0.5 * (0.5 * mass()) * 2.0 * 2.0 * (1.0 - restitution * restitution);
        assert_close(record.lost[0], loss, 1e-3);
        assert!(record.lost[1].abs() < 1e-12 * loss && record.speed[1] < 1e-12, "{record:?}");
        assert_close(record.lost[0], lost(&simulation), 1e-13);
        assert_close(record.speed[0], 2.0, 1e-13);
    }
}

#[test]
fn an_elastic_impact_has_the_force_and_the_duration_of_hertz() {
    let simulation = head_on(1.0);
    let [Impact { record, .. }] = impacts(&simulation) else { panic!("one impact") };
    // δ = (15 m* v²/(16 E* √R*))^(2/5), F = 4/3 E* √R* δ^(3/2), t = 2.9432 δ/v.
    let (modulus, radius, mass) = (5.0e7 / (1.0 - 0.25 * 0.25) / 2.0, 0.5e-3_f64, 0.5 * mass());
    let depth = (15.0 * mass * 4.0 / (16.0 * modulus * radius.sqrt())).powf(0.4);
    assert_close(record.largest_force, 4.0 / 3.0 * modulus * radius.sqrt() * depth.powf(1.5), 1e-3);
    assert_close(record.duration, 2.9432 * depth / 2.0, 0.01);
}

#[test]
fn impacts_are_counted_by_bodies_and_energy() {
    let simulation = head_on(0.8);
    let [ImpactBin { between, bin, count, lost, largest_force }] = traces(&simulation).bins[..] else {
        panic!("one bin")
    };
    let [impact] = impacts(&simulation) else { panic!("one impact") };
    assert_eq!((between, count, lost), (0, 1, impact.record.lost));
    assert_eq!(largest_force, impact.record.largest_force);
    // Five bins a decade: 3.8 µJ is between 10^(−28/5) = 2.5 µJ and 10^(−27/5) = 4.0 µJ.
    assert!((3.7e-6..3.8e-6).contains(&lost[0]), "{lost:?}");
    assert_eq!(bin, -28);
}

/// A sphere that is thrown at a floor, or several spheres.
fn thrown(floor: &str, files: Files, list: &str) -> Simulation {
    let text = format!("{GRAINS}{EVENTS}[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n{floor}");
    after(&text, files, 1e-3)
}

#[test]
fn a_sphere_that_rolls_over_edges_is_one_impact() {
    let list = "{ position = [-0.3e-3, 0.2e-3, 1.001e-3], radius = 1e-3, velocity = [4.0, 1.0, -1.0] },\n";
    let plane = thrown(FLOOR, Files::new(), list);
    let [on_plane] = impacts(&plane) else { panic!("one impact") };
    assert!(on_plane.record.lost[1] > 0.0 && on_plane.partner.is_none());
    assert_close(on_plane.record.speed[1], 17.0_f64.sqrt(), 1e-12);
    for cells in [2, 40, 80] {
        let mesh = thrown(SHEET, sheet(cells), list);
        let [on_mesh] = impacts(&mesh) else { panic!("{} impacts on {cells} cells", impacts(&mesh).len()) };
        assert_close(on_mesh.record.largest_force, on_plane.record.largest_force, 1e-9);
        assert_close(on_mesh.record.duration, on_plane.record.duration, 1e-9);
        // Where a foot rolls over an edge the book remembers its loads; the last half step is booked at planes alone.
        assert_close(on_mesh.record.lost[0], on_plane.record.lost[0], 0.02);
        assert_close(closed(&mesh), lost(&mesh), 1e-12);
        assert_close(sum(&mesh, 0, |it| &it.normal) + sum(&mesh, 0, |it| &it.tangential), lost(&mesh), 1e-12);
    }
}

#[test]
fn a_sphere_in_a_corner_has_an_impact_with_each_wall() {
    let walls = format!(
        "{FLOOR}[boundary.side]\nrectangle = {{ corner = [0, -5e-3, 0], edges = [[0, 10e-3, 0], [0, 0, 10e-3]] }}\nmaterial = \"stone\"\n"
    );
    let list = "{ position = [1.001e-3, 0, 1.001e-3], radius = 1e-3, velocity = [-1.0, 0.0, -1.0] },\n";
    let simulation = thrown(&walls, Files::new(), list);
    let mut between: Vec<u32> = impacts(&simulation).iter().map(|impact| impact.between).collect();
    between.sort_unstable();
    assert_eq!(between, [0, 1]);
}

#[test]
fn each_sphere_of_a_clump_has_impacts_of_its_own() {
    let text = format!(
        "{GRAINS}{EVENTS}[clump.pair]\nspheres = [{{ position = [0, 0, 0], radius = 1e-3 }}, {{ position = [4e-3, 0, 0], radius = 1e-3 }}]\n\
         [particles.all]\nmaterial = \"stone\"\nclump = \"pair\"\n\
         list = [{{ position = [0.0, 0.0, 1.001e-3], velocity = [0.0, 0.0, -1.0] }}]\n{FLOOR}"
    );
    let simulation = after(&text, Files::new(), 1e-3);
    assert_eq!(impacts(&simulation).len(), 2);
    assert_close(closed(&simulation), lost(&simulation), 1e-12);
    assert_close(
        sum(&simulation, 0, |it| &it.normal) + sum(&simulation, 0, |it| &it.tangential),
        lost(&simulation),
        1e-12,
    );
}

#[test]
fn a_group_has_the_losses_of_its_contacts() {
    let text = format!(
        "{GRAINS}{EVENTS}[particles.all]\nmaterial = \"stone\"\nlist = [{{ position = [0, 0, 3.001e-3], radius = 1e-3, velocity = [0.2, 0.0, -1.0] }}]\n\
         [particles.bed]\nmaterial = \"stone\"\nlist = [{{ position = [0, 0, 1e-3], radius = 1e-3 }}]\n\
         [boundary.bed]\nparticles = {{ set = \"bed\" }}\n"
    );
    let simulation = after(&text, Files::new(), 1e-3);
    assert_eq!(impacts(&simulation).len(), 1);
    assert_close(
        sum(&simulation, 0, |it| &it.normal) + sum(&simulation, 0, |it| &it.tangential),
        lost(&simulation),
        1e-12,
    );
}

#[test]
fn what_touches_at_the_start_has_no_speed_at_touch() {
    let list = "{ position = [0, 0, 0.99e-3], radius = 1e-3, velocity = [0.0, 0.0, 0.05] },\n";
    let simulation = thrown(FLOOR, Files::new(), list);
    let [Impact { record, .. }] = impacts(&simulation) else { panic!("one impact") };
    assert_eq!(record.speed, [0.0; 2]);
    assert!(record.duration > 0.0 && record.largest_force > 0.0);
}
