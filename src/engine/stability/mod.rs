//! How long a time step may be.
//!
//! Velocity Verlet with forces that see the half-step velocity is stable exactly while 4 M − 2 Δt C − Δt² K is positive
//! definite (M masses and moments of inertia, C dashpots, K stiffnesses of the whole network), that is while 2/Δt is above
//! the largest root μ of det(μ² M − μ C − K). If there are contacts alone, [`blocks`] bounds the root from the safe side, and
//! [`cluster`] takes the bodies together that limit it; a given step far below that bound needs no more than the blocks. If there are bonds, [`lanczos`] finds it with a certificate. The passes foresee contacts and bonds still to come
//! ([`SearchLimits`]), [`impacts`] foresees pairs that are not yet near each other. `docs/stability.md` describes all of it.

mod blocks;
mod bonded_motion;
mod cluster;
mod ends;
mod impacts;
mod impedance;
mod lanczos;
mod limiter;
mod network;
mod plain;
mod shares;
mod triangle;
mod tridiagonal;
mod vibration;

use crate::base::threads::{CHUNK, Context};
use crate::engine::bodies::{RigidBody, Striker};
use crate::engine::contacts::{Kind, Link, Pass, SearchLimits};
use crate::engine::integration::Fields;
use crate::engine::state::{GONE, State};
use crate::scene::{Insertion, Scene};
use impacts::Impact;
pub use limiter::{Limiter, LimiterKind, Mode};
pub(crate) use network::Network;
pub(crate) use vibration::Vibrations;

/// What limits the time step.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// A safe bound of the time step \[s\]; infinite if nothing can be stiff.
    pub safe: f64,
    /// What limits it, if anything does.
    pub by: Option<Limiter>,
}

/// What the stable time step is found from.
#[derive(Clone, Copy)]
pub(crate) struct System<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Where everything stands.
    pub state: &'a State,
    /// Groups that move.
    pub bodies: &'a [Option<RigidBody>],
    /// What stands for bodies of several spheres where impacts are foreseen.
    pub strikers: &'a [Striker],
    /// What acts on each particle by itself.
    pub fields: &'a Fields,
    /// Interactions.
    pub passes: &'a [Box<dyn Pass>],
}

/// What was found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StableStep {
    /// Root μ = 2/Δt of the network, from the safe side \[1/s\].
    pub network: f64,
    /// The body that has it; none where several have it together.
    pub body: Option<usize>,
    /// The same of impacts between bodies that are not yet near each other \[1/s\].
    pub impacts: f64,
}

impl StableStep {
    /// The stable time step \[s\].
    pub(crate) fn safe(&self) -> f64 {
        2.0 / self.network.max(self.impacts)
    }
}

impl<'a> System<'a> {
    /// The stable time step of the network as it may get, and of impacts to come at up to twice this speed \[m/s\].
    /// `guess` is a root found earlier, or 0. `counter` numbers the starts of iterations; it is moved on. Where a time step that is known
    /// to be stable is `enough` \[s\], a quick bound that is not shorter is the answer; otherwise the network is told, too.
    pub(crate) fn find(
        &self,
        ahead: &SearchLimits,
        speed: f64,
        guess: f64,
        enough: f64,
        counter: &mut u64,
        context: &Context,
    ) -> (StableStep, Option<Network<'a>>) {
        let impacts = self.impact(speed, ahead.acceleration).unwrap_or(0.0);
        if enough.is_finite() {
            let (network, body) = self.quick_root(ahead, context);
            if network * enough <= 2.0 {
                return (StableStep { network, body, impacts }, None);
            }
        }
        let network = self.network(ahead, context);
        let (root, body) = if network.elements.is_empty() {
            (0.0, None)
        } else if self.has_bonds(ahead) {
            (lanczos::largest_root(&network, guess, counter, context), None)
        } else {
            cluster::largest_root(&network, guess, context)
        };
        (StableStep { network: root, body, impacts }, Some(network))
    }

    /// The largest root by single bodies \[1/s\], from the safe side, and the body that has it. No interaction is kept.
    fn quick_root(&self, ahead: &SearchLimits, context: &Context) -> (f64, Option<usize>) {
        let bodies = Network::of_bodies(self.state, self.bodies, self.fields);
        let supports = bodies.supports(self.bodies);
        let tell = |tell: &mut dyn FnMut(Link)| {
            self.passes.iter().for_each(|pass| pass.stiffness(self.state, ahead, context, tell));
        };
        blocks::quick_root(&bodies, supports, tell, context)
    }

    /// Whether there are bonds, or are about to be.
    fn has_bonds(&self, ahead: &SearchLimits) -> bool {
        let coming = |window| self.scene.bonds.iter().any(|bond| bond.keys.create.comes_within(window));
        self.state.bonds.iter().any(|list| !list.first.is_empty()) || ahead.window.as_ref().is_some_and(coming)
    }

    /// The network, as it may get.
    fn network(&self, ahead: &SearchLimits, context: &Context) -> Network<'a> {
        Network::of(self.state, self.bodies, self.fields, self.passes, ahead, context)
    }

    /// What a step that was found is limited by, with the network that it was found from, if that was kept.
    pub(crate) fn limiter(
        &self,
        ahead: &SearchLimits,
        speed: f64,
        (found, network): (&StableStep, Option<Network>),
        counter: u64,
        context: &Context,
    ) -> Option<Limiter> {
        if found.impacts > found.network {
            return self.hardest_impact(speed, ahead.acceleration).map(Impact::limiter);
        }
        let network = network.unwrap_or_else(|| self.network(ahead, context));
        if network.elements.is_empty() {
            return None;
        }
        let motion = match found.body {
            Some(body) => blocks::critical_motion(&network, found.network, body, context),
            None => lanczos::critical_motion(&network, found.network, counter, context),
        };
        let shares = |place: usize| lanczos::shares(&network, place, found.network, &motion);
        let larger = |most: (usize, f64), next: (usize, f64)| if next.1 > most.1 { next } else { most };
        let all = network.elements.len();
        let largest = |piece: usize| {
            let places = piece * CHUNK..((piece + 1) * CHUNK).min(all);
            places.map(|place| (place, shares(place).iter().sum::<f64>())).reduce(larger)
        };
        let place = context.collect(all.div_ceil(CHUNK), largest).into_iter().flatten().reduce(larger)?.0;
        let parts = shares(place);
        let part = (0..4).reduce(|most, next| if parts[next] > parts[most] { next } else { most })?;
        let (link, mut count) = (std::cell::Cell::new(None), 0);
        for pass in self.passes {
            pass.stiffness(self.state, ahead, context, &mut |told| {
                for _ in network.with_itself(&told).iter().flatten().filter(|link| network.element(link).is_some()) {
                    if count == place {
                        link.set(Some(told));
                    }
                    count += 1;
                }
            });
        }
        let Some(link): Option<Link> = link.get() else {
            // Behind what the passes tell stand the springs to the ground.
            let boundary = network.supported(place)?;
            let mode = if part < 2 { Mode::Normal } else { Mode::Torsion };
            return Some(Limiter {
                kind: LimiterKind::Support,
                first: GONE,
                second: None,
                boundary: Some(boundary),
                mode,
            });
        };
        let name = |slot: u32| self.state.particles.id[slot as usize];
        Some(Limiter {
            kind: match link.kind {
                Kind::Contact => LimiterKind::Contact,
                Kind::ComingContact => LimiterKind::ComingContact,
                Kind::Bond => LimiterKind::Bond,
                Kind::ComingBond => LimiterKind::ComingBond,
            },
            first: name(link.first),
            second: link.second.map(name),
            boundary: link.boundary,
            mode: Mode::ALL[part],
        })
    }

    /// The root of impacts still to come between bodies that are in no list \[1/s\], if anything can touch.
    pub(crate) fn impact(&self, speed: f64, acceleration: f64) -> Option<f64> {
        self.hardest_impact(speed, acceleration).map(|impact| impact.root)
    }

    /// Largest speed of a particle, of those to come as they come \[m/s\].
    pub(crate) fn fastest(&self) -> f64 {
        let squares = self.state.particles.velocity.iter().map(|v| v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        let coming = self.scene.insertions.iter().map(Insertion::fastest);
        coming.fold(squares.fold(0.0, f64::max).sqrt(), f64::max)
    }
}

/// The speed up to which impacts are to be foreseen, of particles this fast \[m/s\] and boundaries this fast \[m/s\] that may
/// become `faster` times as fast: half of what two of them may meet at.
pub(crate) fn foreseen_speed(particles: f64, boundaries: f64, faster: f64) -> f64 {
    faster * particles.max(0.5 * (particles + boundaries))
}
