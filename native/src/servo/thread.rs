//! The servo's thread and the ends that stay outside of it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use glam::DVec3;
use rtrb::Consumer;
use triple_buffer::{Input, Output};

use crate::body::surface::Body;
use crate::clock::suspension::Suspension;
use crate::clock::timing::Waking;
use crate::creep::shown::Remembered;
use crate::device::{Device, Fault};
use crate::pile::laid::Laid;
use crate::rest::borne::Borne;
use crate::servo::Servo;
use crate::servo::exchange::bodies::Hand;
use crate::servo::exchange::rings::Giver;
use crate::servo::paced::{Paced, locked};
use crate::servo::pressed_patch::PressedPatch;
use crate::servo::recorder::{RING_SECONDS, Recorder};
use crate::servo::settings::{Options, Settings};
use crate::servo::snapshot::{Published, Sample};
use crate::servo::stages::Stages;
use crate::servo::tip::Tip;

/// Longest wait of an exchange of the body for the thread.
const EXCHANGE_SECONDS: Duration = Duration::from_millis(200);

/// Reads of a snapshot until it is of the same tick as the patches.
const SAME_TICK_TRIES: usize = 100;

/// A running servo, seen from outside.
pub struct Running {
    paced: Paced,
    bodies: Mutex<Hand>,
    prop: Mutex<Giver<Laid>>,
    tips: Mutex<Vec<Giver<Tip>>>,
    patches: Mutex<Vec<Output<PressedPatch>>>,
    remembered: Mutex<Output<Remembered>>,
    borne: Mutex<Output<Borne>>,
    settings: Mutex<Input<Settings>>,
    snapshots: Mutex<Output<Published>>,
    samples: Mutex<Consumer<Sample>>,
    recorder: Recorder,
    stages: Arc<Stages>,
    finger_count: usize,
}

impl Running {
    /// Starts a thread for these devices, a finger each; `recorded_ticks` are recorded from the
    /// first one on. Samples are kept of `record_samples` ticks.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(
        body: Arc<Body>,
        devices: Vec<Box<dyn Device>>,
        options: Options,
        settings: Settings,
        record_samples: usize,
        recorded_ticks: usize,
    ) -> std::io::Result<Self> {
        let points = devices.iter().map(|_| Tip::Point).collect();
        let recording = (record_samples, recorded_ticks);
        Self::start_with_tips(body, devices, points, None, options, settings, recording)
    }

    /// The same with a tip for each finger, and the body laid down, from the first tick on.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start_with_tips(
        body: Arc<Body>,
        devices: Vec<Box<dyn Device>>,
        tips: Vec<Tip>,
        laid: Laid,
        options: Options,
        settings: Settings,
        (record_samples, recorded_ticks): (usize, usize),
    ) -> std::io::Result<Self> {
        let finger_count = devices.len();
        let (tape, recorder) =
            Recorder::new((RING_SECONDS * options.rate_hz) as usize * finger_count);
        if recorded_ticks > 0 {
            recorder.start(recorded_ticks * finger_count)?;
        }
        let most_samples = record_samples * finger_count;
        let (mut servo, ends) = Servo::new(body, devices, options, &settings, most_samples);
        for (finger, tip) in servo.fingers.iter_mut().zip(tips) {
            finger.tips.held = tip;
        }
        servo.prop.held = laid;
        servo.tape = Some(tape);
        let stages = servo.stages();
        let paced = Paced::spawn(
            "palpate-servo",
            options.rate_hz,
            Waking::BusyWait,
            move |wake| {
                let run = catch_unwind(AssertUnwindSafe(|| {
                    let mut suspension = Suspension::default();
                    while let Some(now) = wake() {
                        servo.tick(now + suspension.seconds());
                    }
                }));
                servo.park(run.is_err().then_some(Fault::Internal));
            },
        )?;
        Ok(Self {
            paced,
            bodies: Mutex::new(ends.bodies),
            prop: Mutex::new(ends.prop),
            tips: Mutex::new(ends.tips),
            patches: Mutex::new(ends.patches),
            remembered: Mutex::new(ends.remembered),
            borne: Mutex::new(ends.borne),
            settings: Mutex::new(ends.settings),
            snapshots: Mutex::new(ends.snapshots),
            samples: Mutex::new(ends.samples),
            recorder,
            stages,
            finger_count,
        })
    }

    /// Hands new settings to the thread.
    pub fn set(&self, settings: Settings) {
        locked(&self.settings).write(settings);
    }

    /// Hands another body and the settings that belong to it to the thread, waits until that uses
    /// them, and frees the body that it used before.
    ///
    /// Should the thread not get to it within [`EXCHANGE_SECONDS`], the old body is freed with the
    /// next exchange or the end.
    pub fn set_body(&self, body: Arc<Body>, settings: Settings) {
        let mut bodies = locked(&self.bodies);
        let number = bodies.give(body);
        self.set(settings);
        bodies.settle();
        let since = Instant::now();
        while self.published().first().snapshot.body != number {
            if since.elapsed() > EXCHANGE_SECONDS || !self.paced.is_running() {
                return;
            }
            std::thread::sleep(Duration::from_micros(200));
        }
        bodies.forget_older();
    }

    /// Gives a finger another tip, waits until the thread uses it, and frees the one before.
    ///
    /// Should the thread not get to it within [`EXCHANGE_SECONDS`], the old tip is freed with the
    /// next exchange or the end.
    ///
    /// # Errors
    /// The tip, while the thread has not got to several others before it.
    pub fn set_tip(&self, finger: usize, tip: Tip) -> Result<(), Tip> {
        self.hand_over(&mut locked(&self.tips)[finger], tip)
    }

    /// Lays the body down as one that nobody holds, or has it held; the same for the rest.
    ///
    /// # Errors
    /// What was to be laid, while the thread has not got to several before it.
    pub fn lay(&self, laid: Laid) -> Result<(), Laid> {
        self.hand_over(&mut locked(&self.prop), laid)
    }

    fn hand_over<T>(&self, giver: &mut Giver<T>, thing: T) -> Result<(), T> {
        giver.free_old();
        giver.give(thing)?;
        let since = Instant::now();
        while self.paced.is_running() && since.elapsed() < EXCHANGE_SECONDS {
            if giver.free_old() > 0 {
                break;
            }
            std::thread::sleep(Duration::from_micros(200));
        }
        Ok(())
    }

    /// What the body remembers of past forces; see [`Remembered::nodes`].
    pub fn remembered(&self) -> Vec<(u32, DVec3)> {
        locked(&self.remembered).read().nodes().to_vec()
    }

    /// What bears a body that nobody holds, and so many others that it presses; see
    /// [`Borne::nodes`].
    pub fn borne(&self, others: usize) -> Vec<Vec<(u32, DVec3)>> {
        locked(&self.borne).read().of_bodies(1 + others)
    }

    /// The newest tick with the patches of its tools, as far as these are of the same tick.
    pub fn published_with_patches(&self) -> (Published, Vec<PressedPatch>) {
        let mut patches = locked(&self.patches);
        let mut published = self.published();
        let mut newest: Vec<PressedPatch> = Vec::new();
        for _ in 0..SAME_TICK_TRIES {
            newest = patches
                .iter_mut()
                .map(|patch| patch.read().clone())
                .collect();
            // A tool's patch is written just before the tick is told.
            let tick = newest.iter().map(|patch| patch.tick).max().unwrap_or(0);
            if tick <= published.first().snapshot.tick {
                break;
            }
            published = self.published();
        }
        (published, newest)
    }

    /// Fingers that it was started with.
    pub fn finger_count(&self) -> usize {
        self.finger_count
    }

    /// The newest tick.
    pub fn published(&self) -> Published {
        *locked(&self.snapshots).read()
    }

    /// Takes all recorded samples out of the ring.
    pub fn drain(&self) -> Vec<Sample> {
        let mut consumer = locked(&self.samples);
        let count = consumer.slots();
        (0..count).map_while(|_| consumer.pop().ok()).collect()
    }

    /// The recording of every tick.
    pub fn recorder(&self) -> &Recorder {
        &self.recorder
    }

    /// Times of the tick's parts.
    pub fn stages(&self) -> &Stages {
        &self.stages
    }

    /// The thread.
    pub fn paced(&self) -> &Paced {
        &self.paced
    }
}
