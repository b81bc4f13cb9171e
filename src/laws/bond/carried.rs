//! What a bond carries, for outputs.

use super::breakage::Stress;
use super::formulation::FormulationNeeds;
use super::law::TakeFunctions;
use super::{Law, Pair, Rows};

/// What a bond carries, for outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondLoads {
    /// Distance of the centres at which it bears no normal force \[m\].
    pub rest: f64,
    /// Unit vector from j to i.
    pub axis: [f64; 3],
    /// From the centre of i to the middle of the cross-section \[m\].
    pub arm: [f64; 3],
    /// Area of the cross-section \[m²\].
    pub area: f64,
    /// Force on i without damping: the gradient of the stored energy, which differs from normal and shear force in the second order of
    /// the strains where a formulation says so \[N\].
    pub force: [f64; 3],
    /// Normal force, above 0 when it pushes \[N\].
    pub normal: f64,
    /// Shear force on i \[N\].
    pub shear: [f64; 3],
    /// Torsion on i along the axis \[N m\].
    pub torsion: f64,
    /// Bending torque on i \[N m\].
    pub bending: [f64; 3],
    /// Normal stress with the law's rule for compression \[Pa\].
    pub normal_stress: f64,
    /// Shear stress \[Pa\].
    pub shear_stress: f64,
    /// Elastic energy \[J\].
    pub energy: f64,
    /// Rate at which its elastic force and torques work on the bodies \[W\].
    pub power: f64,
}

impl Law {
    /// What a bond carries at this moment, for outputs: nothing advances, nothing breaks.
    pub fn carried(&self, pair: &Pair, rows: &Rows) -> BondLoads {
        let law = self.elasticity.at_step::<f64>(0.0);
        let functions = self.formulation.visit(FormulationNeeds { rates: true, ..self.asked() }, TakeFunctions);
        let (motion, elastic) = (functions.respond)(&law, pair, rows);
        let loaded = elastic.loaded(&motion);
        let stress: Stress = loaded.stress();
        BondLoads {
            rest: elastic.compression + motion.distance,
            axis: motion.axis.to_array(),
            arm: (pair.connection * -pair.share_i).to_array(),
            area: motion.section.area,
            force: elastic.force.to_array(),
            normal: elastic.normal,
            shear: elastic.shear.to_array(),
            torsion: elastic.torsion,
            bending: elastic.bending.to_array(),
            normal_stress: loaded.normal_stress(&stress, self.compression_share),
            shear_stress: stress.shear,
            energy: elastic.energy,
            power: elastic.force.dot(pair.velocity)
                + elastic.torque_i.dot(pair.spin_i)
                + elastic.torque_j.dot(pair.spin_j),
        }
    }
}
