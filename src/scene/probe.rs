//! What a scene looks at beside its boundaries and regions: single particles, sets and contacts, and sums of outputs.

use crate::base::document::{Mistake, keys};
use crate::base::quantity::{ParticleId, SetIndex};
use crate::scene::Particle;

/// `[probe.<name>]`
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Its name in the scene and in the unit's variables.
    pub name: String,
    /// What it looks at.
    pub of: Probed,
}

/// What a probe looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Probed {
    /// A particle.
    Particle(ParticleId),
    /// All particles of a set together.
    Set(SetIndex),
    /// Two particles, where they touch or are bonded.
    Contact([ParticleId; 2]),
}

/// `[derived.<name>]`: the sum of other outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Derived {
    /// Its name in the scene and in the unit's variables.
    pub name: String,
    /// Names of outputs, `*` for any characters.
    pub sum: Vec<String>,
}

keys! {
    /// `[probe.<name>]` as a scene writes it: one of these.
    #[derive(Clone, Debug)]
    pub(crate) struct ProbeKeys {
        /// Number of a particle.
        particle: Option<u32> = "one of three",
        /// Name of a set: its mass centre, all forces on it.
        set: Option<String> = "one of three",
        /// Numbers of two particles, `[id, id]`.
        contact: Option<[u32; 2]> = "one of three",
    }
}

keys! {
    /// `[derived.<name>]` as a scene writes it.
    #[derive(Clone, Debug)]
    pub(crate) struct DerivedKeys {
        /// Names of outputs, of which it is the sum; `*` stands for any characters.
        pub(crate) sum: Vec<String> = "required",
    }
}

impl Probe {
    /// The probe that a scene with these sets writes so; refuses what is wrong, with its key.
    pub(crate) fn of(
        name: &str,
        keys: &ProbeKeys,
        sets: &[String],
        refuse: &mut dyn FnMut(&str, Mistake),
    ) -> Option<Self> {
        let of = match (keys.particle, &keys.set, keys.contact) {
            (Some(id), None, None) => Probed::Particle(ParticleId(id)),
            (None, Some(found), None) => {
                let Some(place) = sets.iter().position(|set| set == found) else {
                    let (found, known) = (found.clone(), sets.to_vec());
                    refuse("set", Mistake::UnknownName { found, kind: "particle set", known });
                    return None;
                };
                Probed::Set(SetIndex(place as u32))
            }
            (None, None, Some(ids)) => Probed::Contact(ids.map(ParticleId)),
            (None, None, None) => {
                let expected = "one of particle = id, set = \"..\" and contact = [id, id]".to_owned();
                refuse("", Mistake::Missing { expected });
                return None;
            }
            _ => {
                let (found, expected) = ("several".to_owned(), "one of particle, set and contact".to_owned());
                refuse("", Mistake::Unexpected { found, expected });
                return None;
            }
        };
        Some(Self { name: name.to_owned(), of })
    }

    /// What speaks against it in a scene with these particles, by ascending id, and so many sets; with its key.
    pub(crate) fn objection(&self, particles: &[Particle], sets: usize) -> Option<(&'static str, Mistake)> {
        let there = |id: &ParticleId| particles.binary_search_by_key(&id.0, |particle| particle.id.0).is_ok();
        let range = || match (particles.first(), particles.last()) {
            (Some(first), Some(last)) => {
                format!("the number of a particle of this scene, from {} to {}", first.id.0, last.id.0)
            }
            _ => "a scene with particles at its start".to_owned(),
        };
        let missing = |id: &ParticleId| Mistake::Unexpected { found: id.0.to_string(), expected: range() };
        match &self.of {
            Probed::Particle(id) => (!there(id)).then(|| ("particle", missing(id))),
            Probed::Set(set) => (set.index() >= sets).then(|| {
                let (found, expected) = (format!("index {}", set.0), format!("an index below {sets}"));
                ("set", Mistake::Unexpected { found, expected })
            }),
            Probed::Contact([a, b]) if a == b => {
                let (found, expected) = (format!("{} twice", a.0), "two particles".to_owned());
                Some(("contact", Mistake::Unexpected { found, expected }))
            }
            Probed::Contact(ids) => ids.iter().find(|id| !there(id)).map(|id| ("contact", missing(id))),
        }
    }
}
