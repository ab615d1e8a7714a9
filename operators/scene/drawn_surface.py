"""Drawn mesh at rest, read from Blender into arrays: the surface that a body is made from.

It is the base mesh (the Basis of its shape keys), not the evaluated one: modifiers stay on top.
What these make is read in ``operators/carrier``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.mesh.coordinates import refuse_rounded
from ...core.mesh.surface import Surface
from ...core.sentence import Sentence
from . import fingerprint
from .body_frame import BodyFrame
from .fingerprint import Fingerprint


@dataclass(eq=False)
class Derived:
    """What was computed of a surface; the same wherever its object is moved."""

    body: NDArray[np.float64] | None = None
    shape: Fingerprint | None = None


@dataclass(frozen=True, eq=False)
class DrawnSurface:
    """Arrays of a mesh at rest.

    Attributes
    ----------
    local : float64 (p, 3), vertex coordinates in local units.
    triangles : int64 (m, 3), n-gons triangulated by Blender.
    corners, face_starts : int64, polygons as loops of vertex numbers.
    frame : from local units to metres.
    """

    local: NDArray[np.float64]
    triangles: NDArray[np.int64]
    corners: NDArray[np.int64]
    face_starts: NDArray[np.int64]
    frame: BodyFrame
    derived: Derived = field(default_factory=Derived, kw_only=True, repr=False)

    @property
    def base(self) -> DrawnSurface:
        """The surface of the object's own mesh."""
        return self

    def group(self, thing: bpy.types.Object, name: str) -> NDArray[np.float64]:
        """Weights (p,) of a vertex group at its vertices."""
        return group_weights(thing.data, thing.vertex_groups[name].index)

    @property
    def body(self) -> NDArray[np.float64]:
        """Vertices (p, 3) in metres, body coordinates."""
        if self.derived.body is None:
            self.derived.body = self.frame.body_from_local(self.local)
        return self.derived.body

    def surface(self) -> Surface:
        """The surface to bake, in metres, wound outward as drawn.

        Raises
        ------
        PalpateError
            Nothing there, not finite, flat, or too far from the object's origin.
        """
        # Blender's own precision, of which float64 keeps no trace.
        refuse_rounded(Sentence("mesh"), self.local.astype(np.float32))
        return Surface.checked(self.body, self.frame.wind(self.triangles))

    @property
    def shape(self) -> Fingerprint:
        """Fingerprint without rules."""
        if self.derived.shape is None:
            taken = fingerprint.take(self.local, self.body, self.corners, self.face_starts)
            self.derived.shape = taken
        return self.derived.shape

    def fingerprint(self, pins: str, stiffness: str) -> Fingerprint:
        """Fingerprint of the surface with these rules, stored with a body."""
        return replace(self.shape, pins=pins, stiffness=stiffness)


# Surfaces read last, and their arrays as Blender had them: a large mesh takes long to read. Two, of
# an object: its own mesh, and what its modifiers make of it.
_last: list[tuple[tuple[NDArray[np.generic], ...], DrawnSurface]] = []
MOST_KEPT = 2


def read(
    thing: bpy.types.Object, scene: bpy.types.Scene, mesh: bpy.types.Mesh | None = None
) -> DrawnSurface:
    """Read the mesh of an object, or another that was made of it; one of the surfaces read last
    where that is still the same.

    Raises
    ------
    PalpateError
        An object whose transform flattens it.
    """
    mesh, frame = mesh or thing.data, frame_of(thing, scene)
    local, (corners, starts) = rest_coordinates(mesh), polygons(mesh)
    arrays = (local, corners, starts)
    for known, surface in _last:
        same = all(map(np.array_equal, known, arrays))
        if same and surface.frame.stretches_as(frame):
            # The stretch differs by rounding only, as between two rotations of the object.
            return replace(surface, frame=replace(frame, stretch=surface.frame.stretch))
    surface = DrawnSurface(
        local=local.astype(np.float64).reshape(-1, 3),
        triangles=triangles_of(mesh),
        corners=corners.astype(np.int64),
        face_starts=starts.astype(np.int64),
        frame=frame,
    )
    _last[:] = [(arrays, surface), *_last][:MOST_KEPT]
    return surface


def forget() -> None:
    """Free the memory of the surfaces read last."""
    _last.clear()


def group_weights(mesh: bpy.types.Mesh, group: int) -> NDArray[np.float64]:
    """Weight of a vertex group, by its number, at every vertex (p,); 0 where one is not in it."""
    weights = np.zeros(len(mesh.vertices))
    for vertex in mesh.vertices:
        for membership in vertex.groups:
            if membership.group == group:
                weights[vertex.index] = membership.weight
    return weights


def polygons(mesh: bpy.types.Mesh) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Loops of vertex numbers of all polygons, and the first loop of each."""
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    if len(corners):
        # Seventy times as quick as the loops' own property.
        mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
    starts = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    return corners, starts


def triangles_of(mesh: bpy.types.Mesh) -> NDArray[np.int64]:
    """Triangles (m, 3) of all polygons, as Blender divides them."""
    mesh.calc_loop_triangles()
    triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    return triangles.astype(np.int64).reshape(-1, 3)


def rest_coordinates(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Coordinates of the Basis, or of the mesh where it has no shape keys, flat float32 (3 p,)."""
    if not mesh.shape_keys:
        return coordinates(mesh)
    basis = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.shape_keys.reference_key.points.foreach_get("co", basis)
    return basis


def coordinates(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Coordinates of a mesh as it is, flat float32 (3 p,).

    Those of an evaluated mesh: its shape keys are still the base mesh's.
    """
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    if len(places):
        # An empty mesh has no attribute "position".
        mesh.attributes["position"].data.foreach_get("vector", places)
    return places


def frame_of(thing: bpy.types.Object, scene: bpy.types.Scene) -> BodyFrame:
    """Frame of the object, from local units to metres.

    Raises
    ------
    PalpateError
        A transform that is not finite or flattens the object.
    """
    return BodyFrame.of_matrix(np.array(thing.matrix_world), metres_per_unit(scene))


def size_of(thing: bpy.types.Object, scene: bpy.types.Scene) -> float:
    """Diagonal of the object's bounding box, metres.

    Raises
    ------
    PalpateError
        As of :func:`frame_of`.
    """
    corners = frame_of(thing, scene).body_from_local(np.array(thing.bound_box))
    return float(np.linalg.norm(np.ptp(corners, axis=0)))


def metres_per_unit(scene: bpy.types.Scene) -> float:
    """Metres per Blender unit; 1 without a unit system."""
    units = scene.unit_settings
    return 1.0 if units.system == "NONE" else float(units.scale_length)
