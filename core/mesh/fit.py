"""Fit of a body to the surface it was made from: how far they lie apart, where, and why."""

from __future__ import annotations

from dataclasses import astuple, dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from ..quantities import length, volume
from ..sentence import Sentence
from .closest_point import ClosestPoints
from .surface import Surface
from .tet_mesh import TetMesh
from .winding_volume import enclosed_volume, is_inside, sampled_volume

# Bounds of the volume ratio; outside, the tetrahedra fill something else.
VOLUME_RATIO_BOUNDS = (0.5, 1.5)

# A larger difference is checked against the winding number.
DOUBTFUL_VOLUME_ERROR = 0.1

# Input vertices farther than this share of the diagonal may be walls between merged parts.
BURIED_DISTANCE = 0.01

# Beyond these the drawn shape and the body differ visibly, and the user is warned: a share of the
# diagonal more than the tolerance, and of the volume.
NOTABLE_DISTANCE = 0.01
NOTABLE_VOLUME_ERROR = 0.1

# Distance of the places of a surface whose distances are taken, as a share of the diagonal, and
# places along the side of a triangle at most.
SAMPLE_DISTANCE = 0.04
MOST_ALONG_A_SIDE = 24

# Points whose side is asked for at once, from the farthest on.
POINTS_AT_ONCE = 256

# Thickness, in tolerances, below which fTetWild keeps nothing, and below which it may lose parts.
THICKNESS_LOST, THICKNESS_DOUBTFUL = 1.0, 4.0

# Diagonals of things that people press. Outside of these the unit is doubtful.
SMALLEST_USUAL, LARGEST_USUAL = 1e-3, 20.0


@dataclass(frozen=True)
class Place:
    """Where a distance was found: ``x``, ``y``, ``z`` in metres, and the number of the input's
    nearest ``vertex``.
    """

    x: float
    y: float
    z: float
    vertex: int

    def __str__(self) -> str:
        return f"({self.x:.6g}, {self.y:.6g}, {self.z:.6g}) m"


@dataclass(frozen=True)
class Fit:
    """Fit of tetrahedra to the surface they were made from.

    Attributes
    ----------
    volume_ratio : volume of the tetrahedra over the volume the input encloses; 0 where that is
        nothing.
    body_to_input, input_to_body : largest distance from one surface to the other, metres.
    body_at, input_at : where these were found, on the surface named first.
    """

    volume_ratio: float
    body_to_input: float
    input_to_body: float
    body_at: Place
    input_at: Place

    @classmethod
    def of_dict(cls, plain: dict[str, Any]) -> Self:
        """The fit of :func:`dataclasses.asdict`."""
        places = {name: Place(**plain[name]) for name in ("body_at", "input_at")}
        return cls(**{**plain, **places})

    def as_array(self) -> NDArray[np.float64]:
        """All figures in a row, (11,), for a file."""
        ratio, *distances, body_at, input_at = astuple(self)
        return np.array([ratio, *distances, *body_at, *input_at], dtype=np.float64)

    @classmethod
    def of_array(cls, row: NDArray[np.float64]) -> Self:
        """The fit of :meth:`as_array`.

        Raises
        ------
        PalpateError
            It is not such a row.
        """
        if row.shape != (11,) or row.dtype.kind != "f" or not np.isfinite(row).all():
            raise PalpateError("its figures of fit are no row of 11 numbers")
        ratio, body_to_input, input_to_body = map(float, row[:3])
        places = (_vertex_at(part[:3], int(part[3])) for part in (row[3:7], row[7:11]))
        return cls(ratio, body_to_input, input_to_body, *places)


def measured_fit(mesh: TetMesh, surface: Surface, shell: Surface) -> Fit:
    """Compare a body with the ``surface`` it was made from.

    ``shell`` is the same surface welded and decimated, as it was handed to fTetWild; the volume is
    taken from it.
    """
    enclosed = enclosed_volume(shell)
    if abs(mesh.volume - enclosed) > DOUBTFUL_VOLUME_ERROR * enclosed:
        # The surface may intersect itself; this costs a second or two.
        enclosed = sampled_volume(shell)
    ratio = mesh.volume / enclosed if enclosed > 0 else 0.0
    body = Surface(mesh.nodes, mesh.surface_triangles)
    own = _samples(body)
    from_body = ClosestPoints(surface.vertices, surface.triangles).query(own).distance
    others = _samples(surface)
    from_input = ClosestPoints(body.vertices, body.triangles).query(others).distance
    worst_own = int(from_body.argmax())
    worst_other = _farthest_outside(others, from_input, body, BURIED_DISTANCE * surface.diagonal)
    return Fit(
        float(ratio),
        float(from_body[worst_own]),
        float(from_input[worst_other]),
        _place(own[worst_own], surface),
        _place(others[worst_other], surface),
    )


def refuse_misfit(fit: Fit, mesh: TetMesh, shell: Surface, epsilon: float) -> None:
    """Check that a body has to do with its surface.

    Raises
    ------
    PalpateError
        The volumes differ too much, or the body fell to pieces, as the surface is too thin for
        the tolerance; the volumes differ for another reason.
    """
    least, most = VOLUME_RATIO_BOUNDS
    is_similar = least < fit.volume_ratio < most
    if not is_similar or mesh.component_count > shell.piece_count:
        refuse_thin(shell, epsilon, THICKNESS_DOUBTFUL)
    if is_similar:
        return
    raise PalpateError(
        "tetrahedralization: the body has {body}, but the surface encloses about {surface}; close "
        "large holes, recalculate normals, or use a smaller edge length",
        body=volume(mesh.volume),
        surface=volume(mesh.volume / fit.volume_ratio if fit.volume_ratio else 0.0),
    )


def refuse_thin(surface: Surface, epsilon: float, tolerances: float = THICKNESS_LOST) -> None:
    """Check that a surface is thicker than so many ``tolerances``.

    Raises
    ------
    PalpateError
        It is thinner: fTetWild, free to move each side by the tolerance, loses it.
    """
    thickness = surface.thickness
    allowed = epsilon * surface.diagonal
    if thickness >= tolerances * allowed:
        return
    raise PalpateError(
        "tetrahedralization: the mesh is only about {thickness} thick, too thin for a tolerance of "
        "{allowed}, which is {epsilon:g} of its size; use a tolerance of {fitting:.1g} or less "
        "(Tolerance in the panel, --epsilon), or make it thicker",
        thickness=length(thickness),
        allowed=length(allowed),
        epsilon=epsilon,
        fitting=thickness / (THICKNESS_DOUBTFUL * surface.diagonal),
    )


def fit_warnings(fit: Fit, mesh: TetMesh, shell: Surface, epsilon: float) -> list[Sentence]:
    """What the user should know of the fit of a body to its surface, the most severe last.

    Parameters
    ----------
    mesh, shell : the body, and the surface as it was handed to fTetWild.
    epsilon : distance that was allowed, as a share of the diagonal.
    """
    found = []
    diagonal = shell.diagonal
    if abs(fit.volume_ratio - 1) > NOTABLE_VOLUME_ERROR:
        found.append(
            Sentence(
                "the body has {share:.0f} % of the volume that the mesh encloses; a smaller edge "
                "length or epsilon follows it more closely",
                share=100 * fit.volume_ratio,
            )
        )
    limit = (NOTABLE_DISTANCE + epsilon) * diagonal
    if fit.body_to_input > limit:
        found.append(
            Sentence(
                "the body lies up to {distance} from the mesh ({share:.0f} % of its size), near "
                "vertex {vertex}, at {place}: it fills what the mesh leaves open there; close the "
                "opening or give the sheet thickness (Solidify)",
                distance=length(fit.body_to_input),
                share=100 * fit.body_to_input / diagonal,
                vertex=fit.body_at.vertex,
                place=str(fit.body_at),
            )
        )
    if fit.input_to_body > limit:
        found.append(
            Sentence(
                "the mesh lies up to {distance} from the body ({share:.0f} % of its size), near "
                "vertex {vertex}, at {place}: it is open or too thin there, and follows the body's "
                "nearest place; give it thickness, or use a smaller tolerance",
                distance=length(fit.input_to_body),
                share=100 * fit.input_to_body / diagonal,
                vertex=fit.input_at.vertex,
                place=str(fit.input_at),
            )
        )
    if mesh.component_count > shell.piece_count:
        found.append(
            Sentence(
                "the body fell into {count} pieces, where the mesh has {own}, since it is thinner "
                "there than the tolerance keeps; use a smaller tolerance (Tolerance in the panel, "
                "--epsilon), make the mesh thicker there, or pin each piece",
                count=mesh.component_count,
                own=shell.piece_count,
            )
        )
    return found


def size_warnings(mesh: TetMesh) -> list[Sentence]:
    """What the user should know of a body's size."""
    diagonal = float(np.linalg.norm(np.ptp(mesh.nodes, axis=0)))
    if SMALLEST_USUAL <= diagonal <= LARGEST_USUAL:
        return []
    return [
        Sentence(
            "the body is {size} large; if that is not meant, correct the metres per unit (in "
            "Blender Scene Properties > Units > Unit Scale) or its scale, and bake again",
            size=length(diagonal),
        )
    ]


def _farthest_outside(
    points: NDArray[np.float64], distance: NDArray[np.float64], body: Surface, buried: float
) -> int:
    """Number of the farthest of the ``points``, without those farther than ``buried`` inside."""
    order = np.argsort(-distance, kind="stable")
    near = int(np.searchsorted(-distance[order], -buried))
    for first in range(0, near, POINTS_AT_ONCE):
        some = order[first : min(first + POINTS_AT_ONCE, near)]
        outside = some[~is_inside(points[some], body)]
        if len(outside):
            return int(outside[0])
    return int(order[min(near, len(order) - 1)])


def _place(point: NDArray[np.float64], surface: Surface) -> Place:
    used = np.unique(surface.triangles)
    nearest = np.linalg.norm(surface.vertices[used] - point, axis=1).argmin()
    return _vertex_at(point, int(used[nearest]))


def _vertex_at(point: NDArray[np.float64], vertex: int) -> Place:
    x, y, z = map(float, point)
    return Place(x, y, z, vertex)


def _samples(surface: Surface) -> NDArray[np.float64]:
    """Points (p, 3) of a surface: its vertices, and more where triangles are large."""
    corners = surface.vertices[surface.triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    parts = np.ceil(longest / (SAMPLE_DISTANCE * surface.diagonal))
    parts = np.clip(parts, 1, MOST_ALONG_A_SIDE).astype(np.int64)
    points = [surface.vertices[np.unique(surface.triangles)]]
    for count in np.unique(parts[parts > 1]):
        first, second = np.indices((count + 1, count + 1)).reshape(2, -1)
        kept = first + second <= count
        alpha = np.column_stack([first, second, count - first - second])[kept] / count
        points.append(np.einsum("ac,tcx->tax", alpha, corners[parts == count]).reshape(-1, 3))
    return np.concatenate(points)
