"""Law of an imprint: what a surface is moved beyond its yield depth stays, and fades.

Each place has a plastic displacement p, and yields like a spring in series with a friction slider:
its elastic part never reaches further than the yield depth Y along the displacement u that it is
pressed by. That is the return mapping of rate-independent perfect plasticity in one dimension
(Simo and Hughes, Computational Inelasticity, 1998, chapter 1), with the distance as its measure:

    p <- p + max(0, |u| - Y - p . n) n,    n = u / |u|,    where |u| > Y

So a press to the depth d leaves d - Y, the same press again leaves nothing more, and to let go
moves nothing back. Between presses p fades by exp(-t / T), as in a Maxwell element.

The law moves each place by itself, and what it moves is not put elsewhere: the volume is not kept
beyond what the elastic displacement keeps of it, as where clay is compacted.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Yielding:
    """How far a surface yields, and how long it remembers.

    Attributes
    ----------
    depth : metres; what is moved farther stays. 0 for an elastic surface, of which nothing stays.
    forget : seconds in which an imprint fades to 1 / e; 0 to remember for ever.

    Raises
    ------
    PalpateError
        One of them is negative or not finite.
    """

    depth: float = 0.0
    forget: float = 0.0

    def __post_init__(self) -> None:
        for name, value in (("yield depth", self.depth), ("forget time", self.forget)):
            if not (math.isfinite(value) and value >= 0.0):
                raise PalpateError(
                    "imprint: {name} is {value}; give zero or more", name=name, value=value
                )

    @property
    def elastic(self) -> bool:
        """Whether nothing stays."""
        return self.depth == 0.0

    def grown(self, plastic: Array, moved: Array) -> Array:
        """Plastic displacements (p, 3) once the surface was ``moved`` (p, 3), metres."""
        if self.elastic:
            return plastic
        sizes = np.sqrt(np.einsum("pi,pi->p", moved, moved))
        far = np.flatnonzero(sizes > self.depth)
        along = moved[far] / sizes[far, None]
        stayed = np.einsum("pi,pi->p", plastic[far], along)
        flow = np.maximum(sizes[far] - self.depth - stayed, 0.0)
        grown = plastic.copy()
        grown[far] += flow[:, None] * along
        return grown

    def faded(self, plastic: Array, seconds: float) -> Array:
        """Plastic displacements (p, 3) after some seconds."""
        if self.forget == 0.0 or seconds <= 0.0:
            return plastic
        return plastic * math.exp(-seconds / self.forget)


def beneath(plastic: Array, moved: Array) -> Array:
    """Displacements (p, 3) of a surface with an imprint that is ``moved`` (p, 3) too: as deep as it
    is pressed or as it was, whichever is deeper, and moved with it sideways.
    """
    sizes = np.sqrt(np.einsum("pi,pi->p", plastic, plastic))
    marked = np.flatnonzero(sizes > 0.0)
    along = plastic[marked] / sizes[marked, None]
    pressed = np.maximum(np.einsum("pi,pi->p", moved[marked], along), 0.0)
    seen = moved.copy()
    seen[marked] += np.maximum(sizes[marked] - pressed, 0.0)[:, None] * along
    return seen
