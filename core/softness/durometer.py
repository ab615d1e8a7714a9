"""Virtual durometer: the standard's indenter pressed into a body until body and spring balance.

The body answers linearly, with the near field (:mod:`..contact.near_field`), since an indenter is
smaller than the mesh.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from ..body.soft_body import SoftBody
from ..contact.near_field.compliance_beneath import near_correction
from ..contact.near_field.point_compliance import point_compliance
from ..contact.place import Place
from ..errors import PalpateError
from ..sentence import Sentence
from .durometer_balance import Balance, balanced
from .durometer_points import Seat, set_on
from .scales.durometer_type import MILLIMETRE, TYPES, DurometerType
from .scales.indentation import indenter_force
from .scales.shore import Shore

# The standard's requirements of a specimen, and limits of a credible reading.
LEAST_THICKNESS = 6.0 * MILLIMETRE
MOST_OF_THICKNESS = 0.2
MOST_OVERHANG = 0.05
# Longest edges of the surface, as a share of the thickness, to resolve what is beneath; it matters
# where the contact is wider than a share of the thickness (5 %: by about a point).
MOST_EDGE = 0.25
LEAST_CONTACT = 0.05


@dataclass(frozen=True, eq=False)
class DurometerReading:
    """Reading of a durometer at a place of a body.

    Attributes
    ----------
    shore : the reading.
    block : reading on a large, thick block of the same material.
    place : of the durometer.
    tip_force, foot_force : newton, on the body.
    depth, foot_depth : as in :class:`Balance`, metres.
    thickness : of the body there, along the axis, metres.
    warnings : reasons to doubt the reading, in sentences.
    """

    shore: Shore
    block: Shore
    place: Place
    tip_force: float
    foot_force: float
    depth: float
    foot_depth: float
    thickness: float
    warnings: tuple[Sentence, ...]


def read_durometer(
    body: SoftBody,
    at: ArrayLike,
    scale: str = "00",
    *,
    young_modulus: float | None = None,
    load: float | None = None,
) -> DurometerReading:
    """Read a durometer set on the surface point nearest to ``at`` (3,), metres.

    >>> from palpate.core.bake.settings import BakeSettings
    >>> from palpate.core.bake.steps import bake
    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> body, _ = bake(paper_cube()[0], BakeSettings(poisson_ratio=0.45, young_modulus=1e5))
    >>> print(read_durometer(body, (0.025, 0.025, 0.05), "00").shore)
    00-23.6

    Parameters
    ----------
    scale : "00" or "A".
    young_modulus : pascal; the body's own unless given.
    load : newton on the device, as of a stand; None for a foot that just touches, as in the
        relations between Shore values and Young's modulus.

    Raises
    ------
    PalpateError
        Unknown scale; a load or Young's modulus that is no positive number.
    """
    if scale not in TYPES:
        raise PalpateError(
            "Shore {scale}: there is no such durometer here; choose 00 or A", scale=scale
        )
    kind = TYPES[scale]
    modulus = body.modulus(young_modulus)
    for name, value, unit in (
        (Sentence("Young's modulus"), modulus, Sentence("pascal")),
        (Sentence("load"), load, Sentence("newton")),
    ):
        if value is not None and not (np.isfinite(value) and value > 0):
            raise PalpateError(
                "durometer: {name} is {value}; give a positive number of {unit}",
                name=name,
                value=value,
                unit=unit,
            )
    seat = set_on(body, at, kind)
    balance = balanced(seat_compliance(body, seat) / modulus, seat, kind, load)
    return DurometerReading(
        shore=Shore(scale, balance.reading),
        block=Shore(scale, block_reading(kind, modulus, body.poisson_ratio)),
        place=seat.place,
        tip_force=float(balance.pushes[seat.tip].sum()),
        foot_force=float(balance.pushes[~seat.tip].sum()),
        depth=balance.depth,
        foot_depth=balance.foot_depth,
        thickness=seat.thickness,
        warnings=tuple(_warnings(body, seat, kind, balance)),
    )


def seat_compliance(body: SoftBody, seat: Seat) -> NDArray[np.float64]:
    """Compliance between the contact points along the axis, (p, p), at 1 Pa."""
    points, everyone = seat.points, np.arange(len(seat.points))
    correction = near_correction(body, points)
    blocks = point_compliance(body, points, everyone, everyone, correction)
    axis = seat.place.axis
    along = np.einsum("x,klxy,y->kl", axis, blocks, axis, optimize=True)
    symmetric: NDArray[np.float64] = 0.5 * (along + along.T)
    return symmetric


def block_reading(kind: DurometerType, young_modulus: float, poisson_ratio: float) -> float:
    """Reading on a half-space, by the closed forms of :mod:`.indentation`."""
    stiffness = young_modulus / (1.0 - poisson_ratio**2)

    def excess(reading: float) -> float:
        return stiffness * indenter_force(kind, kind.depth(reading)) - kind.force(reading)

    return 0.0 if excess(0.0) < 0.0 else float(brentq(excess, 0.0, 100.0, xtol=1e-9))


def _warnings(
    body: SoftBody, seat: Seat, kind: DurometerType, balance: Balance
) -> Iterator[Sentence]:
    sunk = (balance.depth + balance.foot_depth) / seat.thickness
    if sunk > MOST_OF_THICKNESS:
        yield Sentence(
            "the indenter goes in by {share:.0f} % of the thickness there, more than a linear "
            "body can be believed for; try a firmer material or another place",
            share=100 * sunk,
        )
    if seat.thickness < LEAST_THICKNESS:
        yield Sentence(
            "the body is {thickness:.1f} mm thick there, and the standard asks for {least:.0f} "
            "mm; the reading tells part and support together",
            thickness=1000 * seat.thickness,
            least=1000 * LEAST_THICKNESS,
        )
    edge = _edge_length(body, seat)
    felt = np.sqrt(kind.shaft * balance.depth) > LEAST_CONTACT * seat.thickness
    if felt and edge > MOST_EDGE * seat.thickness:
        yield Sentence(
            "edges of {edge:.1f} mm are too long for {thickness:.1f} mm of thickness to be "
            "felt; bake with a shorter edge length",
            edge=1000 * edge,
            thickness=1000 * seat.thickness,
        )
    if seat.overhang > MOST_OVERHANG:
        yield Sentence(
            "{share:.0f} % of the foot has no surface under it; choose a place farther from "
            "the edge",
            share=100 * seat.overhang,
        )
    if balance.reading <= 0.0:
        yield (
            Sentence("softer than this durometer tells; try the scale 00")
            if kind.name == "A"
            else Sentence("softer than this durometer tells; read a force curve instead")
        )
    if seat.place.pinned(body):
        yield Sentence("the place is pinned, or next to what is; it is as firm as its support")


def _edge_length(body: SoftBody, seat: Seat) -> float:
    """Root mean square of the edges under the indenter, metres."""
    corners = body.mesh.nodes[body.mesh.surface_triangles[seat.place.triangle]]
    edges = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    return float(np.sqrt((edges**2).mean()))
