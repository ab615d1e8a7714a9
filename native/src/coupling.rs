//! What keeps a stiff body, a delay and a motor from making energy together.

/// How the body is coupled to a device with motors; a pointer has none and feels the body itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coupling {
    /// Stiffness of the spring between device and body, N/m; infinite for none.
    pub stiffness: f64,
    /// Damping of that spring, N s/m.
    pub damping: f64,
    /// Whether energy that would come out of the contact is taken back (time-domain passivity).
    pub passivity_control: bool,
}

impl Default for Coupling {
    fn default() -> Self {
        Self {
            stiffness: f64::INFINITY,
            damping: 0.0,
            passivity_control: false,
        }
    }
}
