//! A place on a surface, as Python tells it.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::body::surface::Body;
use crate::proxy::SurfacePoint;
use crate::python::vectors::{Triple, finite};

/// What area coordinates that were computed may be off.
const ALPHA_ROUNDING: f64 = 1e-6;

/// The place of area coordinates in a triangle.
pub fn surface_point(
    body: &Body,
    name: &str,
    triangle: i64,
    alpha: Triple,
) -> PyResult<SurfacePoint> {
    let count = body.triangles.len();
    let Some(triangle) = u32::try_from(triangle)
        .ok()
        .filter(|&t| (t as usize) < count)
    else {
        return Err(PyValueError::new_err(format!(
            "{name} is on triangle {triangle}, and the body has 0 to {}",
            count.saturating_sub(1)
        )));
    };
    let alpha = finite("alpha", alpha)?;
    if alpha.min_element() < -ALPHA_ROUNDING || (alpha.element_sum() - 1.0).abs() > ALPHA_ROUNDING {
        return Err(PyValueError::new_err(format!(
            "{name} has the area coordinates {alpha}; give three that are not negative and add up to 1"
        )));
    }
    let alpha = alpha.to_array();
    Ok(SurfacePoint { triangle, alpha })
}
