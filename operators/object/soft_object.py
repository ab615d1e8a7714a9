"""Status of an object: whether it can be made soft, and whether its body still fits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum

import bpy

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ...core.stiffness.formulation import LINEAR, LOCKING_POISSON_RATIO, SMOOTHED
from ..carrier import body_source, seen_mesh
from ..pins import pin_group, stiff_region
from ..scene import fingerprint
from ..scene.drawn_surface import DrawnSurface
from ..scene.fingerprint import Fingerprint
from . import baked_settings, body_store, kept_body, pin_change
from .pin_change import PinChange


class Fit(Enum):
    """Fit of an object and its body."""

    NEVER_BAKED = "never baked"
    READY = "ready"
    CHANGED = "changed"  # another bake is needed
    FILE_MISSING = "file missing"  # can be rebuilt
    FILE_DAMAGED = "file damaged"  # found so when it was to be pressed; can be rebuilt


@dataclass(frozen=True)
class BodyStatus:
    """Fit of a body; ``text`` is the reason; ``changed`` names settings that are not in the body
    yet; so does ``pins``, which may need no bake; ``meshing`` names those that need a new mesh.
    """

    fit: Fit
    text: str = ""
    changed: tuple[str, ...] = ()
    pins: PinChange = pin_change.SAME
    meshing: tuple[str, ...] = ()


def refusal(thing: bpy.types.Object | None) -> str:
    """Reason why this object can never be soft; empty if it can."""
    if thing is None:
        return "Select a mesh object"
    if thing.type != "MESH":
        return Sentence("{name} is not a mesh; select a mesh object", name=thing.name)
    if thing.library or thing.override_library or thing.data.library or thing.data.override_library:
        return Sentence(
            "{name} is linked from another file; make it local (Object > Relations)",
            name=thing.name,
        )
    if thing.mode != "OBJECT":
        # The name of most modes is in Blender's own dictionary.
        mode = f"{thing.mode.replace('_', ' ').title()} Mode"
        return Sentence("Leave {mode} first", mode=Sentence(mode))
    keys = thing.data.shape_keys
    if keys and not keys.use_relative:
        return Sentence(
            "{name} has absolute shape keys; tick Relative in its shape keys", name=thing.name
        )
    return ""


def refusal_unbaked(thing: bpy.types.Object | None) -> str:
    """Reason why this object has no body to press; empty if it has."""
    reason = refusal(thing)
    if not reason and thing is not None and not thing.palpate.body_key:
        return Sentence(body_store.NOT_SOFT, name=thing.name)
    return reason


def body_status(thing: bpy.types.Object, scene: bpy.types.Scene) -> BodyStatus:
    """Whether the object's body exists and still fits. Reads the mesh, not the body file.

    Raises
    ------
    PalpateError
        A transform that flattens the object.
    """
    return with_file(thing, mesh_status(thing, body_source.read_again(thing, scene)))


def with_file(thing: bpy.types.Object, status: BodyStatus) -> BodyStatus:
    """Status from :func:`mesh_status` and what is known of the body file; quick."""
    if status.fit is not Fit.READY:
        return status
    status = replace(status, meshing=_other_meshing(thing.palpate))
    path = body_store.locate(thing)
    if path is None and kept_body.is_unsaved(thing):
        return status
    if path is None:
        return replace(status, fit=Fit.FILE_MISSING, text="the body file is missing")
    if body_store.is_known_damaged(path):
        return replace(status, fit=Fit.FILE_DAMAGED, text="the body file is damaged")
    return status


def mesh_status(thing: bpy.types.Object, drawn: DrawnSurface) -> BodyStatus:
    """Whether the object was baked and its mesh is still the same; slow for large meshes."""
    return shape_status(thing, drawn.shape, lambda: drawn)


def shape_status(
    thing: bpy.types.Object, shape: Fingerprint, drawn: Callable[[], DrawnSurface]
) -> BodyStatus:
    """:func:`mesh_status` by the fingerprint of a mesh; the mesh is read for changed pins only."""
    baked = thing.palpate
    if not baked.body_key:
        return BodyStatus(Fit.NEVER_BAKED)
    try:
        old = Fingerprint.from_text(baked.fingerprint)
        baked_settings.settings_of(thing)
    except PalpateError:
        return BodyStatus(Fit.CHANGED, Sentence("what this file says of its body cannot be true"))
    pins, stiffness = pin_group.pin_rule(thing), stiff_region.stiff_rule(thing)
    made_by = seen_mesh.digest(thing) if old.stack else ""
    new = replace(shape, pins=pins, stiffness=stiffness, stack=made_by)
    change = fingerprint.changed_body(old, new)
    if change:
        return BodyStatus(Fit.CHANGED, change)
    return BodyStatus(
        Fit.READY, changed=_unbaked_settings(thing, old, new), pins=pin_change.look(thing, drawn)
    )


def refuse_changed(thing: bpy.types.Object, status: BodyStatus) -> None:
    """Refuse an object that has changed since the bake.

    Raises
    ------
    PalpateError
        What changed, with the remedy.
    """
    if status.fit is Fit.CHANGED:
        raise PalpateError(
            "{name}: {reason}; press Make Soft to bake it again",
            name=thing.name,
            reason=status.text,
        )


def formulation_now(thing: bpy.types.Object) -> str:
    """Formulation that the next bake takes."""
    return LINEAR if thing.palpate.formulation == "LINEAR" else SMOOTHED


def _unbaked_settings(
    thing: bpy.types.Object, old: Fingerprint, new: Fingerprint
) -> tuple[str, ...]:
    settings = thing.palpate
    ratio = settings.poisson_ratio - settings.baked_poisson_ratio
    changes = (
        ("Poisson's Ratio", abs(ratio) > 1e-6),
        ("Formulation", _other_formulation(thing)),
        ("Stiff Region", old.stiffness != new.stiffness),
        ("Compliance", _other_form(settings)),
    )
    return tuple(name for name, changed in changes if changed)


def _other_formulation(thing: bpy.types.Object) -> bool:
    """Whether the chosen formulation is not the body's. What was baked linear when that was the
    default stays as it is.
    """
    baked, now = thing.palpate.baked_formulation, formulation_now(thing)
    once_default = baked == LINEAR and thing.palpate.poisson_ratio < LOCKING_POISSON_RATIO
    return now != baked and not (now == SMOOTHED and once_default)


def _other_meshing(settings: bpy.types.PropertyGroup) -> tuple[str, ...]:
    baked = (
        ("Edge Length", settings.edge_length, settings.baked_edge_length),
        ("Tolerance", settings.epsilon, settings.baked_epsilon),
    )
    return tuple(
        name for name, now, then in baked if then and not math.isclose(now, then, rel_tol=1e-5)
    )


def _other_form(settings: bpy.types.PropertyGroup) -> bool:
    """Whether the chosen form is not the body's; Automatic accepts any."""
    if settings.form == "AUTO":
        return False
    if settings.form.lower() != settings.baked_form:
        return True
    finer = settings.compression_tolerance < settings.baked_tolerance * (1 - 1e-5)
    return settings.form == "COMPRESSED" and finer
