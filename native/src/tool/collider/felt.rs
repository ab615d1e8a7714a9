//! What a tool felt in a tick.

use glam::{DMat3, DVec3};

use crate::tool::effort::Effort;

/// What the tool feels, and how it was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Felt {
    /// Force on the tool, N.
    pub force: DVec3,
    /// Torque on the tool about its reference point, N m.
    pub torque: DVec3,
    /// How the force resists a small move of the tool while other tools stay, N/m.
    pub stiffness: DMat3,
    /// Of what it presses, J: its share of the body's, and what springs before its points hold.
    pub energy: f64,
    /// What its force does on the displacements that the body remembers, J.
    pub remembered: f64,
    /// How far the body itself has moved what it presses in this tick, along its force, m.
    pub carried: DVec3,
    /// What its own pushes put into that, were nobody else there, J.
    pub own_energy: f64,
    /// Points that are pressed.
    pub pressed: usize,
    /// Linearisations it took.
    pub linearisations: usize,
    /// All points near were looked at, and displacements stopped changing within the bound.
    pub exact: bool,
    /// What the tick took, of all tools.
    pub effort: Effort,
}

impl Default for Felt {
    /// Nothing felt. A matrix that is not told would be the identity.
    fn default() -> Self {
        Self {
            force: DVec3::ZERO,
            torque: DVec3::ZERO,
            stiffness: DMat3::ZERO,
            energy: 0.0,
            remembered: 0.0,
            carried: DVec3::ZERO,
            own_energy: 0.0,
            pressed: 0,
            linearisations: 0,
            exact: false,
            effort: Effort::default(),
        }
    }
}

/// What came out is no number: no force may be made of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotANumber;
