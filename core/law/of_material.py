"""Laws of materials by name, with their constants and where these come from.

A law has Young's modulus and Poisson's ratio of its body at small strain, whatever they are, so
that it is no part of what is baked: it may be exchanged like the modulus.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import PalpateError
from .foam import Cells, Foam
from .law import Law
from .neo_hookean import NeoHookean
from .ogden import Ogden
from .principal import Power


@dataclass(frozen=True)
class NamedLaw:
    """One of :data:`LAWS`.

    Attributes
    ----------
    law : it, for a Poisson's ratio of 0 or more.
    source : of its constants.
    """

    law: Law
    source: str


def _powers(*constants: tuple[float, float]) -> tuple[Power, ...]:
    """Of shear moduli, in any unit, and exponents."""
    whole = sum(modulus for modulus, _ in constants)
    return tuple(Power(modulus / whole, exponent) for modulus, exponent in constants)


RUBBER = "rubber"
LAWS = {
    RUBBER: NamedLaw(NeoHookean(), "neo-Hookean, without constants of its own"),
    "natural-rubber": NamedLaw(
        # There mu' = 6.3, 0.012, -0.1 kg/cm2 with exponents a of 1.3, 5 and -2; mu = a mu' / 2.
        Ogden(_powers((0.5 * 1.3 * 6.3, 1.3), (0.5 * 5.0 * 0.012, 5.0), (0.5 * 2.0 * 0.1, -2.0))),
        "Ogden 1972, Proceedings of the Royal Society A 326, 565: three terms for Treloar's "
        "natural rubber",
    ),
    "foam": NamedLaw(
        Cells(_powers((5280.146, 22.08547), (1042.675, 26.69817))),
        "Silber and Then 2013, Preventive Biomechanics, Springer, table 4.3: slow foam of a "
        "mattress, what lasts: 5.280 and 1.043 kPa, Poisson's ratios of 0.000 and 0.003",
    ),
    "fibres": NamedLaw(
        Cells(_powers((1.0, -2.0))),
        "van Wyk 1946, Journal of the Textile Institute 37, T285: the stress of a mass of fibres "
        "grows with the cube of its density",
    ),
}


def law_of(poisson_ratio: float, name: str = RUBBER) -> Law:
    """The law of this name, for a body of this Poisson's ratio.

    Where that is below 0 (auxetic foam) it is Blatz' and Ko's foam, which alone is stable there.
    """
    return LAWS[name].law if poisson_ratio >= 0.0 else Foam(poisson_ratio)


def law_checked(name: str) -> str:
    """A name of :data:`LAWS`.

    Raises
    ------
    PalpateError
        It is none.
    """
    if name not in LAWS:
        raise PalpateError(
            "the law {name} is unknown; choose the material again, or give one of {others}",
            name=repr(name),
            others=", ".join(LAWS),
        )
    return name
