//! Nodes of meshes that the outside moves: where they stand and what they feel.

use super::check::{StateFault, demand, demand_all, finite};
use super::{Row, clone_in_place};
use serde::{Deserialize, Serialize};

/// The nodes of one mesh, in the order of its vertices. Rows hold x, y, z and a zero. Forces are those *of the particles on the
/// surface*, shared out on the nodes.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Nodes {
    /// The boundary.
    pub boundary: u32,
    /// Displacements since time 0 \[m\].
    #[serde(with = "super::plain")]
    pub displacement: Vec<Row>,
    /// Displacements before the present time step \[m\].
    #[serde(with = "super::plain")]
    pub before: Vec<Row>,
    /// Velocities in the present time step \[m/s\].
    #[serde(with = "super::plain")]
    pub velocity: Vec<Row>,
    /// Displacements where the present communication step began \[m\].
    #[serde(with = "super::plain")]
    pub start: Vec<Row>,
    /// Displacements where it is to end \[m\].
    #[serde(with = "super::plain")]
    pub end: Vec<Row>,
    /// The displacements given last \[m\].
    #[serde(with = "super::plain")]
    pub target: Vec<Row>,
    /// Their rates at the start of the communication step; 0 where none was given \[m/s\].
    #[serde(with = "super::plain")]
    pub target_rate: Vec<Row>,
    /// Displacements when the neighbour lists were made \[m\].
    #[serde(with = "super::plain")]
    pub listed: Vec<Row>,
    /// Forces at the present time \[N\].
    #[serde(with = "super::plain")]
    pub force: Vec<Row>,
    /// Sums of the half-kick impulses of the present communication step \[N s\].
    #[serde(with = "super::plain")]
    pub impulse: Vec<Row>,
    /// Mean forces over the last communication step \[N\].
    #[serde(with = "super::plain")]
    pub mean_force: Vec<Row>,
    /// Largest speed of a node on its way through the communication step \[m/s\].
    pub fastest: f64,
}

clone_in_place!(Nodes {
    boundary,
    displacement,
    before,
    velocity,
    start,
    end,
    target,
    target_rate,
    listed,
    force,
    impulse,
    mean_force,
    fastest
});

impl Nodes {
    /// So many nodes of a boundary, at rest where the scene has them.
    pub(crate) fn at_rest(boundary: u32, count: usize) -> Self {
        let rows = || vec![[0.0; 4]; count];
        Self {
            boundary,
            displacement: rows(),
            before: rows(),
            velocity: rows(),
            start: rows(),
            end: rows(),
            target: rows(),
            target_rate: rows(),
            listed: rows(),
            force: rows(),
            impulse: rows(),
            mean_force: rows(),
            fastest: 0.0,
        }
    }

    /// All columns.
    pub(super) fn columns(&self) -> [&[Row]; 11] {
        let Self { boundary: _, displacement, before, velocity, start, end, target, target_rate, .. } = self;
        let Self { listed, force, impulse, mean_force, fastest: _, .. } = self;
        [displacement, velocity, start, end, target, target_rate, listed, force, impulse, mean_force, before]
            .map(Vec::as_slice)
    }

    /// How far the node that has moved most since the neighbour lists were made is from where it was \[m\].
    pub(crate) fn way_since_listed(&self) -> f64 {
        farthest(&self.displacement, &self.listed)
    }
}

/// The largest distance of a place from that of the same number \[m\].
pub(crate) fn farthest(places: &[Row], others: &[Row]) -> f64 {
    let square = |(a, b): (&Row, &Row)| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>();
    places.iter().zip(others).map(square).fold(0.0, f64::max).sqrt()
}

impl Nodes {
    /// Whether the columns have one length and finite numbers.
    pub(super) fn check(&self) -> Result<(), StateFault> {
        let count = self.target.len();
        let lengths = self.columns().map(|column| column.len() == count);
        demand_all(lengths.into_iter(), "nodes", "columns of one length")?;
        self.columns().into_iter().try_for_each(|column| finite(column, "nodes"))?;
        demand(self.fastest.is_finite() && self.fastest >= 0.0, "nodes", 0, "a speed of 0 or above")
    }
}
