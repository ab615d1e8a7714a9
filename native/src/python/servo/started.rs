//! Every servo that may still run, so that the interpreter's exit can stop it.

use std::sync::{Arc, Mutex, Weak};

use pyo3::prelude::*;

use crate::servo::paced::locked;
use crate::servo::thread::Running;

static STARTED: Mutex<Vec<Weak<Running>>> = Mutex::new(Vec::new());

pub fn remember(running: &Arc<Running>) {
    let mut started = locked(&STARTED);
    started.retain(|weak| weak.strong_count() > 0);
    started.push(Arc::downgrade(running));
}

/// Stops every servo that still runs; called at the interpreter's exit.
#[pyfunction]
pub fn stop_all(py: Python<'_>) {
    let mut started = locked(&STARTED);
    let started = std::mem::take(&mut *started);
    py.detach(|| {
        for running in started.iter().filter_map(Weak::upgrade) {
            running.paced().stop();
        }
    });
}
