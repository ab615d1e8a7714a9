//! What goes to and fro between the servo's thread and others: bodies, tips, props.

pub mod bodies;
pub mod ends;
pub mod rings;
mod shown;
