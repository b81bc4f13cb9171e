//! What is handed to the thread that writes.

use crate::engine::simulation::{BondRecord, ContactRecord};
use crate::engine::state::{BoundaryState, Break, CellState, Clumps, FacetTraces, Impact, Nodes, Particles, State};
use crate::interface::{Field, Value};
use std::sync::mpsc::SyncSender;

/// One thing to write.
pub(crate) enum Job {
    /// A row of the history.
    Row {
        /// Time \[s\].
        time: f64,
        /// The outputs.
        values: Vec<Value>,
    },
    /// Bonds that broke.
    Breaks(Vec<Break>),
    /// Impacts that ended.
    Impacts(Vec<Impact>),
    /// A frame.
    Frame {
        /// Time \[s\].
        time: f64,
        /// The particles.
        particles: Box<Particles>,
        /// The contacts, if the scene asks for them or for the boundaries.
        contacts: Option<Vec<ContactRecord>>,
        /// The bonds, if the scene has any.
        bonds: Option<Vec<BondRecord>>,
        /// Where the boundaries and their nodes stand, if the scene asks for them.
        boundaries: Option<(Vec<BoundaryState>, Vec<Nodes>)>,
        /// What contacts left on the boundaries, if the scene asks for it and for the boundaries.
        traces: Option<Vec<FacetTraces>>,
        /// The periodic cell, if the scene has one.
        cell: Option<Box<CellState>>,
        /// The clumps, if the scene has any.
        clumps: Option<Box<Clumps>>,
        /// Fields on each grid that has any.
        grids: Vec<Vec<Field>>,
    },
    /// A checkpoint.
    Checkpoint(Box<State>),
    /// Nothing but to tell that it is its turn.
    Tell(SyncSender<()>),
}

impl Job {
    /// The text of a row; nothing for other jobs.
    pub(crate) fn text(&self) -> String {
        match self {
            Self::Row { time, values } => cells(*time, values).join(","),
            _ => String::new(),
        }
    }
}

/// The cells of a row.
pub(super) fn cells(time: f64, values: &[Value]) -> Vec<String> {
    std::iter::once(format!("{time:?}")).chain(values.iter().map(ToString::to_string)).collect()
}
