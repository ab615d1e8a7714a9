//! The state machine: what the servo is doing and why; pure, one transition a tick.
//!
//! `docs/safety.md` has the same table for people. Whatever takes the force away does so in the
//! tick in which it is found; force comes back only by way of [`State::Ramping`].

use crate::device::Fault;
use crate::device::reason::{self, after};

/// State of the servo.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u8)]
pub enum State {
    /// No device yet, or one that is not ready.
    Waiting,
    /// The force is coming back, from nothing.
    Ramping,
    /// The probe is off the surface.
    Free,
    /// The probe presses.
    Touching,
    /// Zero force because of a fault.
    Fault,
    /// Zero force because the user or the device's button wants it.
    Disabled,
    /// The thread does not run.
    #[default]
    Stopped,
}

impl State {
    /// All states, in the order of their numbers.
    pub const ALL: [Self; 7] = [
        Self::Waiting,
        Self::Ramping,
        Self::Free,
        Self::Touching,
        Self::Fault,
        Self::Disabled,
        Self::Stopped,
    ];

    /// Name for people and tests.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Ramping => "ramping",
            Self::Free => "free",
            Self::Touching => "touching",
            Self::Fault => "fault",
            Self::Disabled => "disabled",
            Self::Stopped => "stopped",
        }
    }

    /// Whether force may be given.
    pub const fn may_push(self) -> bool {
        matches!(self, Self::Ramping | Self::Free | Self::Touching)
    }
}

/// A device that was too fast must be slow for this long before there is force again, s.
pub const CALM_SECONDS: f64 = 0.1;
/// After a suspension, ticks must come regularly for this long, s: meanwhile what the line had
/// stored is read, which is older than it seems.
pub const STEADY_SECONDS: f64 = 0.02;

/// Time that a fault lasts after its cause has gone, s.
const fn lasts(fault: Fault) -> f64 {
    match fault {
        Fault::TooFast => CALM_SECONDS,
        Fault::Suspended => STEADY_SECONDS,
        _ => 0.0,
    }
}

/// Findings of one tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Findings {
    /// Something is wrong now.
    pub fault: Option<Fault>,
    /// The device has no position or wants no force; the reason.
    pub waiting: Option<&'static str>,
    /// There is no position in this tick.
    pub blind: bool,
    /// The user wants no force.
    pub switched_off: bool,
    /// A button of the device is held.
    pub button: bool,
    /// The body is another one since this tick.
    pub body_replaced: bool,
    /// The device moves so slowly that force may come back after it was too fast.
    pub calm: bool,
    /// The ramp is through.
    pub ramped: bool,
    /// The probe presses.
    pub touching: bool,
    /// The probe was set down inside of the body.
    pub inside: bool,
}

/// State of the machine, with its reason.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Standing {
    /// The state.
    pub state: State,
    /// The fault while the state is [`State::Fault`].
    pub fault: Option<Fault>,
    /// Why, or empty.
    pub reason: &'static str,
    /// Least time that the fault still lasts, s.
    lasts: f64,
}

impl Standing {
    /// A state with its reason.
    pub const fn new(state: State, reason: &'static str) -> Self {
        Self {
            state,
            fault: None,
            reason,
            lasts: 0.0,
        }
    }

    /// Zero force because of a fault.
    pub const fn fault(fault: Fault) -> Self {
        Self {
            state: State::Fault,
            fault: Some(fault),
            reason: "",
            lasts: lasts(fault),
        }
    }

    /// Whether force may be given in this tick.
    pub fn may_push(&self, found: &Findings) -> bool {
        self.state.may_push() && !found.body_replaced
    }
}

/// Next state of the machine, after a tick of `dt` seconds with these findings.
///
/// The first rule that applies decides: a fault; a fault that still lasts; a device that waits; the
/// user's switch; the device's button; a ramp; touching or free.
pub fn transition(before: &Standing, found: &Findings, dt: f64) -> Standing {
    if let Some(fault) = found.fault {
        return Standing::fault(fault);
    }
    if let Some(fault) = before.fault {
        let left = match fault {
            Fault::TooFast if !found.calm => lasts(fault),
            _ => before.lasts - dt,
        };
        // Half a tick, for the sum of many dt is not exact.
        if left > -0.5 * dt && lasts(fault) > 0.0 {
            return Standing {
                lasts: left,
                ..*before
            };
        }
    }
    if let Some(reason) = found.waiting {
        return Standing::new(State::Waiting, reason);
    }
    if found.switched_off {
        return Standing::new(State::Disabled, reason::SWITCHED_OFF);
    }
    if found.button {
        return Standing::new(State::Disabled, reason::BUTTON);
    }
    if found.body_replaced {
        return Standing::new(State::Ramping, reason::BODY_REPLACED);
    }
    if !before.state.may_push() {
        return Standing::new(State::Ramping, way_back(before));
    }
    if before.state == State::Ramping && !found.ramped {
        return *before;
    }
    if found.touching {
        Standing::new(State::Touching, "")
    } else {
        let reason = if found.inside { reason::INSIDE } else { "" };
        Standing::new(State::Free, reason)
    }
}

/// Reason of a ramp after a state without force.
fn way_back(before: &Standing) -> &'static str {
    match (before.fault, before.state) {
        (Some(fault), _) => after(fault),
        (_, State::Waiting) => reason::READY,
        (_, State::Disabled) if before.reason == reason::BUTTON => reason::RELEASED,
        (_, State::Disabled) => reason::SWITCHED_ON,
        _ => reason::STARTED,
    }
}
