"""Rigid tools that touch a body: fingertip, rod, plate, any convex mesh.

A tool is the convex hull of a few core points, grown by a ball (their Minkowski sum): one point is
a sphere, two a rod with round ends (capsule), the corners of a box a plate with rounded edges. So
one signed distance serves all of them, its gradient is the outward normal, and both are exact:
outside the core by the closest point of the hull, inside it by the nearest face, as in C. Ericson,
*Real-Time Collision Detection* (2005), 5.1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from ...errors import PalpateError
from ...mesh.closest_point import closest_area_coordinates
from ...mesh.coordinates import refuse_unusable
from ...sentence import Sentence
from .front import pointed_spacing

# Corners at most: distances to larger hulls take too long in the servo's tick.
MOST_CORE_POINTS = 64

# Core points closer to one plane (line, point) than this share of their extent lie in it.
FLATNESS = 1e-6

# Spacing of contact points, as a share of the radius of a sphere, of a rod (more of which is in
# contact), and of a flat tool's width; of a pointed one's see :mod:`.front`.
SPACING_PER_RADIUS = 0.2
SPACING_PER_ROD_RADIUS = 0.25
SPACING_PER_WIDTH = 0.125

# Default rounding of the edges, as a share of the inner radius: a sharp edge has no normal.
SHARPEST_ROUNDING = 0.1


@dataclass(frozen=True, eq=False)
class Tool:
    """Rigid tool: the convex hull of ``core`` (k, 3), metres in its frame, grown by a ``radius``.

    Made by :func:`sphere`, :func:`rod`, :func:`plate` and :func:`convex`, or directly.

    Raises
    ------
    PalpateError
        Core points that are not (k, 3) finite numbers, none or more than 64 of them; a radius that
        is not a positive number.
    """

    name: str
    core: NDArray[np.float64]
    radius: float

    def __post_init__(self) -> None:
        core = np.array(self.core, dtype=np.float64)
        if core.ndim != 2 or core.shape[1] != 3 or not len(core):
            raise PalpateError(
                "tool {name}: core points have shape {shape}, expected (k, 3) with k > 0; give "
                "one row of x, y, z in metres per point",
                name=self.name,
                shape=core.shape,
            )
        refuse_unusable(Sentence("tool {name}", name=self.name), core)
        if len(core) > MOST_CORE_POINTS:
            raise PalpateError(
                "tool {name}: {count} core points are more than the {most} the servo can follow; "
                "give fewer, or use convex(), which simplifies",
                name=self.name,
                count=len(core),
                most=MOST_CORE_POINTS,
            )
        _refuse_no_length(self.name, Sentence("radius"), self.radius)
        core.setflags(write=False)
        object.__setattr__(self, "core", core)

    @cached_property
    def faces(self) -> NDArray[np.int64]:
        """Triangles (f, 3) of the core's hull, numbers of core points.

        A core without volume has triangles without sides: a polygon's fan (seen from both sides),
        a segment [0, 1, 1], a point [0, 0, 0].
        """
        return self._hull[0]

    @cached_property
    def planes(self) -> NDArray[np.float64]:
        """Outward unit normal and offset (f, 4) of each face; none where the core has no volume.

        A point x is inside the hull where ``planes[:, :3] @ x + planes[:, 3] < 0`` for all.
        """
        return self._hull[1]

    @cached_property
    def _hull(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        dimension, axes = span(self.core)
        nothing = np.empty((0, 4))
        if dimension == 3:
            hull = ConvexHull(self.core)
            return hull.simplices.astype(np.int64), hull.equations.astype(np.float64)
        along = (self.core - self.core.mean(axis=0)) @ axes[:, :2]
        if dimension == 2:
            ring = ConvexHull(along).vertices.astype(np.int64)
            fan = np.column_stack([np.full(len(ring) - 2, ring[0]), ring[1:-1], ring[2:]])
            return fan, nothing
        ends = np.argsort(along[:, 0], kind="stable")[[0, -1, -1]].astype(np.int64)
        return ends[None] if dimension else np.zeros((1, 3), dtype=np.int64), nothing

    @cached_property
    def inner_radius(self) -> float:
        """Distance from the middle of the core points to the tool's surface, metres."""
        if not len(self.planes):
            return self.radius
        middle = self.core.mean(axis=0)
        depth = -(self.planes[:, :3] @ middle + self.planes[:, 3])
        return self.radius + float(depth.min())

    @cached_property
    def extents(self) -> NDArray[np.float64]:
        """Lengths (3,) of the tool along its own axes, metres, longest first."""
        lengths: NDArray[np.float64] = np.sort(np.ptp(self.core, axis=0))[::-1]
        return lengths + 2.0 * self.radius

    @property
    def size(self) -> float:
        """Width of the tool, metres: the middle one of its three extents."""
        return float(self.extents[1])

    @cached_property
    def spacing(self) -> float:
        """Spacing of contact points on a body for this tool, metres."""
        if len(self.planes):
            pointed = pointed_spacing(self.core, self.faces, SPACING_PER_WIDTH)
            return min(SPACING_PER_WIDTH * self.size, pointed)
        if span(self.core)[0] == 2:
            return SPACING_PER_WIDTH * self.size
        round_share = SPACING_PER_RADIUS if len(self.core) == 1 else SPACING_PER_ROD_RADIUS
        return round_share * self.radius

    @cached_property
    def reach(self) -> float:
        """Distance from the reference point to the tool's farthest point, metres."""
        return float(np.linalg.norm(self.core, axis=1).max()) + self.radius

    def distance(
        self, points: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Signed distances (p,), negative inside, and outward unit normals (p, 3) there.

        ``points`` (p, 3) are in the tool's frame, as the normals. Where several places of the
        surface are equally near (a sphere's centre), one of the normals.
        """
        points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        away = points - self._closest_core_points(points)
        distance = np.linalg.norm(away, axis=1)
        # Closer than this the direction is rounding; the face's own normal is as good.
        clear = distance > 1e-9 * self.radius
        normals = np.tile(self._normal_of_flat_core, (len(points), 1))
        np.divide(away, distance[:, None], out=normals, where=clear[:, None])
        if len(self.planes):
            heights = points @ self.planes[:, :3].T + self.planes[:, 3]
            nearest = heights.argmax(axis=1)
            height = heights[np.arange(len(points)), nearest]
            inside = (height <= 0.0) | ~clear
            distance[inside] = np.minimum(height[inside], distance[inside])
            normals[inside] = self.planes[nearest[inside], :3]
        return distance - self.radius, normals

    def _closest_core_points(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        if len(self.core) == 1:
            return np.broadcast_to(self.core, points.shape)
        corners = self.core[self.faces]
        pairs = (len(points), len(corners), 3)
        spread = np.broadcast_to(points[:, None], pairs).reshape(-1, 3)
        faces = np.broadcast_to(corners, (len(points), *corners.shape)).reshape(-1, 3, 3)
        alpha = closest_area_coordinates(spread, faces)
        places = np.einsum("pc,pcx->px", alpha, faces).reshape(pairs)
        nearest = np.linalg.norm(places - points[:, None], axis=2).argmin(axis=1)
        closest: NDArray[np.float64] = places[np.arange(len(points)), nearest]
        return closest

    @cached_property
    def _normal_of_flat_core(self) -> NDArray[np.float64]:
        """Direction of push within a core without volume: across it, towards -z."""
        across = span(self.core)[1][:, 2]
        return across if across[2] < 0 else -across


def sphere(radius: float, name: str = "sphere") -> Tool:
    """Sphere about its reference point: a fingertip."""
    return Tool(name, np.zeros((1, 3)), radius)


def rod(radius: float, length: float, name: str = "rod") -> Tool:
    """Round-ended rod (capsule) along x, its axis ``length`` metres long without the ends."""
    _refuse_no_length(name, Sentence("length"), length)
    return Tool(name, np.array([[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]]) * length, radius)


def plate(
    width: float,
    depth: float,
    rounding: float | None = None,
    thickness: float | None = None,
    name: str = "plate",
) -> Tool:
    """Plate of ``width`` along x and ``depth`` along y, over all, which works with its -z face.

    The middle of that face is the reference point, the plate lies in z >= 0. ``rounding`` is the
    radius of its edges (default: a twentieth of the smaller side); ``thickness`` defaults to half
    the smaller side, so that nothing comes out at its back.

    Raises
    ------
    PalpateError
        Lengths that are not positive, or a rounding too large for them.
    """
    _refuse_no_length(name, Sentence("width"), width)
    _refuse_no_length(name, Sentence("depth"), depth)
    edge = min(width, depth) / 20 if rounding is None else rounding
    high = min(width, depth) / 2 if thickness is None else thickness
    _refuse_no_length(name, Sentence("rounding"), edge)
    _refuse_no_length(name, Sentence("thickness"), high)
    if 2 * edge >= min(width, depth, high):
        raise PalpateError(
            "tool {name}: a rounding of {edge:g} m leaves nothing of a plate of {width:g} by "
            "{depth:g} by {high:g} m; give less than half the smallest",
            name=name,
            edge=edge,
            width=width,
            depth=depth,
            high=high,
        )
    x, y = width / 2 - edge, depth / 2 - edge
    core = [(a, b, c) for a in (-x, x) for b in (-y, y) for c in (edge, high - edge)]
    return Tool(name, np.array(core), edge)


def span(points: NDArray[np.float64]) -> tuple[int, NDArray[np.float64]]:
    """Dimensions spanned by points (k, 3), and their principal axes as columns, widest first."""
    _, _, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=True)
    lengths = np.ptp(points @ axes.T, axis=0)
    dimension = int((lengths > FLATNESS * max(float(lengths.max()), np.finfo(float).tiny)).sum())
    return (dimension if lengths.max() > 0.0 else 0), axes.T


def _refuse_no_length(name: str, which: Sentence, value: float) -> None:
    if not (np.isfinite(value) and value > 0.0):
        raise PalpateError(
            "tool {name}: {which} is {value}; give a positive number of metres",
            name=name,
            which=which,
            value=value,
        )
