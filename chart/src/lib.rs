//! Speed against accuracy, charted: tables and their pictures, and the chart of a user's scene over the time step.

mod drawing;
mod error;
pub mod picture;
mod scene;
pub mod table;

pub use drawing::Drawing;
pub use error::ChartError;
pub use scene::SceneChart;
