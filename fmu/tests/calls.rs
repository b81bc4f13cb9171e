//! The C functions themselves: call orders, refusals, saved states, several instances.

mod cost;
mod environment;
mod frames;
mod host;
mod order;
mod parameters;
mod refusals;
mod starting;
mod states;
mod stepping;
