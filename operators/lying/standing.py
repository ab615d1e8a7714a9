"""Whether an object may lie by itself, and whether it stands where it is."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.mesh.tet_mesh import pieces
from ...core.shape.shapes import shape_name
from ..layer import layers, stack
from ..played import mesh_cache
from ..scene.drawn_surface import DrawnSurface, metres_per_unit
from ..shape.drawn_shape import chosen_shape
from .laid import is_animated
from .placement import placement_of

Array = NDArray[np.float64]

# Share of its size over what bears it at which a body that falls is looked at again; so near to its
# floor it stands on it.
LANDING = 0.05
# Weight over stiffness, rho g h / E, beyond which a body is a heap: the foot of a block of twice
# that would be pressed to nothing if it gave way as a linear one, and it falls over before.
HEAP = 0.5
# Vertices so near to each other, as a share of the size, are one; more parts than this are apart.
SAME, MOST_PARTS = 1e-5, 300
# Any direction, and how often a ray may meet a surface.
RAY, MOST_CROSSED = Vector((0.43, 0.61, 0.665)).normalized(), 1000


def stands(thing: bpy.types.Object, surface: DrawnSurface, scene: bpy.types.Scene) -> bool:
    """Whether an object that nobody pins could be pressed where it is: it may lie by itself, its
    floor or colliders are right under it, it is no heap, and in one piece.
    """
    used = np.unique(surface.triangles)
    if refusal(thing) is not None or is_animated(thing) or not used.size:
        return False
    places = placement_of(surface.frame).to_world(surface.body[used])
    size = float(np.linalg.norm(np.ptp(places, axis=0)))
    is_near = _over_floor(thing, scene, float(places[:, 2].min())) <= LANDING * size
    is_borne = thing.palpate.colliders is not None or is_near
    return is_borne and limpness(thing, scene, places) <= HEAP and _is_one(surface, size)


def _over_floor(thing: bpy.types.Object, scene: bpy.types.Scene, lowest: float) -> float:
    """How far its lowest place is from its floor, metres; infinite without one."""
    chosen = thing.palpate
    match chosen.floor:
        case "NONE":
            return float("inf")
        case "HEIGHT":
            return abs(lowest - metres_per_unit(scene) * float(chosen.floor_height))
    return max(lowest, 0.0)


def limpness(thing: bpy.types.Object, scene: bpy.types.Scene, places: Array) -> float:
    """Of an object as it stands with ``places`` (k, 3) in the world, metres, rho g h / E."""
    chosen = thing.palpate
    heights = places @ np.array(scene_gravity(scene))
    return float(chosen.density * np.ptp(heights) / chosen.young_modulus)


def scene_gravity(scene: bpy.types.Scene) -> tuple[float, float, float]:
    """Gravity of a scene, m/s2."""
    x, y, z = scene.gravity if scene.use_gravity else (0.0, 0.0, 0.0)
    return float(x), float(y), float(z)


def _is_one(surface: DrawnSurface, size: float) -> bool:
    """Whether all loose parts of a surface hang together: they meet, or one is in another."""
    cells = np.round(surface.body / (SAME * size)).astype(np.int64)
    _, number = np.unique(cells, axis=0, return_inverse=True)
    corners = number.reshape(-1)[surface.triangles]
    part = pieces(corners, int(number.max()) + 1)[corners[:, 0]]
    parts = [surface.triangles[part == one] for one in np.unique(part)]
    if not 1 < len(parts) <= MOST_PARTS:
        return len(parts) == 1
    boxes = [surface.body[one].reshape(-1, 3) for one in parts]
    low = np.array([box.min(axis=0) for box in boxes]) - SAME * size
    high = np.array([box.max(axis=0) for box in boxes]) + SAME * size
    near = np.argwhere(((low[:, None] <= high) & (low <= high[:, None])).all(axis=2))
    trees = [
        BVHTree.FromPolygons(box.tolist(), np.arange(len(box)).reshape(-1, 3).tolist())
        for box in boxes
    ]
    meet = [
        (one, other)
        for one, other in near.tolist()
        if one < other
        and (
            trees[one].overlap(trees[other])
            or _is_in(boxes[one][0], trees[other])
            or _is_in(boxes[other][0], trees[one])
        )
    ]
    pairs = np.array(meet, dtype=np.int64).reshape(-1, 2)
    return not pieces(pairs, len(parts)).any()


def _is_in(place: Array, tree: BVHTree) -> bool:
    """Whether a place (3,) is within a closed surface: a ray leaves it an odd number of times."""
    crossed, here = 0, Vector(place)
    while crossed < MOST_CROSSED:
        hit, _, _, away = tree.ray_cast(here, RAY)
        if hit is None:
            break
        crossed, here = crossed + 1, hit + RAY * max(1e-6 * away, 1e-9)
    return crossed % 2 == 1


def refusal(thing: bpy.types.Object) -> PalpateError | None:
    """Reason why an object cannot move by itself."""
    if thing.parent is not None or any(one.enabled for one in thing.constraints):
        return PalpateError(
            "{name} is moved by its parent or a constraint, and cannot lie by itself; clear them, "
            "or choose other Pins",
            name=thing.name,
        )
    if shape_name(chosen_shape(thing)) == "paper":
        return PalpateError(
            "{name}: without pins it has no tables of the paper's; choose Real under Large "
            "Deformation",
            name=thing.name,
        )
    posing = [kind for kind in stack.following(thing, layers.made_by(thing)) if kind in stack.POSES]
    if posing and not mesh_cache.plays(thing):
        return PalpateError(
            "{name} is posed by its modifiers, and rests as it was made; hide them, or choose "
            "other Pins",
            name=thing.name,
        )
    return None
