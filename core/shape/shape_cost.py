"""Cost of a shape, predicted from a body's size."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .paper.paper_shape import MOST_BYTES
from .rotation_strain.rotation_strain_shape import frame_plan
from .shapes import ShapeName

# The coefficients below were measured on a body of so many nodes, and their exponents up to 20,000.
MEASURED_NODES = 1700


@dataclass(frozen=True)
class BodySize:
    """Counts of a body: its nodes, tetrahedra and free surface nodes."""

    nodes: int
    tets: int
    free_surface_nodes: int


@dataclass(frozen=True)
class ShapeCost:
    """About what a shape takes; right within a factor of two on machines of this decade.

    Attributes
    ----------
    frame_seconds : for each frame that is drawn.
    first_seconds : from the first touch until the shape is drawn as it should be.
    table_seconds : for a table of the whole body; 0 without a table.
    memory_bytes : beyond the body itself, a whole table included.
    """

    frame_seconds: float
    first_seconds: float
    table_seconds: float
    memory_bytes: float


def shape_cost(name: ShapeName, size: BodySize) -> ShapeCost:
    """The cost of a shape for a body of this size."""
    match name:
        case "linear":
            return ShapeCost(_linear_seconds(size), 0.0, 0.0, 0.0)
        case "real":
            return _rotation_strain(size)
        case "paper":
            return _paper(size)


def _rotation_strain(size: BodySize) -> ShapeCost:
    plan = frame_plan(size.nodes)
    if plan.lattice_nodes:
        lattice = BodySize(plan.lattice_nodes, 0, 0)
        # Each of a lattice's nodes, in every frame and in every step.
        frame = _linear_seconds(size) + plan.lattice_nodes * (4e-6 + 2e-6 * plan.steps)
        return ShapeCost(frame, 0.1 + 5e-5 * size.nodes, 0.0, 4 * _factor_bytes(lattice))
    frame = _solve_seconds(size) + plan.steps * 1.8e-6 * size.nodes
    # Beside the factor of the stiffness one of the Poisson equation that puts the tets together.
    first = 2 * _factor_seconds(size)
    return ShapeCost(frame, first, 0.0, 1.3 * _factor_bytes(size) + 200.0 * size.tets)


def _paper(size: BodySize) -> ShapeCost:
    # The mean for one sign; easy ones take a fifth of it, those that Newton's method ends thrice.
    entry = 0.1 * _grown(size, 1.5)
    table = 2 * _dense_bytes(size)
    return ShapeCost(
        _linear_seconds(size) + 1e-3,
        _factor_seconds(size) + 18 * entry,
        6 * size.free_surface_nodes * entry,
        # A second factor for equilibria under load.
        2 * _factor_bytes(size) + 2500.0 * size.tets + min(table, MOST_BYTES),
    )


def _grown(size: BodySize, exponent: float) -> float:
    """Cost relative to that of the measured body."""
    return math.pow(size.nodes / MEASURED_NODES, exponent)


def _linear_seconds(size: BodySize) -> float:
    return 1e-7 * size.free_surface_nodes


def _solve_seconds(size: BodySize) -> float:
    """One load, by the factor of the stiffness."""
    return 1.5e-3 * _grown(size, 1.57)


def _factor_seconds(size: BodySize) -> float:
    return 0.05 * _grown(size, 1.66)


def _factor_bytes(size: BodySize) -> float:
    return 12e6 * _grown(size, 1.45)


def _dense_bytes(size: BodySize) -> float:
    return 36.0 * size.free_surface_nodes**2
