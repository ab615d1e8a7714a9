//! The thin binding: arrays in, arrays out. Nothing of Python reaches the servo thread.

mod body;
mod closed_loop;
mod compliance;
mod counters;
mod devices;
mod frames;
mod haply;
mod proxy;
mod samples;
mod servo;
mod settings;
mod several;
mod snapshot;
mod started;
mod stepped;
mod stepped_fingers;
mod tick_cost;
mod tool;
mod tool_cost;
mod vectors;

use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::cones::MAX_FINGERS;
use crate::device::Fault;
use crate::safety::LIMITERS;
use crate::state::{State, after, reason};

#[pymodule]
fn palpate_servo(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add_class::<body::Body>()?;
    module.add_class::<compliance::Compliance>()?;
    module.add_class::<proxy::Proxy>()?;
    module.add_class::<devices::PointerSetup>()?;
    module.add_class::<devices::LinkSetup>()?;
    module.add_class::<devices::HaplySetup>()?;
    module.add_class::<servo::Servo>()?;
    module.add_class::<snapshot::Snapshot>()?;
    module.add_class::<snapshot::FingerSnapshot>()?;
    module.add_class::<stepped::SteppedServo>()?;
    module.add_class::<stepped_fingers::SteppedFingers>()?;
    module.add_class::<tool::Tool>()?;
    module.add_class::<tool::ToolSurface>()?;
    module.add_class::<tool::ToolContact>()?;
    module.add_class::<counters::BareTimer>()?;
    module.add_class::<frames::Decoder>()?;
    module.add_function(wrap_pyfunction!(counters::bare_timer, module)?)?;
    module.add_function(wrap_pyfunction!(frames::encode_frame, module)?)?;
    module.add_function(wrap_pyfunction!(closed_loop::simulate_contact, module)?)?;
    module.add_function(wrap_pyfunction!(closed_loop::coupled_forces, module)?)?;
    module.add_function(wrap_pyfunction!(closed_loop::device_coupling, module)?)?;
    module.add_function(wrap_pyfunction!(several::solve_contacts, module)?)?;
    module.add_function(wrap_pyfunction!(tick_cost::tick_costs, module)?)?;
    module.add_function(wrap_pyfunction!(haply::haply_encoder_step, module)?)?;
    let stop_all = wrap_pyfunction!(started::stop_all, module)?;
    py.import("atexit")?
        .call_method1("register", (&stop_all,))?;
    module.add_function(stop_all)?;
    module.add("MAX_FINGERS", MAX_FINGERS)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("STATES", PyTuple::new(py, State::ALL.map(State::name))?)?;
    let reasons = reason::ALL.into_iter().chain(Fault::ALL.map(after));
    module.add("REASONS", PyTuple::new(py, reasons.collect::<Vec<_>>())?)?;
    module.add("LIMITERS", PyTuple::new(py, LIMITERS)?)?;
    module.add("FAULTS", PyTuple::new(py, Fault::ALL.map(Fault::name))?)?;
    Ok(())
}
