//! The body: compliance in both forms, displacement of its surface.

#[path = "../bodies/mod.rs"]
mod bodies;
mod compliance;
mod cones;
mod consistent_contact;
mod creep;
