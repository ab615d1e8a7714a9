"""Look at a mesh, taken in a moment and measured in any thread: what panels say of it.

Reading the triangles of half a million vertices takes Blender a third of a second, and measuring
them another; a panel cannot wait for either.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.bake.cost.crossing import crossing_length
from ...core.bake.cost.size import ShapeSize, bending
from ...core.errors import PalpateError
from ...core.mesh.formats.polygons import triangulated
from ...core.mesh.surface import Surface
from ..layer import stack
from ..scene import drawn_surface, fingerprint
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import polygons
from ..scene.fingerprint import Fingerprint


@dataclass(frozen=True)
class MeasuredMesh:
    """What a status and a prediction need of a mesh.

    Attributes
    ----------
    shape : its fingerprint, without rules.
    size : of the surface; the reason where it cannot be baked.
    """

    shape: Fingerprint
    size: ShapeSize | PalpateError


@dataclass(frozen=True, eq=False)
class MeshArrays:
    """Arrays of a mesh, as Blender holds them.

    Attributes
    ----------
    local : float32 (p, 3), vertex coordinates in local units.
    corners, face_starts : int32, polygons as loops of vertex numbers.
    """

    local: NDArray[np.float32]
    corners: NDArray[np.int32]
    face_starts: NDArray[np.int32]

    @classmethod
    def at_rest(cls, mesh: bpy.types.Mesh) -> MeshArrays:
        """Copy those of an object's own mesh, at rest."""
        return cls(drawn_surface.rest_coordinates(mesh).reshape(-1, 3), *polygons(mesh))

    @classmethod
    def evaluated(cls, mesh: bpy.types.Mesh) -> MeshArrays:
        """Copy those of an evaluated mesh, as it is posed."""
        return cls(drawn_surface.coordinates(mesh).reshape(-1, 3), *polygons(mesh))

    def surface(self, frame: BodyFrame) -> Surface:
        """The surface, metres. Polygons are taken as fans.

        Raises
        ------
        PalpateError
            It cannot be baked.
        """
        corners, starts = self.corners.astype(np.int64), self.face_starts.astype(np.int64)
        sizes = np.diff(starts, append=len(corners))
        body = frame.body_from_local(self.local.astype(np.float64))
        return Surface.checked(body, triangulated(corners, sizes))


@dataclass(frozen=True, eq=False)
class MeshLook:
    """Arrays of an object.

    Attributes
    ----------
    own : of its mesh at rest.
    baked : of what would be baked: its mesh, or what modifiers make of it, as it is posed now.
    frame : from local units to metres.
    """

    own: MeshArrays
    baked: MeshArrays
    frame: BodyFrame

    @classmethod
    def take(cls, thing: bpy.types.Object, scene: bpy.types.Scene) -> MeshLook:
        """Copy the arrays of a mesh object: 20 ms for half a million vertices.

        Raises
        ------
        PalpateError
            An object whose transform flattens it.
        """
        frame = drawn_surface.frame_of(thing, scene)
        own = baked = MeshArrays.at_rest(thing.data)
        if thing.palpate.bake_from != "BASE" and stack.making(thing):
            graph = bpy.context.evaluated_depsgraph_get()
            baked = MeshArrays.evaluated(thing.evaluated_get(graph).data)
        return cls(own, baked, frame)

    def measured(self) -> MeasuredMesh:
        """Measure it, without Blender."""
        local = self.own.local.astype(np.float64)
        corners, starts = self.own.corners.astype(np.int64), self.own.face_starts.astype(np.int64)
        shape = fingerprint.take(local, self.frame.body_from_local(local), corners, starts)
        try:
            return MeasuredMesh(shape, shape_size(self.baked.surface(self.frame)))
        except PalpateError as problem:
            return MeasuredMesh(shape, problem)


def shape_size(surface: Surface) -> ShapeSize:
    """Size of a surface; quick also for several parts, whose overlaps count twice."""
    middle = surface.vertices.mean(axis=0)
    i, j, k = (surface.vertices[surface.triangles[:, corner]] - middle for corner in range(3))
    volume = abs(float(np.einsum("fx,fx->", i, np.cross(j, k)))) / 6.0
    area, triangles = float(surface.areas.sum()), len(surface.triangles)
    crossing = crossing_length(surface)
    return ShapeSize(area, volume, surface.diagonal, triangles, bending(surface), crossing)
