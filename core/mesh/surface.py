"""The surface a body is made from: triangles in metres, checked to be fit for a solid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import PalpateError
from ..sentence import Sentence
from .coordinates import refuse_rounded, refuse_unusable
from .tet_mesh import pieces

# Vertices closer than this share of the diagonal are one: seams that only look open are closed.
WELD_TOLERANCE = 1e-6

# A rod is less than so many times as wide as its volume is to half its area; a plate is wider.
ROD_WIDTH = 6.0

# Beyond, a vertex that belongs to no face is as good as any other.
FARTHEST_STEP = 2.0**62

# A shape thinner than this share of its diagonal everywhere is a sheet, not a solid.
FLATTEST = 1e-3

# Of a closed surface the area vectors add up to nothing, of half a sphere to half its area.
OPENEST = 0.9


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangle soup that may be open, overlapping or in several parts.

    Attributes
    ----------
    vertices : float64 (V, 3), metres.
    triangles : int64 (F, 3), vertex numbers.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]

    @classmethod
    def checked(cls, vertices: ArrayLike, triangles: ArrayLike) -> Surface:
        """Make a surface from arrays (V, 3) and (F, 3).

        Raises
        ------
        PalpateError
            Nothing there, numbers that are not finite, vertex numbers out of range, a flat or
            degenerate shape.
        """
        points = np.array(vertices, dtype=np.float64).reshape(-1, 3)
        faces = np.array(triangles, dtype=np.int64).reshape(-1, 3)
        if not len(points) or not len(faces):
            raise PalpateError(
                "mesh: it has {vertices} vertices and {faces} faces, so there is nothing to make "
                "soft; choose a mesh with faces",
                vertices=len(points),
                faces=len(faces),
            )
        refuse_unusable(Sentence("mesh"), points)
        refuse_rounded(Sentence("mesh"), np.asarray(vertices))
        if faces.min() < 0 or faces.max() >= len(points):
            wrong = int(faces.min()) if faces.min() < 0 else int(faces.max())
            raise PalpateError(
                "mesh: a face names vertex {wrong}, but they are numbered 0 to {last}; the file "
                "is damaged, export it again",
                wrong=wrong,
                last=len(points) - 1,
            )
        surface = cls(points, faces)
        surface._refuse_sheet()
        return surface

    @cached_property
    def diagonal(self) -> float:
        """Diagonal of the bounding box, metres."""
        used = self.vertices[np.unique(self.triangles)]
        return float(np.linalg.norm(np.ptp(used, axis=0)))

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Area of each triangle, (F,), square metres."""
        i, j, k = (self.vertices[self.triangles[:, corner]] for corner in range(3))
        area: NDArray[np.float64] = 0.5 * np.linalg.norm(np.cross(j - i, k - i), axis=1)
        return area

    @property
    def openness(self) -> float:
        """Sum of the area vectors, as a share of the area: 0 where closed, 1 of a plane piece."""
        i, j, k = (self.vertices[self.triangles[:, corner]] for corner in range(3))
        open_area = float(np.linalg.norm(0.5 * np.cross(j - i, k - i).sum(axis=0)))
        return open_area / float(self.areas.sum())

    @property
    def signed_volume(self) -> float:
        """Enclosed volume by the divergence theorem, cubic metres; for closed surfaces only."""
        # From a point of its own: far from the origin the terms would cancel to rounding.
        corners = self.vertices[self.triangles] - self.vertices[self.triangles[0, 0]]
        i, j, k = (corners[:, corner] for corner in range(3))
        return float(np.einsum("fx,fx->", i, np.cross(j, k)) / 6.0)

    @cached_property
    def is_closed(self) -> bool:
        """Whether every edge is used once in each direction."""
        edges = np.concatenate([self.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
        forward = np.unique(edges, axis=0)
        backward = np.unique(edges[:, ::-1], axis=0)
        return len(forward) == len(edges) and np.array_equal(forward, backward)

    @cached_property
    def piece_count(self) -> int:
        """Number of parts that share no vertex."""
        used, corners = np.unique(self.triangles, return_inverse=True)
        return int(pieces(corners.reshape(-1, 3), len(used)).max()) + 1

    @property
    def thickness(self) -> float:
        """About the thickness as of a rod or a plate, metres; of an open surface its second largest
        extent.
        """
        used = self.vertices[np.unique(self.triangles)]
        axes = np.linalg.svd(used - used.mean(axis=0), full_matrices=False)[2]
        width = float(np.ptp(used @ axes[1]))
        if not self.is_closed:
            return width
        plate = 2 * abs(self.signed_volume) / float(self.areas.sum())
        return 2 * plate if width < ROD_WIDTH * plate else plate

    def coinciding(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """One vertex of each place, (P,), and for every vertex the number of its place, (V,)."""
        low = self.vertices[np.unique(self.triangles)].min(axis=0)
        steps = (self.vertices - low) / (WELD_TOLERANCE * self.diagonal)
        # Vertices of no face may lie anywhere.
        grid = np.clip(np.round(steps), -FARTHEST_STEP, FARTHEST_STEP).astype(np.int64)
        _, first, place = np.unique(grid, axis=0, return_index=True, return_inverse=True)
        return first, place.reshape(-1)

    def welded(self) -> Surface:
        """The same surface with coinciding vertices merged, and without collapsed triangles and
        vertices of none.
        """
        first, place = self.coinciding()
        faces = place[self.triangles]
        proper = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        used, corners = np.unique(faces[proper], return_inverse=True)
        return Surface(self.vertices[first[used]], corners.reshape(-1, 3))

    def _refuse_sheet(self) -> None:
        used = self.vertices[np.unique(self.triangles)]
        if not self.areas.sum() > 0:
            raise PalpateError(
                "mesh: all its faces have zero area, so it encloses nothing; choose a mesh with "
                "an inside"
            )
        extents = np.linalg.svd(used - used.mean(axis=0), compute_uv=False)
        if extents[1] < FLATTEST * extents[0]:
            raise PalpateError(
                "mesh: it is a needle more than {times:.0f} times as long as thick, too thin to be "
                "a solid; make it thicker or shorter",
                times=1 / FLATTEST,
            )
        if extents[2] < FLATTEST * extents[0]:
            raise PalpateError(
                "mesh: it is flat, so it has no inside to be soft; give it thickness (for example "
                "apply a Solidify modifier) or choose a closed mesh"
            )
        if self.openness > OPENEST:
            raise PalpateError(
                "mesh: it is an open sheet that encloses no volume; give it thickness (for example "
                "apply a Solidify modifier) or close its holes"
            )
