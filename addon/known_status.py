"""The body status of objects as last looked up, so that drawing a panel does not read meshes."""

import bpy

from ..core.errors import PalpateError
from ..operators import soft_object
from ..operators.soft_object import BodyStatus, Fit

_known: dict[tuple[int, str, str, float], BodyStatus] = {}


def body_status(thing: bpy.types.Object, scene: bpy.types.Scene) -> BodyStatus:
    """As :func:`operators.soft_object.body_status`, but read again only after changes."""
    settings = thing.palpate
    pins = f"{settings.pin_mode} {settings.pin_fraction:.4f} {settings.pin_group}"
    question = (thing.session_uid, settings.body_key, pins, settings.poisson_ratio)
    if question not in _known:
        try:
            _known[question] = soft_object.body_status(thing, scene)
        except PalpateError as problem:
            _known[question] = BodyStatus(Fit.CHANGED, str(problem))
    return _known[question]


def forget() -> None:
    """Look everything up again: a mesh, a transform or a file changed."""
    _known.clear()
