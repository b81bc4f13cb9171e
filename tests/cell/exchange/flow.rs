//! Insertions and outlets see images.

use super::scenes::{dense, least_gap, scene, spheres};
use crate::support::{read, start};
use cograin::lanes::Width;

/// Spheres that come into a region across the corner of a cell.
fn filling(more: &str) -> String {
    let rest = format!(
        "[region.corner]\nbox = [[-0.01, -0.045, -0.02], [0.045, 0.0, 0.025]]\n\
         [insertion.feed]\nregion = \"corner\"\nmaterial = \"glass\"\nsizes = {{ uniform = [0.002, 0.004] }}\n{more}\n"
    );
    let apart: Vec<_> = dense().into_iter().take(20).map(|(place, radius, way)| (place, 0.95 * radius, way)).collect();
    scene(&apart, &rest)
}

#[test]
fn what_comes_finds_room_among_images() {
    let mut simulation = start(&filling("mass = 0.05"));
    for _ in 0..20 {
        simulation.advance(5e-5).unwrap();
        let all: Vec<_> = spheres(&simulation).into_iter().map(|(place, radius, _)| (place, radius)).collect();
        // Within 50 µs at 1 m/s nothing comes nearer by more than 0.1 mm.
        assert!(least_gap(&all, [true; 3]) > -0.1);
    }
    let came = simulation.state().exchange.as_ref().unwrap().feeds[0].came;
    assert!(came.count > 30, "{}", came.count);
    for _ in 0..20 {
        simulation.advance(2e-3).unwrap();
    }
    let turnover = simulation.state().ledger.as_ref().unwrap().turnover;
    assert!(simulation.energy_residual().unwrap().abs() < 1e-12 * turnover);
    let cell = simulation.state().cell.as_ref().unwrap();
    assert_eq!(cell.edges_away.len(), simulation.state().particles.slot.len());
}

#[test]
fn what_comes_and_goes_through_the_faces_gives_the_same_bits() {
    let rest = "count_rate = 20000.0\nvelocity = [2.0, -1.0, 0.5]\nscatter = 0.5\n\
                [region.hole]\nbox = [[0.1, -0.05, -0.03], [0.12, -0.02, 0.02]]\n[outlet.out]\nregion = \"hole\"\n\
                [flow_meter.face]\npolygon = [[0.06, -0.1, -0.1], [0.06, 0.1, -0.1], [0.06, 0.1, 0.1], [0.06, -0.1, 0.1]]\n";
    let text = |threads: usize| {
        let motion = "motion = { driven = [\"xx\", \"zz\"], shear = \"xz\" }\n";
        filling(rest).replace("[run]\nstep = 1e-5", &format!("[run]\nthreads = {threads}\nstep = 4e-6")) + motion
    };
    let run = |threads: usize, width: Width, kept: bool| {
        let begin = || {
            let mut simulation = start(&text(threads));
            simulation.set_width(width);
            simulation
        };
        let mut simulation = begin();
        for step in 0..8 {
            simulation.set_strain(0, -0.01 * f64::from(step));
            simulation.set_strain(4, 0.1 * f64::from(step));
            simulation.advance(2e-3).unwrap();
            if kept && step == 4 {
                let state = simulation.state().clone();
                simulation = begin();
                simulation.restore(&state).unwrap();
            }
        }
        simulation.state().clone()
    };
    let first = run(1, Width::widest(), false);
    let exchange = first.exchange.as_ref().unwrap();
    assert!(exchange.outlets[0].count > 10 && exchange.feeds[0].came.count > 50, "{exchange:?}");
    assert!(exchange.meters[0].counts[0] > 10);
    assert!(!first.particles.free.is_empty() || exchange.feeds[0].came.count > exchange.outlets[0].count);
    for (threads, width, kept) in [(3, Width::widest(), false), (1, Width::Least, false), (2, Width::widest(), true)] {
        assert!(run(threads, width, kept) == first, "{threads} threads, {width:?}, restored {kept}");
    }
}

#[test]
fn clumps_come_and_go_through_the_faces_as_spheres_do() {
    let shape = "[clump.pair]\nspheres = [{ position = [0.0, 0.0, 0.0], radius = 0.002 }, { position = [0.003, 0.0, 0.0], radius = 0.002 }]\n";
    let rest = "count_rate = 20000.0\nvelocity = [2.0, -1.0, 0.5]\nscatter = 0.5\n\
                [region.hole]\nbox = [[0.1, -0.05, -0.03], [0.12, -0.02, 0.02]]\n[outlet.out]\nregion = \"hole\"\n\
                [flow_meter.face]\npolygon = [[0.06, -0.1, -0.1], [0.06, 0.1, -0.1], [0.06, 0.1, 0.1], [0.06, -0.1, 0.1]]\n";
    let run = |threads: usize, width: Width, kept: bool| {
        let begin = || {
            let text = filling(rest).replace("[run]\nstep = 1e-5", &format!("[run]\nthreads = {threads}\nstep = 4e-6"));
            let text = text
                .replace("sizes = {", "sizes = { clump = \"pair\",")
                .replace("[region.corner]", &format!("{shape}[region.corner]"));
            let mut simulation = start(&text);
            simulation.set_width(width);
            simulation
        };
        let mut simulation = begin();
        for step in 0..8 {
            simulation.advance(2e-3).unwrap();
            if kept && step == 4 {
                let state = simulation.state().clone();
                simulation = begin();
                simulation.restore(&state).unwrap();
            }
        }
        let turnover = simulation.state().ledger.as_ref().unwrap().turnover;
        assert!(simulation.energy_residual().unwrap().abs() < 1e-12 * turnover);
        simulation.state().clone()
    };
    let first = run(1, Width::widest(), false);
    let exchange = first.exchange.as_ref().unwrap();
    assert!(exchange.feeds[0].came.clumps > 20 && exchange.outlets[0].clumps > 5, "{exchange:?}");
    assert_eq!(first.cell.as_ref().unwrap().edges_away.len(), first.particles.slot.len());
    for (threads, width, kept) in [(3, Width::widest(), false), (1, Width::Least, false), (2, Width::widest(), true)] {
        assert!(run(threads, width, kept) == first, "{threads} threads, {width:?}, restored {kept}");
    }
}

#[test]
fn an_outlet_takes_what_has_an_image_in_it() {
    let outlet = "[region.gate]\nbox = [[0.157, -0.02, 0.0], [0.163, 0.05, 0.045]]\n[outlet.out]\nregion = \"gate\"\n";
    // The gate is the face at x = 0.06 two cells away; one flies along it, the other through it.
    let list = [([0.03, 0.0, 0.02], 0.002, [0.0, 1.0, 0.0]), ([0.02, 0.0, 0.02], 0.002, [1.0, 0.0, 0.0])];
    let mut simulation = start(&scene(&list, outlet));
    for _ in 0..20 {
        simulation.advance(2e-3).unwrap();
    }
    let exchange = simulation.state().exchange.as_ref().unwrap();
    assert_eq!(exchange.outlets[0].count, 1);
    assert_eq!(simulation.state().particles.slots().count(), 1);
    let refused = read(&scene(&list, "[outlet.all]\nbeyond = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n"));
    assert!(refused.unwrap_err().contains("one that crosses them"));
}
