//! The 2DIY: geometry, bytes, and the device against a board in memory.

mod board;
mod device;
mod faults;
mod no_allocation;
mod protocol;
