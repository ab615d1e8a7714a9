//! Whole ticks.

#[path = "../bodies/mod.rs"]
mod bodies;
mod circling;
#[path = "../counting/mod.rs"]
mod counting;
mod coupled;
mod faults_of_fingers;
mod fingers;
mod interrupted;
mod jumps;
mod laid;
mod no_allocation;
mod recorder;
mod scripted;
mod ticks;
mod tools_on_fingers;
