//! How stiff interactions are, and how stiff they may get before anybody looks again: what the stable time step is found
//! from.

use crate::base::number::{Row, Vector};
use crate::engine::contacts::coefficients::overlap_of;
use crate::engine::state::Particles;
use crate::laws::bond::creation::Window;
use crate::laws::contact::{Contact, Law, MOST_HISTORY};

/// How much faster than at the last look anything may become before the next, at least.
pub(crate) const FASTER: f64 = 1.5;

/// A contact without a past.
const NO_HISTORY: [Row; MOST_HISTORY] = [[0.0; 4]; MOST_HISTORY];

/// Stiffness or damping of a contact or bond in its own frame: along the normal, across it \[N/m or kg/s\], against twisting
/// about it and against bending \[N m or N m s\].
pub(crate) type Frame = [f64; 4];

/// What an interaction is to the stable time step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Bodies that touch.
    Contact,
    /// Bodies that may touch soon.
    ComingContact,
    /// Bonded bodies.
    Bond,
    /// Bodies that may be bonded soon.
    ComingBond,
}

/// One interaction as springs and dashpots.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    /// What it is.
    pub kind: Kind,
    /// One particle (slot).
    pub first: u32,
    /// The other particle (slot), or none at a boundary that is not a particle.
    pub second: Option<u32>,
    /// That boundary.
    pub boundary: Option<u32>,
    /// Unit normal, from the second to the first.
    pub normal: Vector,
    /// Arms at the first and the second particle \[m\].
    pub arms: [f64; 2],
    /// Stiffness.
    pub stiffness: Frame,
    /// Damping.
    pub damping: Frame,
}

impl Link {
    /// A contact of these two particles, or of one with a boundary, by a law and its coefficients.
    pub(crate) fn of_contact(
        (first, second, boundary): (u32, Option<u32>, Option<u32>),
        (law, row): (&Law, &[f64]),
        contact: &Contact,
        arms: [f64; 2],
    ) -> Self {
        let [stiffness, damping] = frames(law, row, contact);
        // Slip that is seen with the arms of the undeformed bodies stretches springs by these.
        let missing = if law.undeformed_arms() { 0.5 * contact.overlap.max(0.0) } else { 0.0 };
        Self {
            kind: Kind::Contact,
            first,
            second,
            boundary,
            normal: contact.normal,
            arms: arms.map(|arm| arm + missing),
            stiffness,
            damping,
        }
    }
}

/// Springs and dashpots of a contact.
pub(super) fn frames(law: &Law, row: &[f64], contact: &Contact) -> [Frame; 2] {
    let (response, rolling) = (law.stiffness(row, contact), law.rolling_response(row, contact));
    [
        [
            response.normal_stiffness,
            response.tangential_stiffness,
            rolling.torsional_stiffness,
            rolling.bending_stiffness,
        ],
        [response.normal_damping, response.tangential_damping, rolling.torsional_damping, rolling.bending_damping],
    ]
}

/// Two bodies that are about to touch, or one and a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    /// Indices of their materials; no second one at a surface.
    pub materials: (u32, Option<u32>),
    /// What their law sees as they begin to touch, but for the pair constant.
    pub contact: Contact,
    /// Mass that the pair constant is made of: at a surface that of the particle, even where forces move it \[kg\].
    pub mass: f64,
    /// Kinetic energy that the contact takes up \[J\].
    pub energy: f64,
}

impl Link {
    /// The same without stiffness and damping along the normal: a bond suppresses them.
    pub(crate) fn without_normal(mut self) -> Self {
        (self.stiffness[0], self.damping[0]) = (0.0, 0.0);
        self
    }
}

/// How far ahead the search for stiffnesses looks.
#[derive(Clone, Debug, Default)]
pub(crate) struct SearchLimits {
    /// Overlaps that grow by no more than this count as if they had \[m\]: certain, whatever moves the bodies.
    pub margin: f64,
    /// Two bodies come no nearer to each other than by this until the next look \[m\].
    pub way: f64,
    /// Largest acceleration by gravity and applied forces and, of what moves by its load sooner than by its speed, by all loads \[m/s²\].
    pub acceleration: f64,
    /// How much faster than now anything may become.
    pub faster: f64,
    /// Largest speed that each boundary has or is about to get, of its particles \[m/s\].
    pub boundaries: Vec<f64>,
    /// The load that each boundary which forces move is not yet held against \[N\]; 0 for others.
    pub loads: Vec<f64>,
    /// Which boundaries forces move: these may turn round and come back.
    pub moved: Vec<bool>,
    /// Largest speed at which a cell that is deformed brings neighbours towards each other \[m/s\].
    pub streaming: f64,
    /// The time steps in which bonds to be made count; none where no bond to come does.
    pub window: Option<Window>,
}

impl SearchLimits {
    /// The largest speed at which a pair may close: as it does now \[m/s\], faster by what may come, by what the boundaries
    /// of its particles get and by a fall through the gap \[m\].
    fn closing_speed(&self, closing: f64, gap: f64, boundary: f64) -> f64 {
        self.faster * (closing.max(0.0) + boundary) + (2.0 * self.acceleration * gap.max(0.0)).sqrt()
    }

    /// What the boundary of a particle (slot) may add to its speed \[m/s\].
    fn of_boundary(&self, particles: &Particles, slot: u32) -> f64 {
        match particles.group(slot as usize) {
            None => 0.0,
            Some(boundary) => {
                let [x, y, z, _] = particles.velocity[slot as usize];
                let now = Vector::new(x, y, z).length();
                self.boundaries.get(boundary).map_or(0.0, |speed| (speed - now).max(0.0))
            }
        }
    }

    /// The contact of two particles as deep as it may get, if it may.
    pub(crate) fn between(
        &self,
        law: &Law,
        row: &[f64],
        contact: &Contact,
        particles: &Particles,
        slots: [u32; 2],
    ) -> Option<Contact> {
        let [i, j] = slots.map(|slot| particles.velocity[slot as usize][3]);
        let boundary = slots.map(|slot| self.of_boundary(particles, slot));
        let away = |slot: u32, normal: Vector| {
            let group = particles.group(slot as usize).filter(|group| self.moves(*group as u32));
            group.map_or(0.0, |_| Vector::from(particles.velocity[slot as usize]).dot(normal).max(0.0))
        };
        let away = away(slots[0], contact.normal) + away(slots[1], contact.normal * -1.0);
        let back = Contact { normal_velocity: contact.normal_velocity - 2.0 * away, ..*contact };
        let group = |slot: u32| particles.group(slot as usize).map_or(0.0, |group| self.load_of(group as u32));
        let load = i.max(j) * self.acceleration + group(slots[0]) + group(slots[1]);
        self.deepest((law, row, &back), (i.max(j), load), boundary[0] + boundary[1] + self.streaming)
    }

    /// The load of a boundary that forces move \[N\].
    fn load_of(&self, boundary: u32) -> f64 {
        self.loads.get(boundary as usize).copied().unwrap_or(0.0)
    }

    /// Whether forces move a boundary.
    pub(crate) fn moves(&self, boundary: u32) -> bool {
        self.moved.get(boundary as usize).is_some_and(|moved| *moved)
    }

    /// The contact of a particle of this velocity \[m/s\] with a boundary of this speed \[m/s\] as deep as it may get, if it may.
    pub(crate) fn at_boundary(
        &self,
        (law, row, contact): (&Law, &[f64], &Contact),
        (particle, now): (Vector, f64),
        boundary: u32,
    ) -> Option<Contact> {
        let speed = self.boundaries.get(boundary as usize).map_or(0.0, |speed| (speed - now).max(0.0));
        // As fast as the surface goes away, its springs or what it strikes may send it back.
        let away =
            if self.moves(boundary) { (contact.normal_velocity - particle.dot(contact.normal)).max(0.0) } else { 0.0 };
        let back = Contact { normal_velocity: contact.normal_velocity - 2.0 * away, ..*contact };
        let load = contact.mass * self.acceleration + self.load_of(boundary);
        self.deepest((law, row, &back), (contact.mass, load), speed)
    }

    /// A contact or near pair, its overlap negative where it has a gap, as deep as it may get; damped as at the turn.
    /// None where it does not touch.
    ///
    /// Whatever the speeds, the overlap grows by no more than the way of both bodies. Where that is more than the margin, it is
    /// bounded by the energy of the closing pair as well: that of the heavier body, for it may be pushed from behind, and by
    /// the work that the load on it does as they are pressed together. This second bound is a heuristic, for others may push too.
    fn deepest(
        &self,
        (law, row, contact): (&Law, &[f64], &Contact),
        (mass, load): (f64, f64),
        boundary: f64,
    ) -> Option<Contact> {
        let overlap = contact.overlap;
        let certain = overlap + self.margin;
        let farthest = overlap + self.way;
        let mut deep = certain.max(0.0);
        if farthest > certain {
            let speed = self.closing_speed(-contact.normal_velocity, -overlap, boundary);
            if (speed > 0.0 || load > 0.0) && farthest > 0.0 {
                let held = |overlap: f64| match overlap > 0.0 {
                    true => law.elastic_energy(row, &Contact { overlap, ..*contact }, 0.0, &NO_HISTORY),
                    false => 0.0,
                };
                let energy = held(overlap) + 0.5 * mass * speed * speed;
                // At rest the margin is above what the energy reaches. Attraction beyond touch has energy that falls, too.
                let work = load * (deep - overlap.max(0.0));
                if energy + work > held(deep) || law.holds_beyond_touch() {
                    deep = deep.max(overlap_of((law, row, contact), [energy, load], farthest));
                }
            }
        }
        (deep > 0.0).then_some(Contact { overlap: deep, normal_velocity: 0.0, ..*contact })
    }
}
