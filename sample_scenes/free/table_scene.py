"""The scene about what lies: a plush mouse on a table, pressed by a finger of three rods."""

from itertools import pairwise

import bodies
import bpy
import fabric
import numpy as np
import scenes
import studio
from numpy.typing import NDArray

Array = NDArray[np.float64]

NAME = "Plush Mouse"
# Of the table: halves of its top and of a leg, metres; a leg's place as a share of the top.
TOP, LEG, INSET = (0.105, 0.075, 0.006), (0.007, 0.007, 0.027), 0.86
HEIGHT = 2.0 * (TOP[2] + LEG[2])
# Joints of the finger from its tip on, seen from the tip, metres, and the radius of each rod.
JOINTS = ((0.0, 0.0, 0.0), (0.021, 0.0, 0.021), (0.048, 0.0, 0.034), (0.088, 0.0, 0.038))
RADII = (0.0075, 0.0085, 0.0095)
# Frames, and heights of the fingertip's middle over the table then.
FRAMES, HEIGHTS = (1, 14, 30, 40), (0.085, 0.052, 0.052, 0.085)
PLACE, BAKED_STEP = (-0.012, 0.0), 3
# The vertex group of what is sewn of felt, and how many times as stiff as plush that is.
FELT, FELT_FACTOR = "Felt", 300.0
WOOD, SKIN = (0.45, 0.25, 0.11), (0.80, 0.50, 0.38)


def table_scene() -> list[bpy.types.Object]:
    """A plush that lies on a table, and a finger over it."""
    scene = studio.empty_scene("Table")
    mouse = scenes.plush_mouse(scene)
    mouse.name, mouse.location.z = NAME, HEIGHT + 0.001
    settings = mouse.palpate
    settings.pin_mode, settings.pin_group, settings.static_friction = "NONE", "", 0.8
    # Of plush the tail would sag by many times its length.
    felt = scenes.felt_vertices(mouse.data)
    mouse.vertex_groups.new(name=FELT).add(felt.tolist(), 1.0, "REPLACE")
    bodies.set_stiff(mouse, FELT, FELT_FACTOR)
    bearing = bpy.data.collections.new("Bearing")
    scene.collection.children.link(bearing)
    bearing.objects.link(_table())
    settings.colliders = bearing
    _finger(scene)
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    aim = (0.0, 0.0, HEIGHT + 0.022)
    studio.present(scene, mouse, aim, (0.26, -0.40, 0.27), 62.0, 0.36, lit=(0.0, 0.0, HEIGHT))
    return [mouse]


def bake_press() -> None:
    """What the finger does, as keyframes of the mouse and a point cache of its surface."""
    mouse, scene = bpy.data.objects[NAME], bpy.context.scene
    bpy.context.view_layer.objects.active = mouse
    scene.frame_set(FRAMES[0])
    if bpy.ops.palpate.settle() != {"FINISHED"}:
        raise RuntimeError(f"{NAME}: it did not come to rest")
    mouse.palpate.pressers = bpy.data.collections["Finger"]
    if bpy.ops.palpate.press_frames(step=BAKED_STEP) != {"FINISHED"}:
        raise RuntimeError(f"{NAME}: Bake Animation did not finish")
    scene.frame_set(FRAMES[1] + 4)


def tets() -> dict[str, bodies.Tets]:
    """The mouse's tetrahedra, of which none is pinned."""
    nodes, corners, _ = bodies.stored_tets("mouse")
    return {NAME: (nodes, corners, np.empty(0, dtype=np.int64))}


def _table() -> bpy.types.Object:
    """A top on four legs: five convex parts of one mesh."""
    boxes = [(np.array([0.0, 0.0, HEIGHT - TOP[2]]), np.array(TOP))]
    for x in (-1.0, 1.0):
        for y in (-1.0, 1.0):
            at = np.array([x * INSET * TOP[0], y * INSET * TOP[1], LEG[2]])
            boxes.append((at, np.array(LEG)))
    unit = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    box = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    places = np.concatenate([at + unit * half for at, half in boxes])
    faces = [[8 * number + corner for corner in face] for number in range(5) for face in box]
    mesh = bpy.data.meshes.new("Small Table")
    mesh.from_pydata(places.tolist(), [], faces)
    mesh.materials.append(fabric.felt(WOOD))
    scenes.paint(mesh, np.tile(WOOD, (len(places), 1)))
    return bpy.data.objects.new("Small Table", mesh)


def _finger(scene: bpy.types.Scene) -> None:
    """Three rods that an Empty moves: what is keyed is the Empty."""
    guide = studio.link(scene, "Fingertip", None)
    guide.empty_display_size = RADII[0]
    for frame, height in zip(FRAMES, HEIGHTS, strict=True):
        guide.location = (*PLACE, HEIGHT + height - 0.02)
        guide.keyframe_insert("location", frame=frame)
    rods = bpy.data.collections.new("Finger")
    scene.collection.children.link(rods)
    ends = pairwise(JOINTS)
    for number, ((start, end), radius) in enumerate(zip(ends, RADII, strict=True)):
        rod = bpy.data.objects.new(
            f"Rod {number + 1}", _rod(np.array(start), np.array(end), radius)
        )
        rod.parent = guide
        rods.objects.link(rod)


def _rod(start: Array, end: Array, radius: float) -> bpy.types.Mesh:
    """A cylinder with round ends."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=10, radius=radius)
    ball = bpy.context.object
    mesh = ball.data.copy()
    bpy.data.objects.remove(ball)
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", places)
    along = (end - start) / np.linalg.norm(end - start)
    across = np.linalg.svd(along[None])[2][1:]
    turn = np.stack([across[0], np.cross(along, across[0]), along])
    places = places.reshape(-1, 3)
    far = places[:, 2:] > 1e-6
    placed = places @ turn + np.where(far, end, start)
    mesh.vertices.foreach_set("co", placed.astype(np.float32).ravel())
    mesh.shade_smooth()
    mesh.update()
    mesh.materials.append(fabric.felt(SKIN))
    scenes.paint(mesh, np.tile(SKIN, (len(placed), 1)))
    return mesh
