"""A soft body as native code holds it."""

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
    """The same compliance as native code reads it, in place; its arrays become read-only.

    A table that lies in a file is read there, unchecked: what a touched point's displacement takes
    from it is shown and recorded, while the force comes from contact blocks that were checked.

    Raises
    ------
    PalpateError
        A file that was cut short while in use.
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


def native_body(body: SoftBody, *, whole: bool = False) -> Body:
    """The rest surface, contact blocks and compliance of a body as native code holds them.

    It gets copies. Of the compliance it takes the blocks of all nodes and edges, a megabyte at
    20,000 nodes, so that no tick reads a file or waits for memory.

    Several fingers and tools need the compliance of any two nodes. A ``whole`` body keeps it all; a
    table that lies in a file is checked and read into memory once, here.

    Raises
    ------
    PalpateError
        A boundary on which a god object cannot walk, or a file that was cut short while in use.
    """
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
