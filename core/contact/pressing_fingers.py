"""Several moving fingers: when each touches, and what it presses, tick by tick.

A single finger touches where it is inside the rest surface. With several that would be wrong: one
finger pushes the surface away from another that is inside the rest surface, or against one that is
still outside, and forces would jump whenever a finger came or went. So every finger's god object is
shown the finger moved back to where it would be had the others not moved the surface::

    v_q = sum_{p != q} C_qp F_p / E    what the others do at finger q, by the last tick's forces
    s_q = v_q                          while q does not touch
    s_q += n_q n_q.(v_q - s_q)         while it does: only along its push
    y_q = x_q - s_q                    the finger moved back; its god object goes to g_q
    u_q = x_q - g_q                    what the body is asked for at g_q
    y_q - g_q                          the push, along n_q
    s_q += w - n_q n_q.w               with w = sum_p C_qp F_p / E - u_q, once the forces are known

At the moment of touching y_q = g_q, so that u_q = v_q: what the surface does already, and no force.
Across its push a finger holds the surface as it met it (followed there too, v would feed on itself)
until its force leans on its cone: then it slips by w, by which the surface slips away under it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..body.soft_body import SoftBody
from .equations import Touch
from .several_contacts import solve_distinct, told_apart


class GodObject(Protocol):
    """A point that follows a finger and stays on or outside the rest surface."""

    def move(
        self, finger: NDArray[np.float64], /
    ) -> tuple[bool, NDArray[np.float64], int, NDArray[np.float64]]:
        """Whether it touches, where it is now, and that place as triangle and area coordinates."""
        ...


@dataclass(frozen=True, eq=False)
class Finger:
    """One finger after a tick.

    Attributes
    ----------
    by_others : float64 (3,), metres: v, how far the forces of all others move the surface there.
    moved_back : float64 (3,), metres: s.
    direction : float64 (3,), unit vector of its push; zero while it does not touch.
    triangle : number of the surface triangle that it touches or is nearest to.
    alpha : float64 (3,), area coordinates there.
    touch : None while it does not touch.
    """

    by_others: NDArray[np.float64]
    moved_back: NDArray[np.float64]
    direction: NDArray[np.float64]
    triangle: int
    alpha: NDArray[np.float64]
    touch: Touch | None

    @property
    def force(self) -> NDArray[np.float64]:
        """On the body, (3,), newton; zero while it does not touch."""
        return np.zeros(3) if self.touch is None else -self.touch.force


def fingers_at(body: SoftBody, probes: ArrayLike) -> tuple[Finger, ...]:
    """Fingers that have just come to ``probes`` (m, 3) and touch nothing yet."""
    return tuple(_free(body, probe, np.zeros(3)) for probe in np.asarray(probes, dtype=np.float64))


def press_fingers(
    body: SoftBody,
    god_objects: Sequence[GodObject],
    before: Sequence[Finger],
    probes: ArrayLike,
    young_modulus: float | None = None,
) -> tuple[Finger, ...]:
    """One tick: the fingers ``before`` have moved to ``probes`` (m, 3), metres."""
    modulus = body.modulus(young_modulus)
    fingers = [
        _followed(body, *each)
        for each in zip(god_objects, before, np.asarray(probes, dtype=np.float64), strict=True)
    ]
    compliance = told_apart(
        body.contact_compliance([one.triangle for one in fingers], [one.alpha for one in fingers])
    )
    forces = _forces(compliance, fingers, before, modulus)
    moved = np.einsum("pqij,qj->pi", compliance, forces)
    by_itself = np.einsum("ppij,pj->pi", compliance, forces)
    return tuple(
        _pressed(finger, modulus * force, at, at - own)
        for finger, force, at, own in zip(fingers, forces, moved, by_itself, strict=True)
    )


def _followed(
    body: SoftBody, god_object: GodObject, before: Finger, probe: NDArray[np.float64]
) -> Finger:
    """The finger where it is now, its touch still without forces."""
    s, n = before.by_others, before.direction
    if before.touch is not None:
        s = before.moved_back + n * float(n @ (s - before.moved_back))
    touches, at, triangle, alpha = god_object.move(probe - s)
    if not touches:
        return _free(body, probe, s)
    push = probe - s - at
    depth = float(np.linalg.norm(push))
    corners = body.mesh.surface_triangles[triangle]
    touch = Touch(corners, alpha, at, probe - at, np.zeros((3, 3)))
    return Finger(np.zeros(3), s, push / depth if depth > 0 else n, triangle, alpha, touch)


def _free(body: SoftBody, probe: NDArray[np.float64], moved_back: NDArray[np.float64]) -> Finger:
    place = body.closest_points.query(probe - moved_back)
    return Finger(
        np.zeros(3), moved_back, np.zeros(3), int(place.triangle[0]), place.alpha[0], None
    )


def _forces(
    compliance: NDArray[np.float64],
    fingers: Sequence[Finger],
    before: Sequence[Finger],
    young_modulus: float,
) -> NDArray[np.float64]:
    """Forces (m, 3) at unit modulus; none for fingers that do not touch."""
    forces = np.zeros((len(fingers), 3))
    touching = [q for q, finger in enumerate(fingers) if finger.touch is not None]
    if touching:
        asked = np.array([one.touch.displacement for one in fingers if one.touch is not None])
        back = np.array([fingers[q].moved_back for q in touching])
        start = np.array([before[q].force for q in touching]) / young_modulus
        among = compliance[np.ix_(touching, touching)]
        forces[touching] = solve_distinct(among, asked, asked - back, start)
    return forces


def _pressed(
    finger: Finger,
    force: NDArray[np.float64],
    moved: NDArray[np.float64],
    by_others: NDArray[np.float64],
) -> Finger:
    """The finger with its force, and let slip by what the surface slips away under it."""
    if finger.touch is None:
        return replace(finger, by_others=by_others)
    touch = replace(finger.touch, nodal_forces=finger.alpha[:, None] * force)
    slip = moved - touch.displacement
    slip -= finger.direction * float(finger.direction @ slip)
    back = finger.moved_back + slip
    return replace(finger, by_others=by_others, moved_back=back, touch=touch)
