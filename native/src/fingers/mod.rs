//! Several fingers on one body.

pub mod press;
pub mod several;
