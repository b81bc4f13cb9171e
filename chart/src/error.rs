//! Why a chart was not drawn.

use cograin::scene::SceneErrors;

/// Why a chart was not drawn.
#[derive(Debug, thiserror::Error)]
pub enum ChartError {
    /// A scene was refused.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
    /// A scene stopped.
    #[error(transparent)]
    Run(#[from] cograin::simulation::RunError),
    /// A scene does not say when it ends.
    #[error("the scene has no [run] end; a chart of it needs one (--set run.end=0.5)")]
    NoEnd,
    /// A file was not written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
}
