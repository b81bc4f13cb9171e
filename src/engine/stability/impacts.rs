//! Impacts still to come between bodies that are in no list: of all pairs of materials that can meet, the hardest.
//!
//! Of equal materials the lightest body has the largest root. So each material stands for its two lightest particles (those that an
//! insertion lets come among them) and its largest, for the groups that forces move and for those that nothing moves; each shape of a clump for its lightest and its heaviest. Any two of
//! these can meet, and each can meet every surface; a particle cannot meet itself. Two bodies alone are bounded exactly, with their rolling springs.

use super::System;
use super::limiter::{Limiter, LimiterKind, Mode};
use crate::base::number::Vector;
use crate::engine::bodies::RigidBody;
use crate::engine::bodies::Striker;
use crate::engine::contacts::{Frame, Meeting};
use crate::engine::integration::Fields;
use crate::engine::state::GONE;
use crate::laws::contact::Contact;
use crate::scene::ParticleShape;

/// Turns in which the root of slip and rolling comes down to where it stands.
const TURNS: usize = 12;

/// How many surfaces that stand or are led a sphere may meet at once: two in an edge.
const AT_SURFACES: f64 = 2.0;

/// What meets: a particle, another one, or a boundary.
type ImpactBodies = (u32, Option<u32>, Option<u32>);

/// A body that may meet another one, or a surface.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    /// Index of its material.
    material: u32,
    /// Radius \[m\].
    radius: f64,
    /// Mass that contact laws see \[kg\].
    mass: f64,
    /// 1/mass that it strikes with \[1/kg\].
    per_striking_mass: f64,
    /// Acceleration along the normal by a unit force \[1/kg\].
    shift: f64,
    /// Acceleration of the point of contact by a unit force across \[1/kg\].
    slip: f64,
    /// Angular acceleration by a unit couple \[1/(kg m²)\].
    spin: f64,
    /// Angular acceleration by a unit force across \[1/(kg m)\].
    turn: f64,
    /// A particle of it: index into the scene's particles.
    particle: u32,
    /// Whether it is a sphere by itself.
    is_sphere: bool,
    /// Whether there are others like it.
    has_likes: bool,
}

/// A surface that forces move.
struct MovedSurface {
    /// Accelerations that unit loads give it: of where it is touched \[1/kg\], and angular \[1/(kg m²)\].
    answers: [f64; 2],
    /// The acceleration that its present load gives it \[m/s²\].
    acceleration: f64,
}

/// An impact that can come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impact {
    /// The root \[1/s\].
    pub root: f64,
    /// One particle, the other one and the boundary, as a [`Limiter`] names them.
    bodies: (u32, Option<u32>, Option<u32>),
    /// How the bodies move.
    mode: Mode,
}

impl Impact {
    /// As what limits the time step.
    pub(super) fn limiter(self) -> Limiter {
        let (first, second, boundary) = self.bodies;
        Limiter { kind: LimiterKind::Impact, first, second, boundary, mode: self.mode }
    }
}

impl System<'_> {
    /// The hardest impact at up to twice this speed \[m/s\], with what falling over a radius adds at this acceleration \[m/s²\]; none
    /// where nothing can touch.
    pub(super) fn hardest_impact(&self, speed: f64, acceleration: f64) -> Option<Impact> {
        let mut hardest: Option<Impact> = None;
        self.impacts(speed, acceleration, &mut |bodies, freedoms, parts| {
            let (root, mode) = freedoms.root(parts);
            if root > hardest.map_or(0.0, |most| most.root) {
                hardest = Some(Impact { root, bodies, mode });
            }
        });
        hardest
    }

    /// Whether any impact is stiffer where all is so much `faster` than this \[m/s\].
    pub(crate) fn stiffens(&self, speed: f64, faster: f64) -> bool {
        let all = |speed: f64| {
            let mut all = Vec::new();
            self.impacts(speed, 0.0, &mut |_, _, parts| all.push(parts));
            all
        };
        all(speed) != all(faster * speed)
    }

    /// Tells bodies, freedoms, springs and dashpots of every impact that can come at up to twice this speed \[m/s\], with what
    /// falling over a radius adds.
    fn impacts(&self, speed: f64, acceleration: f64, tell: &mut dyn FnMut(ImpactBodies, Freedoms, [Frame; 2])) {
        let (candidates, surfaces) = (self.candidates(), self.moved_surfaces());
        let closing = |radius: f64| 2.0 * speed + (2.0 * acceleration * radius).sqrt();
        for (place, a) in candidates.iter().enumerate() {
            for b in &candidates[place..] {
                let same = a.is_sphere && b.is_sphere && a.particle == b.particle && a.particle != GONE;
                let alone = same || (std::ptr::eq(a, b) && !a.has_likes);
                let freedoms = Freedoms::of_pair(a, b);
                if alone || freedoms.slip <= 0.0 {
                    continue;
                }
                let closing = closing(a.radius.min(b.radius));
                let energy = 0.5 * closing * closing / (a.per_striking_mass + b.per_striking_mass);
                let contact = contact_of(a, Some(b));
                let meeting =
                    Meeting { materials: (a.material, Some(b.material)), contact, mass: contact.mass, energy };
                let second = Some(b.particle).filter(|second| *second != a.particle);
                for pass in self.passes {
                    pass.impacts(self.state, &meeting, &mut |_, parts| {
                        tell((a.particle, second, None), freedoms, parts);
                    });
                }
            }
            if a.slip <= 0.0 {
                continue;
            }
            let contact = contact_of(a, None);
            let materials = (a.material, None);
            let times = if a.is_sphere { AT_SURFACES } else { 1.0 };
            let energy = 0.5 * closing(a.radius) * closing(a.radius) / a.per_striking_mass;
            let standing = Meeting { materials, contact, mass: a.mass, energy };
            for pass in self.passes {
                pass.impacts(self.state, &standing, &mut |boundary, parts| {
                    if boundary.is_some_and(|boundary| surfaces[boundary as usize].is_none()) {
                        let parts = parts.map(|frame| frame.map(|it| times * it));
                        tell((a.particle, None, boundary), Freedoms::of(a), parts);
                    }
                });
            }
            for (index, surface) in surfaces.iter().enumerate() {
                let Some(surface) = surface else { continue };
                let gained = acceleration.max(surface.acceleration);
                let closing = 2.0 * speed + (4.0 * gained * a.radius).sqrt();
                // Dashpots take the mass of both, which is what answers where they touch; twice it, for the surface may not turn.
                let mass = 2.0 / (a.shift + surface.answers[0]);
                let (radius, section_radius) = (2.0 * contact.radius, 2.0 * contact.section_radius);
                let contact = Contact { mass, radius, section_radius, ..contact };
                let meeting = Meeting { materials, contact, mass: a.mass, energy: 0.5 * mass * closing * closing };
                for pass in self.passes {
                    pass.impacts(self.state, &meeting, &mut |boundary, parts| {
                        if boundary == Some(index as u32) {
                            tell((a.particle, None, boundary), Freedoms::at(a, surface), parts);
                        }
                    });
                }
            }
        }
    }

    /// Of each boundary: the surface, where forces move it.
    fn moved_surfaces(&self) -> Vec<Option<MovedSurface>> {
        let extents = &self.state.neighbours.boundary_extent;
        let surface = |(index, body): (usize, &Option<RigidBody>)| {
            let body = body.as_ref().filter(|body| body.is_free() && body.is_surface())?;
            let (moved, extent) = (&self.state.boundaries[index], extents.get(index).copied().unwrap_or(0.0));
            let answers = body.answers(extent, self.fields.amplification_of(&body.members));
            Some(MovedSurface { answers, acceleration: body.acceleration(moved, extent) })
        };
        self.bodies.iter().enumerate().map(surface).collect()
    }

    /// The bodies that stand for all.
    fn candidates(&self) -> Vec<Candidate> {
        let materials = self.scene.materials.len();
        let particles = &self.state.particles;
        let mut lightest: Vec<[Option<Candidate>; 2]> = vec![[None; 2]; materials];
        let mut largest: Vec<Option<Candidate>> = vec![None; materials];
        let mut still: Vec<Option<Candidate>> = vec![None; materials];
        let mut moved: Vec<Option<Candidate>> = vec![None; materials];
        for slot in 0..particles.len() {
            let material = particles.material[slot];
            let (mass, radius) = (particles.velocity[slot][3], particles.position[slot][3]);
            let Some(owner) = particles.group(slot) else {
                let (two, large) = (&mut lightest[material as usize], &mut largest[material as usize]);
                let is_larger = large.is_none_or(|large| radius > large.radius);
                if is_larger || two[1].is_none_or(|second| mass < second.mass) {
                    let (id, inertia) = (particles.id[slot], particles.angular_velocity[slot][3]);
                    let next = Candidate::sphere(material, id, (radius, mass, inertia), self.fields.amplification(id));
                    put(two, next);
                    *large = if is_larger { Some(next) } else { *large };
                }
                continue;
            };
            if self.bodies.get(owner).is_none_or(|body| body.as_ref().is_some_and(RigidBody::is_free)) {
                continue;
            }
            let next = Candidate::group(material, particles.id[slot], (radius, mass, f64::INFINITY), [0.0; 2]);
            join(&mut still[material as usize], next);
        }
        for insertion in &self.scene.insertions {
            // Clumps are among those that strike.
            for kind in insertion.kinds.iter().filter(|kind| kind.clump.is_none()) {
                let [smallest, most] = kind.sizes.bounds().map(|radius| {
                    let mass = kind.mass(radius);
                    let body = (radius, mass, ParticleShape::Sphere.inertia(mass, radius));
                    Candidate::sphere(insertion.material.0, GONE, body, [1.0; 2])
                });
                for _ in 0..2 {
                    put(&mut lightest[insertion.material.index()], smallest);
                }
                let large = &mut largest[insertion.material.index()];
                *large = large.filter(|large| large.radius >= most.radius).or(Some(most));
            }
        }
        for body in self.bodies.iter().flatten().filter(|body| body.is_free() && !body.is_surface()) {
            let factors = self.fields.amplification_of(&body.members);
            let answers = body.answers(body.farthest + body.largest, factors);
            let mut own: Vec<Option<Candidate>> = vec![None; materials];
            for &member in &body.members {
                let Some(slot) = particles.slot_of(member) else { continue };
                let (mass, radius) = (particles.velocity[slot][3], particles.position[slot][3]);
                let material = particles.material[slot];
                let next = Candidate::group(material, member, (radius, mass, body.mass), answers);
                let (had, own) = (own[material as usize], &mut own[material as usize]);
                join(own, next);
                // Members of one body do not meet.
                *own = own.map(|own| Candidate { has_likes: had.is_some_and(|had| had.has_likes), ..own });
            }
            for (moved, own) in moved.iter_mut().zip(own) {
                if let Some(own) = own {
                    join(moved, own);
                }
            }
        }
        let strikers = self.strikers.iter().map(|it| Some(it.candidate(self.fields)));
        lightest.into_iter().flatten().chain(largest).chain(still).chain(moved).chain(strikers).flatten().collect()
    }
}

impl Striker {
    /// A sphere of a clump that may meet others like it.
    fn candidate(&self, fields: &Fields) -> Candidate {
        let [linear, angular] = fields.amplification(self.particle);
        let [shift, slip] = [self.shift, self.slip].map(|by_arm| linear / self.mass + angular * by_arm);
        let spin = angular * self.spin;
        Candidate {
            material: self.material,
            radius: self.radius,
            mass: self.mass,
            per_striking_mass: 1.0 / self.mass,
            shift,
            slip,
            spin,
            turn: (slip * spin).sqrt(),
            particle: self.particle,
            is_sphere: false,
            has_likes: true,
        }
    }
}

/// Puts a particle among the two lightest.
fn put([first, second]: &mut [Option<Candidate>; 2], next: Candidate) {
    if first.is_none_or(|first| next.mass < first.mass) {
        (*second, *first) = (*first, Some(next));
    } else if second.is_none_or(|second| next.mass < second.mass) {
        *second = Some(next);
    }
}

/// Lets one body stand for two: as large, as heavy and as easily moved as either.
fn join(all: &mut Option<Candidate>, next: Candidate) {
    *all = Some(all.map_or(next, |it| Candidate {
        radius: it.radius.max(next.radius),
        mass: it.mass.max(next.mass),
        per_striking_mass: it.per_striking_mass.min(next.per_striking_mass),
        shift: it.shift.max(next.shift),
        slip: it.slip.max(next.slip),
        spin: it.spin.max(next.spin),
        turn: it.turn.max(next.turn),
        particle: if next.slip > it.slip { next.particle } else { it.particle },
        has_likes: true,
        ..it
    }));
}

/// What a contact law sees of two bodies, or of one at a surface, as they begin to touch.
fn contact_of(a: &Candidate, b: Option<&Candidate>) -> Contact {
    let reduced = |x: f64, y: f64| x * y / (x + y);
    let rolling = |it: &Candidate| it.mass * it.radius * it.radius;
    let contact = Contact { normal: Vector::new(1.0, 0.0, 0.0), ..Contact::zero() };
    match b {
        Some(b) => {
            let radius = reduced(a.radius, b.radius);
            Contact {
                radius,
                mass: reduced(a.mass, b.mass),
                section_radius: 2.0 * radius,
                per_reach: 1.0 / (a.radius + b.radius),
                rolling_inertia: reduced(rolling(a), rolling(b)),
                ..contact
            }
        }
        None => {
            Contact { radius: a.radius, mass: a.mass, section_radius: a.radius, rolling_inertia: rolling(a), ..contact }
        }
    }
}

impl Candidate {
    /// A sphere of this radius \[m\], mass \[kg\] and moment of inertia \[kg m²\], accelerated by so much more than those say.
    fn sphere(
        material: u32,
        particle: u32,
        (radius, mass, inertia): (f64, f64, f64),
        [linear, angular]: [f64; 2],
    ) -> Self {
        let (shift, spin) = (linear / mass, angular / inertia);
        Self {
            material,
            radius,
            mass,
            per_striking_mass: 1.0 / mass,
            shift,
            slip: shift + spin * radius * radius,
            spin,
            turn: spin * radius,
            particle,
            is_sphere: true,
            has_likes: false,
        }
    }

    /// A sphere of a group: its radius \[m\] and mass \[kg\], the mass of the group \[kg\], and how unit loads accelerate it.
    fn group(material: u32, particle: u32, (radius, mass, whole): (f64, f64, f64), [slip, spin]: [f64; 2]) -> Self {
        Self {
            material,
            radius,
            mass,
            per_striking_mass: 1.0 / whole,
            shift: slip,
            slip,
            spin,
            turn: (slip * spin).sqrt(),
            particle,
            is_sphere: false,
            has_likes: false,
        }
    }
}

/// How two bodies answer to unit loads between them.
#[derive(Clone, Copy, Debug)]
struct Freedoms {
    /// Relative acceleration along the normal by a force along it \[1/kg\].
    shift: f64,
    /// Relative acceleration of the points of contact by a force across \[1/kg\].
    slip: f64,
    /// Relative angular acceleration by a couple \[1/(kg m²)\].
    spin: f64,
    /// Relative angular acceleration by a force across, or above \[1/(kg m)\].
    turn: f64,
}

impl Freedoms {
    /// Of a body at what stands still.
    fn of(a: &Candidate) -> Self {
        Self { shift: a.shift, slip: a.slip, spin: a.spin, turn: a.turn }
    }

    /// Of a body at a surface that forces move: about what touches it, that may turn as it likes.
    fn at(a: &Candidate, surface: &MovedSurface) -> Self {
        let [slip, spin] = surface.answers;
        let turn = a.turn + (slip * spin).sqrt();
        Self { shift: a.shift + slip, slip: a.slip + slip, spin: a.spin + spin, turn }
    }

    /// Of two bodies. Slip turns two spheres alike: about that they roll only by their difference.
    fn of_pair(a: &Candidate, b: &Candidate) -> Self {
        let turn = if a.is_sphere && b.is_sphere { (a.turn - b.turn).abs() } else { a.turn + b.turn };
        Self { shift: a.shift + b.shift, slip: a.slip + b.slip, spin: a.spin + b.spin, turn }
    }

    /// The largest root \[1/s\] with these springs and dashpots, and how the bodies then move.
    fn root(&self, [stiffness, damping]: [Frame; 2]) -> (f64, Mode) {
        let of = |k: f64, c: f64| 0.5 * (c + (c * c + 4.0 * k).sqrt());
        let ([kn, kt, kz, kb], [cn, ct, cz, cb]) = (stiffness, damping);
        // From above: from the trace, by a map that grows with the root.
        let mut across = of(kt * self.slip + kb * self.spin, ct * self.slip + cb * self.spin);
        if kb > 0.0 || cb > 0.0 {
            for _ in 0..TURNS {
                let (slipping, rolling) = (kt + across * ct, kb + across * cb);
                let (a, b) = (slipping * self.slip, rolling * self.spin);
                let between = slipping * rolling * self.turn * self.turn;
                let square = 0.5 * (a + b) + (0.25 * (a - b) * (a - b) + between).sqrt();
                across = across.min(square.sqrt());
            }
        }
        let bends = (kb + across * cb) * self.spin > (kt + across * ct) * self.slip;
        let modes = [
            (of(kn * self.shift, cn * self.shift), Mode::Normal),
            (across, if bends { Mode::Bending } else { Mode::Tangential }),
            (of(kz * self.spin, cz * self.spin), Mode::Torsion),
        ];
        modes.into_iter().fold((0.0, Mode::Normal), |most, next| if next.0 > most.0 { next } else { most })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The root by Cholesky's test: the least μ with μ² − S(μ) positive definite.
    fn by_bisection(shift: [f64; 3], [k, c]: [[f64; 2]; 2]) -> f64 {
        let [slip, spin, turn] = shift;
        let holds = |root: f64| {
            let (s, r) = (k[0] + root * c[0], k[1] + root * c[1]);
            let (a, b) = (root * root - s * slip, root * root - r * spin);
            a > 0.0 && a * b > s * r * turn * turn
        };
        let (mut below, mut above) = (0.0, 1e9);
        for _ in 0..200 {
            let middle = 0.5 * (below + above);
            if holds(middle) { above = middle } else { below = middle }
        }
        above
    }

    #[test]
    fn slip_and_rolling_have_the_root_of_their_pair_from_above() {
        for c in [[0.0, 0.0], [0.3, 0.0], [0.3, 2e-5], [0.0, 1e-3]] {
            let (slip, spin, turn) = (1e3, 4e8, 3e5);
            let freedoms = Freedoms { shift: 0.0, slip, spin, turn };
            let (k, parts) = ([1e5, 0.02], [[0.0, 1e5, 0.0, 0.02], [0.0, c[0], 0.0, c[1]]]);
            let (found, expected) = (freedoms.root(parts).0, by_bisection([slip, spin, turn], [k, c]));
            assert!((1.0..1.001).contains(&(found / expected * (1.0 + 1e-12))), "{found} 1/s, {expected} expected");
        }
    }

    #[test]
    fn a_spring_alone_has_the_root_of_the_reduced_mass() {
        let sphere = Candidate::sphere(0, 0, (1e-3, 2.0, 8e-7), [1.0; 2]);
        let freedoms = Freedoms::of_pair(&sphere, &sphere);
        assert_eq!(freedoms.root([[4.0, 0.0, 0.0, 0.0], [0.0; 4]]), (2.0, Mode::Normal));
        // Equal spheres do not roll on each other as they slip.
        assert_eq!(freedoms.turn, 0.0);
    }
}
