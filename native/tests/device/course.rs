//! Courses of hands, and of encoders that lose their place.

use glam::DVec3;
use palpate_servo::device::course::{Course, Elapsed, Step};

use crate::damage::Dice;

/// Of people with the handle of a teleoperator, m/s^2 (Draper, Handel and Hood 1990, "Fitts' task by
/// teleoperator: movement time, velocity, and acceleration": from -29 to 41 in the fastest phase).
const HARDEST_HAND: f64 = 41.0;

#[test]
fn a_hand_that_goes_on_is_on_its_course_and_one_that_jumps_is_not() {
    let mut course = Course::default();
    course.resume(DVec3::ZERO, 0.0);
    for ms in 1..50 {
        let step = course.step(DVec3::X * 1e-3 * f64::from(ms), Elapsed::of(1e-3), 1.0);
        assert!(step.speed < 1.0 + 1e-9 && !step.has_strayed);
    }
    // After a while unseen: on its way, stopped on the way, and elsewhere. In 15 ms a hand may have
    // turned, in 5 ms not.
    for (ms, millimetres, strays) in [
        (15.0, 64.0, false),
        (15.0, 55.0, false),
        (15.0, 44.0, true),
        (15.0, 70.0, true),
        (5.0, 54.0, false),
        (5.0, 44.0, true),
        (5.0, 59.0, true),
    ] {
        let place = DVec3::X * 1e-3 * millimetres;
        let step = course.clone().step(place, Elapsed::of(1e-3 * ms), 1.0);
        assert_eq!(step.has_strayed, strays, "{ms} {millimetres}");
        assert_eq!(step.speed > 2.0, strays && ms < 6.0, "{ms} {millimetres}");
    }
}

#[test]
fn a_jump_in_parts_is_one() {
    for parts in [2, 3, 4] {
        let mut course = Course::default();
        let mut strayed = false;
        for ms in 0..50 {
            let gone = 7.5e-3 / f64::from(parts) * f64::from((ms - 30).clamp(0, parts));
            let step = course.step(DVec3::X * gone, Elapsed::of(1e-3), 0.0);
            strayed |= step.has_strayed;
        }
        assert!(strayed, "{parts}");
    }
}

#[test]
fn a_hand_that_sets_out_at_once_keeps_its_course() {
    for (ms, speed) in [
        (0.25, 0.75),
        (0.5, 0.75),
        (1.0, 0.75),
        (2.0, 0.75),
        (2.5, 0.75),
        (3.0, 0.75),
        (4.0, 0.75),
        (5.0, 0.75),
        (10.0, 0.35),
    ] {
        // Between any two messages.
        for start in 0..100 {
            let start = 40.0 + 0.1 * f64::from(start);
            let mut course = Course::default();
            course.resume(DVec3::ZERO, 0.0);
            for k in 0..100 {
                let seconds = 1e-3 * ms * (f64::from(k) - start).max(0.0);
                let step = course.step(DVec3::X * speed * seconds, Elapsed::of(1e-3 * ms), 0.0);
                assert!(!step.has_strayed, "{ms} {start}");
            }
        }
    }
}

#[test]
fn a_hand_that_starts_and_stops_hard_keeps_its_course() {
    // To and fro by 150 mm, at 1.0 m/s and 7 m/s^2; at each rate.
    for period in [2.5e-4, 1e-3, 2.5e-3, 5e-3, 1e-2] {
        let mut course = Course::default();
        course.resume(DVec3::X * 0.15, 0.0);
        for k in 1..10_000 {
            let place = DVec3::X * 0.15 * (7.0 * period * f64::from(k)).cos();
            let step = course.step(place, Elapsed::of(period), 0.0);
            assert!(!step.has_strayed, "{period} {k} {step:?}");
        }
    }
}

#[test]
fn after_an_interruption_only_what_is_near_has_been_reached() {
    let mut course = Course::default();
    assert_eq!(course.resume(DVec3::Y, 0.0), Step::default(), "set down");
    course.interrupt();
    assert!(!course.resume(DVec3::Y * 1.003, 0.03).has_strayed);
    course.interrupt();
    assert!(course.resume(DVec3::Y * 1.008, 0.03).has_strayed);
    course.reset();
    assert!(!course.resume(DVec3::ZERO, 0.03).has_strayed);
}

#[test]
fn a_hand_out_of_sight_goes_on_or_stops_but_does_not_turn() {
    let mut course = Course::default();
    course.resume(DVec3::ZERO, 0.0);
    for ms in 1..50 {
        course.step(DVec3::X * 5e-4 * f64::from(ms), Elapsed::of(1e-3), 0.5);
    }
    course.interrupt();
    // 0.5 m/s for 30 ms; for a second no way of 0.5 m is believed.
    for (millimetres, seconds, strays) in [
        (39.0, 0.03, false),
        (26.0, 0.03, false),
        (45.0, 0.03, true),
        (14.5, 0.03, true),
        (74.0, 1.0, false),
        (80.0, 1.0, true),
    ] {
        let place = DVec3::X * 1e-3 * millimetres;
        let step = course.clone().resume(place, seconds);
        assert_eq!(step.has_strayed, strays, "{millimetres} {seconds}");
    }
    // Who knows where it goes when it is back.
    course.resume(DVec3::X * 0.03, 0.03);
    course.interrupt();
    assert!(course.resume(DVec3::X * 0.04, 0.03).has_strayed);
}

/// Some hands with this acceleration (m/s^2), now in one direction, now in another: the worst step of
/// each, seen after so many ms. As fast as a device may be, but for a little.
fn hands(acceleration: f64, pauses: &[f64]) -> Vec<Step> {
    let mut dice = Dice::new(7);
    let mut hand = || {
        let mut course = Course::default();
        course.resume(DVec3::ZERO, 0.0);
        let (mut place, mut velocity) = (DVec3::ZERO, DVec3::ZERO);
        let mut push = DVec3::X * acceleration;
        let mut worst = Step::default();
        for _ in 0..1000 {
            let pause = pauses[dice.below(pauses.len())] * 1e-3;
            // Too little for it to matter how exactly the way is found.
            for _ in 0..20 {
                let coordinates = [(); 3].map(|()| dice.below(201) as f64 - 100.0);
                if dice.below(400) == 0 {
                    push = DVec3::from(coordinates).normalize_or(DVec3::X) * acceleration;
                }
                if velocity.length() > 1.9 {
                    push = -velocity.normalize() * acceleration;
                }
                velocity += push * pause / 20.0;
                place += velocity * pause / 20.0;
            }
            worst = worst.or(course.step(place, Elapsed::of(pause), velocity.length()));
        }
        worst
    };
    (0..200).map(|_| hand()).collect()
}

#[test]
fn the_hardest_hand_keeps_its_course() {
    for (period, acceleration) in [
        (0.25, 100.0),
        (0.5, 100.0),
        (1.0, 100.0),
        (2.0, 100.0),
        (2.5, 100.0),
        (5.0, 100.0),
        (10.0, 35.0),
    ] {
        for step in hands(acceleration, &[period]) {
            assert!(!step.has_strayed && step.speed < 2.0, "{period} {step:?}");
        }
    }
}

#[test]
fn a_hand_is_followed_through_8_ms_and_never_too_fast_in_longer_pauses() {
    let most = |ms: u32| (1..=ms).map(f64::from).chain([1.0; 20]).collect::<Vec<_>>();
    for step in hands(HARDEST_HAND, &most(8)) {
        assert!(!step.has_strayed && step.speed < 2.0, "{step:?}");
    }
    let longer = hands(HARDEST_HAND, &most(20));
    assert!(longer.iter().all(|step| step.speed < 2.0));
    assert!(longer.iter().any(|step| step.has_strayed), "set down anew");
}
