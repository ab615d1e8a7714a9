//! `Relaxation`: the body's own material, relaxed under forces.

mod given;

use std::sync::{Arc, Mutex};

use numpy::{AllowTypeChange, PyArrayLike3};
use pyo3::prelude::*;

use self::given::{
    GivenFactor, GivenHolds, GivenLaw, GivenMotions, GivenPlaces, GivenSprings, GivenTerm,
    GivenTool, Numbers, Rows, factor, table, unfit,
};
use crate::python::vectors::{self, Matrix};
use crate::servo::paced::locked;
use crate::solid::law::Law;
use crate::solid::load::against::Against;
use crate::solid::load::{Led, Load};
use crate::solid::relaxation::{Relaxation as Relaxing, Solid};
use crate::solid::strained::Strained;
use crate::solid::warp::Warp;

#[pyclass(frozen, module = "palpate_servo")]
pub struct Relaxation {
    inner: Mutex<Relaxing>,
}

#[pymethods]
impl Relaxation {
    #[new]
    #[pyo3(signature = (terms, stiffness, poisson, *, law=None, springs=None, motions=None))]
    fn new(
        terms: Vec<GivenTerm<'_>>,
        stiffness: GivenFactor<'_, f32>,
        poisson: GivenFactor<'_, f64>,
        law: Option<GivenLaw>,
        springs: Option<GivenSprings<'_>>,
        motions: Option<GivenMotions<'_>>,
    ) -> PyResult<Self> {
        let (stiffness, poisson) = (factor(&stiffness)?, factor(&poisson)?);
        let nodes = poisson.len();
        if terms.is_empty() || stiffness.len() != 3 * nodes {
            return Err(unfit());
        }
        let first_shear = terms[0].4.as_array().to_vec();
        let made = (terms.iter())
            .map(|term| given::term(term, nodes))
            .collect::<PyResult<Vec<_>>>()?;
        let weights = made[0].domains.in_fours(&first_shear);
        let springs = springs
            .map(|given| given::springs(&given, nodes))
            .transpose()?;
        let gauge = motions
            .map(|given| given::gauge(&given, nodes))
            .transpose()?;
        let solid = Solid {
            strained: Strained {
                terms: made,
                law: law
                    .map_or(Some(Law::default()), of_powers)
                    .ok_or_else(unfit)?,
                springs,
            },
            warp: Warp::new(weights, poisson),
            stiffness,
            gauge,
        };
        Ok(Self::of(Arc::new(solid)))
    }

    fn another(&self) -> Self {
        Self::of(locked(&self.inner).solid().clone())
    }

    fn warped<'py>(&self, py: Python<'py>, linear: Rows<'_>) -> PyResult<Matrix<'py>> {
        let mut relaxing = locked(&self.inner);
        relaxing.linear = given::rows("linear", &linear, relaxing.solid().nodes())?;
        relaxing.warp();
        table(py, &relaxing.warped)
    }

    fn pulled_back<'py>(
        &self,
        py: Python<'py>,
        linear: Rows<'_>,
        forces: Rows<'_>,
    ) -> PyResult<Matrix<'py>> {
        let mut relaxing = locked(&self.inner);
        let nodes = relaxing.solid().nodes();
        relaxing.linear = given::rows("linear", &linear, nodes)?;
        let mut forces = given::rows("forces", &forces, nodes)?;
        let mut pulled = vec![[0.0; 3]; nodes];
        relaxing.warp();
        relaxing.pull_back(&mut forces, &mut pulled);
        table(py, &pulled)
    }

    fn energy_and_forces<'py>(
        &self,
        py: Python<'py>,
        displacements: Rows<'_>,
    ) -> PyResult<(f64, Matrix<'py>)> {
        let solid = locked(&self.inner).solid().clone();
        let moved = given::rows("displacements", &displacements, solid.nodes())?;
        let mut forces = vec![[0.0; 3]; solid.nodes()];
        let energy = solid.strained.energy_and_forces(&moved, &mut forces);
        Ok((energy, table(py, &forces)?))
    }

    #[pyo3(signature = (linear, forces, steps, turning=None))]
    fn relaxed<'py>(
        &self,
        py: Python<'py>,
        linear: Option<Rows<'_>>,
        forces: Rows<'_>,
        steps: usize,
        turning: Option<Rows<'_>>,
    ) -> PyResult<Matrix<'py>> {
        let nodes = self.nodes(py);
        let linear = linear
            .map(|u| given::rows("linear", &u, nodes))
            .transpose()?;
        let dead = given::rows("forces", &forces, nodes)?;
        let turning = turning
            .map(|t| given::rows("turning", &t, nodes))
            .transpose()?;
        let warped = py.detach(|| {
            let load = Load {
                dead: &dead,
                turning: turning.as_deref(),
                led: None,
                against: None,
            };
            let mut relaxing = locked(&self.inner);
            let linear = linear.unwrap_or_else(|| relaxing.linear_under(&dead));
            relaxing.relax(&linear, &load, steps);
            relaxing.warped.clone()
        });
        table(py, &warped)
    }

    #[pyo3(signature = (linear, patterns, moved, wanted, response, close, most_steps, goes_on=false))]
    #[expect(clippy::too_many_arguments, reason = "Python's names tell them apart")]
    fn led<'py>(
        &self,
        py: Python<'py>,
        linear: Rows<'_>,
        patterns: Vec<Rows<'_>>,
        moved: Vec<Rows<'_>>,
        wanted: Numbers<'_>,
        response: Rows<'_>,
        close: f64,
        most_steps: usize,
        goes_on: bool,
    ) -> PyResult<(Matrix<'py>, Matrix<'py>, Vec<f64>, f64, usize)> {
        let nodes = self.nodes(py);
        let fields = |name: &str, given: &[Rows<'_>]| {
            (given.iter())
                .map(|one| given::rows(name, one, nodes))
                .collect::<PyResult<Vec<_>>>()
        };
        let linear = given::rows("linear", &linear, nodes)?;
        let (patterns, moved) = (fields("patterns", &patterns)?, fields("moved", &moved)?);
        let response = response.as_array().iter().copied().collect();
        let wanted = wanted.as_array().to_vec();
        let mut led = Led::new(patterns, moved, wanted, response).ok_or_else(unfit)?;
        let (linear, warped, pulls, rest) = py.detach(|| {
            let mut relaxing = locked(&self.inner);
            let rest = relaxing.lead((&linear, goes_on), &mut led, close, most_steps);
            let pulls = led.pulls(&relaxing.warped);
            (
                relaxing.linear.clone(),
                relaxing.warped.clone(),
                pulls,
                rest,
            )
        });
        Ok((
            table(py, &linear)?,
            table(py, &warped)?,
            pulls,
            rest.left,
            rest.steps,
        ))
    }

    #[pyo3(signature = (linear, tools, places, compliance, work, close, most_steps, dead=None, loose=None, holds=None, gives=false))]
    #[expect(clippy::too_many_arguments, reason = "Python's names tell them apart")]
    fn kept_out<'py>(
        &self,
        py: Python<'py>,
        linear: Rows<'_>,
        tools: Vec<GivenTool<'_>>,
        places: GivenPlaces<'_>,
        compliance: PyArrayLike3<'_, f64, AllowTypeChange>,
        work: f64,
        close: f64,
        most_steps: usize,
        dead: Option<Rows<'_>>,
        loose: Option<GivenMotions<'_>>,
        holds: Option<GivenHolds<'_>>,
        gives: bool,
    ) -> PyResult<(Matrix<'py>, Matrix<'py>, Matrix<'py>, f64, usize)> {
        let nodes = self.nodes(py);
        let linear = given::rows("linear", &linear, nodes)?;
        let tools = (tools.iter())
            .map(|(tool, position, rotation)| {
                Ok((tool.inner.clone(), vectors::pose(*position, *rotation)?))
            })
            .collect::<PyResult<Vec<_>>>()?;
        let compliance = vectors::matrices("compliance", &compliance)?;
        let known = compliance.len().isqrt();
        let mut places = given::places(&places, nodes, known)?;
        if let Some(holds) = &holds {
            given::hold(holds, &mut places)?;
        }
        let mut against =
            Against::new(places, tools, compliance, known, nodes).ok_or_else(unfit)?;
        against.gives = gives;
        let dead = dead.map_or_else(
            || Ok(vec![[0.0; 3]; nodes]),
            |forces| given::rows("dead", &forces, nodes),
        )?;
        let loose = loose.map(|given| given::gauge(&given, nodes)).transpose()?;
        let (linear, warped, pushes, rest) = py.detach(|| {
            let mut relaxing = locked(&self.inner);
            let load = (dead.as_slice(), &mut against);
            let rest = relaxing.keep_out(&linear, load, loose, (work, close), most_steps);
            let pushes = against.pushes(&relaxing.warped);
            (
                relaxing.linear.clone(),
                relaxing.warped.clone(),
                pushes,
                rest,
            )
        });
        let pushes = vectors::table(py, pushes.into_iter())?;
        Ok((
            table(py, &linear)?,
            table(py, &warped)?,
            pushes,
            rest.left,
            rest.steps,
        ))
    }
}

impl Relaxation {
    fn of(solid: Arc<Solid>) -> Self {
        Self {
            inner: Mutex::new(Relaxing::new(solid)),
        }
    }

    /// Whoever relaxes may take its time: the interpreter goes on.
    fn nodes(&self, py: Python<'_>) -> usize {
        py.detach(|| locked(&self.inner).solid().nodes())
    }
}

fn of_powers((stretches, volume, is_straight): GivenLaw) -> Option<Law> {
    Law::of(&stretches, &volume, is_straight)
}
