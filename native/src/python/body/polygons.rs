//! Polygons of a drawn mesh on a line, and near a point.

use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::drawn::Polygons;
use crate::python::vectors::{Triple, finite};

type Places<'py> = PyReadonlyArray2<'py, f32>;
type Numbers<'py> = PyReadonlyArray1<'py, i32>;

#[pyfunction]
pub fn polygons_on_line<'py>(
    py: Python<'py>,
    places: Places<'py>,
    corners: Numbers<'py>,
    starts: Numbers<'py>,
    origin: Triple,
    direction: Triple,
) -> PyResult<Bound<'py, PyArray1<i64>>> {
    let (origin, along) = (finite("origin", origin)?, finite("direction", direction)?);
    if along.try_normalize().is_none() {
        return Err(PyValueError::new_err(format!(
            "direction is {along}; give one with a length"
        )));
    }
    let polygons = polygons(&places, &corners, &starts)?;
    let found = py.detach(|| polygons.on_line(origin, along));
    Ok(PyArray1::from_iter(py, found.into_iter().map(i64::from)))
}

#[pyfunction]
pub fn nearest_polygon<'py>(
    py: Python<'py>,
    places: Places<'py>,
    corners: Numbers<'py>,
    starts: Numbers<'py>,
    point: Triple,
) -> PyResult<Option<u32>> {
    let point = finite("point", point)?;
    let polygons = polygons(&places, &corners, &starts)?;
    Ok(py.detach(|| polygons.nearest(point)))
}

fn polygons<'a>(
    places: &'a Places<'_>,
    corners: &'a Numbers<'_>,
    starts: &'a Numbers<'_>,
) -> PyResult<Polygons<'a>> {
    let refused = || {
        PyValueError::new_err(format!(
            "places {:?}, corners {:?} and starts {:?} make no polygons; places must be (p, 3), corners \
             name places, and starts ascend from 0",
            places.shape(),
            corners.shape(),
            starts.shape()
        ))
    };
    let found = Polygons::new(places.as_slice()?, corners.as_slice()?, starts.as_slice()?);
    let found = found.filter(|_| places.as_array().ncols() == 3);
    found.ok_or_else(refused)
}
