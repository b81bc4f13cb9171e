//! Why a run stopped.

/// Why a run stopped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// A particle would move further in one step than its neighbours were looked for.
    #[error(
        "particle {id} would move {radii:.2} of its radius in one step at t = {time} s; \
         likely a time step above the stable one ({stable:.2e} s), or an overlap at the start"
    )]
    Runaway {
        /// The particle.
        id: u32,
        /// Its way in one step, over its radius.
        radii: f64,
        /// Time \[s\].
        time: f64,
        /// The computed stable step \[s\].
        stable: f64,
    },
    /// A number ceased to be one.
    #[error(
        "particle {id} has a {quantity} that is not finite at t = {time} s; likely a time step above the stable one ({stable:.2e} s)"
    )]
    NotFinite {
        /// The particle.
        id: u32,
        /// What is not finite.
        quantity: &'static str,
        /// Time \[s\].
        time: f64,
        /// The computed stable step \[s\].
        stable: f64,
    },
    /// The centre of a particle is behind a plane.
    #[error(
        "particle {id} went through boundary {boundary} at t = {time} s; likely a load above what its stiffness holds, or a boundary moved too fast"
    )]
    Behind {
        /// The particle.
        id: u32,
        /// The plane.
        boundary: String,
        /// Time \[s\].
        time: f64,
    },
    /// A particle left the domain.
    #[error("particle {id} left the [domain] at t = {time} s, at ({x:.3e}, {y:.3e}, {z:.3e}) m; likely a missing wall")]
    Escaped {
        /// The particle.
        id: u32,
        /// Time \[s\].
        time: f64,
        /// Position \[m\].
        x: f64,
        /// Position \[m\].
        y: f64,
        /// Position \[m\].
        z: f64,
    },
    /// A bond is bent further than its formulation can follow.
    #[error(
        "the bond of particle {first} and {} is bent beyond half a turn at t = {time} s; likely a missing breakage limit",
        second.map_or_else(|| "a plane".to_owned(), |second| format!("particle {second}"))
    )]
    Overbent {
        /// One particle.
        first: u32,
        /// The other; none where it is a plane.
        second: Option<u32>,
        /// Time \[s\].
        time: f64,
    },
    /// The given time step is too long.
    #[error(
        "the time step {step:.3e} s is above the stable one, {stable:.3e} s, at t = {time} s; likely a particle pair or load stiffer than thought; set [run] step below it, or \"auto\""
    )]
    StepTooLong {
        /// The step given \[s\].
        step: f64,
        /// The stable step \[s\].
        stable: f64,
        /// Time \[s\].
        time: f64,
    },
    /// Half a turn or more about several axes at once.
    #[error(
        "boundary {boundary} would turn {angle:.4} rad about several axes in one communication step at t = {time} s; less than half a turn (pi) is right"
    )]
    Turn {
        /// The boundary.
        boundary: String,
        /// The turn \[rad\].
        angle: f64,
        /// Time \[s\].
        time: f64,
    },
    /// Bodies are put in the middle of their way in a scene whose planes remember something.
    #[error(
        "bodies cannot be put in the middle of their way beside boundary {boundary}: what contacts and bonds at a plane remember is not put with them; a scene without planes is right"
    )]
    PutAtPlane {
        /// The plane.
        boundary: String,
    },
    /// Lists that have no room.
    #[error(
        "{pairs:.2e} {why} need about {:.1} GB of memory, and {:.1} GB are free; a shorter one or fewer particles are right",
        needed / 1e9, *free as f64 / 1e9
    )]
    Memory {
        /// How many pairs.
        pairs: f64,
        /// Bytes they need.
        needed: f64,
        /// Bytes that are free.
        free: u64,
        /// Which pairs, and why so many.
        why: String,
    },
    /// A group of a scene that takes over another one's state would have to jump.
    #[error(
        "[boundary.{boundary}] has particle {id} {way:.3e} m from where it has come to; a group of the checkpoint's scene, of the \
         same name and particles, or particles that have not moved are right"
    )]
    GroupElsewhere {
        /// The group.
        boundary: String,
        /// One of its particles.
        id: u32,
        /// How far it would jump \[m\].
        way: f64,
    },
    /// An interval that is no interval.
    #[error("an interval of {interval} s cannot be advanced; a finite number above 0 is right")]
    Interval {
        /// What was asked for \[s\].
        interval: f64,
    },
}
