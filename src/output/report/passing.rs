//! How many particles a run may have where they come and go, and what each of them adds to files.

use crate::base::number::Vector;
use crate::engine::simulation::Simulation;
use crate::engine::state::InsertedParticle;
use crate::output::results::frames;
use crate::output::results::vtk::EncodeError;
use crate::scene::exchange::Amount;
use crate::scene::packing::generator::{generator_after, uniform};
use crate::scene::{Insertion, Scene};

/// Particles by which sizes are found.
const SAMPLES: u32 = 200;

/// Particles that come and go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ParticleExchange {
    /// How many there are.
    present: f64,
    /// How many may be left at least and, where nothing goes, be there at most.
    pub(crate) counts: [f64; 2],
    /// How many are there in the mean over the run, where nothing goes and all find room.
    pub(crate) mean: f64,
    /// What each adds to a frame and to a checkpoint \[bytes\].
    each: [f64; 2],
}

/// Which files.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Files {
    /// Frames.
    Frame = 0,
    /// Checkpoints.
    Checkpoint = 1,
}

impl ParticleExchange {
    /// What is foretold of so long a time \[s\]; nothing where the number of particles stays.
    pub(crate) fn of(simulation: &Simulation, duration: f64) -> Result<Option<Self>, EncodeError> {
        let scene = simulation.scene();
        if !scene.changes_number() {
            return Ok(None);
        }
        let present = simulation.state().particles.len() as f64;
        let come = |share: fn(Amount) -> f64| -> f64 {
            let of = |insertion: &Insertion| share(insertion.amount) * count(scene, insertion, duration);
            scene.insertions.iter().map(of).sum()
        };
        let mean = present + come(share_present);
        let least = if scene.removes() { 0.0 } else { present };
        Ok(Some(Self { present, counts: [least, present + come(|_| 1.0)], mean, each: each(simulation)? }))
    }

    /// Least and largest size of a file that has this size now \[bytes\].
    pub(crate) fn sizes(&self, files: Files, now: f64) -> [f64; 2] {
        self.counts.map(|count| (now + (count - self.present) * self.each[files as usize]).max(0.0))
    }
}

/// Which share of what comes is there in the mean over the time in which it comes: what a mass lets come may do so at once.
fn share_present(amount: Amount) -> f64 {
    match amount {
        Amount::CountRate(_) | Amount::MassRate(_) => 0.5,
        Amount::Mass(_) => 1.0,
    }
}

/// How many particles an insertion brings in so long a time, spheres of clumps among them, if all find room.
fn count(scene: &Scene, insertion: &Insertion, duration: f64) -> f64 {
    let mut random = generator_after(scene.run.seed, &format!("forecast.{}", insertion.name), 0);
    let mut next = || uniform(&mut random);
    let (mut masses, mut spheres) = (0.0, 0);
    for _ in 0..SAMPLES {
        let (kind, radius) = insertion.draw(&mut next);
        let kind = &insertion.kinds[kind as usize];
        (masses, spheres) = (masses + kind.mass(radius), spheres + kind.spheres());
    }
    let [mean, each] = [masses, spheres as f64].map(|sum| sum / f64::from(SAMPLES));
    each * match insertion.amount {
        Amount::CountRate(rate) => rate * duration,
        Amount::MassRate(rate) => rate * duration / mean,
        Amount::Mass(mass) => mass / mean,
    }
}

/// What a particle adds to a frame and to a checkpoint \[bytes\]: found by some that are put anywhere.
fn each(simulation: &Simulation) -> Result<[f64; 2], EncodeError> {
    let (scene, mut state) = (simulation.scene(), simulation.state().clone());
    let sizes = |state: &crate::engine::state::State| {
        let frame = frames::particles(scene, (&state.particles, scene.has_clumps().then_some(&state.clumps)), None)
            .encode(scene.output.compressed)?
            .len();
        Ok([frame as f64, state.to_bytes(0).len() as f64])
    };
    let before = sizes(&state)?;
    let mut random = generator_after(scene.run.seed, "forecast", 0);
    let declared = vec![0.0; state.particles.declared.len()];
    for number in 0..SAMPLES {
        let [x, y, z, u, v, w] = [(); 6].map(|()| uniform(&mut random));
        let (position, velocity) = (Vector::new(x, y, z).row_with(uniform(&mut random)), [u, v, w, 1.0]);
        let newcomer = InsertedParticle { position, velocity, inertia: 1.0, material: 0, number, declared: &declared };
        state.add_particle(&newcomer, 0, !state.particles.orientation.is_empty());
    }
    let after = sizes(&state)?;
    Ok([0, 1].map(|place| (after[place] - before[place]) / f64::from(SAMPLES)))
}
