"""The scene about what lies in something hollow: a teddy in a bowl of staves."""

import bodies
import bpy
import fabric
import mouse_shape
import numpy as np
import scenes
import studio
import teddy_shape

NAME, SIZE = "Teddy", (0.05, 0.0037)
# Radii and heights of the bowl's inside, from the bottom to the rim, its wall, metres; staves.
FOOT, RIM, BOTTOM, HIGH, WALL, STAVES = 0.038, 0.074, 0.006, 0.052, 0.005, 11
# Half of what is between two staves, radians: parts that touch in their corners would be one.
SEAM = 0.004
# How the teddy is let go: metres over the ground, and leaning back by degrees.
AT, LEANING = (-0.012, 0.0, 0.022), 24.0
WOODS, FUR, STITCH, PATCH = (
    ((0.42, 0.23, 0.10), (0.50, 0.29, 0.13)),
    (0.46, 0.27, 0.12),
    (0.18, 0.09, 0.04),
    (0.78, 0.62, 0.42),
)


def bowl_scene() -> list[bpy.types.Object]:
    """A teddy over a bowl."""
    scene = studio.empty_scene("Bowl")
    teddy = _teddy(scene)
    teddy.location, teddy.rotation_euler.y = AT, np.radians(-LEANING)
    bearing = bpy.data.collections.new("Bearing")
    scene.collection.children.link(bearing)
    bearing.objects.link(_bowl())
    teddy.palpate.colliders = bearing
    aim = (0.0, 0.0, 0.055)
    studio.present(scene, teddy, aim, (0.36, -0.34, 0.26), 68.0, 0.36, lit=(0.0, 0.0, 0.05))
    return [teddy]


def settle_teddy() -> None:
    """How it lies, as transform and layer, which need no Palpate."""
    if bpy.ops.palpate.settle() != {"FINISHED"}:
        raise RuntimeError(f"{NAME}: it did not come to rest")


def tets() -> dict[str, bodies.Tets]:
    """The teddy's tetrahedra, of which none is pinned."""
    return {NAME: bodies.stored_tets("teddy")}


def _teddy(scene: bpy.types.Scene) -> bpy.types.Object:
    shape = teddy_shape.teddy()
    mesh = scenes.soft_mesh(NAME, shape)
    for material in (
        fabric.plush(fabric.ringed, FUR, STITCH, PATCH),
        fabric.felt((0.05, 0.03, 0.02)),
        fabric.bead(),
    ):
        mesh.materials.append(material)
    colours = np.where((shape.felt < 0.0)[:, None], PATCH, np.tile(FUR, (len(shape.felt), 1)))
    dark = np.unique(shape.quads[shape.part != mouse_shape.Part.PLUSH])
    colours[dark] = (0.02, 0.012, 0.01)
    scenes.paint(mesh, colours)
    teddy = studio.link(scene, NAME, mesh)
    settings = teddy.palpate
    settings.material, settings.pin_mode, settings.bake_from = "PLUSH", "NONE", "BASE"
    bodies.set_mesh_size(teddy, SIZE)
    return teddy


def _bowl() -> bpy.types.Object:
    """Staves around a round bottom: convex parts of one mesh."""
    places, faces, tones = [], [], []
    turns = 2.0 * np.pi * np.arange(STAVES + 1) / STAVES
    ring = np.column_stack([np.cos(turns), np.sin(turns)])[:-1]
    for number in range(STAVES):
        first = len(places)
        for turn in (turns[number] + SEAM, turns[number + 1] - SEAM):
            x, y = np.cos(turn), np.sin(turn)
            for radius, height in (
                (FOOT, 0.0),
                (FOOT + WALL, 0.0),
                (RIM, HIGH),
                (RIM + WALL, HIGH),
            ):
                places.append((radius * x, radius * y, height))
                tones.append(WOODS[number % 2])
        corners = np.array([(1, 3, 2, 0), (6, 7, 5, 4), (2, 6, 4, 0), (5, 7, 3, 1)])
        ends = np.array([(4, 5, 1, 0), (3, 7, 6, 2)])
        faces.extend((first + np.concatenate([corners, ends])).tolist())
    first, inner = len(places), FOOT * (1.0 + 0.3 * BOTTOM / HIGH)
    for height in (0.0, BOTTOM):
        places.extend((inner * x, inner * y, height) for x, y in ring)
        tones.extend([WOODS[1]] * STAVES)
    low, high = first + np.arange(STAVES), first + STAVES + np.arange(STAVES)
    faces.extend([low[::-1].tolist(), high.tolist()])
    after = np.roll(np.arange(STAVES), -1)
    faces.extend(np.column_stack([low, low[after], high[after], high]).tolist())
    mesh = bpy.data.meshes.new("Bowl")
    mesh.from_pydata(places, [], faces)
    mesh.materials.append(fabric.felt(WOODS[0]))
    scenes.paint(mesh, np.array(tones))
    return bpy.data.objects.new("Bowl", mesh)
