//! What makes a motion nonsense.

/// That a time step is below the stable one \[s\]; nothing where nothing is stiff, so that there is none.
fn below(stable: f64) -> String {
    if stable.is_finite() { format!(", though that is below the stable one, {stable:.3e} s") } else { String::new() }
}

/// The cause of a motion that no longer makes sense, with its figures.
#[derive(Clone, Debug, Default, PartialEq, thiserror::Error)]
pub enum Cause {
    /// The program has not searched for it yet.
    #[default]
    #[error("the cause is not known")]
    NotSearched,
    /// The time step is too long.
    #[error("the time step, {step:.3e} s, is above the stable one, {stable:.3e} s")]
    Step {
        /// The time step \[s\].
        step: f64,
        /// The stable one, as last found \[s\].
        stable: f64,
    },
    /// The body is too fast for the time step.
    #[error(
        "its speed, {speed:.3e} m/s, is too high for a time step of {step:.3e} s{}", below(*.stable)
    )]
    Speed {
        /// Speed \[m/s\].
        speed: f64,
        /// The time step \[s\].
        step: f64,
        /// The stable one, as last found \[s\].
        stable: f64,
    },
    /// A particle and a boundary are too fast for the time step.
    #[error("they meet at {speed:.3e} m/s, which is too fast for a time step of {step:.3e} s")]
    Meeting {
        /// Speed of the particle as the boundary sees it \[m/s\].
        speed: f64,
        /// The time step \[s\].
        step: f64,
    },
    /// A force throws the body.
    #[error(
        "the force on it, {force:.3e} N, is too large for its mass: an overlap, a bond made under load or an applied force (the time step is below the stable one)"
    )]
    Force {
        /// Force \[N\].
        force: f64,
    },
    /// Bodies met too fast.
    #[error(
        "they meet at {speed:.3e} m/s, which is more than the stiffness of the contact holds (the time step is below the stable one)"
    )]
    Impact {
        /// Closing speed \[m/s\].
        speed: f64,
    },
    /// Two centres are in one place, so that their contact has no direction.
    #[error("the centres of particles {first} and {second} coincide, where a contact has no direction")]
    Coincident {
        /// One particle.
        first: u32,
        /// The other.
        second: u32,
    },
    /// A load is too large.
    #[error("the load on the contact is above what its stiffness holds (the time step is below the stable one)")]
    Load,
    /// Cohesion pulls bodies into each other.
    #[error("cohesion: its energy density is {ratio:.3} of the effective modulus, and contacts collapse above {bound}")]
    Cohesion {
        /// Energy density over effective modulus.
        ratio: f64,
        /// The bound.
        bound: f64,
    },
    /// A bond is loaded beyond what its formulation follows.
    #[error("its load turns it that far, and no breakage limit ends it (the time step is below the stable one)")]
    Unbroken,
    /// The law itself, or numbers at the end of what is finite.
    #[error("no single cause is seen (time step {step:.3e} s{})", below(*.stable))]
    Unidentified {
        /// The time step \[s\].
        step: f64,
        /// The stable one, as last found \[s\].
        stable: f64,
    },
}
