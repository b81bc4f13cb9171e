//! The commands: what they leave, what they say, and with which status they end.

mod beyond;
mod broken_off;
mod charts;
mod checks;
mod chosen;
mod economy;
mod faults;
mod folders;
mod ground;
mod hostile;
mod impacts;
mod inputs;
mod protocols;
mod read_back;
mod recipes;
mod refusals;
mod runs;
mod settling;
mod shells;
mod unasked;
