"""How a material relaxes: its modulus in time, at a constant Poisson's ratio.

::

    E(t) = E (1 + sum of s_i e^(-t / t_i))

with E the modulus in the end, which presets and panels give, and a *share* s_i of it that is there
besides at first and fades within the time t_i: a Prony series. What is pressed in a moment meets
1 + sum of s_i times the modulus that a lasting press meets.

What is known of a series is little: times are told more often than shares, and of one batch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class RelaxationTerm:
    """A term of a series.

    Attributes
    ----------
    share : of the modulus in the end; zero or more.
    seconds : the time in which it falls to 1/e.
    """

    share: float
    seconds: float


@dataclass(frozen=True)
class Relaxation:
    """A material's series.

    Attributes
    ----------
    name : in panels and tables.
    terms : at most three, with different times; none for a material that answers for good at once.
    source : of times and shares.
    """

    name: str
    terms: tuple[RelaxationTerm, ...]
    source: str

    @property
    def pairs(self) -> tuple[tuple[float, float], ...]:
        """The terms as the servo takes them: shares, and times in seconds."""
        return tuple((term.share, term.seconds) for term in self.terms)

    def modulus(self, seconds: float) -> float:
        """E(t) over the modulus in the end, this long after a sudden strain."""
        return 1.0 + sum(term.share * math.exp(-seconds / term.seconds) for term in self.terms)

    def loss_tangent(self, hertz: float) -> float:
        """Energy lost over energy stored in a swing at this frequency: tan of the phase angle."""
        stored, lost = 1.0, 0.0
        for term in self.terms:
            x = 2.0 * math.pi * hertz * term.seconds
            stored += term.share * x * x / (1.0 + x * x)
            lost += term.share * x / (1.0 + x * x)
        return lost / stored


def _series(*terms: tuple[float, float]) -> tuple[RelaxationTerm, ...]:
    return tuple(RelaxationTerm(share, seconds) for share, seconds in terms)


# Files hold the order: add new ones at the end only.
RELAXATIONS = {
    "NONE": Relaxation("At Once", (), "elastic"),
    "MEMORY_FOAM": Relaxation(
        "Memory Foam",
        _series((2.0, 0.1), (1.5, 0.7), (1.0, 4.0)),
        "estimate: gives way and comes back within seconds, as foam of slow recovery is sold",
    ),
    "FLESH": Relaxation(
        "Flesh",
        _series((0.6, 0.004), (0.4, 0.07), (0.4, 1.4)),
        "times measured on fingertips: Pawluk and Howe 1999, Journal of Biomechanical Engineering "
        "121, 178; shares estimated",
    ),
    "GEL": Relaxation(
        "Gel",
        _series((0.1, 0.2), (0.1, 2.0), (0.15, 20.0)),
        "estimate: gels that hold their shape relax by a part, over tens of seconds",
    ),
    "CHEWING_GUM": Relaxation(
        "Chewing Gum",
        _series((24.0, 0.05), (10.0, 0.5), (4.0, 5.0)),
        "a power of time with an exponent of about 0.4, as a critical gel: Martinetti et al. 2014, "
        "Journal of Rheology 58, 821; exponent and end estimated",
    ),
}
