//! The thin binding: arrays in, arrays out. Nothing of Python reaches the servo thread.

mod body;
mod device;
mod engine;
mod fold;
#[cfg(feature = "harness")]
mod harness;
mod pile;
mod rest;
mod servo;
mod solid;
mod tool;
mod vectors;

use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::contact::cones::MAX_FINGERS;
use crate::contact::ground::{MOST_BODIES, MOST_SUPPORTS};
use crate::control::safety::LIMITERS;
use crate::control::state::State;
use crate::device::Fault;
use crate::device::reason::{self, after};

#[pymodule]
fn palpate_servo(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add_class::<body::surface::Body>()?;
    module.add_class::<body::compliance::Compliance>()?;
    module.add_class::<body::drawn::CubicPlaces>()?;
    module.add_class::<device::setups::PointerSetup>()?;
    module.add_class::<device::setups::LinkSetup>()?;
    module.add_class::<device::setups::HaplySetup>()?;
    module.add_class::<servo::thread::Servo>()?;
    module.add_class::<servo::snapshot::Snapshot>()?;
    module.add_class::<servo::snapshot::FingerSnapshot>()?;
    module.add_class::<tool::shape::Tool>()?;
    module.add_class::<tool::surface::ToolSurface>()?;
    module.add_class::<engine::ContactEngine>()?;
    module.add_class::<rest::prop::Prop>()?;
    module.add_class::<rest::resting::Resting>()?;
    module.add_class::<solid::Relaxation>()?;
    module.add_class::<pile::Pile>()?;
    module.add_class::<pile::PropAmong>()?;
    module.add_class::<fold::MovedSurface>()?;
    module.add_function(wrap_pyfunction!(body::closest::closest_points, module)?)?;
    module.add_function(wrap_pyfunction!(body::polygons::polygons_on_line, module)?)?;
    module.add_function(wrap_pyfunction!(body::polygons::nearest_polygon, module)?)?;
    module.add_function(wrap_pyfunction!(device::coupling::device_coupling, module)?)?;
    module.add_function(wrap_pyfunction!(device::haply::haply_encoder_step, module)?)?;
    #[cfg(feature = "harness")]
    harness::register(module)?;
    let stop_all = wrap_pyfunction!(servo::started::stop_all, module)?;
    py.import("atexit")?
        .call_method1("register", (&stop_all,))?;
    module.add_function(stop_all)?;
    module.add("MAX_FINGERS", MAX_FINGERS)?;
    module.add("MOST_BODIES", MOST_BODIES)?;
    module.add("MOST_SUPPORTS", MOST_SUPPORTS)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("STATES", PyTuple::new(py, State::ALL.map(State::name))?)?;
    let reasons = reason::ALL.into_iter().chain(Fault::ALL.map(after));
    module.add("REASONS", PyTuple::new(py, reasons.collect::<Vec<_>>())?)?;
    module.add("LIMITERS", PyTuple::new(py, LIMITERS)?)?;
    module.add("FAULTS", PyTuple::new(py, Fault::ALL.map(Fault::name))?)?;
    Ok(())
}
