//! Columns of a batch: what is known of a contact, then what its normal model makes of it.

/// Overlap.
pub(crate) const OVERLAP: usize = 0;
/// Effective radius.
pub(crate) const RADIUS: usize = 1;
/// Effective mass.
pub(crate) const MASS: usize = 2;
/// Unit normal.
pub(crate) const NORMAL: [usize; 3] = [3, 4, 5];
/// Velocity along it.
pub(crate) const NORMAL_VELOCITY: usize = 6;
/// Slip.
pub(crate) const SLIP: [usize; 3] = [7, 8, 9];
/// Arm at the first body.
pub(crate) const FIRST_ARM: usize = 10;
/// Arm at the second body.
pub(crate) const SECOND_ARM: usize = 11;
/// Relative spin.
pub(crate) const SPIN: [usize; 3] = [12, 13, 14];
/// Area of the section.
pub(crate) const SECTION_AREA: usize = 15;
/// Radius of the linearised section.
pub(crate) const SECTION_RADIUS: usize = 16;
/// k_n.
pub(crate) const NORMAL_STIFFNESS: usize = 17;
/// γ_n.
pub(crate) const NORMAL_DAMPING: usize = 18;
/// k_t.
pub(crate) const TANGENTIAL_STIFFNESS: usize = 19;
/// γ_t.
pub(crate) const TANGENTIAL_DAMPING: usize = 20;
/// Force along the normal.
pub(crate) const FORCE: usize = 21;
/// What of it friction sees.
pub(crate) const SEEN: usize = 22;
/// 1/(R_i + R_j).
pub(crate) const PER_REACH: usize = 23;
/// Moment of inertia of rolling.
pub(crate) const ROLLING_INERTIA: usize = 24;
/// Sum of the spins.
pub(crate) const SPIN_SUM: [usize; 3] = [25, 26, 27];
/// Overlap beyond the offset, of a contact that a bond suppresses or has suppressed.
pub(crate) const PRESSING: usize = 28;
/// The offset.
pub(crate) const OFFSET: usize = 29;
/// Angular velocities times arms; then how far the bodies slipped.
pub(crate) const TURNING: [usize; 3] = [30, 31, 32];
/// 1/distance; then half the turn about the normal.
pub(crate) const PER_DISTANCE: usize = 33;
/// What the normal gained.
pub(crate) const TILT: [usize; 3] = [34, 35, 36];
/// Part of the step in which the bodies touched.
pub(crate) const SHARE: usize = 37;
/// Of a book of losses: the tangential spring before; then, in place of its first component, what of the losses is heat.
pub(crate) const SPRING: [usize; 3] = [38, 39, 40];
/// Of a book of losses: velocity along the normal at mid-step.
pub(crate) const VELOCITY: usize = 41;
/// Of impacts: what is lost along the normal and across it.
pub(crate) const LOST: [usize; 2] = [42, 43];
/// Radius of the circle of contact; then the conductance.
pub(crate) const CONDUCTANCE: usize = 44;
/// How many there are.
pub(crate) const COUNT: usize = 45;
