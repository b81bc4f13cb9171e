//! From text to a scene: what is accepted, what is refused, and packings.

mod packings;
mod texts;
