//! Shading and friction of a touched surface.

use crate::contact::touch::ContactMode;

/// Optional shading and friction of the touched surface; the default is neither.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Feel {
    /// Force shading: facets feel like the smooth surface they stand for.
    pub shading: bool,
    /// Coefficient of friction while the finger sticks.
    pub static_friction: f64,
    /// Coefficient of friction while the finger slips, at most the static one.
    pub dynamic_friction: f64,
    /// Mode in which a contact becomes a force; friction is judged by it.
    pub mode: ContactMode,
}
