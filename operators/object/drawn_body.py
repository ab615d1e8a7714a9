"""Body with its drawn mesh: from a contact to drawn displacements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.body.drawn_map import DrawnMap
from ...core.body.imprinted_body import DrawnImprint, imprinted
from ...core.body.soft_body import SoftBody
from ...core.contact.place import nearest_place
from ...core.contact.tool.tool_dent import PressingTool, kept_out
from ...core.errors import PalpateError
from ...core.fold.folds import Folds
from ..carrier import body_source
from ..layer import layers
from ..layer.imprints import imprint_of
from ..place import ray
from ..scene import drawn_surface
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import DrawnSurface
from ..scene.object_handle import ObjectHandle
from . import body_store, kept_body, pin_change, soft_object
from .baked_settings import law_of_object
from .embedded_body import embedded
from .hung_map import hung_on
from .soft_object import BodyStatus, Fit

Array = NDArray[np.float64]

# Reach within which a tool changes what is drawn, as a share of its own: more than tool_dent.FADE.
FARTHEST_KEPT_OUT = 1.3

# Free surface nodes at most for restoring a missing body, a few seconds, without progress.
MOST_NODES_AT_ONCE = 1500


@dataclass(frozen=True, eq=False)
class DrawnBody:
    """Body with its drawn mesh.

    Attributes
    ----------
    body : metres; with its imprints, as a press finds it.
    at_rest : the same without, whose shapes and tables are those of its file.
    hung : the map W to the drawn vertices.
    rest : flat float32 (3 p,), the drawn vertices at rest, local units.
    imprint : flat float32 (3 p,), what stayed of earlier presses, local units.
    frame : between local units, metres and the world.
    folds : what keeps its surface out of itself.
    file : of the body, next to which its tables are stored; None without.
    """

    body: SoftBody
    at_rest: SoftBody
    hung: DrawnMap
    rest: NDArray[np.float32]
    imprint: NDArray[np.float32]
    frame: BodyFrame
    folds: Folds
    file: Path | None = None

    @property
    def size(self) -> float:
        """Diagonal of the body's bounding box, metres."""
        return float(np.linalg.norm(np.ptp(self.body.mesh.nodes, axis=0)))

    @property
    def surface_nodes(self) -> Array:
        """Surface nodes as a press finds them, (s, 3), metres."""
        mesh = self.body.mesh
        nodes: Array = mesh.nodes[mesh.surface_nodes]
        return nodes

    @cached_property
    def node_normals(self) -> Array:
        """Outward unit normals (N, 3) of all nodes at rest; zero inside."""
        mesh = self.body.mesh
        return ray.node_normals(mesh.nodes, mesh.surface_triangles)

    def surface_place(self, near: Array) -> tuple[Array, Array]:
        """Place of the body's rest surface nearest to a point (3,), metres, and its outward unit
        normal, smooth across triangles.
        """
        place = nearest_place(self.body, near)
        normal = place.alpha @ self.node_normals[self.body.mesh.surface_triangles[place.triangle]]
        return place.position, normal / np.linalg.norm(normal)

    @cached_property
    def places(self) -> Array:
        """Drawn vertices as a press finds them, (p, 3), metres, body coordinates."""
        found = self.rest + self.imprint
        return self.frame.body_from_local(found.reshape(-1, 3).astype(np.float64))

    def drawn_displacement(
        self,
        displacements: Array,
        tools: Sequence[PressingTool] = (),
        into: NDArray[np.float32] | None = None,
    ) -> NDArray[np.float32]:
        """Flat displacements (3 p,) of the drawn vertices, local units, by those of the free
        surface nodes (n, 3), metres; the surface does not pass through itself by what is seen, and
        no vertex ends within the tools. They are written ``into`` an array like ``rest``, or a new
        one.
        """
        return self.displaced(self.folds.opened(displacements), tools, into)

    def displaced(
        self,
        displacements: Array,
        tools: Sequence[PressingTool] = (),
        into: NDArray[np.float32] | None = None,
    ) -> NDArray[np.float32]:
        """The same of a surface that may pass through itself, which is linear without tools."""
        into_local = np.linalg.inv(self.frame.metric)
        shaped = None if into is None else into.reshape(-1, 3)
        # The map takes units as they are; there are far fewer nodes than vertices.
        local = self.hung.displacements(displacements @ into_local, shaped)
        if tools:
            near = self._near(tools, float(np.abs(displacements).max(initial=0.0)))
            found, normals = self.places[near], self.hung.normals[self.hung.triangle[near]]
            places = found + local[near] @ self.frame.metric
            for pressing in tools:
                places = kept_out(places, normals, pressing)
            local[near] = (places - found) @ into_local
        return local.ravel()

    def _near(self, tools: Sequence[PressingTool], largest: float) -> NDArray[np.int64]:
        """Drawn vertices (k,) that may be within a tool where none moves along an axis by more than
        twice ``largest``, metres, as far as a smooth dent is deeper than its nodes.
        """
        order, (x, y, z) = self._from_left
        found = []
        for pressing in tools:
            reach = np.float32(FARTHEST_KEPT_OUT * pressing.tool.reach + 2.0 * largest)
            at = pressing.pose.position.astype(np.float32)
            slab = slice(*np.searchsorted(x, np.array([at[0] - reach, at[0] + reach])))
            within = (np.abs(y[slab] - at[1]) < reach) & (np.abs(z[slab] - at[2]) < reach)
            found.append(order[slab][within])
        return found[0] if len(found) == 1 else np.unique(np.concatenate(found))

    @cached_property
    def canvas(self) -> NDArray[np.float32]:
        """An array like ``rest`` for displacements of which only one frame is needed at a time. The
        system hands a new array of megabytes over page by page, which takes longer than to fill it.
        """
        return np.empty_like(self.rest)

    @cached_property
    def _from_left(self) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Numbers (p,) of the drawn vertices along the first axis, and their coordinates (3, p) in
        this order, metres: what is near a tool is looked for in a slab, not among all.
        """
        order = np.argsort(self.places[:, 0])
        return order, np.ascontiguousarray(self.places[order].T, dtype=np.float32)

    def node_displacements(self, displacements: Array) -> Array:
        """Displacements of all nodes (N, 3), zero where pinned or inside."""
        everywhere = np.zeros_like(self.body.mesh.nodes)
        everywhere[self.body.compliance.free_surface] = displacements
        return everywhere

    def surface_displacements(self, displacements: Array, near: Array) -> Array:
        """The same of the places of the rest surface nearest to points (k, 3), metres."""
        moved = self.node_displacements(displacements)
        triangles = self.body.mesh.surface_triangles
        places = [nearest_place(self.body, point) for point in near]
        return np.array([place.alpha @ moved[triangles[place.triangle]] for place in places])

    def moved_to(self, frame: BodyFrame) -> DrawnBody | None:
        """The same body with its object's present frame; None if that was scaled or sheared."""
        if not self.frame.stretches_as(frame):
            return None
        same = np.array_equal(frame.rotation, self.frame.rotation)
        if same and np.array_equal(frame.origin, self.frame.origin):
            return self
        # The baked stretch is kept, so that rounding does not accumulate while the object moves.
        return replace(self, frame=replace(frame, stretch=self.frame.stretch))


def restores_quickly(thing: bpy.types.Object) -> bool:
    """Whether a missing body is restored so quickly that no progress or Escape is needed."""
    return bpy.app.background or _is_small(ObjectHandle.of(thing), thing.palpate.body_key)


# A panel asks as often as it is drawn.
@lru_cache(maxsize=8)
def _is_small(handle: ObjectHandle, _key: str) -> bool:
    """Counted of the tetrahedra: a file can say any number of them."""
    try:
        within = embedded(handle.find())
    except PalpateError:
        # There is nothing to compute, and Press says why.
        return True
    free = np.setdiff1d(within.mesh.surface_nodes, within.fixed)
    return len(free) <= MOST_NODES_AT_ONCE


def open_body(
    thing: bpy.types.Object, scene: bpy.types.Scene, *, as_stored: bool = False
) -> DrawnBody:
    """Load an object's body if it fits; a missing one of usual size is recomputed at once, and
    added pins are applied where that needs no bake. With ``as_stored`` nothing is computed and no
    file is written: for handlers, which nobody asked to.

    Raises
    ------
    PalpateError
        The object cannot be pressed, was never baked, or has changed since, with the remedy.
    """
    refusal = soft_object.refusal(thing)
    if refusal:
        raise PalpateError(refusal)
    surface = body_source.read_again(thing, scene)
    status = soft_object.with_file(thing, soft_object.mesh_status(thing, surface))
    soft_object.refuse_changed(thing, status)
    found = _stored(thing, status) if as_stored else _body(thing, surface, status)
    body = kept_body.of_law(found, law_of_object(thing))
    rest = drawn_surface.rest_coordinates(layers.drawn_mesh(thing))
    places = surface.frame.body_from_local(rest.reshape(-1, 3).astype(np.float64))
    imprint = imprint_of(thing)
    found = _imprinted(body, thing, places, imprint @ surface.frame.metric)
    return DrawnBody(
        body=found,
        at_rest=body,
        hung=hung_on(body, places),
        rest=rest,
        imprint=imprint.ravel(),
        frame=surface.frame,
        folds=Folds(found),
        file=body_store.locate(thing),
    )


def _imprinted(body: SoftBody, thing: bpy.types.Object, places: Array, imprint: Array) -> SoftBody:
    """The body with the imprint (p, 3) of what is drawn, ``places`` (p, 3) at rest, metres."""
    if not imprint.any():
        return body
    triangles = drawn_surface.triangles_of(layers.drawn_mesh(thing))
    return imprinted(body, DrawnImprint(places, triangles, imprint))


def _stored(thing: bpy.types.Object, status: BodyStatus) -> SoftBody:
    """Body of the object as its file has it.

    Raises
    ------
    PalpateError
        There is none, or the pins are to be applied first.
    """
    if status.fit is Fit.READY and status.pins.quick and not status.changed:
        raise PalpateError(
            "{name}: the pins have changed since; press Update Pins", name=thing.name
        )
    return kept_body.load(thing)


def _body(thing: bpy.types.Object, surface: DrawnSurface, status: BodyStatus) -> SoftBody:
    """Body of the object, with its present pins if that needs no bake."""
    if status.fit is Fit.FILE_MISSING and restores_quickly(thing):
        body_store.restore(thing)
        status = replace(status, fit=Fit.READY, pins=pin_change.look(thing, lambda: surface))
    # Other changed settings, and the pins with them, wait for Rebuild Body.
    if status.fit is Fit.READY and status.pins.quick and not status.changed:
        return pin_change.take_over(thing, surface)
    return kept_body.load(thing)
