//! Ways to step that a scene can choose.

/// A way to step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scheme {
    /// What the legend calls it.
    pub name: &'static str,
    /// What the scene says in `[run]`, whole lines.
    pub run: &'static str,
}

/// Those that are charted, the default first.
pub(super) const SCHEMES: &[Scheme] = &[
    Scheme { name: "", run: "" },
    Scheme { name: "midway", run: "scheme = \"midway\"" },
    Scheme { name: "predicted", run: "scheme = \"predicted\"" },
];

/// Those of which pictures have diagrams: the curves of `midway` lie on those of `engine` or of `predicted`; tables have them.
pub(super) fn drawn() -> impl Iterator<Item = &'static Scheme> {
    SCHEMES.iter().filter(|scheme| scheme.name != "midway")
}

impl Scheme {
    /// What a series or a diagram of this name is called with this scheme.
    pub(super) fn named(&self, name: &str) -> String {
        if self.name.is_empty() { name.to_owned() } else { format!("{name}, {}", self.name) }
    }
}
