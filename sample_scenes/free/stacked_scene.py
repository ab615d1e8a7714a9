"""The scene about what rests on each other: three jelly cubes, stacked."""

import bodies
import bpy
import fabric
import mouse_shape
import numpy as np
import scenes
import studio

NAMES = ("Lime", "Cherry", "Lemon")
COLOURS = ((0.20, 0.52, 0.12), (0.62, 0.05, 0.09), (0.86, 0.55, 0.06))
# Of the paper's cube, whose lattice they have: thirty millimetres, or the lowest would be a heap.
SHARE = 0.6
# Metres aside, and turned by degrees, one above the other.
ASIDE, TURNS, AIR = ((0.0, 0.0), (0.003, -0.002), (-0.002, 0.003)), (4.0, -11.0, 19.0), 0.0005


def stacked_scene() -> list[bpy.types.Object]:
    """Three cubes, each a little over the one below."""
    scene = studio.empty_scene("Stacked")
    jelly = bpy.data.collections.new("Jelly")
    scene.collection.children.link(jelly)
    edge = SHARE * scenes.CUBE_EDGE
    cubes = []
    for number, (name, colour) in enumerate(zip(NAMES, COLOURS, strict=True)):
        cube = _cube(scene, name, colour, edge)
        jelly.objects.link(cube)
        x, y = ASIDE[number]
        cube.location = (x, y, number * (edge + AIR))
        cube.rotation_euler.z = np.radians(TURNS[number])
        # One collection for all: each rests on the others.
        cube.palpate.colliders = jelly
        cubes.append(cube)
    aim = (0.0, 0.0, 0.044)
    studio.present(scene, cubes[0], aim, (0.18, -0.30, 0.15), 72.0, 0.22)
    return cubes


def settle_stack() -> None:
    """How they lie, as transforms and layers, which need no Palpate."""
    if bpy.ops.palpate.settle() != {"FINISHED"}:
        raise RuntimeError("Stacked: they did not come to rest")


def tets() -> dict[str, bodies.Tets]:
    """Tetrahedra of each cube, of which none is pinned."""
    nodes, corners, _ = bodies.cube_tets()
    return dict.fromkeys(NAMES, (SHARE * nodes, corners, np.empty(0, dtype=np.int64)))


def _cube(
    scene: bpy.types.Scene, name: str, colour: scenes.Colour, edge: float
) -> bpy.types.Object:
    unit, quads = mouse_shape.cube_surface(scenes.CUBE_CELLS)
    vertices = edge * (unit - np.array([0.5, 0.5, 0.0]))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], quads.tolist())
    mesh.shade_smooth()
    mesh.materials.append(fabric.felt(colour))
    scenes.paint(mesh, scenes.checked(colour, *vertices.T))
    cube = studio.link(scene, name, mesh)
    cube.palpate.material, cube.palpate.pin_mode = "JELLY", "NONE"
    # A firm one: softer ones lean until the uppermost slides off.
    cube.palpate.young_modulus = 2e4
    return cube
