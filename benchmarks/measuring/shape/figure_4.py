"""The paper's Figure 4: one node, one displacement, with and without the correction of (16)."""

from __future__ import annotations

from itertools import combinations, product
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LightSource
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import NDArray

from palpate.core.body.soft_body import SoftBody
from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.shape.paper.paper_formula import paper_displacements
from palpate.core.shape.paper.paper_table import PaperTable
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import NoEquilibrium, equilibrium

FACE, CORAL, INK = "#7cc4c4", "#e4572e", "#263238"
TITLES = ("linear (15)", "corrected (16)", "Newton, same force")

# Which node, in shares of the cube, and how far it is moved, in millimetres. The paper tells that
# node and displacement are the same in both pictures, and not which they are.
PRESSES = (
    ("top dragged sideways", (0.5, 0.5, 1.0), (24.0, 0.0, 0.0)),
    ("edge pulled out", (1.0, 0.5, 1.0), (16.0, 0.0, 8.0)),
)


def draw_figure_4(path: Path, table: PaperTable) -> None:
    """Draw it as a picture, and print how far the shapes are from Newton's."""
    body = table.body
    solid = FreeSolid.of(body, StVenantKirchhoff())
    figure = plt.figure(figsize=(10.5, 2.9 * len(PRESSES)), layout="constrained")
    for row, (name, share, millimetres) in enumerate(PRESSES):
        node, shapes = _shapes(table, solid, np.array(share), 1e-3 * np.array(millimetres))
        for column, (title, shape) in enumerate(zip(TITLES, shapes, strict=True)):
            ax = figure.add_subplot(
                len(PRESSES), 3, 3 * row + column + 1, projection="3d", computed_zorder=False
            )
            _draw(ax, body, shape, node)
            volume = enclosed(body, shape) / enclosed(body, np.zeros_like(shape))
            ax.set_title(f"{name}: {title}\nvolume {volume:.3f}", color=INK, fontsize=9.5, y=0.98)
        linear, corrected, true = shapes
        size = np.linalg.norm(true)
        errors = [np.linalg.norm(shape - true) / size for shape in (linear, corrected)]
        print(f"{name}: from Newton {errors[0]:.1%} linear, {errors[1]:.1%} by (16)")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _shapes(
    table: PaperTable,
    solid: FreeSolid,
    share: NDArray[np.float64],
    displacement: NDArray[np.float64],
) -> tuple[int, list[NDArray[np.float64]]]:
    """The node's place in the free surface, and displacements (n, 3) in three ways."""
    body = table.body
    nodes = body.compliance.free_surface
    place = int(np.linalg.norm(body.mesh.nodes[nodes] - share * 0.05, axis=1).argmin())
    # Equation (9), at unit modulus.
    force = np.linalg.solve(body.compliance.block(place, place), displacement)
    largest = body.young_modulus * table.largest[place]
    newton = body.young_modulus * force
    print(f"force {np.round(newton, 3)} N, F0 {largest[:, 0]} N and {-largest[:, 1]} N")
    columns = table.columns(np.array([place]))
    linear = (force @ columns.linear).reshape(-1, 3)
    corrected = paper_displacements(columns, force).reshape(-1, 3)
    loads = solid.on_free_nodes(nodes[[place]], force[None])
    try:
        true = equilibrium(solid, loads).displacements
    except NoEquilibrium as told:
        print(f"the solid carries {told.held:.0%} of this force")
        true = told.displacements
    return place, [linear, corrected, true[solid.surface]]


def enclosed(body: SoftBody, displacements: NDArray[np.float64]) -> float:
    """The volume within the surface, cubic metres."""
    a, b, c = _moved(body, displacements)[body.mesh.surface_triangles].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def _moved(body: SoftBody, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
    places: NDArray[np.float64] = body.mesh.nodes.copy()
    places[body.compliance.free_surface] += displacements
    return places


def _draw(ax: plt.Axes, body: SoftBody, shape: NDArray[np.float64], node: int) -> None:
    places = 1e3 * _moved(body, shape)
    light = LightSource(azdeg=-80, altdeg=40)
    faces = Poly3DCollection(
        places[body.mesh.surface_triangles],
        facecolors=FACE,
        edgecolors=INK,
        linewidths=0.3,
        shade=True,
        lightsource=light,
    )
    ax.add_collection3d(faces)
    corner = 1e3 * body.mesh.nodes.max(axis=0)
    for start, end in combinations(product((0.0, 1.0), repeat=3), 2):
        if sum(map(abs, np.subtract(start, end))) == 1:
            line = np.stack([np.array(start), np.array(end)]) * corner
            ax.plot(*line.T, color=INK, linewidth=0.6, linestyle=(0, (4, 3)), zorder=0)
    at_rest = 1e3 * body.mesh.nodes[body.compliance.free_surface[node]]
    moved = places[body.compliance.free_surface[node]]
    ax.plot(*np.stack([at_rest, moved]).T, color=CORAL, linewidth=2.0, zorder=10)
    ax.scatter(*moved, color=CORAL, s=18, depthshade=False, zorder=11)
    ax.set(xlim=(-5, 75), ylim=(0, 50), zlim=(0, 60))
    ax.set_box_aspect((80, 50, 60), zoom=1.3)
    ax.view_init(elev=16, azim=-68)
    ax.set_proj_type("ortho")
    ax.set_axis_off()
