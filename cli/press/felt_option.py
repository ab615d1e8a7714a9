"""``--felt``: the force law of points."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.shape.force_at_depth.felt_force import FELT_CHOICES
from ...core.shape.force_at_depth.softening_table import SofteningTable


def add_felt(parser: argparse.ArgumentParser) -> None:
    """Add the option."""
    parser.add_argument(
        "--felt",
        choices=FELT_CHOICES,
        default="linear",
        help="force of points: in proportion to the depth, as in the paper (linear, the default), "
        "or as rubber is, mostly firmer where pressed in far (corrected)",
    )


@contextmanager
def softening_table(body: SoftBody, body_file: Path) -> Iterator[SofteningTable]:
    """Softenings of a body, stored next to its file when the block ends.

    If that fails it is reported, and they are computed anew the next time.
    """
    table = SofteningTable(body, body_file)
    try:
        yield table
    finally:
        try:
            table.close()
        except PalpateError as problem:
            table.notice = str(problem)
        if table.notice:
            print(f"palpate: warning: {table.notice}", file=sys.stderr)


def softenings_for(
    arguments: argparse.Namespace, body: SoftBody, places: ArrayLike
) -> NDArray[np.float64] | None:
    """Softenings at the surface points nearest to places (m, 3) for the chosen force law; None if
    not needed.
    """
    if arguments.felt == "linear":
        return None
    nearest = body.closest_points.query(np.asarray(places, dtype=np.float64).reshape(-1, 3))
    with softening_table(body, arguments.body) as table:
        table.wait_for(body.mesh.surface_triangles[nearest.triangle])
        return table.values


def refuse_with_tool(arguments: argparse.Namespace) -> None:
    """Refuse a corrected force law for a tool, whose points share the softening of one node."""
    if arguments.felt != "linear":
        raise PalpateError(
            "--felt: a tool's force is linear; leave it out with a tool, or press with a point"
        )
