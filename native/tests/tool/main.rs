//! Tools on a body.

#[path = "../bodies/mod.rs"]
mod bodies;
mod complementarity;
mod contact;
#[path = "../counting/mod.rs"]
mod counting;
mod friction;
mod on_cube;
mod several_bodies;
mod shape;
