"""Paths on which contacts are made and broken, and lead over facets, edges and nodes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from palpate.core.body.soft_body import SoftBody

from .smooth_places import Place

Vectors = NDArray[np.float64]

# How far above the surface fingers wait, metres.
LIFT = 0.001


def press(place: Place, depth: float, sideways: float = 0.0) -> Vectors:
    """In and out again, (3, 1, 3), beginning so far beside the place."""
    above = place.at + sideways * place.along
    heights = np.array([LIFT, -depth, LIFT])
    return (above + heights[:, None] * place.normal)[:, None]


def slide(body: SoftBody, place: Place, depth: float, length: float, parts: int = 24) -> Vectors:
    """Down, along the surface and up again, (parts + 3, 1, 3), through the place."""
    offsets = np.linspace(-0.5, 0.5, parts + 1) * length
    line = place.at + offsets[:, None] * place.along
    # Back to the surface along the normal, in three rounds as the surface is nearly flat.
    for _ in range(3):
        found = body.closest_points.query(line).position
        line = line + ((found - line) @ place.normal)[:, None] * place.normal
    pressed = line - depth * place.normal
    up = (depth + LIFT) * place.normal
    return np.concatenate([[pressed[0] + up], pressed, [pressed[-1] + up]])[:, None]


def moved_to_node(body: SoftBody, place: Place) -> Place:
    """The place moved to the nearest node of the surface."""
    nodes = body.mesh.nodes[body.mesh.surface_nodes]
    nearest = nodes[np.linalg.norm(nodes - place.at, axis=1).argmin()]
    return Place(nearest, place.normal, place.along, place.bend)


def beside(place: Place, depth: float, apart: float) -> Vectors:
    """One finger goes in and stays; another comes and goes twice beside it. (k, 2, 3)."""
    there = place.at + apart * place.along
    first = np.array([LIFT, -depth, -depth, -depth, -depth, -depth, LIFT])
    second = np.array([LIFT, LIFT, -0.8 * depth, LIFT, -1.2 * depth, LIFT, LIFT])
    down = place.normal
    return np.stack([place.at + first[:, None] * down, there + second[:, None] * down], axis=1)


def passing(place: Place, depth: float, length: float) -> Vectors:
    """One finger stays in; another goes in, is drawn past it through its very place. (k, 2, 3)."""
    heights = np.array([LIFT, -depth, -depth, LIFT])[:, None] * place.normal
    drawn = np.array([-0.5, -0.5, 0.5, 0.5])[:, None] * length * place.along
    return np.stack([place.at + heights, place.at + drawn + heights], axis=1)


def pinch(body: SoftBody, place: Place, depth: float) -> Vectors:
    """Two fingers from opposite sides, together and apart, one before the other. (k, 2, 3)."""
    far = opposite(body, place)
    first = np.array([LIFT, -depth, -depth, LIFT, LIFT])
    second = np.array([LIFT, -0.3 * depth, -depth, -0.5 * depth, LIFT])
    left = place.at + first[:, None] * place.normal
    return np.stack([left, far - second[:, None] * place.normal], axis=1)


def opposite(body: SoftBody, place: Place) -> Vectors:
    """Where the line through the place against its normal leaves the body, (3,)."""
    nodes = body.mesh.nodes[body.mesh.surface_nodes]
    a, b, c = (nodes[body.mesh.surface_local_triangles[:, k]] for k in range(3))
    sides = np.stack([a - c, b - c, np.broadcast_to(place.normal, a.shape)], axis=2)
    solvable = np.abs(np.linalg.det(sides)) > 1e-18
    alpha, beta, way = np.linalg.solve(sides[solvable], (place.at - c[solvable])[..., None])[
        ..., 0
    ].T
    # at = c + alpha (a - c) + beta (b - c) + way normal
    hit = (alpha >= 0.0) & (beta >= 0.0) & (alpha + beta <= 1.0) & (way > 1e-6)
    distance = float(way[hit].min())
    leaving: Vectors = place.at - distance * place.normal
    return leaving
