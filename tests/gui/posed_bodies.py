"""Bodies that are seen elsewhere than at rest, for scenarios."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from mathutils import Matrix

# Few tetrahedra: a bake takes about two seconds.
COARSE = 0.2


def arm(segments: int = 20) -> bpy.types.Object:
    """An arm of radius 0.5 along X, from -2 to 2, with two bones that meet at the origin."""
    rings = np.linspace(-2.0, 2.0, 2 * segments + 1)
    around = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    places = [(x, 0.5 * np.cos(a), 0.5 * np.sin(a)) for x in rings for a in around]
    faces = [
        (n * segments + k, n * segments + j, (n + 1) * segments + j, (n + 1) * segments + k)
        for n in range(len(rings) - 1)
        for k, j in ((k, (k + 1) % segments) for k in range(segments))
    ]
    last = len(places) - segments
    faces += [tuple(reversed(range(segments))), tuple(range(last, last + segments))]
    thing = _object("Arm", places, faces)
    _bend_at_origin(thing)
    return thing


def bend(thing: bpy.types.Object, angle: float) -> None:
    """Turn the forearm up by an angle."""
    bone = thing.modifiers["Armature"].object.pose.bones["Forearm"]
    bone.matrix = Matrix.Rotation(-angle, 4, "Y") @ bone.bone.matrix_local
    bpy.context.view_layer.update()


def half_sphere() -> bpy.types.Object:
    """The half of a sphere with x >= 0 and a Mirror modifier."""
    shape = bmesh.new()
    bmesh.ops.create_uvsphere(shape, u_segments=32, v_segments=16, radius=1.0)
    elements = [*shape.verts, *shape.edges, *shape.faces]
    bmesh.ops.bisect_plane(
        shape, geom=elements, plane_co=(0, 0, 0), plane_no=(1, 0, 0), clear_inner=True
    )
    thing = _object("Half", [], [])
    shape.to_mesh(thing.data)
    shape.free()
    thing.modifiers.new("Mirror", "MIRROR")
    return thing


def places(thing: bpy.types.Object) -> np.ndarray:
    """Vertices (p, 3) as seen, world coordinates."""
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    flat = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", flat)
    matrix = np.array(thing.matrix_world)
    return flat.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def _object(name: str, places: list, faces: list) -> bpy.types.Object:
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places, [], faces)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    # Pressed from all sides.
    thing.palpate.edge_length, thing.palpate.pin_mode = COARSE, "CORE"
    return thing


def _bend_at_origin(thing: bpy.types.Object) -> None:
    armature = bpy.data.objects.new("Bones", bpy.data.armatures.new("Bones"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for name, head, tail in (("Upper Arm", -2.0, 0.0), ("Forearm", 0.0, 2.0)):
        bone = armature.data.edit_bones.new(name)
        bone.head, bone.tail = (head, 0.0, 0.0), (tail, 0.0, 0.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.hide_set(True)
    groups = [thing.vertex_groups.new(name=name) for name in ("Upper Arm", "Forearm")]
    for vertex in thing.data.vertices:
        share = float(np.clip(0.5 + vertex.co.x, 0.0, 1.0))
        share = share * share * (3.0 - 2.0 * share)
        for group, weight in zip(groups, (1.0 - share, share), strict=True):
            group.add([vertex.index], weight, "REPLACE")
    thing.modifiers.new("Armature", "ARMATURE").object = armature
    bpy.context.view_layer.objects.active = thing
    bpy.context.view_layer.update()
