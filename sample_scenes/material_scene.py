"""The same press on rubber, foam and memory foam."""

import bodies
import bpy
import fabric
import numpy as np
import scenes
import studio
from installed import palpate

# Name, preset and colour of each cube, from left to right; metres from one to the next.
CUBES = (
    ("Rubber", "RUBBER", (0.16, 0.16, 0.18)),
    ("Foam", "PU_FOAM_SOFT", (0.85, 0.68, 0.30)),
    ("Memory Foam", "MEMORY_FOAM", (0.60, 0.72, 0.85)),
)
APART = 0.075
CELLS = 8
# The press: radius and depth, metres; where it is out, in, out again, and all is over, frames.
RADIUS, DEPTH = 0.012, 0.014
FRAMES = (1, 12, 30, 38, 110)


def material_scene() -> list[bpy.types.Object]:
    """Three cubes beside each other, each of its preset."""
    scene = studio.empty_scene("Materials")
    cubes = []
    for number, (name, material, colour) in enumerate(CUBES):
        cube = scenes.paper_cube(scene, name)
        cube.location.x = (number - 1) * APART
        bodies.set_up(cube, scenes.PINNED, material=material)
        darker = (0.5 * colour[0], 0.5 * colour[1], 0.5 * colour[2])
        cube.data.materials[0] = fabric.foam(colour, darker, scenes.CUBE_EDGE / 10.0)
        cubes.append(cube)
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    studio.present(scene, cubes[0], (0.0, 0.0, 0.022), (0.0, -0.42, 0.24), 70.0, 0.26)
    return cubes


def tets() -> dict[str, bodies.Tets]:
    """The tetrahedra of each cube."""
    mesh, fixed = palpate("core.mesh.paper_cube").paper_cube(cells=CELLS)
    one = mesh.nodes - np.array([0.025, 0.025, 0.0]), mesh.tets, fixed
    return dict.fromkeys((name for name, *_ in CUBES), one)


def keep_presses() -> None:
    """The same push on each, in and out; what gives way with time comes back by its creep."""
    scene, layers = bpy.context.scene, palpate("operators.layer.layers")
    for name, *_ in CUBES:
        cube = scene.objects[name]
        bpy.context.view_layer.objects.active = cube
        place = (cube.location.x, 0.0, scenes.CUBE_EDGE)
        bpy.ops.palpate.stroke(motion="PUSH", place=place, radius=RADIUS, depth=DEPTH)
        layer = layers.layers_of(cube)[0]
        path = layers.strength_path(layer)
        out, pressed, let_go, free, end = FRAMES
        keys = [(out, 0.0), (pressed, 1.0), (let_go, 1.0)]
        keys += _coming_back(cube, let_go, end) or [(free, 0.0)]
        for frame, share in keys:
            layers.set_strength(cube, layer, share)
            cube.keyframe_insert(path, frame=frame)
    scene.frame_set(FRAMES[3])


def _coming_back(cube: bpy.types.Object, begin: int, end: int) -> list[tuple[int, float]]:
    """Keys of what is left of a dent that was held for long, by the material's relaxation."""
    terms = palpate("core.law.relaxation").RELAXATIONS[cube.palpate.relaxation].pairs
    if not terms:
        return []
    # Strain e under no stress, from the springs of a Maxwell chain that had all relaxed:
    # e + sum of s_i (e - m_i) = 0, t_i dm_i/dt = e - m_i, in steps of a hundredth of a frame.
    shares, seconds = np.array(terms).T
    held, steps, keys = np.ones(len(shares)), 100, []
    dt = 1.0 / (bpy.context.scene.render.fps * steps)
    for frame in range(begin + 1, end + 1):
        for _ in range(steps):
            strain = shares @ held / (1.0 + shares.sum())
            held += dt / seconds * (strain - held)
        keys.append((frame, float(strain)))
    return [keys[0], *(key for key in keys[1:] if (key[0] - begin) % 6 == 0)]
