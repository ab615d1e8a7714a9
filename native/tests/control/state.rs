//! The state machine: every way into force leads over the ramp, every fault takes it at once.

use palpate_servo::control::state::{Findings, Standing, State, transition};
use palpate_servo::device::Fault;
use palpate_servo::device::reason::{self, after};

const DT: f64 = 1e-3;
const CALM: Findings = Findings {
    fault: None,
    waiting: None,
    blind: false,
    switched_off: false,
    button: false,
    body_replaced: false,
    calm: true,
    ramped: true,
    touching: false,
    inside: false,
};

fn every_standing() -> impl Iterator<Item = Standing> {
    let named = State::ALL
        .into_iter()
        .filter(|s| *s != State::Fault)
        .map(|s| Standing::new(s, ""));
    named.chain(Fault::ALL.into_iter().map(Standing::fault))
}

fn every_finding() -> impl Iterator<Item = Findings> {
    let bit = |bits: u32, place: u32| bits >> place & 1 == 1;
    (0..256).flat_map(move |bits| {
        let found = Findings {
            fault: None,
            waiting: bit(bits, 0).then_some("why"),
            blind: bit(bits, 0),
            switched_off: bit(bits, 1),
            button: bit(bits, 2),
            body_replaced: bit(bits, 3),
            calm: bit(bits, 4),
            ramped: bit(bits, 5),
            touching: bit(bits, 6),
            inside: bit(bits, 7),
        };
        let faulty = Fault::ALL.map(|fault| Findings {
            fault: Some(fault),
            ..found
        });
        faulty.into_iter().chain([found])
    })
}

#[test]
fn no_way_leads_past_the_ramp() {
    for before in every_standing() {
        for found in every_finding() {
            let after = transition(&before, &found, DT);
            if matches!(after.state, State::Free | State::Touching) {
                assert!(before.state.may_push(), "{before:?} {found:?}");
                assert!(before.state != State::Ramping || found.ramped);
            }
            assert_eq!(after.state == State::Fault, after.fault.is_some());
        }
    }
}

#[test]
fn whatever_takes_the_force_away_does_so_in_the_same_tick() {
    for before in every_standing() {
        for found in every_finding() {
            let after = transition(&before, &found, DT);
            let reasons_against = found.fault.is_some()
                || found.waiting.is_some()
                || found.switched_off
                || found.button
                || found.body_replaced;
            if reasons_against {
                assert!(!after.may_push(&found), "{before:?} {found:?} {after:?}");
            }
            if let Some(fault) = found.fault {
                assert_eq!(after.fault, Some(fault));
            }
        }
    }
}

#[test]
fn every_state_is_left_when_its_cause_has_gone() {
    for before in every_standing() {
        let mut standing = before;
        for _ in 0..200 {
            standing = transition(&standing, &CALM, DT);
        }
        assert_eq!(standing.state, State::Free, "{before:?}");
    }
}

#[test]
fn faults_last_as_long_as_told_and_too_fast_until_the_device_is_calm() {
    for fault in Fault::ALL {
        let mut standing = Standing::fault(fault);
        let mut ticks = 0;
        while standing.state == State::Fault {
            standing = transition(&standing, &CALM, DT);
            ticks += 1;
        }
        let expected = match fault {
            Fault::TooFast => 101,
            Fault::Suspended => 21,
            _ => 1,
        };
        assert_eq!(ticks, expected, "{fault:?}");
        assert_eq!(standing, Standing::new(State::Ramping, after(fault)));
    }
    let mut standing = Standing::fault(Fault::TooFast);
    let restless = Findings {
        calm: false,
        ..CALM
    };
    for tick in 0..1000 {
        let found = if tick % 100 == 99 { &restless } else { &CALM };
        standing = transition(&standing, found, DT);
        assert_eq!(standing.fault, Some(Fault::TooFast), "{tick}");
    }
}

#[test]
fn the_ramp_says_what_it_follows() {
    let from =
        |found: &Findings| transition(&transition(&Standing::default(), found, DT), &CALM, DT);
    let off = Findings {
        switched_off: true,
        ..CALM
    };
    let held = Findings {
        button: true,
        ..CALM
    };
    let waits = Findings {
        waiting: Some(reason::NO_STATE),
        ..CALM
    };
    let replaced = Findings {
        body_replaced: true,
        ..CALM
    };
    assert_eq!(from(&off).reason, reason::SWITCHED_ON);
    assert_eq!(from(&held).reason, reason::RELEASED);
    assert_eq!(from(&waits).reason, reason::READY);
    let started = transition(&Standing::default(), &CALM, DT);
    assert_eq!(started.reason, reason::STARTED);
    let touching = Standing::new(State::Touching, "");
    let other = transition(&touching, &replaced, DT);
    assert_eq!(
        (other.state, other.reason),
        (State::Ramping, reason::BODY_REPLACED)
    );
    let growing = Findings {
        ramped: false,
        ..CALM
    };
    assert_eq!(transition(&other, &growing, DT), other);
}
