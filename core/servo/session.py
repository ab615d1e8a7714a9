"""Sessions: a soft body as the native thread needs it, and displacements from its snapshots."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from palpate_servo import (
    STATES,
    Body,
    FingerSnapshot,
    HaplyDevice,
    LinkDevice,
    Pointer,
    Servo,
    Snapshot,
    ToolContact,
    ToolSurface,
    device_coupling,
    haply_encoder_step,
)
from palpate_servo import Compliance as NativeCompliance
from palpate_servo import Tool as NativeTool

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import FingerCounters as FingerCounters  # noqa: PLC0414
    from palpate_servo import LinkCounters as LinkCounters  # noqa: PLC0414
    from palpate_servo import ServoCounters as ServoCounters  # noqa: PLC0414

from ..body.soft_body import SoftBody
from ..compliance.compression.compressed_compliance import CompressedCompliance
from ..compliance.dense import DenseCompliance
from ..compliance.mapped import MappedCompliance
from ..compliance.protocol import Compliance
from ..contact.tool.tool_surface import correction_for, surface_for
from ..contact.tool.tools import Tool
from ..errors import PalpateError
from .settings import Settings

__all__ = [
    "STATES",
    "Body",
    "FingerSnapshot",
    "HaplyDevice",
    "LinkDevice",
    "Pointer",
    "Servo",
    "Snapshot",
    "device_coupling",
    "displacements_of",
    "haply_encoder_step",
    "native_body",
    "native_compliance",
    "native_tool",
    "servo_on",
    "touched_nodes",
]


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
    """The rest surface, contact blocks and compliance of a body as the native thread holds them.

    The thread gets copies. Of the compliance it takes the blocks of all nodes and edges, a megabyte
    at 20,000 nodes, so that no tick reads a file or waits for memory.

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


def servo_on(
    surface: Body,
    settings: Settings,
    *,
    rate_hz: int = 1000,
    max_force: float = 3.0,
    record_seconds: float = 10.0,
) -> Servo:
    """Servo for a native body, ready to be started with a pointer or a serial device.

    >>> from palpate.core.bake.settings import BakeSettings
    >>> from palpate.core.bake.steps import bake
    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> body, _ = bake(paper_cube()[0], BakeSettings(poisson_ratio=0.45, young_modulus=1e5))
    >>> servo = servo_on(native_body(body), Settings(young_modulus=body.young_modulus))
    >>> servo.start(Pointer((0.025, 0.025, 0.06)))
    >>> servo.set_target((0.025, 0.025, 0.049))
    >>> while servo.snapshot().output_force[2] < 0.2:
    ...     pass
    >>> servo.stop()

    Parameters
    ----------
    surface : see :func:`native_body`. For the felt force ``corrected`` it needs its softenings: let
        a :class:`..shape.force_at_depth.softening_table.SofteningTable` tell them.
    settings : to begin with.
    rate_hz : 100 to 8000.
    max_force : newton; the clamp on what any device is told.
    record_seconds : how long samples are kept until somebody takes them.

    Raises
    ------
    PalpateError
        A setting out of its range.
    """
    try:
        return Servo(
            surface,
            settings,
            rate_hz=rate_hz,
            max_force=max_force,
            record_seconds=record_seconds,
        )
    except (ValueError, OverflowError) as problem:
        raise PalpateError("servo: {problem}", problem=problem) from problem


def touched_nodes(body: SoftBody, snapshot: Snapshot) -> NDArray[np.int64]:
    """Node numbers of the mesh that fingers of a snapshot press, (k,)."""
    nodes = [finger.nodes for finger in snapshot.fingers]
    pressed: NDArray[np.int64] = np.concatenate([np.zeros(0, dtype=np.int64), *nodes])
    return body.mesh.surface_nodes[pressed]


def displacements_of(
    body: SoftBody, snapshot: Snapshot, young_modulus: float | None = None
) -> NDArray[np.float64] | None:
    """Displacements (n, 3) of the free surface nodes that all fingers of a snapshot ask for.

    None while none of them touches.
    """
    touching = [finger for finger in snapshot.fingers if len(finger.nodes)]
    if not touching:
        return None
    nodes = np.concatenate([finger.nodes for finger in touching])
    forces = np.concatenate([finger.nodal_forces for finger in touching])
    return body.deform(body.mesh.surface_nodes[nodes], forces, young_modulus)


def native_tool(body: SoftBody, surface: Body, tool: Tool, *, friction: float = 0.0) -> ToolContact:
    """A tool as the native thread holds it, with all the memory that it will ever need.

    Takes some tenths of a second: contact points are spread and what the mesh is too coarse for is
    told from the nodes around each node.

    Parameters
    ----------
    surface : of ``native_body(body, whole=True)``, the one that the servo touches.
    friction : coefficient of the contact when it is stepped alone; a servo's fingers have that of
        its settings.

    Raises
    ------
    PalpateError
        A body without its whole compliance, a tool too small for the body, or friction below zero.
    """
    points, near = surface_for(body, tool), correction_for(body, tool)
    try:
        return ToolContact(
            ToolSurface(
                surface,
                points.positions,
                points.normals,
                points.triangles,
                points.alphas,
                points.areas,
                near.arrays(),
            ),
            NativeTool(tool.core, tool.radius),
            friction=friction,
        )
    except ValueError as problem:
        raise PalpateError("tool {name}: {problem}", name=tool.name, problem=problem) from problem
