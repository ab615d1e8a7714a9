"""What a shape costs, predicted from a body's size, before anything is computed."""

from __future__ import annotations

from dataclasses import dataclass

from .shapes import ShapeName


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
    # A factor of the stiffness at rest, as measured at 1,700 and 20,000 nodes.
    factor_seconds = 0.05 * (size.nodes / 1700) ** 1.65
    factor_bytes = 10e6 * (size.nodes / 1700) ** 1.5
    linear_frame = 1e-4 * size.free_surface_nodes / 1000
    solve_seconds = 1.5e-3 * (size.nodes / 1700) ** 1.55
    freedoms = 3 * size.free_surface_nodes
    match name:
        case "linear":
            return ShapeCost(linear_frame, 0.0, 0.0, 0.0)
        case "rotation-strain":
            frame = 4e-3 * size.tets / 6300
            return ShapeCost(frame, factor_seconds, 0.0, factor_bytes)
        case "series":
            a_freedom = 4 * solve_seconds
            return ShapeCost(
                linear_frame * 4,
                factor_seconds + 9 * a_freedom,
                freedoms * a_freedom,
                factor_bytes + 2 * 4 * 3.0 * freedoms * size.free_surface_nodes / 5,
            )
        case "table":
            # One Newton solve for each freedom and sign.
            an_entry = 0.3 * size.nodes / 1700
            return ShapeCost(
                linear_frame * 4,
                factor_seconds + 18 * an_entry,
                2 * freedoms * an_entry,
                factor_bytes + 2 * 4 * 3.0 * freedoms * size.free_surface_nodes,
            )
