//! Forces of displaced contact points.

pub mod cone;
pub mod cones;
pub mod fading;
pub mod ground;
pub mod mobility;
pub mod touch;
