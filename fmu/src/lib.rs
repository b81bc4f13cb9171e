//! The FMI 2.0 functions.
