//! The god object and the contact point that follows it.

mod adversaries;
#[path = "../bodies/mod.rs"]
mod bodies;
mod feel;
mod friction;
mod god_object;
mod pushes;
mod pushing;
mod thin_parts;
mod through;
