"""Body statuses and predicted costs for panels, which are drawn many times a second and never wait.

What depends on a mesh is looked up again only after a handler has reported a change of it. A small
mesh is measured at once; of a larger one a copy is taken when it has rested, and measured in the
background. Meanwhile the older figures are shown, or none.
"""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.bake.settings import BakeSettings
from ..core.errors import PalpateError
from ..core.machine.machine_speed import dgemm_rate
from ..core.stiffness.pins import Pins
from ..operators.bake import bake_prediction
from ..operators.bake.bake_prediction import Prediction
from ..operators.object import soft_object
from ..operators.object.mesh_look import MeasuredMesh, MeshLook
from ..operators.object.soft_object import BodyStatus, Fit
from ..operators.scene import drawn_surface
from ..operators.scene.drawn_surface import DrawnSurface
from ..operators.scene.object_handle import ObjectHandle
from ..operators.scene.viewport import redraw_views

# Vertices; up to here a mesh is measured while the panel is drawn, in a few milliseconds.
MOST_AT_ONCE = 2_000
SECONDS_OF_REST = 0.6
SECONDS_BETWEEN_LOOKS = 0.05
# Relative tolerance of equal stretches: matrices are float32.
SAME_STRETCH = 1e-5
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
    """Mesh as it was measured, and what was derived from it, by settings.

    Attributes
    ----------
    mesh_uid, vertices, stretch : of the object's data then; the squared stretches of its matrix.
    is_stale : whether a handler has reported a change since.
    """

    mesh_uid: int
    vertices: int
    stretch: NDArray[np.float64]
    measured: MeasuredMesh
    is_stale: bool = False
    drawn: DrawnSurface | None = None
    statuses: dict[Values, BodyStatus] = field(default_factory=dict)
    pins: dict[Values, Pins] = field(default_factory=dict)

    def fits(self, thing: bpy.types.Object) -> bool:
        """Whether the object's mesh and scale are still these."""
        is_same_mesh = (self.mesh_uid, self.vertices) == _mesh_of(thing)
        if self.is_stale or not is_same_mesh:
            return False
        now = _stretch(thing)
        return bool(np.abs(now - self.stretch).max() <= SAME_STRETCH * np.abs(now).max())

    def drawn_of(self, thing: bpy.types.Object, scene: bpy.types.Scene) -> DrawnSurface:
        """The whole mesh, read where changed pins need it."""
        if self.drawn is None:
            self.drawn = drawn_surface.read(thing, scene)
        return self.drawn


@dataclass(eq=False)
class _Asked:
    """Mesh that a panel waits for.

    Attributes
    ----------
    future : while it is being measured.
    is_stale : whether a handler has reported a change since the copy was taken.
    """

    handle: ObjectHandle
    scene: str
    mesh_uid: int
    future: Future[_KnownMesh] | None = None
    is_stale: bool = False


_known: dict[Values, _KnownMesh] = {}
_asked: dict[Values, _Asked] = {}
_background = ThreadPoolExecutor(1, "palpate-panel")
_speed: list[Future[float]] = []


def body_status(thing: bpy.types.Object, scene: bpy.types.Scene) -> BodyStatus | None:
    """Status of the object's body by the newest figures; None while there are none."""
    if not thing.palpate.body_key:
        return BodyStatus(Fit.NEVER_BAKED)
    try:
        known = _mesh(thing, scene)
    except PalpateError as problem:
        return BodyStatus(Fit.CHANGED, problem.sentence)
    if known is None:
        return None
    question = _values(thing, STATUS_SETTINGS)
    if question not in known.statuses:
        known.statuses[question] = soft_object.shape_status(
            thing, known.measured.shape, lambda: known.drawn_of(thing, scene)
        )
    return soft_object.with_file(thing, known.statuses[question])


def prediction(thing: bpy.types.Object, scene: bpy.types.Scene) -> Prediction | None:
    """Predicted cost of a bake with the present settings; None until mesh and machine are measured.

    Raises
    ------
    PalpateError
        What cannot be baked at all, with the remedy.
    """
    known = _mesh(thing, scene)
    if not _is_speed_known() or known is None:
        return None
    if isinstance(known.measured.size, PalpateError):
        raise known.measured.size
    question = _values(thing, PIN_SETTINGS)
    if question not in known.pins:
        known.pins[question] = bake_prediction.pins_of(thing)
    settings = bake_prediction.settings_of(thing, known.pins[question])
    return bake_prediction.predict(known.measured.size, settings)


def changed(depsgraph: bpy.types.Depsgraph) -> None:
    """Measure those meshes again that the dependency graph reports as changed.

    Moves and turns are none; a changed scale is seen when a panel asks.
    """
    uids = {u.id.original.session_uid for u in depsgraph.updates if u.is_updated_geometry}
    if not uids:
        return
    meshes: list[tuple[Values, _KnownMesh | _Asked]] = [*_known.items(), *_asked.items()]
    for which, one in meshes:
        if which[0] in uids or one.mesh_uid in uids:
            one.is_stale = True
    if _asked and bpy.app.timers.is_registered(_look):
        # Whatever changes has not come to rest.
        bpy.app.timers.unregister(_look)
        bpy.app.timers.register(_look, first_interval=SECONDS_OF_REST)


def forget() -> None:
    """Look everything up again: another file, another step of undo."""
    _known.clear()
    _asked.clear()


def forget_files() -> None:
    """Look up again what depends on files, and not on meshes."""
    for known in _known.values():
        known.statuses.clear()


def end() -> None:
    """Take back the timer."""
    forget()
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)


def _mesh(thing: bpy.types.Object, scene: bpy.types.Scene) -> _KnownMesh | None:
    """The mesh as it was measured last; asks for another look where that is not the present one.

    Raises
    ------
    PalpateError
        A transform that flattens the object.
    """
    # No handler reports a changed unit scale.
    which = (thing.session_uid, drawn_surface.metres_per_unit(scene), thing.palpate.bake_from)
    known = _known.get(which)
    if known is not None and known.fits(thing):
        return known
    # Timers do not fire in the background.
    if bpy.app.background or len(thing.data.vertices) <= MOST_AT_ONCE:
        look = MeshLook.take(thing, scene)
        _known[which] = _measure(look, *_mesh_of(thing), _stretch(thing))
        return _known[which]
    drawn_surface.frame_of(thing, scene)
    if which not in _asked:
        _asked[which] = _Asked(ObjectHandle.of(thing), scene.name, thing.data.session_uid)
    if not bpy.app.timers.is_registered(_look):
        wait = SECONDS_OF_REST if known is not None else 0.0
        bpy.app.timers.register(_look, first_interval=wait)
    # Weights and fingerprints of another mesh would be nonsense.
    return known if known is not None and known.vertices == len(thing.data.vertices) else None


def _measure(
    look: MeshLook, mesh_uid: int, vertices: int, stretch: NDArray[np.float64]
) -> _KnownMesh:
    return _KnownMesh(mesh_uid, vertices, stretch, look.measured())


def _look() -> float | None:
    """Timer: take copies of the meshes that are asked for, and what was measured of them."""
    for which, asked in list(_asked.items()):
        if asked.future is None:
            _begin(which, asked)
        elif asked.future.done():
            del _asked[which]
            _known[which] = asked.future.result()
            _known[which].is_stale = asked.is_stale
            redraw_views()
    return SECONDS_BETWEEN_LOOKS if _asked else None


def _begin(which: Values, asked: _Asked) -> None:
    thing, scene = asked.handle.find(), bpy.data.scenes.get(asked.scene)
    if thing is None or thing.type != "MESH" or scene is None or thing.mode != "OBJECT":
        del _asked[which]
        return
    try:
        look = MeshLook.take(thing, scene)
    except PalpateError:
        # The panel finds the same when it asks again.
        del _asked[which]
        return
    asked.mesh_uid, asked.is_stale = thing.data.session_uid, False
    asked.future = _background.submit(_measure, look, *_mesh_of(thing), _stretch(thing))


def _is_speed_known() -> bool:
    """Whether the machine's speed is measured, a tenth of a second in the background."""
    if not dgemm_rate.cache_info().currsize and not _speed:
        _speed.append(_background.submit(dgemm_rate, BakeSettings.threads))
        if not bpy.app.background:
            bpy.app.timers.register(_show_speed, first_interval=SECONDS_BETWEEN_LOOKS)
    return bool(dgemm_rate.cache_info().currsize)


def _show_speed() -> float | None:
    if not _speed[0].done():
        return SECONDS_BETWEEN_LOOKS
    redraw_views()
    return None


def _mesh_of(thing: bpy.types.Object) -> tuple[int, int]:
    return thing.data.session_uid, len(thing.data.vertices)


def _stretch(thing: bpy.types.Object) -> NDArray[np.float64]:
    axes = np.array(thing.matrix_world, dtype=np.float64)[:3, :3]
    squared: NDArray[np.float64] = axes.T @ axes
    return squared


def _values(thing: bpy.types.Object, names: tuple[str, ...]) -> Values:
    return tuple(getattr(thing.palpate, name) for name in names)
