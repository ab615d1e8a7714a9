//! What makes a solid, from numpy arrays.

use numpy::{
    AllowTypeChange, PyArray1, PyArrayLike1, PyArrayLike2, PyArrayMethods, PyReadonlyArray1,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::python::tool::shape::Tool;
use crate::python::vectors::{Matrix, misshaped};
use crate::solid::domains::Domains;
use crate::solid::factor::Factor;
use crate::solid::load::hold::Hold;
use crate::solid::load::place::Place;
use crate::solid::relaxation::gauge::Gauge;
use crate::solid::strained::{Springs, Term};

pub(super) type Rows<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;
pub(super) type Numbers<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;
/// Of 32 bits where numpy's own are: on Windows before its version 2, as in Blender 4.5 and 5.0.
pub(super) type Counts<'py> = PyArrayLike1<'py, i64, AllowTypeChange>;
/// Where the entries of each domain begin, their nodes and gradients; Lame's parameters times volumes.
pub(super) type GivenTerm<'py> = (
    Counts<'py>,
    Counts<'py>,
    Rows<'py>,
    Numbers<'py>,
    Numbers<'py>,
);
/// Order of elimination, sizes of fronts, lengths of boundaries, boundaries, entries.
pub(super) type GivenFactor<'py, T> = (
    Counts<'py>,
    Counts<'py>,
    Counts<'py>,
    Counts<'py>,
    PyReadonlyArray1<'py, T>,
);
/// Corners and the same among the nodes known, flat; area coordinates, places at rest, force over depth, which tool.
pub(super) type GivenPlaces<'py> = (
    Counts<'py>,
    Counts<'py>,
    Rows<'py>,
    Rows<'py>,
    Numbers<'py>,
    Counts<'py>,
);
/// Of each place the displacement it is held at, the tool's normal, friction, and what presses there.
pub(super) type GivenHolds<'py> = (Rows<'py>, Rows<'py>, Numbers<'py>, Numbers<'py>, Rows<'py>);
/// Shares and exponents of stretches and of volumes, and whether what is pulled goes on as a parabola.
pub(super) type GivenLaw = (Vec<(f64, f64)>, Vec<(f64, f64)>, bool);
/// Where the entries of each row begin, columns, values.
pub(super) type GivenSprings<'py> = (Counts<'py>, Counts<'py>, Numbers<'py>);
/// Rigid motions of the nodes, the loads of inertia against them, and how loose each is.
pub(super) type GivenMotions<'py> = (Vec<Rows<'py>>, Vec<Rows<'py>>, Vec<f64>);

/// A tool, its position and its rotation.
pub(super) type GivenTool<'py> = (PyRef<'py, Tool>, [f64; 3], [[f64; 3]; 3]);

pub(super) fn rows(name: &str, array: &Rows<'_>, nodes: usize) -> PyResult<Vec<[f64; 3]>> {
    let array = array.as_array();
    if array.shape() != [nodes, 3] {
        let wanted = format!("({nodes}, 3), a row for each free node");
        return Err(misshaped(name, array.shape(), wanted));
    }
    let rows = array.rows().into_iter();
    Ok(rows.map(|row| [row[0], row[1], row[2]]).collect())
}

pub(super) fn table<'py>(py: Python<'py>, field: &[[f64; 3]]) -> PyResult<Matrix<'py>> {
    PyArray1::from_slice(py, field.as_flattened()).reshape([field.len(), 3])
}

pub(super) fn term(
    (starts, nodes, slopes, lame, shear): &GivenTerm<'_>,
    count: usize,
) -> PyResult<Term> {
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

pub(super) fn factor<T: numpy::Element + Copy>(
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

pub(super) fn places(
    (corners, known, alphas, rests, firmness, tools): &GivenPlaces<'_>,
    nodes: usize,
    seen: usize,
) -> PyResult<Vec<Place>> {
    let (corners, known) = (below(corners, nodes)?, below(known, seen)?);
    let tools = sizes(tools)?;
    let (alphas, rests) = (
        rows("alphas", alphas, tools.len())?,
        rows("rests", rests, tools.len())?,
    );
    let firmness = firmness.as_array().to_vec();
    if [corners.len(), known.len()] != [3 * tools.len(); 2] || firmness.len() != tools.len() {
        return Err(unfit());
    }
    let three = |of: &[u32], one: usize| [of[3 * one], of[3 * one + 1], of[3 * one + 2]];
    Ok((0..tools.len())
        .map(|one| Place {
            corners: three(&corners, one),
            known: three(&known, one),
            alpha: alphas[one],
            rest: rests[one].into(),
            firmness: firmness[one],
            tool: tools[one],
            hold: None,
        })
        .collect())
}

/// Has rough tools hold places.
pub(super) fn hold(
    (goals, normals, friction, pushes, pulls): &GivenHolds<'_>,
    places: &mut [Place],
) -> PyResult<()> {
    let goals = rows("goals", goals, places.len())?;
    let normals = rows("normals", normals, places.len())?;
    let pulls = rows("pulls", pulls, places.len())?;
    let (friction, pushes) = (friction.as_array().to_vec(), pushes.as_array().to_vec());
    if [friction.len(), pushes.len()] != [places.len(); 2] {
        return Err(unfit());
    }
    for (one, place) in places.iter_mut().enumerate() {
        place.hold = (friction[one] > 0.0).then(|| Hold {
            goal: goals[one].into(),
            normal: normals[one].into(),
            friction: friction[one],
            push: pushes[one],
            pull: pulls[one].into(),
        });
    }
    Ok(())
}

pub(super) fn springs(
    (starts, columns, values): &GivenSprings<'_>,
    nodes: usize,
) -> PyResult<Springs> {
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

pub(super) fn gauge((motions, loads, gives): &GivenMotions<'_>, nodes: usize) -> PyResult<Gauge> {
    let fields = |name: &str, given: &[Rows<'_>]| {
        (given.iter())
            .map(|one| rows(name, one, nodes))
            .collect::<PyResult<Vec<_>>>()
    };
    let (motions, loads) = (fields("motions", motions)?, fields("loads", loads)?);
    Gauge::new(motions, loads, gives, nodes).ok_or_else(unfit)
}

pub(super) fn sizes(numbers: &Counts<'_>) -> PyResult<Vec<usize>> {
    let numbers = numbers.as_slice()?.iter();
    numbers
        .map(|&one| usize::try_from(one).map_err(|_| unfit()))
        .collect()
}

pub(super) fn below(numbers: &Counts<'_>, count: usize) -> PyResult<Vec<u32>> {
    let numbers = numbers.as_slice()?.iter();
    numbers
        .map(|&one| match usize::try_from(one) {
            Ok(number) if number < count => Ok(number as u32),
            _ => Err(unfit()),
        })
        .collect()
}

pub(super) fn unfit() -> PyErr {
    PyValueError::new_err("arrays of a solid do not fit together; make them of one body")
}
