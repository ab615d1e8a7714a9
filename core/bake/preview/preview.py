"""What is baked for a preview: a lattice, held and stiffened as the fine body is."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from palpate_servo import closest_points

from ...mesh.surface import Surface
from ...mesh.tet_mesh import TetMesh
from ...stiffness.pins import held_at, pinned_nodes
from ...stiffness.regions import TetScale, young_scale
from ..settings import BakeSettings
from .lattice import lattice

# Vertices of the surface that are compared, at most.
COMPARED = 20_000
# What a preview is off at least: it gives way otherwise than fine tetrahedra, wherever it lies.
LEAST_OFF = 0.01


@dataclass(frozen=True, eq=False)
class Preview:
    """Source and settings of a bake that takes a moment.

    Attributes
    ----------
    off : largest distance of the surface's vertices from the lattice, as a share of the diagonal,
        and never less than a hundredth.
    """

    mesh: TetMesh
    settings: BakeSettings
    off: float


def preview(surface: Surface, settings: BakeSettings) -> Preview:
    """Coarse body of a surface, in about a tenth of a second.

    Raises
    ------
    PalpateError
        The lattice is too coarse for the pins; the surface encloses nothing.
    """
    mesh = lattice(surface)
    # By nodes and tetrahedra, so that the surface is not compared once more.
    held = held_at(pinned_nodes(settings.pins, mesh, surface))
    stiffness = settings.stiffness
    if stiffness is not None:
        stiffness = TetScale(young_scale(stiffness, mesh, surface))
    coarse = replace(settings, pins=held, stiffness=stiffness, form="dense")
    return Preview(mesh, coarse, _off(mesh, surface))


def _off(mesh: TetMesh, surface: Surface) -> float:
    asked = surface.vertices[:: 1 + len(surface.vertices) // COMPARED]
    triangle, alpha = closest_points(mesh.nodes, mesh.surface_triangles, asked)
    corners = mesh.nodes[mesh.surface_triangles[triangle]]
    away = np.linalg.norm(np.einsum("pc,pcx->px", alpha, corners) - asked, axis=1)
    return max(LEAST_OFF, float(away.max() / surface.diagonal))
