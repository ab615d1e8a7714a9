//! Coupling, passivity and the state machine.

#[path = "../bodies/mod.rs"]
mod bodies;
mod coupling;
mod coupling_pull;
mod state;
