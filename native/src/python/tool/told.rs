//! What a tool felt, as a dictionary of arrays.

use glam::DVec3;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::python::vectors::{array, square, table};
use crate::tool::collider::Collider;
use crate::tool::slot::Slot;

/// What a tool felt in the last tick, in N and m.
pub fn told_tool<'py>(
    py: Python<'py>,
    tool: &Collider,
    modulus: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let felt = tool.felt().copied().unwrap_or_default();
    let pressed = || tool.pressed().iter();
    let numbers = |of: &dyn Fn(&Slot) -> f64| PyArray1::from_iter(py, pressed().map(of));
    let vectors = |of: &dyn Fn(&Slot) -> DVec3| table(py, pressed().map(of));
    let area = |slot: &Slot| slot.at.area;
    let told = PyDict::new(py);
    told.set_item("force", array(py, felt.force))?;
    told.set_item("torque", array(py, felt.torque))?;
    told.set_item("stiffness", square(py, felt.stiffness)?)?;
    told.set_item("exact", felt.exact)?;
    told.set_item("free", tool.is_free())?;
    if let Some(pose) = tool.pose() {
        told.set_item("position", array(py, pose.position))?;
        told.set_item("rotation", square(py, pose.rotation)?)?;
    }
    let which = pressed().map(|slot| i64::from(slot.point));
    told.set_item("points", PyArray1::from_iter(py, which))?;
    told.set_item("areas", numbers(&area))?;
    told.set_item("pushes", numbers(&|slot| slot.push * modulus))?;
    told.set_item(
        "pressures",
        numbers(&|slot| slot.push * modulus / area(slot)),
    )?;
    told.set_item("places", vectors(&|slot| slot.at.position)?)?;
    told.set_item("point_forces", vectors(&|slot| slot.force * modulus)?)?;
    told.set_item("normals", vectors(&|slot| slot.normal)?)?;
    told.set_item("displacements", vectors(&|slot| slot.moved)?)?;
    let nodes = tool.nodal_forces(0).iter();
    let (numbers, forces): (Vec<i64>, Vec<DVec3>) =
        (nodes.map(|&(node, force)| (i64::from(node), force * modulus))).unzip();
    told.set_item("nodes", PyArray1::from_vec(py, numbers))?;
    told.set_item("nodal_forces", table(py, forces.into_iter())?)?;
    Ok(told)
}
