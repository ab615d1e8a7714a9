//! The near field of a surface, from the arrays that core names.

use glam::DMat3;
use numpy::{AllowTypeChange, PyArrayLike1, PyArrayLike2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::tool::near_field::{NearField, NodeField, PointField};

use crate::python::vectors::{matrices, vectors};

/// The arrays that `core/contact/near_field/compliance_beneath.py` gives.
const NEAR_FIELD: [&str; 15] = [
    "believed",
    "short",
    "poisson_ratio",
    "normals",
    "edges",
    "softness",
    "regular",
    "slopes",
    "excess",
    "far_nodes",
    "far_weights",
    "shares",
    "softness_of_points",
    "own",
    "lifts",
];

/// From the arrays that `core/contact/near_field/compliance_beneath.py` names.
pub fn near_field(arrays: &Bound<'_, PyDict>) -> PyResult<NearField> {
    // A servo that is older than core would leave out a part of the field, and press wrongly.
    for name in arrays.keys() {
        let name: String = name.extract()?;
        if !NEAR_FIELD.contains(&name.as_str()) {
            return Err(PyValueError::new_err(format!(
                "near has {name}, which this palpate_servo does not know; install the one that \
                 belongs to this palpate (make package, or make test from the source)"
            )));
        }
    }
    let array = |name: &'static str| {
        arrays.get_item(name)?.ok_or_else(|| {
            PyValueError::new_err(format!("near has no {name}; give what native_tool gives"))
        })
    };
    let numbers = |name| -> PyResult<Vec<f64>> {
        let given = array(name)?.extract::<PyArrayLike1<'_, f64, AllowTypeChange>>()?;
        Ok(given.as_array().to_vec())
    };
    let blocks = |name| -> PyResult<Vec<DMat3>> { matrices(name, &array(name)?.extract()?) };
    let limits = |name| -> PyResult<[f64; 2]> { array(name)?.extract() };
    let (believed, short) = (limits("believed")?, limits("short")?);
    let poisson_ratio: f64 = array("poisson_ratio")?.extract()?;
    let normals = vectors("normals", &array("normals")?.extract()?)?;
    let (edges, softness, regular) = (numbers("edges")?, numbers("softness")?, blocks("regular")?);
    let (slopes, excess) = (blocks("slopes")?, numbers("excess")?);
    let far_nodes = array("far_nodes")?.extract::<PyArrayLike2<'_, i64>>()?;
    let far_weights = vectors("far_weights", &array("far_weights")?.extract()?)?;
    let [shares, softness_of_points] = [numbers("shares")?, numbers("softness_of_points")?];
    let own = blocks("own")?;
    let lifts = vectors("lifts", &array("lifts")?.extract()?)?;
    let (nodes, points) = (normals.len(), shares.len());
    if [edges.len(), softness.len(), regular.len(), excess.len()] != [nodes; 4]
        || far_nodes.as_array().dim() != (nodes, 3)
        || far_weights.len() != nodes
        || slopes.len() != 3 * nodes
        || [softness_of_points.len(), own.len()] != [points; 2]
        || lifts.len() % points.max(1) != 0
    {
        return Err(PyValueError::new_err(format!(
            "near is of {nodes} nodes (by normals) and {points} contact points (by shares), and not all of \
             its arrays have a row for each (three of slopes, of lifts alike many); give what native_tool gives"
        )));
    }
    let node = |k: usize| NodeField {
        normal: normals[k],
        edge: edges[k],
        softness: softness[k],
        excess: excess[k],
        regular: regular[k],
        slope: [0, 1, 2].map(|axis| slopes[3 * k + axis]),
        // What is no number of a node is found to be unsound with the rest.
        far_nodes: [0, 1, 2]
            .map(|c| u32::try_from(far_nodes.as_array()[[k, c]]).unwrap_or(u32::MAX)),
        far_weights: far_weights[k].to_array(),
    };
    let point = |k: usize| PointField {
        share: shares[k],
        softness: softness_of_points[k],
        own: own[k],
    };
    Ok(NearField {
        nodes: (0..nodes).map(node).collect(),
        points: (0..points).map(point).collect(),
        lifts,
        believed,
        short,
        poisson_ratio,
    })
}
