//! Bodies that nobody holds: where such a body is, what bears it, how it comes to rest.
//!
//! The elastic displacement lives in the body's own frame, in which tools and supports are led; the
//! frame moves by what the tick's contact problem says.

pub mod borne;
mod coming_in;
pub mod finger;
pub mod frame;
pub mod free_body;
pub mod placement;
pub mod prop;
pub mod resting;
pub mod settling;
mod to_and_fro;
