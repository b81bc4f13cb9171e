//! Where each sub-model of a law has its numbers: of what is remembered of a contact, and of the coefficients.

/// Which row of what a law remembers is that of each sub-model, for those that remember anything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HistoryPlaces {
    /// The normal model's.
    pub normal: Option<usize>,
    /// The tangential model's.
    pub tangential: Option<usize>,
    /// The rolling model's.
    pub rolling: Option<usize>,
    /// The cohesion model's.
    pub cohesion: Option<usize>,
    /// The scheme's: velocities before.
    pub rates: Option<usize>,
    /// Whose fourth number is the scheme's: the velocity along the normal before.
    pub normal_velocity: Option<usize>,
    /// Of records: velocities that dashpots saw.
    pub seen: Option<usize>,
    /// Of a book of losses: k_t and the force of dashpots.
    pub loads: Option<usize>,
    /// Of a book of losses: what else acted.
    pub other_loads: Option<usize>,
    /// Of losses that warm the bodies: what the contact holds of them.
    pub held: Option<usize>,
    /// Of single impacts: what each lost so far, and, in the row behind it, how it began.
    pub impact: Option<usize>,
}

impl HistoryPlaces {
    /// The rows that end at touch, where a cohesion model acts beyond it.
    pub(super) fn of_touch(&self) -> impl Iterator<Item = usize> {
        [self.normal, self.tangential, self.rolling, self.rates, self.normal_velocity].into_iter().flatten()
    }
}

/// Where the coefficients of each sub-model begin in a row of a law's; those of the normal model and the switches stand
/// first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoefficientPlaces {
    /// The tangential model's.
    pub tangential: usize,
    /// The rolling model's.
    pub rolling: usize,
    /// The cohesion model's.
    pub cohesion: usize,
    /// How many there are in all.
    pub count: usize,
}
