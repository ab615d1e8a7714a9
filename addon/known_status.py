"""How meshes fit their bodies, as last looked up, so that drawing a panel does not read them."""

import bpy

from ..core.errors import PalpateError
from ..operators import drawn_surface, soft_object
from ..operators.soft_object import BodyStatus, Fit

_known: dict[tuple[object, ...], BodyStatus] = {}


def body_status(thing: bpy.types.Object, scene: bpy.types.Scene) -> BodyStatus:
    """As :func:`operators.soft_object.body_status`, but the mesh is read only after changes."""
    settings = thing.palpate
    pins = f"{settings.pin_mode} {settings.pin_fraction:.4f} {settings.pin_group}"
    # No handler tells of a changed unit scale.
    unit = drawn_surface.metres_per_unit(scene)
    question = (thing.session_uid, settings.body_key, pins, settings.poisson_ratio, unit)
    if question not in _known:
        try:
            _known[question] = soft_object.mesh_status(thing, scene)
        except PalpateError as problem:
            _known[question] = BodyStatus(Fit.CHANGED, str(problem))
    return soft_object.with_file(thing, _known[question])


def forget() -> None:
    """Look everything up again: a mesh, a transform or a file changed."""
    _known.clear()
