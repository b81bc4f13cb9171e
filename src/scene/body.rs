//! What a boundary is as a rigid body that forces move.

/// Mass, inertia and support of a boundary. The default is a body that has them from its particles, if it has any, and that
/// nothing holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// Mass of a surface \[kg\]; 0 where the scene gives none.
    pub mass: f64,
    /// Mass centre of a surface at time 0 \[m\].
    pub centre: [f64; 3],
    /// Inertia of a surface about its mass centre, in global axes at time 0 \[kg m²\]; zeros where the scene gives none.
    pub inertia: [[f64; 3]; 3],
    /// Springs to the ground: along x, y, z \[N/m\] and about them \[N m/rad\].
    pub stiffness: [f64; 6],
    /// Dashpots to the ground: along x, y, z \[N s/m\] and about them \[N m s/rad\].
    pub damping: [f64; 6],
}
