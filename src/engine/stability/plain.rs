//! The product of a small network of contacts between particles with a motion: no groups, nothing that resists turning alone.
//!
//! Arms lie along the normal n. With k along and q across it, the relative velocity s at the contact gives the force
//! f = q s + (k − q) (n · s) n, whose couple about either centre is the arm's length times n × f = q n × s.

use super::network::{Element, Network, UNMOVED};

/// A contact.
struct ContactLink {
    /// Its bodies: places among those that interact; the second may be [`UNMOVED`].
    bodies: [u32; 2],
    /// Unit normal.
    normal: [f64; 3],
    /// From each centre to where the forces act, along the normal \[m\].
    arms: [f64; 2],
    /// Spring along and across the normal \[N/m\].
    stiffness: [f64; 2],
    /// Dashpot along and across the normal \[kg/s\].
    damping: [f64; 2],
}

/// A network of contacts between particles.
pub(super) struct Plain {
    /// The contacts.
    ties: Vec<ContactLink>,
    /// What scales translations \[1/√kg\] and rotations \[1/√(kg m²)\] of each body.
    roots: Vec<[f64; 2]>,
}

impl Plain {
    /// That of a network with these bodies, whose elements have these ends; none where it has more than contacts of particles.
    pub(super) fn of(network: &Network, movers: &[u32], ends_of: &[[u32; 2]]) -> Option<Self> {
        if network.stiffness.resists_turning() || network.damping.resists_turning() {
            return None;
        }
        let roots = movers.iter().map(|&mover| network.roots.get(mover as usize).copied()).collect::<Option<_>>()?;
        let tie = |(place, element): (usize, &Element)| {
            let parts = |[along, across, _, _]: [f64; 4]| [along, across];
            ContactLink {
                bodies: ends_of[place],
                normal: element.normal.map(f64::from),
                arms: element.arms.map(f64::from),
                stiffness: parts(network.stiffness.of(place)),
                damping: parts(network.damping.of(place)),
            }
        };
        Some(Self { ties: network.elements.iter().enumerate().map(tie).collect(), roots })
    }

    /// S(μ) of a motion.
    pub(super) fn multiply(&self, root: f64, motion: &[[f64; 6]], image: &mut [[f64; 6]]) {
        image.fill([0.0; 6]);
        for tie in &self.ties {
            let [first, second] = tie.bodies;
            let (mut slip, mut spin) = self.moved(first, tie.arms[0], motion);
            if second != UNMOVED {
                let (velocity, turn) = self.moved(second, tie.arms[1], motion);
                for k in 0..3 {
                    slip[k] -= velocity[k];
                    spin[k] -= turn[k];
                }
            }
            let n = tie.normal;
            let by_spin = cross(spin, n);
            let s = [slip[0] + by_spin[0], slip[1] + by_spin[1], slip[2] + by_spin[2]];
            let [along, across] = [0, 1].map(|k| tie.stiffness[k] + root * tie.damping[k]);
            let pressed = (along - across) * (n[0] * s[0] + n[1] * s[1] + n[2] * s[2]);
            let force: [f64; 3] = std::array::from_fn(|k| across * s[k] + pressed * n[k]);
            let couple = cross(n, force);
            self.load(first, 1.0, tie.arms[0], [force, couple], image);
            if second != UNMOVED {
                self.load(second, -1.0, tie.arms[1], [force, couple], image);
            }
        }
    }

    /// Velocity of a body, and its angular velocity times its arm.
    #[inline(always)]
    fn moved(&self, body: u32, arm: f64, motion: &[[f64; 6]]) -> ([f64; 3], [f64; 3]) {
        let ([v, w], [a, b, c, d, e, f]) = (self.roots[body as usize], motion[body as usize]);
        let turn = w * arm;
        ([v * a, v * b, v * c], [turn * d, turn * e, turn * f])
    }

    /// Adds a force and its couple for an arm of unit length to what a body feels.
    #[inline(always)]
    fn load(&self, body: u32, sign: f64, arm: f64, [force, couple]: [[f64; 3]; 2], image: &mut [[f64; 6]]) {
        let ([v, w], image) = (self.roots[body as usize], &mut image[body as usize]);
        let (v, w) = (sign * v, sign * w * arm);
        for k in 0..3 {
            image[k] += v * force[k];
            image[3 + k] += w * couple[k];
        }
    }
}

/// Vector product.
#[inline(always)]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
