//! Wires that hold bytes back are told apart from slow devices and busy hosts.

use palpate_servo::device::arrival::{ArrivalReport, Arrivals};

/// A host that looks at the times `looks` (us), and STATEs made and arriving at `(made, came)`.
fn seen(looks: impl IntoIterator<Item = u32>, states: &[(u32, u32)]) -> ArrivalReport {
    let mut arrivals = Arrivals::default();
    let mut coming = states.iter().peekable();
    for now in looks {
        while let Some((made, _)) = coming.next_if(|(_, came)| *came <= now) {
            // Near its end, so that the device's clock wraps.
            arrivals.take(made.wrapping_sub(500_000));
        }
        arrivals.end_of_tick(f64::from(now) * 1e-6);
    }
    arrivals.report
}

fn every(period: u32) -> impl Iterator<Item = u32> {
    (0..1_000_000).step_by(period as usize)
}

/// Made every `period`, let through every `latency` (us).
fn held_back(period: u32, latency: u32) -> Vec<(u32, u32)> {
    let through = |made: u32| (made / latency + 1) * latency;
    every(period).map(|made| (made, through(made))).collect()
}

/// Repeatable dice, 0 to `limit`.
fn jitter(number: u32, limit: u32) -> u32 {
    (u64::from(number).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as u32 % limit
}

fn mean_ms(report: &ArrivalReport) -> f64 {
    report.burst_seconds * 1e3 / report.bursts as f64
}

#[test]
fn a_latency_timer_of_16_ms_makes_62_bursts_a_second() {
    for looks in [1_000, 125, 10_000] {
        let report = seen(every(looks), &held_back(1_000, 16_000));
        let all = 1_000_000 / 16_000;
        assert!((all * 5 / 10..=all).contains(&report.bursts), "{report:?}");
        assert!(report.burst_states * 2 > report.states, "{report:?}");
        if looks <= 1_000 {
            assert!((report.bursts + 2) > all, "{report:?}");
            assert!((mean_ms(&report) - 16.0).abs() < 0.5, "{report:?}");
        }
        assert!((report.device_seconds / report.states as f64 - 1e-3).abs() < 2e-5);
    }
}

#[test]
fn other_latencies_are_told_with_their_length() {
    for latency in [5_000, 10_000, 255_000] {
        let report = seen(every(1_000), &held_back(1_000, latency));
        assert!((mean_ms(&report) - f64::from(latency) * 1e-3).abs() < 0.5);
        assert!(report.burst_states * 10 >= report.states * 9, "{report:?}");
    }
    // A device of 500 Hz is held back just so.
    assert!(seen(every(1_000), &held_back(2_000, 16_000)).bursts > 55);
}

#[test]
fn a_healthy_line_has_no_bursts() {
    for latency in [1, 1_000, 2_000] {
        assert_eq!(seen(every(1_000), &held_back(1_000, latency)).bursts, 0);
        assert_eq!(seen(every(125), &held_back(1_000, latency)).bursts, 0);
    }
    // Full-speed USB hands over what came within a millisecond.
    assert_eq!(seen(every(125), &held_back(125, 1_000)).bursts, 0);
    let shaken: Vec<(u32, u32)> = every(1_000)
        .map(|made| (made, made + jitter(made, 2_500)))
        .collect();
    let looks = every(1_000).map(|look| look + jitter(look, 900));
    let report = seen(looks, &shaken);
    assert_eq!(report.bursts, 0, "{report:?}");
    assert!(report.longest_pause < 4.5e-3 && report.pauses > 500);
}

#[test]
fn a_device_of_62_hz_is_slow_and_not_held_back() {
    let report = seen(every(1_000), &held_back(16_000, 1));
    assert_eq!((report.bursts, report.burst_states), (0, 0));
    assert!((report.pause_seconds / report.pauses as f64 - 16e-3).abs() < 1e-4);
    assert!((report.device_seconds / report.states as f64 - 16e-3).abs() < 1e-4);
}

#[test]
fn a_host_that_was_held_up_does_not_blame_the_wire() {
    let away = |look: &u32| !(200_000..230_000).contains(&(look % 300_000));
    let report = seen(every(1_000).filter(away), &held_back(1_000, 1));
    assert_eq!(report.bursts, 0);
    assert!(report.longest_pause > 0.025);
    // Nor does one that looks seldom.
    assert_eq!(seen(every(10_000), &held_back(1_000, 1)).bursts, 0);
}

#[test]
fn a_device_that_was_held_up_is_no_burst() {
    let states: Vec<(u32, u32)> = every(1_000)
        .filter(|made| !(200_000..230_000).contains(made))
        .map(|made| (made, made))
        .collect();
    assert_eq!(seen(every(1_000), &states).bursts, 0);
}

#[test]
fn a_device_that_makes_its_states_in_bursts_is_not_held_back_by_the_wire() {
    let states: Vec<(u32, u32)> = every(16_000)
        .flat_map(|begin| (0..5).map(move |i| (begin + 100 * i, begin + 900)))
        .collect();
    let report = seen(every(1_000), &states);
    assert!(report.pauses > 50 && report.states > 250);
    assert_eq!(report.bursts, 0, "{report:?}");
}

#[test]
fn silence_and_a_new_line_are_no_pauses() {
    let mut arrivals = Arrivals::default();
    let mut arrive = |now: f64, forget: bool| {
        arrivals.take((now * 1e6) as u32);
        arrivals.end_of_tick(now);
        if forget {
            arrivals.forget();
        }
        arrivals.report.pauses
    };
    assert_eq!(arrive(0.000, false), 0);
    assert_eq!(arrive(0.001, false), 1);
    assert_eq!(arrive(0.600, true), 1);
    assert_eq!(arrive(0.601, false), 1);
    assert_eq!(arrive(0.602, false), 2);
}
