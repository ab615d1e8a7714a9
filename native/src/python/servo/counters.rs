//! Counters as dictionaries.

use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::clock::durations::{BUCKETS, DurationReport, bucket_limit_ns};
use crate::clock::timing::{LATE_LIMITS_NS, Timing};
use crate::device::{Fault, LinkReport};
use crate::servo::snapshot::FingerReport;
use crate::servo::stages::{Stage, Stages};

fn us(ns: u64) -> f64 {
    ns as f64 * 1e-3
}

pub fn timing_counters<'py>(
    py: Python<'py>,
    timing: &Timing,
    realtime: &str,
) -> PyResult<Bound<'py, PyDict>> {
    const LATE_TICK: usize = 2;
    let report = timing.report();
    let counters = PyDict::new(py);
    counters.set_item("ticks", report.ticks())?;
    counters.set_item("missed", report.missed)?;
    counters.set_item("late_ticks", report.late[LATE_TICK])?;
    for (limit, count) in LATE_LIMITS_NS.iter().zip(report.late) {
        counters.set_item(format!("late_over_{}_us", limit / 1000), count)?;
    }
    let late = |part| us(report.lateness.percentile_ns(part));
    let lateness = [
        ("p50", late(0.5)),
        ("p99", late(0.99)),
        ("p99_9", late(0.999)),
        ("max", us(report.lateness.largest_ns)),
    ];
    counters.set_item("lateness_us", lateness.into_py_dict(py)?)?;
    let filled = (0..BUCKETS).filter(|&i| report.lateness.histogram[i] > 0);
    let histogram: Vec<(f64, u64)> = filled
        .map(|i| (us(bucket_limit_ns(i)), report.lateness.histogram[i]))
        .collect();
    counters.set_item("histogram", histogram)?;
    counters.set_item("longest_gap_us", us(report.longest_gap_ns))?;
    for (name, times) in [("busy_us", &report.busy), ("spun_us", &report.busy_waited)] {
        let (mean, max) = (times.mean_ns() * 1e-3, us(times.largest_ns));
        counters.set_item(name, [("mean", mean), ("max", max)].into_py_dict(py)?)?;
    }
    counters.set_item("realtime", realtime)?;
    Ok(counters)
}

/// Mean, 99 % and largest time of each stage, us.
pub fn stage_counters<'py>(
    py: Python<'py>,
    stages: Option<&Stages>,
) -> PyResult<Bound<'py, PyDict>> {
    let counters = PyDict::new(py);
    for stage in Stage::ALL {
        let report = stages.map(|s| s.report(stage));
        let of = |figure: fn(&DurationReport) -> f64| report.as_ref().map_or(0.0, figure);
        let times = [
            ("mean", of(|r| r.mean_ns() * 1e-3)),
            ("p99", of(|r| us(r.percentile_ns(0.99)))),
            ("max", of(|r| us(r.largest_ns))),
        ];
        counters.set_item(stage.name(), times.into_py_dict(py)?)?;
    }
    Ok(counters)
}

pub fn link_counters<'py>(py: Python<'py>, link: &LinkReport) -> PyResult<Bound<'py, PyDict>> {
    let counters = [
        ("states", link.states),
        ("forces", link.forces),
        ("lost", link.lost),
        ("duplicates", link.duplicates),
        ("out_of_order", link.out_of_order),
        ("crc_errors", link.crc_errors),
        ("cobs_errors", link.cobs_errors),
        ("oversize", link.oversize),
        ("unknown", link.unknown),
        ("orientations", link.orientations),
        ("orientations_unpaired", link.orientations_unpaired),
        ("orientations_refused", link.orientations_refused),
        ("orientations_lost", link.orientations_lost),
        ("hellos", link.hellos),
        ("device_faults", link.device_faults),
        ("unsent", link.unsent),
        ("reopened", link.reopened),
        ("forces_in_flight", link.in_flight),
    ]
    .into_py_dict(py)?;
    counters.set_item("last_fault", link.last_fault)?;
    counters.set_item("round_trip_ms", link.round_trip.map(|s| s * 1e3))?;
    counters.set_item("guarded", link.guarded)?;
    counters.set_item("state_age_ms", link.state_age.map(|s| s * 1e3))?;
    let arrivals = &link.arrivals;
    let mean = |sum: f64, count: u64, unit: f64| sum * unit / count.max(1) as f64;
    let by_device = mean(arrivals.device_seconds, arrivals.states, 1e6);
    let burst_ms = mean(arrivals.burst_seconds, arrivals.bursts, 1e3);
    let interval = [
        ("mean", mean(arrivals.pause_seconds, arrivals.pauses, 1e6)),
        ("max", arrivals.longest_pause * 1e6),
        ("device", by_device),
    ];
    counters.set_item("state_interval_us", interval.into_py_dict(py)?)?;
    counters.set_item("bursts", arrivals.bursts)?;
    counters.set_item("burst_ms", burst_ms)?;
    counters.set_item("burst_states", arrivals.burst_states)?;
    let device = link.greeting.map(|g| -> PyResult<_> {
        let device = PyDict::new(py);
        let name = String::from_utf8_lossy(&g.name);
        device.set_item("name", name.trim_end_matches('\0'))?;
        device.set_item("protocol", g.protocol)?;
        device.set_item("axes", g.axes)?;
        device.set_item("max_force", g.max_force)?;
        device.set_item("half_extents", g.half_extents)?;
        device.set_item("rate_hz", g.rate_hz)?;
        device.set_item("largest_damping", g.largest_damping)?;
        Ok(device)
    });
    counters.set_item("device", device.transpose()?)?;
    Ok(counters)
}

/// Times each fault began.
pub fn fault_counters<'py>(py: Python<'py>, report: &FingerReport) -> PyResult<Bound<'py, PyDict>> {
    let names = Fault::ALL.map(Fault::name);
    names.into_iter().zip(report.faults).into_py_dict(py)
}

/// Counters of one finger.
pub fn finger_counters(
    py: Python<'_>,
    counters: &Bound<'_, PyDict>,
    report: &FingerReport,
) -> PyResult<()> {
    counters.set_item("faults", fault_counters(py, report)?)?;
    counters.set_item("link", link_counters(py, &report.link)?)?;
    let (most_steps, rescues) = (u64::from(report.most_steps), report.rescues);
    let proxy = [("most_steps", most_steps), ("rescues", rescues)];
    counters.set_item("proxy", proxy.into_py_dict(py)?)
}
