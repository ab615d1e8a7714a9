//! `CubicPlaces`: places in curved triangles, moved with every frame.

use numpy::{
    AllowTypeChange, PyArray1, PyArray2, PyArrayLike1, PyArrayLike2, PyArrayLike3, PyArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::drawn::{self, CONTROLS, Patch};

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
            return Err(PyValueError::new_err(format!(
                "alpha has the shape {:?}, not ({}, 3)",
                alpha.shape(),
                patch.len()
            )));
        }
        // What does not fit is as wrong as what is too large.
        let numbers = patch
            .iter()
            .map(|&one| u32::try_from(one).unwrap_or(u32::MAX));
        let alphas = alpha.rows().into_iter().map(|r| [r[0] as f32, r[1] as f32]);
        drawn::CubicPlaces::new(numbers.collect(), alphas.collect(), patches)
            .map(|inner| Self { inner, patches })
            .ok_or_else(|| {
                PyValueError::new_err(format!("a place names another patch than the {patches}"))
            })
    }

    fn vectors<'py>(
        &self,
        py: Python<'py>,
        patches: PyArrayLike3<'py, f32, AllowTypeChange>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let patches = patches.as_array();
        if patches.shape() != [self.patches, CONTROLS, 3] {
            return Err(PyValueError::new_err(format!(
                "patches has the shape {:?}, not ({}, {CONTROLS}, 3)",
                patches.shape(),
                self.patches
            )));
        }
        let patches: Vec<Patch> = patches
            .outer_iter()
            .map(|one| std::array::from_fn(|k| [one[[k, 0]], one[[k, 1]], one[[k, 2]], 0.0]))
            .collect();
        let moved = py.detach(|| {
            let mut moved = vec![[0.0; 3]; self.inner.len()];
            self.inner.evaluate(&patches, &mut moved);
            moved.into_flattened()
        });
        PyArray1::from_vec(py, moved).reshape([self.inner.len(), 3])
    }
}
