//! Sessions of a device on the link: where one begins, and which STATE counts.

use crate::device::link::device::{LinkDevice, STALE_SECONDS};
use crate::device::link::doubt::Doubt;
use crate::device::link::freshness::Freshness;
use crate::device::link::messages::{DeviceState, FIRST_PROTOCOL, Message, PROTOCOL, Taken, parse};
use crate::device::link::newest::Newest;
use crate::device::link::sending::FAREWELLS;
use crate::device::serial::wire::Opener;
use crate::device::speedometer::has_begun_anew;

/// Code of a FAULT: nothing was heard for 20 ms.
const LIMP: u8 = 1;
/// Code of a FAULT: the host's HELLO was of another protocol.
const OTHER_PROTOCOL: u8 = 2;

impl<O: Opener> LinkDevice<O> {
    pub(super) fn take(&mut self, byte: u8, now: f64) {
        let Some(payload) = self.decoder.push(byte) else {
            return;
        };
        match parse(payload) {
            Some(Message::Hello(greeting)) if !greeting.is_sound() => {
                self.end_session();
                self.report.unknown += 1;
            }
            // An older device: it says so, with a FAULT, and waits to be asked in its own words.
            Some(Message::Hello(greeting))
                if greeting.protocol == FIRST_PROTOCOL && self.protocol > FIRST_PROTOCOL =>
            {
                self.end_session();
                self.begin_session(now);
                self.protocol = FIRST_PROTOCOL;
                self.next_hello = now;
            }
            Some(Message::Fault {
                code: OTHER_PROTOCOL,
                detail,
            }) if detail == u16::from(PROTOCOL) && self.protocol == FIRST_PROTOCOL => {}
            Some(Message::Hello(greeting)) => {
                // One that says the same was only asked twice; another figure is another device.
                if self.greeting != Some(greeting) {
                    self.orientations.dismiss();
                    self.end_session();
                    self.begin_session(now);
                }
                self.greeting = Some(greeting);
                self.report.greeting = Some(greeting);
                self.doubt.hear(now);
            }
            // A device that streams before it was greeted may speak another version.
            Some(Message::State(state)) if self.is_greeted() => {
                if state.taken.is_some() == (self.protocol == PROTOCOL) {
                    self.take_state(state, now);
                } else {
                    self.report.unknown += 1;
                }
            }
            Some(Message::Orientation(orientation)) if self.is_greeted() => {
                self.orientations.tell(orientation);
            }
            Some(Message::State(_) | Message::Orientation(_)) => {}
            Some(Message::Fault { code, detail }) => {
                self.device_fault = true;
                self.report.device_faults += 1;
                self.report.last_fault = Some((code, detail));
                if code == LIMP {
                    self.doubt_it(now);
                }
            }
            None => self.report.unknown += 1,
        }
    }

    /// Whether force would come too late: what was said is not taken in time, or does not leave.
    pub(super) fn is_deaf(&mut self, now: f64) -> bool {
        if self
            .refused
            .is_some_and(|since| now - since > STALE_SECONDS)
        {
            self.freshness.refuse(now);
            self.doubt_it(now);
        }
        if self.doubt.is_unanswered(now) {
            self.doubt_it(now);
        }
        if self.doubt.asks(now) {
            self.say_hello();
        }
        self.freshness.is_deaf(now) || self.doubt.stands()
    }

    /// The device has heard nothing lately. In protocol 2 each STATE tells when it hears again.
    fn doubt_it(&mut self, now: f64) {
        if self.protocol == FIRST_PROTOCOL {
            self.doubt.begin(now);
        }
    }

    /// The device is another one, or none that can be: it is told to let go as long as it may still
    /// hold a force of the session that it has left.
    fn end_session(&mut self) {
        if self.is_greeted() {
            self.farewells = FAREWELLS;
        }
        self.greeting = None;
    }

    /// Forgets where the device was before, and its sequence.
    fn begin_session(&mut self, now: f64) {
        self.heard = now;
        self.begun_anew |= self.newest.take().is_some();
        self.stale = false;
        self.unseen = true;
        self.device_fault = false;
        self.speedometer.reset();
        self.orientations.forget();
        self.freshness = Freshness::default();
        self.doubt = Doubt::default();
        self.refused = None;
    }

    fn take_state(&mut self, state: DeviceState, now: f64) {
        if let Some(last) = &self.newest
            && self.stale
            && has_begun_anew(last.state.time_us, state.time_us, now - self.heard)
        {
            self.farewells = FAREWELLS;
            self.begin_session(now);
        }
        if let Some(last) = &self.newest
            && !self.stale
        {
            match state.sequence.wrapping_sub(last.state.sequence) {
                0 => {
                    self.report.duplicates += 1;
                    return self.orientations.dismiss();
                }
                ahead @ 1..=0x7FFF => self.report.lost += u64::from(ahead) - 1,
                _ => {
                    self.report.out_of_order += 1;
                    return self.orientations.dismiss();
                }
            }
        }
        self.report.states += 1;
        self.arrivals.take(state.time_us);
        let step = self.speedometer.step(state.position(), state.time_us, now);
        let was_turned = self.orientations.is_known();
        let step = step.or(self.orientations.pair(state.sequence, state.time_us, now));
        self.unseen |= step.has_strayed;
        if !was_turned && self.orientations.is_known() {
            // Until now it was taken for upright: no sweep leads from there to how it is turned.
            self.begun_anew |= self.newest.is_some();
            self.unseen = true;
        }
        self.pacing.hear(now, self.dt);
        if let Some(Taken::Force(sequence)) = state.taken {
            self.freshness.hear(sequence, now);
        }
        self.newest = Some(Newest::of(state, step.speed, now, self.newest.as_ref()));
        self.heard = now;
        self.stale = false;
    }
}
