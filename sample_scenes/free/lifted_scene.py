"""The scene about what nobody holds: a ball that two hands squeeze and lift."""

import bodies
import bpy
import fabric
import numpy as np
import scenes
import studio
from numpy.typing import NDArray

Array = NDArray[np.float64]

RADIUS, CELLS = 0.03, 6
# Halves of a hand, metres; frames: apart, squeezed, lifted, still there.
HAND = (0.008, 0.022, 0.03)
FRAMES, GAPS, LIFTS = (1, 12, 36, 48), (0.012, -0.006, -0.006, -0.006), (0.0, 0.0, 0.05, 0.05)
BAKED_STEP = 3
RUBBER, SKIN = (0.75, 0.22, 0.14), (0.80, 0.50, 0.38)
# Corners of a cell in the order of their sums, and the six ways from the first to the last.
WAYS = ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0))


def lifted_scene() -> list[bpy.types.Object]:
    """A ball that two hands squeeze and lift."""
    scene = studio.empty_scene("Lifted")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=RADIUS)
    ball = bpy.context.object
    ball.name, ball.location.z = "Ball", RADIUS
    ball.data.shade_smooth()
    ball.data.materials.append(fabric.felt(RUBBER))
    scenes.paint(ball.data, np.tile(RUBBER, (len(ball.data.vertices), 1)))
    settings = ball.palpate
    settings.material, settings.pin_mode, settings.static_friction = "PLUSH", "NONE", 1.0
    settings.bake_from = "BASE"
    hands = bpy.data.collections.new("Hands")
    scene.collection.children.link(hands)
    for name, side in (("Left Hand", -1.0), ("Right Hand", 1.0)):
        hand = _hand(name)
        hands.objects.link(hand)
        for frame, gap, lift in zip(FRAMES, GAPS, LIFTS, strict=True):
            hand.location = (side * (RADIUS + HAND[0] + gap), 0.0, RADIUS + lift)
            hand.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    aim = (0.0, 0.0, 0.05)
    studio.present(scene, ball, aim, (0.16, -0.36, 0.14), 70.0, 0.3)
    return [ball]


def bake_lift() -> None:
    """What the hands do, as keyframes of the ball and a point cache of its surface."""
    ball, scene = bpy.data.objects["Ball"], bpy.context.scene
    bpy.context.view_layer.objects.active = ball
    scene.frame_set(1)
    if bpy.ops.palpate.settle() != {"FINISHED"}:
        raise RuntimeError("Ball: it did not come to rest")
    ball.palpate.pressers = bpy.data.collections["Hands"]
    if bpy.ops.palpate.press_frames(step=BAKED_STEP) != {"FINISHED"}:
        raise RuntimeError("Ball: Bake Animation did not finish")
    scene.frame_set(FRAMES[2])


def tets() -> dict[str, bodies.Tets]:
    """Tetrahedra of the ball, of which none is pinned."""
    return {"Ball": (*_ball(), np.empty(0, dtype=np.int64))}


def _hand(name: str) -> bpy.types.Object:
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * HAND
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners.tolist(), [], faces)
    mesh.materials.append(fabric.felt(SKIN))
    scenes.paint(mesh, np.tile(SKIN, (len(corners), 1)))
    return bpy.data.objects.new(name, mesh)


def _ball() -> tuple[Array, NDArray[np.int64]]:
    """A lattice blown up to a ball about the origin, each cell in six tetrahedra."""
    side = CELLS + 1
    at = np.indices((side, side, side)).reshape(3, -1).T * (2.0 / CELLS) - 1.0
    # Cells of a grown cube are alike where lines from the middle turn by the same angles.
    at = np.tan(0.25 * np.pi * at)
    length = np.linalg.norm(at, axis=1)
    blown = np.abs(at).max(axis=1) / np.where(length > 0.0, length, 1.0)
    steps, cells = np.array([side * side, side, 1]), []
    starts = np.indices((CELLS, CELLS, CELLS)).reshape(3, -1).T @ steps
    for one, two, three in WAYS:
        corners = np.cumsum([0, steps[one], steps[two], steps[three]])
        # Three of the six ways go round the other way.
        odd = np.linalg.det(np.eye(3)[[one, two, three]]) < 0.0
        order = [0, 2, 1, 3] if odd else [0, 1, 2, 3]
        cells.append(starts[:, None] + corners[order])
    return RADIUS * at * blown[:, None], np.concatenate(cells).astype(np.int64)
