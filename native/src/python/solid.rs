//! `Relaxation`: the body's own material, relaxed under forces.

use std::sync::{Arc, Mutex};

use numpy::{
    AllowTypeChange, PyArray1, PyArrayLike1, PyArrayLike2, PyArrayMethods, PyReadonlyArray1,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::python::vectors::{Matrix, misshaped};
use crate::servo::paced::locked;
use crate::solid::domains::Domains;
use crate::solid::factor::Factor;
use crate::solid::law::Law;
use crate::solid::load::{Led, Load};
use crate::solid::relaxation::{Relaxation as Relaxing, Solid};
use crate::solid::strained::{Springs, Strained, Term};
use crate::solid::warp::Warp;

type Rows<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;
type Numbers<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;
type Counts<'py> = PyReadonlyArray1<'py, i64>;
/// Where the entries of each domain begin, their nodes and gradients; Lame's parameters times volumes.
type GivenTerm<'py> = (
    Counts<'py>,
    Counts<'py>,
    Rows<'py>,
    Numbers<'py>,
    Numbers<'py>,
);
/// Order of elimination, sizes of fronts, lengths of boundaries, boundaries, entries.
type GivenFactor<'py, T> = (
    Counts<'py>,
    Counts<'py>,
    Counts<'py>,
    Counts<'py>,
    PyReadonlyArray1<'py, T>,
);
/// Shares and exponents of stretches and of volumes, and whether what is pulled goes on as a parabola.
type GivenLaw = (Vec<(f64, f64)>, Vec<(f64, f64)>, bool);
type GivenSprings<'py> = (Counts<'py>, Counts<'py>, Numbers<'py>);

#[pyclass(frozen, module = "palpate_servo")]
pub struct Relaxation {
    inner: Mutex<Relaxing>,
}

#[pymethods]
impl Relaxation {
    #[new]
    #[pyo3(signature = (terms, stiffness, poisson, *, law=None, springs=None))]
    fn new(
        terms: Vec<GivenTerm<'_>>,
        stiffness: GivenFactor<'_, f32>,
        poisson: GivenFactor<'_, f64>,
        law: Option<GivenLaw>,
        springs: Option<GivenSprings<'_>>,
    ) -> PyResult<Self> {
        let (stiffness, poisson) = (factor(&stiffness)?, factor(&poisson)?);
        let nodes = poisson.len();
        if terms.is_empty() || stiffness.len() != 3 * nodes {
            return Err(unfit());
        }
        let first_shear = terms[0].4.as_array().to_vec();
        let made = (terms.iter())
            .map(|term| self::term(term, nodes))
            .collect::<PyResult<Vec<_>>>()?;
        let weights = made[0].domains.in_fours(&first_shear);
        let springs = springs
            .map(|given| self::springs(&given, nodes))
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
        };
        Ok(Self::of(Arc::new(solid)))
    }

    fn another(&self) -> Self {
        Self::of(locked(&self.inner).solid().clone())
    }

    fn warped<'py>(&self, py: Python<'py>, linear: Rows<'_>) -> PyResult<Matrix<'py>> {
        let mut relaxing = locked(&self.inner);
        relaxing.linear = self::rows("linear", &linear, relaxing.solid().nodes())?;
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
        relaxing.linear = self::rows("linear", &linear, nodes)?;
        let forces = self::rows("forces", &forces, nodes)?;
        let mut pulled = vec![[0.0; 3]; nodes];
        relaxing.warp();
        relaxing.pull_back(&forces, &mut pulled);
        table(py, &pulled)
    }

    fn energy_and_forces<'py>(
        &self,
        py: Python<'py>,
        displacements: Rows<'_>,
    ) -> PyResult<(f64, Matrix<'py>)> {
        let solid = locked(&self.inner).solid().clone();
        let moved = self::rows("displacements", &displacements, solid.nodes())?;
        let mut forces = vec![[0.0; 3]; solid.nodes()];
        let energy = solid.strained.energy_and_forces(&moved, &mut forces);
        Ok((energy, table(py, &forces)?))
    }

    #[pyo3(signature = (linear, forces, steps, turning=None))]
    fn relaxed<'py>(
        &self,
        py: Python<'py>,
        linear: Rows<'_>,
        forces: Rows<'_>,
        steps: usize,
        turning: Option<Rows<'_>>,
    ) -> PyResult<Matrix<'py>> {
        let nodes = self.nodes(py);
        let linear = self::rows("linear", &linear, nodes)?;
        let dead = self::rows("forces", &forces, nodes)?;
        let turning = turning
            .map(|t| self::rows("turning", &t, nodes))
            .transpose()?;
        let warped = py.detach(|| {
            let load = Load {
                dead: &dead,
                turning: turning.as_deref(),
                led: None,
            };
            let mut relaxing = locked(&self.inner);
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
                .map(|one| self::rows(name, one, nodes))
                .collect::<PyResult<Vec<_>>>()
        };
        let linear = self::rows("linear", &linear, nodes)?;
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

fn rows(name: &str, array: &Rows<'_>, nodes: usize) -> PyResult<Vec<[f64; 3]>> {
    let array = array.as_array();
    if array.shape() != [nodes, 3] {
        let wanted = format!("({nodes}, 3), a row for each free node");
        return Err(misshaped(name, array.shape(), wanted));
    }
    let rows = array.rows().into_iter();
    Ok(rows.map(|row| [row[0], row[1], row[2]]).collect())
}

fn table<'py>(py: Python<'py>, field: &[[f64; 3]]) -> PyResult<Matrix<'py>> {
    PyArray1::from_slice(py, field.as_flattened()).reshape([field.len(), 3])
}

fn term((starts, nodes, slopes, lame, shear): &GivenTerm<'_>, count: usize) -> PyResult<Term> {
    let starts = sizes(starts)?;
    let nodes: Vec<u32> = below(nodes, count)?;
    let slopes = rows("gradients", slopes, nodes.len())?;
    let domains = starts.len().saturating_sub(1);
    let (lame, shear) = (lame.as_array().to_vec(), shear.as_array().to_vec());
    let is_rising = starts.windows(2).all(|pair| pair[0] <= pair[1]);
    let is_whole = starts.first() == Some(&0) && starts.last() == Some(&nodes.len());
    if !(is_rising && is_whole && lame.len() == domains && shear.len() == domains) {
        return Err(unfit());
    }
    let domains = Domains::new(&starts, &nodes, &slopes);
    let moduli = (domains.in_fours(&lame).into_iter())
        .zip(domains.in_fours(&shear))
        .collect();
    Ok(Term { domains, moduli })
}

fn factor<T: numpy::Element + Copy>(
    (order, fronts, reaches, boundaries, entries): &GivenFactor<'_, T>,
) -> PyResult<Factor<T>> {
    let order_length = order.as_slice()?.len();
    let sizes: Vec<_> = (self::sizes(fronts)?.into_iter())
        .zip(self::sizes(reaches)?)
        .collect();
    let (order, boundaries) = (
        below(order, order_length)?,
        below(boundaries, order_length)?,
    );
    Factor::new(order, &sizes, boundaries, entries.as_slice()?.to_vec()).ok_or_else(unfit)
}

fn springs((starts, columns, values): &GivenSprings<'_>, nodes: usize) -> PyResult<Springs> {
    let (starts, columns) = (sizes(starts)?, below(columns, nodes)?);
    let values = values.as_array().to_vec();
    let is_whole = starts.len() == nodes + 1
        && starts.windows(2).all(|pair| pair[0] <= pair[1])
        && starts[nodes] == columns.len()
        && columns.len() == values.len();
    if is_whole {
        Ok(Springs::new(starts, columns, values))
    } else {
        Err(unfit())
    }
}

fn sizes(numbers: &Counts<'_>) -> PyResult<Vec<usize>> {
    let numbers = numbers.as_slice()?.iter();
    numbers
        .map(|&one| usize::try_from(one).map_err(|_| unfit()))
        .collect()
}

fn below(numbers: &Counts<'_>, count: usize) -> PyResult<Vec<u32>> {
    let numbers = numbers.as_slice()?.iter();
    numbers
        .map(|&one| match usize::try_from(one) {
            Ok(number) if number < count => Ok(number as u32),
            _ => Err(unfit()),
        })
        .collect()
}

fn of_powers((stretches, volume, is_straight): GivenLaw) -> Option<Law> {
    Law::of(&stretches, &volume, is_straight)
}

fn unfit() -> PyErr {
    PyValueError::new_err("arrays of a solid do not fit together; make them of one body")
}
