//! What the program computes, held against theory and published numbers: one claim a file.

mod axial_chain;
mod bending_frequencies;
mod bond_energy;
mod cantilever;
mod chain;
mod chung_ooi;
mod cohesion_limits;
mod conservative_block;
mod contact_records;
mod cundall_decay;
mod cundall_frame;
mod elastic_energy;
mod exchange;
mod grazing_energy;
mod hertz_impact;
mod momentum;
mod oblique_impact;
mod pulse;
mod restitution;
mod rigid_rotation;
mod rolling;
mod sjkr;
mod sliding;
mod spin_impact;
mod stage;
mod uniform_drift;
