//! One tick: read, proxy, contact, toll, safety, write, publish. No allocation, no lock.

mod child_thread;
pub mod exchange;
pub mod finger;
pub mod paced;
pub mod pressed_patch;
pub mod recorder;
pub mod settings;
pub mod snapshot;
pub mod stages;
pub mod thread;
pub mod tip;

use std::sync::Arc;
use std::time::Instant;

use rtrb::{Consumer, Producer};
use triple_buffer::{Input, Output, triple_buffer};

use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::ground::{Ground, MOST_TOOLS};
use crate::contact::touch::ContactMode;
use crate::control::toll::Toll;
use crate::creep::shown::Remembered;
use crate::creep::step::Step;
use crate::device::{Device, Fault};
use crate::engine::Engine;
use crate::servo::exchange::{Hand, Holder, exchange};
use crate::servo::finger::{Finger, Followed, Touch};
use crate::servo::pressed_patch::PressedPatch;
use crate::servo::recorder::{Tape, touched_ring};
use crate::servo::settings::{Moment, Options, Settings};
use crate::servo::snapshot::{Published, Sample, Snapshot};
use crate::servo::stages::{Stage, Stages};
use crate::servo::tip::{Tip, TipHand, exchange_tips};

/// The ends of a servo's ways that stay outside of its thread.
pub struct Ends {
    /// Bodies to touch.
    pub bodies: Hand,
    /// Tips, by finger.
    pub tips: Vec<TipHand>,
    /// Patches of tools, by finger.
    pub patches: Vec<Output<PressedPatch>>,
    /// Settings.
    pub settings: Input<Settings>,
    /// The newest tick.
    pub snapshots: Output<Published>,
    /// What the body remembers of past forces.
    pub remembered: Output<Remembered>,
    /// Every tick, as far as there is room.
    pub samples: Consumer<Sample>,
}

/// The loop's body and memory.
pub struct Servo {
    bodies: Holder,
    /// Those that touch it, at least one.
    pub fingers: Vec<Finger>,
    options: Options,
    settings: Output<Settings>,
    snapshots: Input<Published>,
    samples: Producer<Sample>,
    /// Where ticks go while they are recorded.
    pub tape: Option<Tape>,
    engine: Engine,
    remembered: Input<Remembered>,
    remembers_nothing: bool,
    toll: Toll<MAX_FINGERS>,
    tick: u64,
    /// Time of the last tick, s.
    ticked_at: Option<f64>,
    samples_lost: u64,
    stages: Arc<Stages>,
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
        let (samples_in, samples) = touched_ring(most_samples);
        let (mut tips, mut patches) = (Vec::new(), Vec::new());
        let fingers = devices.into_iter().zip(&settings.fingers);
        let fingers = fingers.map(|(device, own)| {
            let (tip_hand, tip_holder) = exchange_tips(Tip::Point);
            let (patches_in, patches_out) = triple_buffer(&PressedPatch::default());
            tips.push(tip_hand);
            patches.push(patches_out);
            Finger::new(device, tip_holder, patches_in, own)
        });
        let servo = Self {
            fingers: fingers.collect(),
            bodies: holder,
            options,
            settings: settings_out,
            snapshots: snapshots_in,
            samples: samples_in,
            tape: None,
            engine: Engine::default(),
            remembered: remembered_in,
            remembers_nothing: true,
            toll: Toll::default(),
            tick: 0,
            ticked_at: None,
            samples_lost: 0,
            stages: Arc::default(),
        };
        let ends = Ends {
            bodies,
            tips,
            patches,
            settings: settings_in,
            snapshots,
            remembered,
            samples,
        };
        (servo, ends)
    }

    /// Times of the tick's parts, for other threads to read.
    pub fn stages(&self) -> Arc<Stages> {
        self.stages.clone()
    }

    /// Does one tick at `now`, s since the start.
    pub fn tick(&mut self, now: f64) {
        let mut since = Instant::now();
        // The body before the settings that belong to it. The exchange keeps it: the end of this
        // tick never frees it.
        let (body, number, body_replaced) = self.bodies.newest();
        let body = Arc::clone(body);
        let (mut settings, options) = (*self.settings.read(), self.options);
        let dt = 1.0 / f64::from(options.rate_hz);
        let creep = creep_of(&settings, &body, dt);
        let relaxed = settings.young_modulus;
        settings.young_modulus *= creep.firmness();
        self.tick += 1;
        let moment = Moment {
            tick: self.tick,
            now,
            dt,
            creep,
            gap: self.ticked_at.replace(now).map_or(0.0, |last| now - last),
            body: &body,
            body_number: number,
            body_replaced,
            settings: &settings,
            options: &options,
        };
        let own = &settings.fingers;
        let readings = each(&mut self.fingers, |k, finger| {
            Some(finger.read(&moment, &own[k]))
        });
        self.stages.end_of(Stage::Read, &mut since);

        let followed = each(&mut self.fingers, |k, finger| {
            Some(finger.follow(&moment, &own[k], readings[k].as_ref()?))
        });
        self.stages.end_of(Stage::Proxy, &mut since);

        let touches = self.feel(&moment, &followed);
        let touches = self.pay(&moment, &touches);
        self.stages.end_of(Stage::Contact, &mut since);

        let shots = each(&mut self.fingers, |k, finger| {
            Some(finger.send(followed[k].as_ref()?, touches[k].as_ref()?))
        });
        (self.toll)
            .sent(&shots.map(|shot| Some(shot.filter(|s| s.state.may_push())?.output_force)));
        self.stages.end_of(Stage::Write, &mut since);
        self.show_memory(moment.tick, relaxed);
        self.publish(&shots, settings.young_modulus);
    }

    /// The contact of each finger with the body.
    fn feel(&mut self, moment: &Moment<'_>, followed: &Each<Followed<'_>>) -> Each<Touch> {
        let settings = moment.settings;
        // The paper couples fingers on nodes alone (10); in its mode each feels as if it were alone.
        let are_several = self.fingers.len() > 1;
        let creeps = !moment.creep.is_none();
        let is_consistent = settings.feel.mode == ContactMode::Consistent;
        let are_coupled = (are_several || creeps) && is_consistent;
        let acts = followed.iter().flatten().any(Followed::acts);
        let mut presses = [None; MAX_FINGERS];
        if are_coupled && (acts || creeps || self.fingers.iter().any(Finger::is_moved)) {
            presses = each(&mut self.fingers, |k, finger| {
                finger.press(followed[k].as_ref()?)
            });
        }
        let mut led = [const { None }; MOST_TOOLS];
        for ((led, finger), followed) in led.iter_mut().zip(&mut self.fingers).zip(followed) {
            *led = (followed.as_ref()).and_then(|followed| finger.lead(followed, are_several));
        }
        let ground = Ground {
            body: moment.body,
            number: moment.body_number,
            young_modulus: settings.young_modulus,
            mobility: None,
            creep: moment.creep,
        };
        let answers = (self.engine).tick(&[ground], &presses, &mut led);
        each(&mut self.fingers, |k, finger| {
            let answer = answers.as_ref().map(|answers| &answers[k]);
            Some(finger.feel(followed[k].as_ref()?, answer))
        })
    }

    /// The contact of each finger with what it pays for sliding.
    fn pay(&mut self, moment: &Moment<'_>, touches: &Each<Touch>) -> Each<Touch> {
        if moment.body_replaced {
            self.toll = Toll::default();
        }
        let pressed = touches.map(|touch| touch.map_or_else(Default::default, |t| t.pressed));
        let brakes = self.toll.take(&pressed, moment.dt);
        each(&mut self.fingers, |k, _| {
            Some(touches[k]?.braked(brakes[k]))
        })
    }

    fn publish(&mut self, shots: &Each<Snapshot>, young_modulus: f64) {
        let published = self.snapshots.input_buffer_mut();
        published.count = self.fingers.len();
        for (number, shot) in shots.iter().flatten().enumerate() {
            published.reports[number] = *self.fingers[number].tell(shot, young_modulus);
            let sample = Sample::of(shot, number as u32);
            if self.samples.push(sample).is_err() {
                self.samples_lost += 1;
            }
            if let Some(tape) = &mut self.tape {
                tape.put(sample);
            }
        }
        published.samples_lost = self.samples_lost;
        self.snapshots.publish();
    }

    /// Publishes what the body remembers, where that is or was anything.
    fn show_memory(&mut self, tick: u64, young_modulus: f64) {
        let memory = &self.engine.memories()[0];
        if !(memory.is_empty() && self.remembers_nothing) {
            (self.remembered.input_buffer_mut()).show(tick, memory, young_modulus);
            self.remembered.publish();
        }
        self.remembers_nothing = memory.is_empty();
    }

    /// Leaves all devices limp and says so.
    pub fn park(&mut self, fault: Option<Fault>) {
        let published = self.snapshots.input_buffer_mut();
        published.count = self.fingers.len();
        published.samples_lost = self.samples_lost;
        for (report, finger) in published.reports.iter_mut().zip(&mut self.fingers) {
            *report = *finger.park(fault);
        }
        self.snapshots.publish();
    }
}

/// How a body gives way with time in a tick of `dt` s: one that does not keep its whole compliance does
/// not, for nobody knows how it moves where it was touched before. Nor does the paper's.
fn creep_of(settings: &Settings, body: &Body, dt: f64) -> Step {
    if body.is_whole() && settings.feel.mode == ContactMode::Consistent {
        settings.creep.step(dt)
    } else {
        Step::default()
    }
}

/// A value of each finger that there is, by number.
type Each<T> = [Option<T>; MAX_FINGERS];

/// A stage of the tick: its value of each finger.
fn each<T>(
    fingers: &mut [Finger],
    mut stage: impl FnMut(usize, &mut Finger) -> Option<T>,
) -> Each<T> {
    std::array::from_fn(|k| stage(k, fingers.get_mut(k)?))
}
