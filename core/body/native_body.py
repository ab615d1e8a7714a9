"""Native form of a soft body."""

from __future__ import annotations

import numpy as np
from palpate_servo import Body
from palpate_servo import Compliance as NativeCompliance

from ..compliance.compression.compressed_compliance import CompressedCompliance
from ..compliance.dense import DenseCompliance
from ..compliance.mapped import MappedCompliance
from ..compliance.protocol import Compliance
from ..errors import PalpateError
from .soft_body import SoftBody


def native_compliance(compliance: Compliance) -> NativeCompliance:
    """Native compliance over the same arrays, which become read-only.

    A mapped table is read unchecked: only the displacement of the touched point depends on it, for
    display and recording, while the force comes from checked contact blocks.

    Raises
    ------
    PalpateError
        A file that was truncated while in use.
    """
    match compliance:
        case CompressedCompliance():
            return NativeCompliance.compressed(compliance.arrays())
        case MappedCompliance():
            compliance.check_length()
            return NativeCompliance.dense(compliance.mapped_table.array)
        case DenseCompliance():
            return NativeCompliance.dense(compliance.table)
        case _:
            raise TypeError(f"no native form of a {type(compliance).__name__}")


def _in_memory(compliance: Compliance) -> NativeCompliance:
    if isinstance(compliance, MappedCompliance):
        return NativeCompliance.dense(np.array(compliance.table))
    return native_compliance(compliance)


def native_body(body: SoftBody, *, whole: bool = False, may_move: bool = False) -> Body:
    """Native rest surface, contact blocks and compliance of a body, copied.

    Of the compliance it keeps the blocks of all nodes and edges, a megabyte at 20,000 nodes, so
    that no tick reads a file or waits for memory. A ``whole`` body, for several fingers and tools,
    keeps all of it; a mapped table is checked and read into memory here.

    A body without pins is for those who move it as a whole, which ``may_move`` says, or have it in
    a hand (:attr:`SoftBody.in_hand`).

    Raises
    ------
    PalpateError
        A boundary on which a god object cannot walk, or a file that was truncated while in use; a
        body without pins that would not move.
    """
    if body.is_free and not (may_move or body.in_hand):
        raise PalpateError(
            "the body has no pins and would move away here; lay it on a floor ('palpate settle', "
            "'palpate press' with a tool), or pin it ('palpate pin')"
        )
    try:
        return Body(
            body.mesh.nodes[body.mesh.surface_nodes],
            body.mesh.surface_local_triangles,
            body.contact_blocks,
            _in_memory(body.compliance) if whole else native_compliance(body.compliance),
            np.searchsorted(body.mesh.surface_nodes, body.compliance.free_surface),
            whole=whole,
        )
    except ValueError as problem:
        raise PalpateError(
            "servo: the body's surface cannot be touched ({problem}); bake it again, with another "
            "edge length if that does not help",
            problem=problem,
        ) from problem
