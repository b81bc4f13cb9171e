//! Regions, flow meters, insertions, outlets, packings and files beside a periodic cell.

mod averages;
mod flow;
mod packings;
mod scenes;
