//! Losses as outputs: what each is, and which a scene can have.

use crate::engine::state::Loss;
use crate::laws::contact::Law;
use crate::scene::Scene;

/// Name and description of each of [`Loss::ALL`].
pub(super) const LOSSES: [(&str, &str); Loss::COUNT] = [
    ("energy.lost.normal_damping", "energy that dashpots along the normals of contacts took since the start"),
    ("energy.lost.tangential_damping", "energy that tangential dashpots of contacts took since the start"),
    ("energy.lost.sliding", "energy that friction at its limit took since the start"),
    ("energy.lost.rolling", "energy that rolling resistance took since the start and does not hold as elastic energy"),
    (
        "energy.lost.tangential_stiffness",
        "energy that tangential springs lost by changes of their stiffness since the start; below 0: a gain of the law",
    ),
    (
        "energy.lost.projection",
        "energy of tangential springs that was projected away as contacts turned, since the start",
    ),
    ("energy.lost.parting", "energy that tangential springs still held as bodies parted, since the start"),
    (
        "energy.lost.cohesion",
        "work against attraction since the start, less what normal forces that stick hold as elastic energy",
    ),
    ("energy.lost.plastic", "energy that plastic normal forces took since the start and do not hold as elastic energy"),
    ("energy.lost.bond_damping", "energy that damping and relaxation took of the bonds since the start"),
    ("energy.lost.bond_release", "elastic energy that broken bonds released since the start"),
    ("energy.lost.global_damping", "energy that global damping took since the start"),
    ("energy.lost.drag", "energy that the drag of the fluid took since the start"),
    (
        "energy.lost.removed",
        "kinetic, elastic and potential energy that left with particles since the start, less what came with others",
    ),
];

/// Whether a scene asks for losses and can have this one.
pub(super) fn is_booked(scene: &Scene, loss: Loss) -> bool {
    let contacts = |has: fn(&Law) -> bool| scene.contacts.iter().any(|law| has(&Law::of(&law.choice)));
    let possible = || match loss {
        Loss::NormalDamping => !scene.contacts.is_empty(),
        Loss::TangentialDamping | Loss::Sliding => contacts(Law::has_friction),
        Loss::Rolling => contacts(Law::has_rolling),
        Loss::TangentialStiffness | Loss::Projection | Loss::Parting => contacts(|law| law.spring().is_some()),
        Loss::Cohesion => contacts(|law| law.has_other_force() && !law.is_plastic()),
        Loss::Plastic => contacts(Law::is_plastic),
        Loss::BondDamping => (0..scene.bonds.len()).any(|bond| scene.bond_law(bond).dissipates()),
        Loss::BondRelease => scene.bonds.iter().any(|bond| !bond.keys.breakage.is_empty()),
        Loss::GlobalDamping => !scene.damping.is_empty(),
        Loss::Drag => scene.fluid.is_some(),
        Loss::Removed => scene.changes_number(),
    };
    scene.output.losses && possible()
}
