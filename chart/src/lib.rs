//! Speed against accuracy and stability, charted by the program itself: each chart is a table and a picture of it.
//!
//! A chart is a row of [`CHARTS`]: a name, what it shows, what it costs, and a function that computes its table.

pub mod charts;
mod error;
pub mod picture;
mod scene;
mod stage;
pub mod table;

pub use charts::{CHARTS, Chart, Drawing, named};
pub use error::ChartError;
pub use scene::SceneChart;
