//! The automatic time step follows the moment: what is in contact, and what is about to be.
//!
//! Impacts of two bodies alone need short time steps, for their restitution is that of a spring and a dashpot; in a packing a contact
//! takes up what its neighbours leave it, and a step that is stable is short enough. How long it may be follows from the energy that
//! both have, and from what the laws' own code makes of an impact ([`ErrorCurve`]).

use super::due::{BETWEEN_LOOKS, Seen};
use crate::base::threads::Context;
use crate::engine::boundaries::course;
use crate::engine::contacts::Encounters;
use crate::engine::simulation::Simulation;
use crate::engine::state::Pace;
use crate::laws::contact::impact::{ErrorCurve, Impact, LONGEST_PART};
use crate::scene::Kind;
use crate::scene::{Scene, Step};

/// The longest time step over the stable one where a servo follows what it presses on.
const SERVED_PART: f64 = 0.2;

/// (ω Δt)² over the error of a body's frequency ω on its springs: 24, and less by what higher powers add.
const SPRUNG: f64 = 20.0;

/// (ω Δt)² over the error of the amplitude of a vibration of angular frequency ω that begins with a velocity: velocity Verlet
/// swings it out by 1/√(1 − (ω Δt)²/4). The frequency is off by a third of that.
const SWUNG: f64 = 8.0;

impl Simulation {
    /// The fraction of the stable step that the automatic one takes now; none where it is given.
    pub(crate) fn part_of_stable(&self) -> Option<f64> {
        match self.scene.run.step {
            Step::Given(_) => None,
            Step::Automatic { safety } => Some(safety),
            Step::Following => {
                // Without impacts the longest there is.
                let part = self.errors.longest(self.scene.run.accuracy.error() / self.state.pace.share);
                Some(if self.serves { part.min(SERVED_PART) } else { part })
            }
        }
    }

    /// The time step in which bodies swing on their springs to the ground as accurately as impacts are; infinite where the scene gives
    /// it otherwise \[s\].
    pub(in crate::engine::simulation) fn longest_by_springs(&self) -> f64 {
        if self.scene.run.step != Step::Following {
            return f64::INFINITY;
        }
        let bodies = self.bodies.iter().zip(&self.state.boundaries).filter_map(|(body, moved)| {
            let body = body.as_ref().filter(|body| body.is_free())?;
            Some(body.springs().iter().zip(body.yields(moved)).map(|(k, per_mass)| k * per_mass).fold(0.0, f64::max))
        });
        let square = bodies.fold(0.0, f64::max);
        (SPRUNG * self.scene.run.accuracy.error() / square).sqrt()
    }

    /// The time step in which bonded bodies vibrate as accurately as impacts are; infinite where none vibrates or the scene gives it
    /// otherwise \[s\].
    pub(in crate::engine::simulation) fn longest_by_vibration(&self) -> f64 {
        if self.scene.run.step != Step::Following {
            return f64::INFINITY;
        }
        (SWUNG * self.scene.run.accuracy.error() / self.state.pace.vibration).sqrt()
    }

    /// Impacts of each two materials that can meet.
    pub(crate) fn impacts(&self) -> Vec<Impact> {
        let (mut known, mut impacts) = (Vec::new(), Vec::new());
        let Some(body) = lightest(&self.scene) else { return impacts };
        for pass in &self.passes {
            pass.rows(&self.scene, &mut |found| {
                if !known.contains(&found.key) {
                    known.push(found.key);
                    impacts.extend(Impact::of(found.law, found.row, body));
                }
            });
        }
        impacts
    }

    /// The longest fraction of the stable step that the automatic one takes.
    pub(crate) fn longest_part(&self) -> f64 {
        self.errors.longest(f64::INFINITY)
    }

    /// The fraction of the stable step that impacts of two bodies allow where nothing else is in contact.
    pub(crate) fn part_of_impacts(&self) -> f64 {
        self.errors.longest(self.scene.run.accuracy.error())
    }

    /// Finds out what a time step makes of impacts, where it is to follow them.
    pub(in crate::engine::simulation) fn try_impacts(&mut self) {
        if self.scene.run.step == Step::Following {
            self.errors = ErrorCurve::of(&self.impacts(), self.scene.run.accuracy.error());
        }
    }

    /// Looks at contacts and at those to come, where that is due; boundaries are this fast \[m/s\].
    pub(in crate::engine::simulation) fn look_at_contacts(&mut self, boundaries: f64, context: &Context) -> Seen {
        let due = self.contacts_due(boundaries);
        if due != Seen::Nothing {
            let speed = self.state.clock.speed.max(boundaries);
            self.find_pace(speed, due == Seen::Everything, context);
        }
        due
    }

    /// Looks at contacts and at those to come, of all contacts or of bodies in at most one.
    pub(in crate::engine::simulation) fn find_pace(&mut self, speed: f64, whole: bool, context: &Context) {
        if self.scene.run.step != Step::Following {
            return;
        }
        let mut vibrations = std::mem::take(&mut self.workspace.vibrations);
        let system = self.system();
        let is_bonded = system.is_bonded();
        let vibration = if is_bonded {
            system.find_clusters(&mut vibrations.clusters);
            system.vibration(&mut vibrations)
        } else {
            0.0
        };
        let clusters = is_bonded.then_some(&vibrations.clusters);
        let Self { scene, state, fields, bodies, passes, workspace, .. } = self;
        let speeds = course::speeds(scene, bodies, state, state.clock.step).collect();
        let room = std::mem::take(&mut workspace.contacts);
        // Beyond the lists nothing is seen, and after so many time steps they are looked at again.
        let time = (2.0 * state.neighbours.skin / speed).min(BETWEEN_LOOKS as f64 * LONGEST_PART * state.clock.stable);
        // At the start no stable step is known.
        let time = if time > 0.0 { time } else { f64::INFINITY };
        let mut found = Encounters::of(state, (fields, bodies), (speeds, room), clusters, (whole, time), context);
        for pass in &*passes {
            pass.encounters(state, &mut found);
        }
        let energies = found.energies;
        let packed = if whole { energies.packed } else { state.pace.packed };
        let all = energies.impacts + energies.coming + energies.held + packed;
        let share = if energies.impacts > 0.0 { (energies.impacts / all).min(1.0) } else { 0.0 };
        let whole_at = if whole { state.clock.steps } else { state.pace.whole_at };
        let (until, rebuilds) = (state.clock.time + time, state.clock.rebuilds);
        state.pace = Pace { share, packed, vibration, whole_at, until, rebuilds, speed };
        workspace.contacts = found.into_room();
        workspace.vibrations = vibrations;
    }
}

/// Radius \[m\] and mass \[kg\] of the lightest particle of a scene.
fn lightest(scene: &Scene) -> Option<[f64; 2]> {
    let now = scene.particles.iter().map(|particle| [particle.radius, particle.mass()]);
    let coming = scene.insertions.iter().map(|insertion| insertion.kinds.iter().map(Kind::lightest));
    now.chain(coming.flatten()).reduce(|least, next| if next[1] < least[1] { next } else { least })
}
