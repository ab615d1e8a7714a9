r"""How much of the corrected force fingers get that hold each other through the body.

A finger's own part of the displacement, v_p of :mod:`.felt_fingers`, counts all its place gives
way alone, bending of the body included. Where another finger holds against that, as in a pinch of a
slender part, v_p is many times what the place moves, and a correction by it is far too large. So
the correction goes as the coupling grows. What counts is the direction in which the place softens:
with ``M = b b^T + 0.05 w K_p / k`` (along b a displacement counts, all others a little) ::

    m_p = sum_q sqrt(tr(M C_pq C_qq^-1 C_qp) / tr(M C_pp))        q the others that touch

is how far the others can move p's place that way, beside p itself by forces of as much energy: at
most 1 for each, nearly that in a pinch. With it the place has ::

    b' = s b        w' = max(s w, k b'.C_pp b' r)

    s = 1 up to m = WEAK, 0 from STRONG on, a smooth step between
    1 + 1/r = m^(-1/3)

b' and w' are a softening and a saturation as any, and depend on the places alone: while these are
held, the forces are the gradient of an energy. The second saturation is for places that stiffen:
along b' no tangent exceeds (1 + 1/r)^(3/2) = m^(-1/2) times that at rest, which leaves the place
m^(1/2) of its compliance beside the m of what couples it. (In other directions tangents exceed that
at rest by less, m^(-1/6); the energy in forces is not proven to be convex there.) Alone, m = 0:
nothing changes. From STRONG on the forces are the linear ones.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .felt_force import Relation

# Couplings (m) between which the share of the correction goes from all to nothing.
WEAK, STRONG = 0.35, 0.65
# Weight of all directions beside that of b, in parts of w.
SIDEWAYS = 0.05


def couplings(
    compliance: NDArray[np.float64], relations: Sequence[Relation]
) -> NDArray[np.float64]:
    """How strongly each finger is coupled to all others, (m,).

    ``compliance`` (m, m, 3, 3) is C_pq, :func:`.told_apart`; ``relations`` are those of the places
    alone. A place with a linear one has coupling 0, for there is nothing to hold.
    """
    count = len(relations)
    total = np.zeros(count)
    stiffness = [np.linalg.inv(compliance[p, p]) for p in range(count)]
    for p, own in enumerate(relations):
        weight = np.outer(own.softening, own.softening)
        weight += SIDEWAYS * own.saturation / own.mean_stiffness * own.stiffness
        alone = float(np.trace(weight @ compliance[p, p]))
        if alone <= 0.0:
            continue
        for q in range(count):
            if q != p:
                back = compliance[p, q] @ stiffness[q] @ compliance[q, p]
                total[p] += np.sqrt(max(float(np.trace(weight @ back)), 0.0) / alone)
    return total


def share_of(coupling: float) -> float:
    """Share (0 to 1) of the correction at a coupling."""
    x = min(max((STRONG - coupling) / (STRONG - WEAK), 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def firmness_of(coupling: float) -> float:
    """Least saturation r at a coupling, in parts of k b.C b."""
    root = float(np.cbrt(min(coupling, STRONG)))
    return root / (1.0 - root)


def coupled(relation: Relation, coupling: float) -> Relation:
    """The relation of a place whose finger is coupled so to others."""
    share = share_of(coupling)
    softening = share * relation.softening
    yielding = float(softening @ np.linalg.solve(relation.stiffness, softening))
    least = relation.mean_stiffness * yielding * firmness_of(coupling)
    return Relation(relation.stiffness, softening, max(share * relation.saturation, least))
