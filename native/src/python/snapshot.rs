//! `Snapshot`: one tick, whole, of one finger or all; and the recorded ticks as a structured array.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyList};

use super::vectors::{Matrix, Vector, array, rows, square, table};
use crate::device::Fault;
use crate::pressed_patch::{PressedPatch, PressedPoint};
use crate::snapshot::{Published, Sample};

#[pyclass(frozen, module = "palpate_servo")]
pub struct Snapshot {
    inner: Box<Published>,
    patches: Vec<PressedPatch>,
}

/// One finger of a tick.
#[pyclass(frozen, module = "palpate_servo")]
pub struct FingerSnapshot {
    inner: crate::snapshot::Snapshot,
    /// Of a tool that touches.
    patch: Option<Box<PressedPatch>>,
}

impl Snapshot {
    /// Of all fingers, and first of all of finger 0.
    pub fn of(published: &Published, patches: Vec<PressedPatch>) -> Self {
        Self {
            inner: Box::new(*published),
            patches,
        }
    }

    fn shot(&self) -> &crate::snapshot::Snapshot {
        &self.inner.first().snapshot
    }
}

impl FingerSnapshot {
    fn pressed(&self) -> &[PressedPoint] {
        self.patch.as_ref().map_or(&[], |patch| patch.points())
    }

    fn shot(&self) -> &crate::snapshot::Snapshot {
        &self.inner
    }
}

/// What snapshots of finger 0 and of any finger have in common.
macro_rules! snapshot_methods {
    ($name:ident, $($own:item)*) => {
        #[pymethods]
        impl $name {
            #[getter]
            fn probe<'py>(&self, py: Python<'py>) -> Vector<'py> {
                array(py, self.shot().probe)
            }
            #[getter]
            fn proxy<'py>(&self, py: Python<'py>) -> Vector<'py> {
                array(py, self.shot().proxy)
            }
            #[getter]
            fn orientation<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
                square(py, self.shot().orientation)
            }
            #[getter]
            fn triangle<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
                let nodes = match self.shot().hold {
                    Some(_) => self.shot().triangle.map(i64::from),
                    None => [-1; 3],
                };
                PyArray1::from_slice(py, &nodes)
            }
            #[getter]
            fn triangle_index(&self) -> i64 {
                self.shot().hold.map_or(-1, |(t, _)| i64::from(t))
            }
            #[getter]
            fn alpha<'py>(&self, py: Python<'py>) -> Vector<'py> {
                PyArray1::from_slice(py, &self.shot().hold.map_or([0.0; 3], |(_, a)| a))
            }
            #[getter]
            fn contact_force<'py>(&self, py: Python<'py>) -> Vector<'py> {
                array(py, self.shot().contact_force)
            }
            #[getter]
            fn felt(&self) -> &'static str {
                self.shot().felt.name()
            }
            #[getter]
            fn felt_share(&self) -> f64 {
                self.shot().felt_share
            }
            #[getter]
            fn output_force<'py>(&self, py: Python<'py>) -> Vector<'py> {
                array(py, self.shot().output_force)
            }
            #[getter]
            fn torque<'py>(&self, py: Python<'py>) -> Vector<'py> {
                array(py, self.shot().torque)
            }
            #[getter]
            fn surface_point<'py>(&self, py: Python<'py>) -> Option<Vector<'py>> {
                self.shot().surface_point.map(|point| array(py, point))
            }
            #[getter]
            fn touching(&self) -> bool {
                self.shot().touching
            }
            #[getter]
            fn sticking(&self) -> bool {
                self.shot().sticking
            }
            #[getter]
            fn state(&self) -> &'static str {
                self.shot().state.name()
            }
            #[getter]
            fn fault(&self) -> &'static str {
                self.shot().fault.map_or("", Fault::name)
            }
            #[getter]
            fn reason(&self) -> &'static str {
                self.shot().reason
            }
            #[getter]
            fn limited(&self) -> &'static str {
                self.shot().limited
            }
            #[getter]
            fn buttons(&self) -> u8 {
                self.shot().buttons
            }
            fn __repr__(&self) -> String {
                let s = self.shot();
                format!(
                    "{}(tick={}, state={:?}, fault={:?}, probe={}, proxy={}, contact_force={})",
                    stringify!($name),
                    s.tick,
                    s.state.name(),
                    self.fault(),
                    s.probe,
                    s.proxy,
                    s.contact_force
                )
            }
            $($own)*
        }
    };
}

snapshot_methods! {
    Snapshot,
    #[getter]
    fn tick(&self) -> u64 {
        self.shot().tick
    }
    #[getter]
    fn time(&self) -> f64 {
        self.shot().time
    }
    #[getter]
    fn body(&self) -> u32 {
        self.shot().body
    }
    #[getter]
    fn nodal_forces<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        rows(py, &self.shot().nodal_forces)
    }
    #[getter]
    fn fingers(&self) -> Vec<FingerSnapshot> {
        let told = self.inner.fingers().iter().enumerate();
        let patch_of = |finger: usize, shot: &crate::snapshot::Snapshot| {
            let presses_with_tool = shot.touching && shot.hold.is_none();
            let patch = self.patches.get(finger).filter(|_| presses_with_tool)?;
            (patch.tick == shot.tick).then(|| Box::new(patch.clone()))
        };
        told.map(|(finger, told)| FingerSnapshot {
            inner: told.snapshot,
            patch: patch_of(finger, &told.snapshot),
        })
        .collect()
    }
}

snapshot_methods! {
    FingerSnapshot,
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let nodes: Vec<i64> = match (&self.patch, self.inner.hold) {
            (Some(patch), _) => patch.nodes().iter().map(|&(node, _)| i64::from(node)).collect(),
            (None, Some(_)) => self.inner.triangle.map(i64::from).to_vec(),
            (None, None) => Vec::new(),
        };
        PyArray1::from_vec(py, nodes)
    }
    #[getter]
    fn nodal_forces<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        match (&self.patch, self.inner.hold) {
            (Some(patch), _) => table(py, patch.nodes().iter().map(|&(_, force)| force)),
            (None, Some(_)) => rows(py, &self.inner.nodal_forces),
            (None, None) => table(py, std::iter::empty()),
        }
    }
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        table(py, self.pressed().iter().map(|point| point.position))
    }
    #[getter]
    fn point_forces<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        table(py, self.pressed().iter().map(|point| point.force))
    }
    #[getter]
    fn pressures<'py>(&self, py: Python<'py>) -> Vector<'py> {
        PyArray1::from_iter(py, self.pressed().iter().map(|point| point.pressure))
    }
}

fn bytes_of(samples: &[Sample]) -> &[u8] {
    let length = std::mem::size_of_val(samples);
    // SAFETY: `Sample` is `repr(C)` of numbers of 8 bytes and then two of 4, without padding.
    unsafe { std::slice::from_raw_parts(samples.as_ptr().cast::<u8>(), length) }
}

/// Samples as a structured numpy array of their own.
pub fn structured<'py>(py: Python<'py>, samples: &[Sample]) -> PyResult<Bound<'py, PyAny>> {
    structured_pieces(py, std::slice::from_ref(&samples))
}

/// Samples in pieces as one structured numpy array.
pub fn structured_pieces<'py>(
    py: Python<'py>,
    pieces: &[impl AsRef<[Sample]>],
) -> PyResult<Bound<'py, PyAny>> {
    let pieces = || pieces.iter().map(|piece| bytes_of(piece.as_ref()));
    let length = pieces().map(<[u8]>::len).sum();
    let bytes = PyByteArray::new_with(py, length, |mut bytes| {
        for piece in pieces() {
            let (head, rest) = bytes.split_at_mut(piece.len());
            head.copy_from_slice(piece);
            bytes = rest;
        }
        Ok(())
    })?;
    let numpy = py.import("numpy")?;
    let dtype = numpy.call_method1("dtype", (sample_fields(py)?,))?;
    numpy.call_method1("frombuffer", (bytes, dtype))
}

fn sample_fields<'py>(py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
    const _: () = assert!(size_of::<Sample>() == 18 * 8);
    let number = |name: &str, kind: &str| (name, kind).into_pyobject(py).map(Bound::into_any);
    let vector = |name: &str| (name, "=f8", (3,)).into_pyobject(py).map(Bound::into_any);
    PyList::new(
        py,
        [
            number("tick", "=u8")?,
            number("time", "=f8")?,
            vector("probe")?,
            vector("proxy")?,
            vector("surface")?,
            vector("force")?,
            vector("output")?,
            number("state", "=u4")?,
            number("finger", "=u4")?,
        ],
    )
}
