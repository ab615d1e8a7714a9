//! `palpate_servo.harness`: parts for tests and benchmarks; not in the extension's wheel.

mod bare_timer;
mod block_cost;
mod closed_loop;
mod frames;
mod proxy;
mod stepped;
mod stepped_fingers;
mod stepping;
mod tool_contact;
mod tool_cost;

use pyo3::prelude::*;

/// Adds the module, so that `from palpate_servo.harness import ...` finds it.
pub fn register(parent: &Bound<'_, PyModule>) -> PyResult<()> {
    const NAME: &str = "palpate_servo.harness";
    let py = parent.py();
    let module = PyModule::new(py, NAME)?;
    module.add_class::<bare_timer::BareTimer>()?;
    module.add_class::<frames::Decoder>()?;
    module.add_class::<proxy::Proxy>()?;
    module.add_class::<stepped::SteppedServo>()?;
    module.add_class::<stepped_fingers::SteppedFingers>()?;
    module.add_class::<tool_contact::ToolContact>()?;
    module.add_function(wrap_pyfunction!(block_cost::seconds_per_block, &module)?)?;
    module.add_function(wrap_pyfunction!(closed_loop::coupled_forces, &module)?)?;
    module.add_function(wrap_pyfunction!(closed_loop::simulate_contact, &module)?)?;
    module.add_function(wrap_pyfunction!(frames::encode_frame, &module)?)?;
    module.add_function(wrap_pyfunction!(tool_cost::tool_costs, &module)?)?;
    parent.add("harness", &module)?;
    py.import("sys")?.getattr("modules")?.set_item(NAME, module)
}
