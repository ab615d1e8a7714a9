//! What is drawn: places in triangles that are curved as cubic Bezier patches, moved many at a
//! time; and what of a mesh is at a line or near a point. Not for the tick.

mod cubic_places;
mod polygons;

pub use cubic_places::{CONTROLS, CubicPlaces, Patch};
pub use polygons::Polygons;
