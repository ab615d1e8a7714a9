//! Devices: the link, the 2DIY, wires with all that goes wrong on them.

mod arrival;
mod codec;
#[path = "../counting/mod.rs"]
mod counting;
mod course;
mod damage;
mod fuzz_link;
#[cfg(unix)]
mod guardian;
mod haply;
mod line;
mod link;
mod link_bench;
mod link_document;
mod orientation;
mod session;
