//! Ways to step that a scene can choose.

/// A way to step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scheme {
    /// What the legend calls it.
    pub name: &'static str,
    /// What the scene says in `[run]`, whole lines.
    pub run: &'static str,
}

/// That of the engines.
pub(crate) const ENGINE: Scheme = Scheme { name: "engine", run: "scheme = \"engine\"" };

/// The default.
pub(crate) const PREDICTED_NORMAL: Scheme = Scheme { name: "predicted_normal", run: "scheme = \"predicted_normal\"" };

/// Springs of second order.
pub(crate) const MIDWAY: Scheme = Scheme { name: "midway", run: "scheme = \"midway\"" };

/// Springs and dashpots of second order.
pub(crate) const PREDICTED: Scheme = Scheme { name: "predicted", run: "scheme = \"predicted\"" };

/// Those that are charted.
pub(crate) const SCHEMES: &[Scheme] = &[ENGINE, PREDICTED_NORMAL, MIDWAY, PREDICTED];

impl Scheme {
    /// What a series or a diagram of this name is called with this scheme.
    pub(crate) fn named(&self, name: &str) -> String {
        format!("{name}, {}", self.name)
    }
}
