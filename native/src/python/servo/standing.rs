//! Settings in force: those that were chosen, and what the devices brought.

use crate::contact::cones::MAX_FINGERS;
use crate::control::coupling::Coupling;
use crate::control::firmness::Firmness;
use crate::device::DeviceFrame;
use crate::python::servo::settings::Chosen;
use crate::servo::settings::FingerSettings;
use crate::servo::settings::Settings;

/// The settings in force.
#[derive(Clone, Copy)]
pub struct Standing {
    pub chosen: Chosen,
    pub brought: [FingerSettings; MAX_FINGERS],
    pub settings: Settings,
}

impl Standing {
    pub fn new(chosen: Chosen, brought: [FingerSettings; MAX_FINGERS]) -> Self {
        let before = Settings {
            fingers: brought,
            ..Settings::new(1.0)
        };
        let settings = chosen.on(&brought, &before);
        Self {
            chosen,
            brought,
            settings,
        }
    }

    pub fn firm(&mut self, firmness: Firmness) -> Settings {
        self.settings.firmness = firmness;
        self.settings
    }

    pub fn choose(&mut self, chosen: Chosen) -> Settings {
        self.chosen = chosen;
        self.settings = chosen.on(&self.brought, &self.settings);
        self.settings
    }

    pub fn bring(&mut self, finger: usize, frame: DeviceFrame, coupling: Coupling) {
        let brought = &mut self.brought[finger];
        (brought.frame, brought.coupling) = (frame, coupling);
        self.settings = self.chosen.on(&self.brought, &self.settings);
    }
}
