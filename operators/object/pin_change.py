"""Work that changed pins need: none, loading another body, a second's work, or a bake."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import lru_cache

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.bake.cost.size import MeshSize
from ...core.bake.repin import pin_more, pin_more_seconds, pins_change
from ...core.body import body_file
from ...core.body.body_key import body_key
from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.mesh.closest_point import SurfacePoints
from ...core.mesh.surface import Surface
from ...core.mesh.tet_mesh import TetMesh
from ...core.stiffness.pins import pinned_nodes, places_on
from ..pins import pin_group
from ..scene.drawn_surface import DrawnSurface
from ..scene.fingerprint import Fingerprint
from ..scene.object_handle import ObjectHandle
from . import baked_record, baked_settings, body_store
from .embedded_body import EmbeddedBody, embedded

# Seconds; longer downdates are left to Rebuild Body, which has progress and Escape.
LONGEST_SECONDS = 5.0
# Bytes a second of reading, writing and reading a body file again.
BYTES_PER_SECOND = 2e8


class PinFit(Enum):
    """Relation of the pins that are set to those of the body."""

    SAME = "same"
    KNOWN = "known"  # a file has the body with these pins
    MORE = "more"  # computed from the body in seconds
    LESS = "less"  # pins were removed: needs a bake
    OTHER = "other"  # elsewhere, or too many more for a quick answer: needs a bake
    UNUSABLE = "unusable"  # they pin nothing, or everything


@dataclass(frozen=True, eq=False)
class PinChange:
    """Fit of the pins, ``seconds`` to apply them, and the ``reason`` if that is impossible."""

    fit: PinFit
    seconds: float = 0.0
    reason: str = ""

    @property
    def quick(self) -> bool:
        """Whether they can be applied now, without a bake."""
        return self.fit in {PinFit.KNOWN, PinFit.MORE}


SAME = PinChange(PinFit.SAME)


def look(thing: bpy.types.Object, drawn: Callable[[], DrawnSurface]) -> PinChange:
    """Compare the pins that are set with those of the body. Reads tetrahedra, not the body file.

    ``drawn`` reads the mesh, which other pins are compared on.

    Only for an object whose mesh still fits its body.
    """
    baked = Fingerprint.from_text(thing.palpate.fingerprint)
    if baked.pins == pin_group.pin_rule(thing):
        return SAME
    try:
        surface_now = drawn()
        if baked.stack and surface_now is surface_now.base:
            # A panel cannot evaluate modifiers; Press can.
            return PinChange(PinFit.OTHER)
        within = _placed(surface_now, ObjectHandle.of(thing), thing.palpate.body_key)
        new = _nodes(thing, surface_now, within)
    except PalpateError as problem:
        return PinChange(PinFit.UNUSABLE, reason=problem.sentence)
    old, surface = within.body.fixed, within.body.mesh.surface_nodes
    change = pins_change(within.body.mesh, old, new)
    if change == "same":
        return SAME
    if np.isin(surface, new).all():
        return PinChange(
            PinFit.UNUSABLE, reason="These pins would hold the whole surface; pin less"
        )
    if body_store.locate_key(_key(thing, within.body, new)) is not None:
        return PinChange(PinFit.KNOWN)
    if change == "bake":
        only_less = not np.setdiff1d(new, old).size
        return PinChange(PinFit.LESS if only_less else PinFit.OTHER)
    seconds = _seconds(thing, within.body.mesh, len(new) - len(old))
    quick = seconds <= LONGEST_SECONDS and body_store.locate(thing) is not None
    return PinChange(PinFit.MORE if quick else PinFit.OTHER, seconds)


def take_over(thing: bpy.types.Object, drawn: DrawnSurface) -> SoftBody:
    """Apply the pins to the body: from its file, or computed and stored next to it.

    Raises
    ------
    PalpateError
        The pins need a bake, cannot be used, or are those of the body already; the body's file is
        missing or damaged. Nothing is changed then.
    """
    change = look(thing, lambda: drawn)
    if change.fit is PinFit.SAME:
        raise PalpateError("{name}: it is pinned like this already; press Press", name=thing.name)
    if change.fit is PinFit.UNUSABLE:
        raise PalpateError(change.reason)
    if change.fit in {PinFit.LESS, PinFit.OTHER}:
        raise PalpateError("{name}: these pins need a bake; press Rebuild Body", name=thing.name)
    within = _placed(drawn, ObjectHandle.of(thing), thing.palpate.body_key)
    new = _nodes(thing, drawn, within)
    path = body_store.locate_key(_key(thing, within.body, new))
    if path is not None:
        body = body_store.load_file(path, _key(thing, within.body, new))
    else:
        body = pin_more(body_store.load(thing), np.setdiff1d(new, within.body.fixed))
        path = body_store.place_for(thing, body.key)
        body_file.save(body, path)
    # Stiff regions are not applied here, so their record stays.
    old = Fingerprint.from_text(thing.palpate.fingerprint)
    fingerprint = drawn.fingerprint(pin_group.pin_rule(thing), old.stiffness)
    baked_record.record(thing, body, path.name, fingerprint)
    return body


@dataclass(frozen=True, eq=False)
class _PlacedBody:
    """Embedded body, and the places of its surface nodes on the drawn surface."""

    body: EmbeddedBody
    surface: Surface
    places: SurfacePoints


# For sliders: the search takes up to a second for large meshes.
@lru_cache(maxsize=1)
def _placed(drawn: DrawnSurface, handle: ObjectHandle, key: str) -> _PlacedBody:
    thing = handle.find()
    body, surface = embedded(thing), drawn.surface()
    return _PlacedBody(body, surface, places_on(surface, body.mesh))


def _nodes(thing: bpy.types.Object, drawn: DrawnSurface, within: _PlacedBody) -> NDArray[np.int64]:
    return pinned_nodes(
        pin_group.pins(thing, drawn), within.body.mesh, within.surface, within.places
    )


def _key(thing: bpy.types.Object, body: EmbeddedBody, fixed: NDArray[np.int64]) -> str:
    baked = baked_settings.settings_of(thing)
    return body_key(body.mesh, fixed, baked.poisson_ratio, baked.formulation, body.young_scale)


def _seconds(thing: bpy.types.Object, mesh: TetMesh, added: int) -> float:
    """Estimated seconds of :func:`take_over`."""
    baked, settings = thing.palpate, baked_settings.settings_of(thing)
    computing = pin_more_seconds(MeshSize.of(mesh), settings, baked.free_surface_count, added)
    return computing + 1e6 * baked.compliance_megabytes / BYTES_PER_SECOND
