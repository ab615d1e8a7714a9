//! `Compliance`: the arrays of either form, held and not copied.

use std::fmt::Display;
use std::ptr::NonNull;
use std::sync::Arc;

use glam::DVec3;
use numpy::{
    AllowTypeChange, Element, PyArrayDyn, PyArrayLike1, PyArrayLike2, PyArrayMethods,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyIndexError, PyKeyError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::body::compliance::table::Table;
use crate::body::compliance::{self, Compressed, CompressedParts, Dense, Either};
use crate::python::vectors::{Matrix, misshaped, square, table};

/// Prefix of the names of a compressed compliance's arrays.
const PREFIX: &str = "compressed_";

#[pyclass(frozen, module = "palpate_servo")]
pub struct Compliance {
    pub inner: Arc<compliance::Compliance>,
}

#[pymethods]
impl Compliance {
    #[staticmethod]
    fn dense(table: &Bound<'_, PyAny>) -> PyResult<Self> {
        let shape: Vec<usize> = table.getattr("shape")?.extract()?;
        let nodes = match shape[..] {
            [nodes, 3, freedoms] if freedoms == 3 * nodes => nodes,
            _ => return Err(misshaped("table", &shape, "(n, 3, 3n)")),
        };
        let table = either("table", table)?;
        made(Dense::new(nodes, table).map(compliance::Compliance::Dense))
    }

    #[staticmethod]
    fn compressed(arrays: &Bound<'_, PyDict>) -> PyResult<Self> {
        let array = |name: &str| {
            let key = format!("{PREFIX}{name}");
            arrays.get_item(&key)?.ok_or_else(|| {
                PyKeyError::new_err(format!(
                    "{key} is missing; give all arrays of a compressed compliance"
                ))
            })
        };
        let parts = CompressedParts {
            places: copied::<i32, u32>("places", &array("places")?)?,
            own_blocks: shared("own_blocks", &array("own_blocks")?)?,
            near_scale: shared("near_scale", &array("near_scale")?)?,
            near_table: copied::<i32, u32>("near_table", &array("near_table")?)?,
            near_steps: shared("near_steps", &array("near_steps")?)?,
            near: either("near", &array("near")?)?,
            tile_counts: copied::<i32, u32>("tile_counts", &array("tile_counts")?)?,
            basis: shared("basis", &array("basis")?)?,
            steps: shared("steps", &array("steps")?)?,
            tile_table: copied::<i32, i32>("tile_table", &array("tile_table")?)?,
            narrow: shared("narrow", &array("narrow")?)?,
            wide: either("wide", &array("wide")?)?,
        };
        made(Compressed::new(parts).map(|c| compliance::Compliance::Compressed(Box::new(c))))
    }

    #[getter]
    fn form(&self) -> &'static str {
        self.inner.form()
    }

    #[getter]
    fn node_count(&self) -> usize {
        self.inner.node_count()
    }

    fn block<'py>(&self, py: Python<'py>, i: usize, j: usize) -> PyResult<Matrix<'py>> {
        let count = self.inner.node_count();
        if i >= count || j >= count {
            return Err(PyIndexError::new_err(format!(
                "block ({i}, {j}) is beyond the {count} nodes; they are numbered from 0"
            )));
        }
        square(py, self.inner.block(i, j))
    }

    fn apply<'py>(
        &self,
        py: Python<'py>,
        nodal_forces: PyArrayLike2<'py, f64, AllowTypeChange>,
        nodes: PyArrayLike1<'py, i64, AllowTypeChange>,
    ) -> PyResult<Matrix<'py>> {
        let (forces, nodes) = (nodal_forces.as_array(), nodes.as_array());
        if forces.ncols() != 3 || forces.nrows() != nodes.len() {
            let wanted = format!("({}, 3), a row for each node", nodes.len());
            return Err(misshaped("nodal_forces", forces.shape(), wanted));
        }
        let count = self.inner.node_count();
        let loads = (nodes.iter().zip(forces.rows()))
            .map(|(&node, force)| match usize::try_from(node) {
                Ok(node) if node < count => Ok((node, DVec3::new(force[0], force[1], force[2]))),
                _ => Err(PyIndexError::new_err(format!(
                    "node {node} is beyond the {count} nodes; they are numbered from 0"
                ))),
            })
            .collect::<PyResult<Vec<_>>>()?;
        table(py, self.inner.apply(&loads).into_iter())
    }
}

fn made(
    result: Result<compliance::Compliance, compliance::ComplianceError>,
) -> PyResult<Compliance> {
    match result {
        Ok(inner) => Ok(Compliance {
            inner: Arc::new(inner),
        }),
        Err(reason) => Err(PyValueError::new_err(reason.to_string())),
    }
}

/// The array if it is one of `T`, without gaps and aligned.
fn plain<'a, 'py, T: Element>(
    name: &str,
    array: &'a Bound<'py, PyAny>,
) -> PyResult<&'a Bound<'py, PyArrayDyn<T>>> {
    let array = array.cast::<PyArrayDyn<T>>().map_err(|_| {
        let kind = array
            .getattr("dtype")
            .map_or_else(|_| array.get_type().to_string(), |d| d.to_string());
        PyTypeError::new_err(format!(
            "{name} is no array of {} but of {kind}; give it as the body file has it",
            std::any::type_name::<T>()
        ))
    })?;
    if !array.is_c_contiguous() || !array.data().is_aligned() {
        return Err(PyValueError::new_err(format!(
            "{name} is not contiguous in memory; pass numpy.ascontiguousarray of it"
        )));
    }
    Ok(array)
}

/// An array to be read in place: it is made read-only and kept alive.
fn shared<T: Element + Copy + Send + Sync + 'static>(
    name: &str,
    array: &Bound<'_, PyAny>,
) -> PyResult<Table<T>> {
    let array = plain::<T>(name, array)?;
    array.getattr("flags")?.setattr("writeable", false)?;
    let first = NonNull::new(array.data()).unwrap_or(NonNull::dangling());
    // SAFETY: aligned and without gaps, as checked; numpy neither moves nor frees the memory of an
    // array that somebody refers to. It can no longer be written to, but for views made before,
    // through which callers promise not to write; nothing in a table addresses memory.
    Ok(unsafe { Table::borrowed(first, array.len(), array.clone().unbind()) })
}

fn either<A, B>(name: &str, array: &Bound<'_, PyAny>) -> PyResult<Either<A, B>>
where
    A: Element + Copy + Send + Sync + 'static,
    B: Element + Copy + Send + Sync + 'static,
{
    if array.cast::<PyArrayDyn<A>>().is_ok() {
        shared(name, array).map(Either::Short)
    } else {
        shared(name, array).map(Either::Long)
    }
}

/// Numbers that address memory: looked at once, and nobody can change them afterwards.
fn copied<T: Element + Copy + Display, U: TryFrom<T>>(
    name: &str,
    array: &Bound<'_, PyAny>,
) -> PyResult<Vec<U>> {
    let array = plain::<T>(name, array)?;
    let numbers: Vec<T> = array.to_vec()?;
    (numbers.into_iter().enumerate())
        .map(|(place, number)| {
            U::try_from(number).map_err(|_| {
                PyValueError::new_err(format!(
                    "{name} has {number} as its number {place}; none may be below zero"
                ))
            })
        })
        .collect()
}
