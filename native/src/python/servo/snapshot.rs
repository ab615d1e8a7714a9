//! `Snapshot` and `FingerSnapshot`: one tick, whole, of all fingers or one.

use glam::DMat3;
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::device::Fault;
use crate::python::servo::told::{Load, Loads, Posed, forces, numbers, posed};
use crate::python::vectors::{Matrix, Vector, array, rows, square, table};
use crate::rest::placement::Placement;
use crate::servo::pressed_patch::{PressedPatch, PressedPoint};
use crate::servo::snapshot::{Published, Snapshot as Shot};

/// One finger of a tick.
#[pyclass(frozen, subclass, module = "palpate_servo")]
#[derive(Clone)]
pub struct FingerSnapshot {
    shot: Shot,
    /// Patch of a tool that touches.
    patch: Option<Box<PressedPatch>>,
}

impl FingerSnapshot {
    /// The same in the axes of a body that is placed there.
    fn seen_from(&self, placement: &Placement) -> Self {
        let (mut shot, mut patch) = (self.shot, self.patch.clone());
        for place in [&mut shot.probe, &mut shot.proxy] {
            *place = placement.place_to_body(*place);
        }
        shot.surface_point = (shot.surface_point).map(|point| placement.place_to_body(point));
        shot.orientation = DMat3::from_quat(placement.rotation.inverse()) * shot.orientation;
        for direction in [
            &mut shot.contact_force,
            &mut shot.output_force,
            &mut shot.torque,
        ] {
            *direction = placement.direction_to_body(*direction);
        }
        if let Some(patch) = &mut patch {
            patch.see_from(placement);
        }
        Self { shot, patch }
    }

    fn pressed(&self) -> &[PressedPoint] {
        self.patch.as_ref().map_or(&[], |patch| patch.points())
    }
}

#[pymethods]
impl FingerSnapshot {
    #[getter]
    fn probe<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.shot.probe)
    }
    #[getter]
    fn proxy<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.shot.proxy)
    }
    #[getter]
    fn orientation<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        square(py, self.shot.orientation)
    }
    #[getter]
    fn triangle<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let nodes = match self.shot.hold {
            Some(_) => self.shot.triangle.map(i64::from),
            None => [-1; 3],
        };
        PyArray1::from_slice(py, &nodes)
    }
    #[getter]
    fn triangle_index(&self) -> i64 {
        self.shot.hold.map_or(-1, |(t, _)| i64::from(t))
    }
    #[getter]
    fn alpha<'py>(&self, py: Python<'py>) -> Vector<'py> {
        PyArray1::from_slice(py, &self.shot.hold.map_or([0.0; 3], |(_, a)| a))
    }
    #[getter]
    fn contact_force<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.shot.contact_force)
    }
    #[getter]
    fn output_force<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.shot.output_force)
    }
    #[getter]
    fn torque<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.shot.torque)
    }
    #[getter]
    fn surface_point<'py>(&self, py: Python<'py>) -> Option<Vector<'py>> {
        self.shot.surface_point.map(|point| array(py, point))
    }
    #[getter]
    fn touching(&self) -> bool {
        self.shot.touching
    }
    #[getter]
    fn sticking(&self) -> bool {
        self.shot.sticking
    }
    #[getter]
    fn state(&self) -> &'static str {
        self.shot.state.name()
    }
    #[getter]
    fn fault(&self) -> &'static str {
        self.shot.fault.map_or("", Fault::name)
    }
    #[getter]
    fn reason(&self) -> &'static str {
        self.shot.reason
    }
    #[getter]
    fn limited(&self) -> &'static str {
        self.shot.limited
    }
    #[getter]
    fn buttons(&self) -> u8 {
        self.shot.buttons
    }
    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let s = &slf.get().shot;
        Ok(format!(
            "{}(tick={}, state={:?}, fault={:?}, probe={}, proxy={}, contact_force={})",
            slf.get_type().name()?,
            s.tick,
            s.state.name(),
            slf.get().fault(),
            s.probe,
            s.proxy,
            s.contact_force
        ))
    }
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let nodes: Vec<i64> = match (&self.patch, self.shot.hold) {
            (Some(patch), _) => patch
                .nodes()
                .iter()
                .map(|&(node, _)| i64::from(node))
                .collect(),
            (None, Some(_)) => self.shot.triangle.map(i64::from).to_vec(),
            (None, None) => Vec::new(),
        };
        PyArray1::from_vec(py, nodes)
    }
    #[getter]
    fn nodal_forces<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        match (&self.patch, self.shot.hold) {
            (Some(patch), _) => table(py, patch.nodes().iter().map(|&(_, force)| force)),
            (None, Some(_)) => rows(py, &self.shot.nodal_forces),
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

/// All fingers of a tick; itself that of finger 0.
#[pyclass(frozen, extends = FingerSnapshot, module = "palpate_servo")]
pub struct Snapshot {
    fingers: Vec<FingerSnapshot>,
    placement: Placement,
    others: Vec<Placement>,
    firmness: f64,
    held: f64,
    loads: Loads,
}

impl Snapshot {
    pub fn of(
        py: Python<'_>,
        published: &Published,
        patches: &[PressedPatch],
        loads: Loads,
    ) -> PyResult<Py<Self>> {
        let reports = published.fingers().iter().enumerate();
        let fingers: Vec<_> = reports
            .map(|(finger, report)| FingerSnapshot {
                shot: report.snapshot,
                patch: patch_of(&report.snapshot, patches.get(finger)),
            })
            .collect();
        let first = fingers[0].clone();
        let told = Self {
            fingers,
            placement: published.placement,
            others: published.others[..published.other_count].to_vec(),
            firmness: published.firmness,
            held: published.held,
            loads,
        };
        Py::new(py, (told, first))
    }

    fn shot(&self) -> &Shot {
        &self.fingers[0].shot
    }
}

#[pymethods]
impl Snapshot {
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
    fn firmness(&self) -> f64 {
        self.firmness
    }
    #[getter]
    fn held(&self) -> f64 {
        self.held
    }
    #[getter]
    fn placement<'py>(&self, py: Python<'py>) -> PyResult<Posed<'py>> {
        posed(py, &self.placement)
    }
    #[getter]
    fn others<'py>(&self, py: Python<'py>) -> PyResult<Vec<Posed<'py>>> {
        self.others.iter().map(|other| posed(py, other)).collect()
    }
    #[getter]
    fn other_loads<'py>(&self, py: Python<'py>) -> PyResult<Vec<Load<'py>>> {
        let others = self.loads.borne.iter().skip(1);
        others
            .map(|load| Ok((numbers(py, load), forces(py, load)?)))
            .collect()
    }
    #[getter]
    fn remembered_nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        numbers(py, &self.loads.remembered)
    }
    #[getter]
    fn remembered_forces<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        forces(py, &self.loads.remembered)
    }
    fn seen_from_body(&self, py: Python<'_>) -> PyResult<Py<Self>> {
        let seen = self.fingers.iter();
        let fingers: Vec<_> = seen.map(|one| one.seen_from(&self.placement)).collect();
        let first = fingers[0].clone();
        let told = Self {
            firmness: self.firmness,
            held: self.held,
            fingers,
            placement: self.placement,
            others: self.others.clone(),
            loads: self.loads.clone(),
        };
        Py::new(py, (told, first))
    }
    #[getter]
    fn borne_nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        numbers(py, self.loads.own())
    }
    #[getter]
    fn borne_forces<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        forces(py, self.loads.own())
    }
    #[getter]
    fn fingers(&self) -> Vec<FingerSnapshot> {
        self.fingers.clone()
    }
}

/// The patch that was published with this tick of a touching tool.
fn patch_of(shot: &Shot, patch: Option<&PressedPatch>) -> Option<Box<PressedPatch>> {
    let presses_with_tool = shot.touching && shot.hold.is_none();
    let patch = patch.filter(|patch| presses_with_tool && patch.tick == shot.tick);
    patch.cloned().map(Box::new)
}
