//! A serial port that may go and come back.

pub(crate) mod line;
pub mod port;
