r"""The felt force at large depth: the choices, and the relation that ``corrected`` means.

``linear`` is the paper's: the force is K u for a contact point moved by u, however far. A solid by
its material's law becomes firmer where it is pressed in (rubber, mostly) or softer (where it bends
away, or foam). ``corrected`` is the gradient of the energy ::

    Phi(u) = P sqrt((P t)^2 + u.K u) - P^2 t      t = 1 + b.u      P^2 = k / w
           = u.K u / (S + t)                      S = sqrt(t^2 + w u.K u / k)

with the stiffness K of the contact point and its mean k = tr K / 3, the *softening* b (1/m) and the
*saturation* w (1/m^2), to which a small share of the linear relation is added::

    f = c K u + (1 - c) (K u - Phi b) / S          c = LEAST_SHARE

Phi is the length of a vector that depends on u in an affine way, less an affine function, and hence
convex, for all b, all w >= 0 and all u, however far from what b and w were taken from. So the force

* is K u for small u,
* is continuous, with a continuous derivative,
* never falls as u goes on: its derivative is symmetric and at least c K,
* gives back what work it took, on every closed path of u.

Its first terms are ``K u (1 - b.u) - b (u.K u) / 2``: b.u is how much softer the place becomes, w
how soon the force saturates. Both are taken from the solid's power series at the nodes
(:mod:`.softening`) and interpolated by the area coordinates, so that the force is continuous over
edges. Where both are zero the relation is the linear one.

Forces are proportional to Young's modulus; b and w do not depend on it.
"""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

from ...errors import PalpateError

FeltName: TypeAlias = Literal["linear", "corrected"]
FELT_CHOICES: tuple[FeltName, ...] = get_args(FeltName)
EXPLANATIONS: dict[FeltName, str] = {
    "linear": "The paper's: in proportion to the depth, however deep",
    "corrected": "As rubber is: mostly firmer where it is pressed in far",
}

# This share of the linear relation stays at any depth: the force never stops growing.
LEAST_SHARE = 0.05


def felt_name(choice: str) -> FeltName:
    """The name, checked.

    Raises
    ------
    PalpateError
        An unknown one.
    """
    for name in FELT_CHOICES:
        if name == choice:
            return name
    raise PalpateError(
        "felt force {choice} is unknown; give {known}",
        choice=repr(choice),
        known=" or ".join(FELT_CHOICES),
    )
