"""Sessions: a soft body as the native thread needs it, and displacements from its snapshots."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from palpate_servo import (
    MOST_BODIES,
    STATES,
    Body,
    FingerSnapshot,
    HaplyDevice,
    LinkDevice,
    Pointer,
    Prop,
    PropAmong,
    Servo,
    Snapshot,
    device_coupling,
    haply_encoder_step,
)

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import FingerCounters as FingerCounters  # noqa: PLC0414
    from palpate_servo import LinkCounters as LinkCounters  # noqa: PLC0414
    from palpate_servo import ServoCounters as ServoCounters  # noqa: PLC0414

from ..body.native_body import native_body, native_compliance
from ..body.soft_body import SoftBody
from ..contact.tool.native_tool import native_tool
from ..errors import PalpateError
from ..rest.prop import native_prop
from .settings import Settings

LEAST_HZ, MOST_HZ = 100, 8000

__all__ = [
    "MOST_BODIES",
    "STATES",
    "Body",
    "FingerSnapshot",
    "HaplyDevice",
    "LinkDevice",
    "Pointer",
    "Prop",
    "PropAmong",
    "Servo",
    "Snapshot",
    "device_coupling",
    "displacements_of",
    "drawn_loads",
    "haply_encoder_step",
    "native_body",
    "native_compliance",
    "native_prop",
    "native_tool",
    "servo_on",
]


def servo_on(
    surface: Body,
    settings: Settings,
    *,
    rate_hz: int = 1000,
    max_force: float = 3.0,
    record_seconds: float = 10.0,
    prop: Prop | PropAmong | None = None,
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
    surface : see :func:`native_body`.
    settings : to begin with.
    rate_hz : 100 to 8000.
    max_force : newton; the clamp on the force of any device, unless ``settings`` have one.
    record_seconds : length of samples kept until they are read, 0 to 60; their memory is taken at
        the start. ``Servo.start_recording`` keeps more.
    prop : the same body laid down as one that nobody holds (:func:`native_prop`), or among others
        that it presses (``Pile.laid``), where only tools feel it; places and forces
        are then those in the world, in which ``Snapshot.placement`` tells where the body is, and
        its contact is always consistent.

    Raises
    ------
    PalpateError
        A setting out of its range.
    """
    if not LEAST_HZ <= rate_hz <= MOST_HZ:
        raise PalpateError(
            "servo: {rate} Hz is no rate of it; give {least} to {most}",
            rate=rate_hz,
            least=LEAST_HZ,
            most=MOST_HZ,
        )
    try:
        servo = Servo(
            surface,
            settings,
            rate_hz=rate_hz,
            max_force=max_force,
            record_seconds=record_seconds,
        )
        servo.lay(prop)
    except (ValueError, OverflowError) as problem:
        raise PalpateError("servo: {problem}", problem=problem) from problem
    return servo


def drawn_loads(snapshot: Snapshot) -> list[tuple[NDArray[np.int64], NDArray[np.float64]]]:
    """Nodes (k,) of the surface and forces (k, 3), N, under which a linear body looks as it does.

    A load a finger, and one of what bears it; or one of all that a body remembers which gives way
    with time.
    """
    if len(snapshot.remembered_nodes):
        return [(snapshot.remembered_nodes, snapshot.remembered_forces)]
    fingers = snapshot.fingers
    firm = snapshot.firmness
    loads = [(finger.nodes, finger.nodal_forces / firm) for finger in fingers if len(finger.nodes)]
    borne = (
        [(snapshot.borne_nodes, snapshot.borne_forces / firm)] if len(snapshot.borne_nodes) else []
    )
    return loads + borne


def displacements_of(
    body: SoftBody, snapshot: Snapshot, young_modulus: float | None = None
) -> NDArray[np.float64] | None:
    """Displacements (n, 3) of the free surface nodes under all fingers of a snapshot, and by what
    the body remembers of them.

    None while none of them touches and nothing is remembered.
    """
    pressed = drawn_loads(snapshot)
    if not pressed:
        return None
    nodes = np.concatenate([nodes for nodes, _ in pressed])
    forces = np.concatenate([forces for _, forces in pressed])
    return body.deform(body.mesh.surface_nodes[nodes], forces, young_modulus)
