//! `solve_contacts`: the servo's coupled contacts without a servo, for tests.

use glam::{DMat3, DVec3};
use numpy::{AllowTypeChange, PyArrayLike2, PyArrayLike4};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::contact::cones::{Blocks, Cone, MAX_FINGERS, Members, Vectors, solve_distinct};
use crate::fingers::several::tell_apart;
use crate::python::vectors::{Matrix, table};

/// Forces (m, 3) on the body at E = 1 of fingers that may only push, as in a tick.
///
/// Takes C (m, m, 3, 3), displacements asked for and pushes (m, 3), forces of the tick before.
/// ValueError for more than MAX_FINGERS, other shapes, or a C that is not positive definite.
#[pyfunction]
#[pyo3(signature = (compliance, displacements, pushes, start=None))]
pub fn solve_contacts<'py>(
    py: Python<'py>,
    compliance: PyArrayLike4<'_, f64, AllowTypeChange>,
    displacements: PyArrayLike2<'_, f64, AllowTypeChange>,
    pushes: PyArrayLike2<'_, f64, AllowTypeChange>,
    start: Option<PyArrayLike2<'_, f64, AllowTypeChange>>,
) -> PyResult<Matrix<'py>> {
    let count = displacements.as_array().nrows();
    if !(1..=MAX_FINGERS).contains(&count) || compliance.as_array().shape() != [count, count, 3, 3]
    {
        return Err(PyValueError::new_err(format!(
            "compliance must have the shape (m, m, 3, 3) for 1 to {MAX_FINGERS} displacements (m, 3)"
        )));
    }
    let asked = vectors(&displacements, count)?;
    let pushes = vectors(&pushes, count)?;
    let before = start.map_or(Ok([DVec3::ZERO; MAX_FINGERS]), |s| vectors(&s, count))?;
    let entries = compliance.as_array();
    let mut blocks: Blocks = [[DMat3::ZERO; MAX_FINGERS]; MAX_FINGERS];
    for (p, row) in blocks.iter_mut().enumerate().take(count) {
        for (q, block) in row.iter_mut().enumerate().take(count) {
            *block = DMat3::from_cols_array_2d(
                &[0, 1, 2].map(|c| [0, 1, 2].map(|r| entries[[p, q, r, c]])),
            );
        }
    }
    let members = Members::of(&std::array::from_fn(|p| (p < count).then_some(())));
    let mut solved = || {
        tell_apart(&mut blocks, &members)?;
        let mut cones = [Cone::default(); MAX_FINGERS];
        for p in members.numbers() {
            cones[p] = Cone::about(pushes[p], &blocks[p][p])?;
        }
        solve_distinct(&blocks, &asked, &cones, &members, &before)
    };
    let forces =
        solved().ok_or_else(|| PyValueError::new_err("the compliance is not positive definite"))?;
    table(py, forces.into_iter().take(count))
}

fn vectors(rows: &PyArrayLike2<'_, f64, AllowTypeChange>, count: usize) -> PyResult<Vectors> {
    let rows = rows.as_array();
    if rows.shape() != [count, 3] {
        return Err(PyValueError::new_err(
            "displacements, pushes and start must have a row of three numbers for each contact",
        ));
    }
    let row = |p: usize| DVec3::new(rows[[p, 0]], rows[[p, 1]], rows[[p, 2]]);
    Ok(std::array::from_fn(|p| {
        if p < count { row(p) } else { DVec3::ZERO }
    }))
}
