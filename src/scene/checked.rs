//! A scene that has been checked as a whole.

use super::SceneDraft;
use crate::base::lanes::Width;
use crate::laws::bond::Law;
use std::ops::Deref;

/// A scene that can be run. Its parts are those of [`SceneDraft`], to be read and not to be changed.
///
/// A scene comes from a file ([`Scene::read`]), from a text (`text.parse()`), or from a draft ([`SceneDraft::build`]); all three pass the same
/// checks.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What was checked.
    draft: SceneDraft,
}

impl Scene {
    /// A draft that has passed every check, or one that differs from a checked scene by what no check looks at.
    pub(crate) fn of_checked(draft: SceneDraft) -> Self {
        Self { draft }
    }

    /// Its parts, to make another scene of them.
    pub fn into_draft(self) -> SceneDraft {
        self.draft
    }

    /// A bond law in numbers.
    pub fn bond_law(&self, bond: usize) -> Law {
        self.bonds[bond].keys.law(self.run.scheme.predicts()).expect("the keys of a scene have been checked")
    }

    /// The same scene for so many threads; `None`: as many as the machine offers. The results are the same.
    pub fn with_threads(mut self, threads: Option<std::num::NonZeroUsize>) -> Self {
        self.draft.run.threads = threads.map(usize::from);
        self
    }

    /// The same scene in this lane width; `None`: the widest that the processor offers. The results are the same.
    pub fn with_width(mut self, width: Option<Width>) -> Self {
        self.draft.run.width = width;
        self
    }
}

impl Deref for Scene {
    type Target = SceneDraft;

    fn deref(&self) -> &SceneDraft {
        &self.draft
    }
}
