//! The god object: a point that the device drags along but that never enters the rest surface.
//!
//! Free, the proxy is the device, and sweeps decide by exact signs where it meets the surface.
//! Touching, the proxy is held *combinatorially* on a triangle, an edge or a node and walks to the
//! point of the surface that is locally nearest to the device. Around the proxy the surface is a
//! cone; the nearest feature of that cone to the device tells both the way down and, by its
//! pseudonormal, whether the device is on the free side. Signs decide, not distances; the few
//! tolerances below only name what rounding cannot tell apart (on an edge, on the surface).
//!
//! The god object judges; the force comes from the contact point that follows it
//! ([`contact_point`]).

mod contact_point;
mod descent;
mod feel;
mod flight;
mod friction;
mod god_object;
mod place;
mod shading;
mod walk;

pub use feel::Feel;
pub use god_object::Proxy;
pub use place::SurfacePoint;
