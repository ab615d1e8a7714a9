//! `CubicPlaces`: places in curved triangles, moved with every frame.

use glam::DVec3;
use numpy::{AllowTypeChange, PyArrayLike1, PyArrayLike2, PyArrayLike3, PyReadwriteArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::drawn::{self, CONTROLS, Patch};
use crate::python::vectors::misshaped;

#[pyclass(frozen, module = "palpate_servo")]
pub struct CubicPlaces {
    inner: drawn::CubicPlaces,
    patches: usize,
}

#[pymethods]
impl CubicPlaces {
    #[new]
    fn new(
        patch: PyArrayLike1<'_, i64, AllowTypeChange>,
        alpha: PyArrayLike2<'_, f64, AllowTypeChange>,
        patches: usize,
    ) -> PyResult<Self> {
        let (patch, alpha) = (patch.as_array(), alpha.as_array());
        if alpha.shape() != [patch.len(), 3] {
            let wanted = format!("({}, 3), a row for each place", patch.len());
            return Err(misshaped("alpha", alpha.shape(), wanted));
        }
        // What does not fit is as wrong as what is too large.
        let numbers: Vec<u32> = patch
            .iter()
            .map(|&one| u32::try_from(one).unwrap_or(u32::MAX))
            .collect();
        let alphas: Vec<[f32; 2]> = (alpha.rows().into_iter())
            .map(|r| [r[0] as f32, r[1] as f32])
            .collect();
        drawn::CubicPlaces::new(&numbers, &alphas, patches)
            .map(|inner| Self { inner, patches })
            .ok_or_else(|| {
                PyValueError::new_err(format!(
                    "a place names a patch beyond the {patches} that there are; they are numbered from 0"
                ))
            })
    }

    fn write(
        &self,
        py: Python<'_>,
        patches: PyArrayLike3<'_, f64, AllowTypeChange>,
        mut moved: PyReadwriteArray2<'_, f32>,
    ) -> PyResult<()> {
        let patches = patches.as_array();
        if patches.shape() != [self.patches, CONTROLS, 3] {
            let wanted = format!("({}, {CONTROLS}, 3)", self.patches);
            return Err(misshaped("patches", patches.shape(), wanted));
        }
        if moved.as_array().shape() != [self.inner.len(), 3] {
            let wanted = format!("({}, 3), a row for each place", self.inner.len());
            return Err(misshaped("moved", moved.as_array().shape(), wanted));
        }
        let patches: Vec<Patch> = patches
            .outer_iter()
            .map(|one| {
                Patch::new(&std::array::from_fn(|k| {
                    DVec3::new(one[[k, 0]], one[[k, 1]], one[[k, 2]])
                }))
            })
            .collect();
        let moved = moved.as_slice_mut()?;
        py.detach(|| self.inner.evaluate(&patches, moved));
        Ok(())
    }
}
