//! What is drawn on a body: places in triangles that are curved as cubic Bezier patches, moved many
//! at a time. Not for the tick.

mod cubic_places;

pub use cubic_places::{CONTROLS, CubicPlaces, Patch};
