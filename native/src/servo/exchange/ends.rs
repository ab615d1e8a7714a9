//! A servo and the other ends of its ways.

use std::sync::Arc;

use rtrb::Consumer;
use triple_buffer::{Input, Output, triple_buffer};

use super::bodies::{Hand, exchange};
use super::rings::{Giver, rings};
use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::control::lending::Lending;
use crate::control::toll::Toll;
use crate::creep::shown::Remembered;
use crate::device::Device;
use crate::engine::Engine;
use crate::pile::laid::Laid;
use crate::rest::borne::Borne;
use crate::servo::Servo;
use crate::servo::finger::Finger;
use crate::servo::pressed_patch::PressedPatch;
use crate::servo::recorder::touched_ring;
use crate::servo::settings::{Options, Settings};
use crate::servo::snapshot::{Published, Sample};
use crate::servo::tip::Tip;

/// The ends of a servo's ways that stay outside of its thread.
pub struct Ends {
    /// Bodies to touch.
    pub bodies: Hand,
    /// Where the body is laid that nobody holds.
    pub prop: Giver<Laid>,
    /// Tips, by finger.
    pub tips: Vec<Giver<Tip>>,
    /// Patches of tools, by finger.
    pub patches: Vec<Output<PressedPatch>>,
    /// Settings.
    pub settings: Input<Settings>,
    /// The newest tick.
    pub snapshots: Output<Published>,
    /// What the body remembers of past forces.
    pub remembered: Output<Remembered>,
    /// What bears a body that nobody holds.
    pub borne: Output<Borne>,
    /// Every tick, as far as there is room.
    pub samples: Consumer<Sample>,
}

impl Servo {
    /// A servo at rest, with as many fingers as devices, one to [`MAX_FINGERS`], points all of them;
    /// and its other ends. As many samples are kept as asked.
    pub fn new(
        body: Arc<Body>,
        devices: Vec<Box<dyn Device>>,
        options: Options,
        settings: &Settings,
        most_samples: usize,
    ) -> (Self, Ends) {
        assert!((1..=MAX_FINGERS).contains(&devices.len()));
        let (bodies, holder) = exchange(body);
        let (settings_in, settings_out) = triple_buffer(settings);
        let before = Published::before_the_start(devices.len());
        let (snapshots_in, snapshots) = triple_buffer(&before);
        let (remembered_in, remembered) = triple_buffer(&Remembered::default());
        let (borne_in, borne) = triple_buffer(&Borne::default());
        let (samples_in, samples) = touched_ring(most_samples);
        let (prop_giver, prop) = rings(None);
        let (mut tips, mut patches) = (Vec::new(), Vec::new());
        let fingers = devices.into_iter().zip(&settings.fingers);
        let fingers = fingers.map(|(device, own)| {
            let (tip_hand, tip_holder) = rings(Tip::Point);
            let (patches_in, patches_out) = triple_buffer(&PressedPatch::default());
            tips.push(tip_hand);
            patches.push(patches_out);
            Finger::new(device, tip_holder, patches_in, own)
        });
        let servo = Self {
            fingers: fingers.collect(),
            bodies: holder,
            prop,
            options,
            settings: settings_out,
            snapshots: snapshots_in,
            samples: samples_in,
            tape: None,
            engine: Engine::default(),
            remembered: remembered_in,
            remembers_nothing: true,
            borne: borne_in,
            nothing_bears: true,
            toll: Toll::default(),
            lending: Lending::default(),
            pressed: 0.0,
            stored: 0.0,
            tick: 0,
            ticked_at: None,
            samples_lost: 0,
            stages: Arc::default(),
        };
        let ends = Ends {
            prop: prop_giver,
            bodies,
            tips,
            patches,
            settings: settings_in,
            snapshots,
            remembered,
            borne,
            samples,
        };
        (servo, ends)
    }
}
