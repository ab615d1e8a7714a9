"""Where a free body can be touched: contact points as fine as its surface is curved.

A round place meets a flat one in a small patch, a flat place in a wide one. So points lie as close
as the body is round there, on the curved surface that its triangles stand for: a patch then holds
about as many points, and as good a pressure, wherever the body lies.
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..body.soft_body import SoftBody
from ..contact.near_field.compliance_beneath import near_correction
from ..contact.near_field.contact_points import contact_points, spacing_on
from ..contact.near_field.surface_shape import CREASE_ANGLE, face_areas, face_normals, surface_area
from ..contact.tool.tool_surface import Touchable, surface_and_correction
from ..contact.tool.tools import Tool
from ..mesh.tet_mesh import TetMesh
from .definite import lifted

Array = NDArray[np.float64]

# Points lie apart by this share of the geometric mean of the two radii of curvature. Pressed by a
# sixtieth of its size between two plates a ball has twelve to eighteen in each patch, and its force
# is found within 2 % (tests/core/rest/test_hertz_on_floor.py).
SHARE_OF_RADIUS = 1.0 / 12.0
# Nowhere closer or farther apart than these shares of the root of the surface: a flat side of a
# cube has some fifty.
CLOSEST, FARTHEST = 1.0 / 60.0, 1.0 / 14.0
# Tools have points of their own where they ask for ones closer than this share of the supports'.
# Between two sets the body gives way as its elements have it, without the near field that is
# between points of one: where hands and floor meet at an edge that could give energy.
FINER = 0.4
# Curvature is that of the surface within so many of the farthest spacings.
SEEN_AROUND = 1.5
# Between places of which it is known it is that of so many of the nearest.
NEAREST = 4

_touchable: WeakKeyDictionary[SoftBody, dict[float | None, Touchable]] = WeakKeyDictionary()


def bearing_points(body: SoftBody, spacing: float | None = None) -> Touchable:
    """Points that floor and supports can press, and their near field; cached with the body.

    ``spacing`` in metres, or None for one that follows the curvature.
    """
    known = _touchable.setdefault(body, {})
    if spacing not in known:
        chosen = curved_spacings(body) if spacing is None else spacing
        known[spacing] = _touched(body, chosen)
    return known[spacing]


def even_points(body: SoftBody, spacing: float | None = None) -> Touchable:
    """The same, alike everywhere: few enough for a tick of 1 kHz unless ``spacing`` is told."""
    return bearing_points(body, even_spacing(body) if spacing is None else spacing)


def even_spacing(body: SoftBody) -> float:
    """How far apart points are of which a tick of 1 kHz has time for all, metres."""
    return FARTHEST * float(np.sqrt(surface_area(body.mesh)))


def pressing_points(body: SoftBody, tool: Tool, spacing: float | None = None) -> Touchable:
    """Points that a tool can press: the supports', or where it asks for much finer ones as fine as
    that and as the body is curved, or those of the tool alone where ``spacing`` says how far the
    supports' lie apart.
    """
    if spacing is not None:
        return surface_and_correction(body, tool)
    asked = spacing_on(body, tool.spacing)
    by_body = curved_spacings(body)
    if asked >= FINER * by_body.max():
        return bearing_points(body)
    known = _touchable.setdefault(body, {})
    if -asked not in known:
        known[-asked] = _touched(body, np.minimum(asked, by_body))
    return known[-asked]


def _touched(body: SoftBody, spacing: float | Array) -> Touchable:
    points = contact_points(body, spacing, rounded=True)
    return points, lifted(body, near_correction(body, points), even_spacing(body))


def curved_spacings(body: SoftBody) -> Array:
    """Distance between contact points that suits the surface at each of its nodes, (s,), metres."""
    mesh = body.mesh
    root = float(np.sqrt(surface_area(mesh)))
    places = contact_points(body, FARTHEST * root)
    around = SEEN_AROUND * FARTHEST * root
    bent = np.maximum(curvatures(mesh, places.positions, places.normals, around), 1.0 / root)
    spacing = np.clip(SHARE_OF_RADIUS / np.sqrt(bent.prod(axis=1)), CLOSEST * root, FARTHEST * root)
    nodes = mesh.nodes[mesh.surface_nodes]
    nearest = cKDTree(places.positions).query(nodes, min(NEAREST, len(places)))[1]
    mean: Array = np.exp(np.log(spacing)[nearest.reshape(len(nodes), -1)].mean(axis=1))
    return mean


def curvatures(mesh: TetMesh, places: Array, normals: Array, around: float) -> Array:
    """Both principal curvatures (p, 2) at ``places`` (p, 3) with unit ``normals``, 1/metre.

    Positive where the body is convex. The normals of the triangles within ``around`` metres, but
    beyond no crease, turn with the way there as a linear map has it, found by least squares.
    """
    centres = mesh.nodes[mesh.surface_triangles].mean(axis=1)
    faces, areas = face_normals(mesh), face_areas(mesh)
    tree = cKDTree(centres)
    place = np.repeat(
        np.arange(len(places)), tree.query_ball_point(places, around, return_length=True)
    )
    triangle = np.concatenate(
        [np.asarray(few, np.int64) for few in tree.query_ball_point(places, around)]
    )
    alike = np.einsum("kx,kx->k", normals[place], faces[triangle]) > np.cos(CREASE_ANGLE)
    place, triangle = place[alike], triangle[alike]
    frames = np.stack(_across(normals), axis=1)[place]
    way = np.einsum("kax,kx->ka", frames, centres[triangle] - places[place])
    turn = np.einsum("kax,kx->ka", frames, faces[triangle])
    x, y = way.T
    none = np.zeros_like(x)
    # Of the map's entries xx, xy and yy: what they make of the way, and so the normal equations.
    made = np.stack([np.stack([x, y, none], 1), np.stack([none, x, y], 1)], axis=1)
    weighted = areas[triangle, None, None] * made
    square, aimed = np.zeros((len(places), 3, 3)), np.zeros((len(places), 3))
    np.add.at(square, place, np.einsum("kai,kaj->kij", weighted, made))
    np.add.at(aimed, place, np.einsum("kai,ka->ki", weighted, turn))
    # Where there is one triangle or none nothing bends.
    least = 1e-6 * np.einsum("pii->p", square) + np.finfo(np.float64).tiny
    xx, xy, yy = np.linalg.solve(square + least[:, None, None] * np.eye(3), aimed[:, :, None])[
        :, :, 0
    ].T
    mean, apart = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    both: Array = np.stack([mean + apart, mean - apart], axis=1)
    return both


def _across(normals: Array) -> tuple[Array, Array]:
    """Two unit directions (p, 3) across each normal and each other."""
    aside = np.eye(3)[np.abs(normals).argmin(axis=1)]
    first = np.cross(normals, aside)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(normals, first)
