//! What limits the time step, and how it is told.

use crate::engine::state::GONE;

/// The interaction that limits the time step, and how its bodies move against it.
#[derive(Clone, Debug, PartialEq)]
pub struct Limiter {
    /// A contact or bond, at work or to come.
    pub kind: LimiterKind,
    /// One particle: index into the scene's particles.
    pub first: u32,
    /// The other particle: index into the scene's particles.
    pub second: Option<u32>,
    /// The boundary that stands for the other particle: index in the scene.
    pub boundary: Option<u32>,
    /// How the bodies move.
    pub mode: Mode,
}

impl Limiter {
    /// Heat: no body has more in it than the whole network.
    pub(crate) const HEAT: Self =
        Self { kind: LimiterKind::Heat, first: GONE, second: None, boundary: None, mode: Mode::Normal };

    /// In words, with what particles and boundaries are called.
    pub fn words(&self, number: impl Fn(u32) -> u32, boundary: impl Fn(u32) -> String) -> String {
        if self.kind == LimiterKind::Heat {
            return self.kind.words().to_owned();
        }
        if let (LimiterKind::Support, Some(index)) = (self.kind, self.boundary) {
            return format!("{} of boundary {} to the ground", self.kind.words(), boundary(index));
        }
        let first = number(self.first);
        let bodies = match (self.second, self.boundary) {
            (Some(second), _) => format!("s {first} and {}", number(second)),
            (None, Some(index)) => format!(" {first} and boundary {}", boundary(index)),
            (None, None) => format!(" {first}"),
        };
        format!("{} of particle{bodies}, {}", self.kind.words(), self.mode.words())
    }
}

/// What limits the time step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimiterKind {
    /// A contact.
    Contact,
    /// A contact between near bodies that may come before the next look.
    ComingContact,
    /// An impact of bodies that are not yet near each other.
    Impact,
    /// A bond.
    Bond,
    /// A bond that may be made before the next look.
    ComingBond,
    /// Springs that hold a boundary to the ground.
    Support,
    /// Heat that flows between bodies.
    Heat,
}

impl LimiterKind {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Contact => "the contact",
            Self::ComingContact => "a contact to come",
            Self::Impact => "an impact to come",
            Self::Bond => "the bond",
            Self::ComingBond => "a bond to come",
            Self::Support => "the springs",
            Self::Heat => "the conduction of heat",
        }
    }
}

/// How two bodies move against each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Along the normal or axis.
    Normal,
    /// Across it.
    Tangential,
    /// Twisting about it.
    Torsion,
    /// Bending.
    Bending,
}

impl Mode {
    /// All, in the order of a link's parts.
    pub(super) const ALL: [Self; 4] = [Self::Normal, Self::Tangential, Self::Torsion, Self::Bending];

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Normal => "along the normal",
            Self::Tangential => "across the normal",
            Self::Torsion => "twisting",
            Self::Bending => "bending",
        }
    }
}
