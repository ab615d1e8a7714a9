"""``--felt``: the force law of points."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.equations import ContactMode, Touch
from ...core.errors import PalpateError
from ...core.shape.force_at_depth.felt_fingers import corrected_touches
from ...core.shape.force_at_depth.felt_force import FELT_CHOICES
from ...core.shape.force_at_depth.softening_table import SofteningTable


def add_felt(parser: argparse.ArgumentParser) -> None:
    """Add the option."""
    parser.add_argument(
        "--felt",
        choices=FELT_CHOICES,
        default="linear",
        help="force of points: in proportion to the depth, as in the paper (linear, the default), "
        "or softer where pressed in far, as a solid of large deformation is (corrected)",
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


def felt_forces(
    arguments: argparse.Namespace,
    body: SoftBody,
    touches: Sequence[Touch],
    young_modulus: float,
    mode: ContactMode,
) -> list[NDArray[np.float64]]:
    """Forces on the fingers (3,), N, of touches by the linear relation, by the one asked for."""
    if arguments.felt == "linear":
        return [touch.force for touch in touches]
    with softening_table(body, arguments.body) as table:
        table.wait_for(np.concatenate([touch.triangle for touch in touches]))
        corrected = corrected_touches(body, table.values, touches, young_modulus, mode)
    return [touch.force for touch in corrected]


def refuse_with_tool(arguments: argparse.Namespace) -> None:
    """Refuse a corrected force law for a tool, whose points share the softening of one node."""
    if arguments.felt != "linear":
        raise PalpateError(
            "--felt: a tool's force is linear; leave it out with a tool, or press with a point"
        )
