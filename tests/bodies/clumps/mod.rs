//! Clumps: rigid bodies of several spheres, against closed forms, against groups, and their books and bits.

mod beds;
mod given;
mod motion;
mod scenes;
