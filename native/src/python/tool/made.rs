//! A tool for a finger: which it is, and the contact points that it meets.

use std::sync::Arc;

use pyo3::prelude::*;

use crate::python::tool::shape::Tool;
use crate::python::tool::surface::ToolSurface;
use crate::servo::tip::Tip;
use crate::tool::collider::Collider;
use crate::tool::points;
use crate::tool::shape;

/// A pair of Python's, (ToolSurface, Tool).
pub type GivenTool<'py> = (PyRef<'py, ToolSurface>, PyRef<'py, Tool>);

/// Its own copy.
pub type MadeTool = (Arc<points::ToolSurface>, shape::Tool);

pub fn made((surface, tool): &GivenTool<'_>) -> MadeTool {
    (surface.inner.clone(), tool.inner.clone())
}

/// A tip with all its memory; a point for no tool.
pub fn tip(made: Option<MadeTool>) -> Tip {
    made.map_or(Tip::Point, |(surface, tool)| {
        Tip::Tool(Box::new(Collider::new(surface, tool)))
    })
}
