"""Cache of body statuses and predicted costs for panels.

A panel is drawn many times a second, and reading a large mesh takes a second: it is read again only
after a handler has reported a change, and a slow one only once it rests.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy

from ..core.bake.cost.size import ShapeSize
from ..core.bake.settings import BakeSettings
from ..core.errors import PalpateError
from ..core.machine.machine_speed import dgemm_rate
from ..core.stiffness.pins import Pins
from ..operators.bake import bake_prediction
from ..operators.bake.bake_prediction import Prediction
from ..operators.object import soft_object
from ..operators.object.soft_object import BodyStatus, Fit
from ..operators.scene import drawn_surface
from ..operators.scene.drawn_surface import DrawnSurface
from ..operators.scene.viewport import redraw_views

# The machine's speed is measured, a tenth of a second, after the panel has appeared.
SECONDS_TO_MEASURING = 0.2
SECONDS_OF_REST = 0.6
# Seconds; a mesh read in less is read again while it changes, and dragging stays smooth.
QUICK_SECONDS = 0.05
PIN_SETTINGS = ("pin_mode", "pin_group", "pin_fraction")
# Properties that a status depends on, besides the mesh.
STATUS_SETTINGS = (
    *PIN_SETTINGS,
    "body_key",
    "poisson_ratio",
    "formulation",
    "form",
    "compression_tolerance",
    "stiff_group",
    "stiff_factor",
)
Values = tuple[object, ...]


@dataclass(eq=False)
class _KnownMesh:
    """Mesh as read, and the statuses derived from it, by settings.

    ``seconds`` is the time of the slowest step.
    """

    drawn: DrawnSurface
    seconds: float = 0.0
    statuses: dict[Values, BodyStatus] = field(default_factory=dict)
    pins: dict[Values, Pins] = field(default_factory=dict)

    @contextmanager
    def timed(self) -> Iterator[None]:
        """Measure the time of a step."""
        begun = time.perf_counter()
        yield
        self.seconds = max(self.seconds, time.perf_counter() - begun)


_known: dict[Values, _KnownMesh] = {}
# Kept while meshes change and measured again once they rest: a second for large ones.
_sizes: dict[Values, ShapeSize] = {}


def body_status(thing: bpy.types.Object, scene: bpy.types.Scene) -> BodyStatus:
    """``body_status`` with the mesh read only after changes."""
    try:
        known = _mesh(thing, scene)
    except PalpateError as problem:
        return BodyStatus(
            Fit.CHANGED if thing.palpate.body_key else Fit.NEVER_BAKED, problem.sentence
        )
    question = _values(thing, STATUS_SETTINGS)
    if question not in known.statuses:
        with known.timed():
            known.statuses[question] = soft_object.mesh_status(thing, known.drawn)
    return soft_object.with_file(thing, known.statuses[question])


def prediction(thing: bpy.types.Object, scene: bpy.types.Scene) -> Prediction | None:
    """Predicted cost of a bake with the present settings; None until the machine's speed is known.

    Raises
    ------
    PalpateError
        What cannot be baked at all, with the remedy.
    """
    if not dgemm_rate.cache_info().currsize:
        if not bpy.app.timers.is_registered(_measure):
            bpy.app.timers.register(_measure, first_interval=SECONDS_TO_MEASURING)
        return None
    known, which = _mesh(thing, scene), _which(thing, scene)
    if which not in _sizes:
        _sizes[which] = bake_prediction.shape_size(known.drawn)
    question = _values(thing, PIN_SETTINGS)
    if question not in known.pins:
        with known.timed():
            known.pins[question] = bake_prediction.pins_of(thing, known.drawn)
    settings = bake_prediction.settings_of(thing, known.pins[question])
    return bake_prediction.predict(_sizes[which], settings)


def forget() -> None:
    """Look everything up again: a mesh, a transform or a file changed."""
    if bpy.app.background:
        # Timers do not fire there, and nothing is dragged.
        _known.clear()
        _sizes.clear()
        return
    for which in [which for which, known in _known.items() if known.seconds < QUICK_SECONDS]:
        del _known[which]
    if bpy.app.timers.is_registered(_forget_what_is_slow):
        bpy.app.timers.unregister(_forget_what_is_slow)
    if _known or _sizes:
        bpy.app.timers.register(_forget_what_is_slow, first_interval=SECONDS_OF_REST)


def _forget_what_is_slow() -> None:
    _known.clear()
    _sizes.clear()
    redraw_views()


def _which(thing: bpy.types.Object, scene: bpy.types.Scene) -> Values:
    # No handler reports a changed unit scale.
    return (thing.session_uid, drawn_surface.metres_per_unit(scene))


def _mesh(thing: bpy.types.Object, scene: bpy.types.Scene) -> _KnownMesh:
    which = _which(thing, scene)
    known = _known.get(which)
    # Weights must belong to the vertices that were read.
    if known is None or len(known.drawn.local) != len(thing.data.vertices):
        begun = time.perf_counter()
        drawn = drawn_surface.read(thing, scene)
        _known[which] = _KnownMesh(drawn, time.perf_counter() - begun)
    return _known[which]


def _values(thing: bpy.types.Object, names: tuple[str, ...]) -> Values:
    return tuple(getattr(thing.palpate, name) for name in names)


def _measure() -> None:
    dgemm_rate(BakeSettings.threads)
    redraw_views()
