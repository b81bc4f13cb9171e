//! The C functions themselves: call orders, refusals, saved states, several instances.

mod arrays;
mod cost;
mod derivatives;
mod environment;
mod frames;
mod host;
mod order;
mod parameters;
mod refusals;
mod starting;
mod states;
mod stepping;
