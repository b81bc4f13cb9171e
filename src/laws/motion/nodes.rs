//! `nodes`: what the nodes of a mesh do, each by itself.

use serde::Deserialize;

/// What the nodes of a mesh do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NodeMotion {
    /// They go with the boundary, which is rigid.
    #[default]
    Rigid,
    /// Each follows its inputs `<boundary>.node[<number>].displacement.<axis>`.
    Driven,
}
