"""Entries of a table by power series: second and third order of freedoms, and how far they hold.

What a series of order three leaves out begins with a_4 s^4, the leading order of K^-1 r, r being
its residual; one more solve gives it, for both signs. (The later orders of K^-1 r say little: where
a part of the body turns, its tangent is K turned with it, and K^-1 r grows though the error does
not.) With q the largest ratio of one order to the next, all orders that are left out add up to
about |a_4| s^4 / (1 - q s). Against Newton's method at every freedom of the paper's cube and at
hundreds of a plush mouse and hare, the true error was 0.7 to 1.8 times that; what is claimed is
three times it. Ratios are taken of the whole and of the farthest moved node, where a cell that is
about to collapse shows first.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .power_series import ORDER, SeriesSolid, value
from .preconditioned_newton import SETTLED, polished

# The force up to which an entry should hold: there the third order is this share of the first.
WANTED_SHARE = 0.01
# The largest relative error that may be claimed at that force, in the displacement of the surface.
TOLERANCE = 0.01
# How many times the estimated error is claimed.
SAFETY = 3.0
# Of q s. Beyond, the solid may be near the load under which a cell collapses: it was seen to give
# way where q s was 0.45 and more, and never below.
LARGEST_RATIO = 0.4
# Of the smallest det F, at the largest force, for the same reason.
SMALLEST_VOLUME_RATIO = 0.1
# Of a polished entry: its last step was smaller, and what is left is a small part of that.
POLISHED_ERROR = SETTLED


@dataclass(frozen=True, eq=False)
class SeriesEntries:
    """What a table keeps of freedoms (k,) of the free surface, for a body of 1 Pa.

    Under the force F on freedom j alone, the free surface nodes (n,) move by ``L_j F + second_j F^2
    + third_j F^3``, up to ``|F| = largest_force``.

    Attributes
    ----------
    second, third : (3n, k).
    first_norm : (k,), the Euclidean norm of L_j.
    largest_force : (k,), F0 of both signs, newton.
    bound : (k,), claimed of the relative error at +F0 and -F0, Euclidean, of all free surface
        nodes' displacements.
    is_polished : bool (k,), whether second and third order were fitted to Newton's answers at both
        ends.
    is_short : bool (k,), whether F0 is smaller than wanted, and was not polished.
    """

    second: NDArray[np.float64]
    third: NDArray[np.float64]
    first_norm: NDArray[np.float64]
    largest_force: NDArray[np.float64]
    bound: NDArray[np.float64]
    is_polished: NDArray[np.bool_]
    is_short: NDArray[np.bool_]


def series_entries(
    body: SeriesSolid, freedoms: NDArray[np.int64], may_polish: bool = True
) -> SeriesEntries:
    """Entries for freedoms (k,), ``3 * place in the free surface + axis``.

    Where the claim at the wanted force would be above :data:`TOLERANCE`, Newton's method polishes
    both ends, which takes some hundred times longer; where it may not, or where the solid has no
    equilibrium there, F0 is smaller.
    """
    loads = body.unit_loads(freedoms)
    terms = body.terms(loads, ORDER + 1)
    surface = [term[body.body.surface] for term in terms]
    estimate = SeriesReach.of(surface)
    wanted = trusted_share(surface, WANTED_SHARE)
    needs_polish = (estimate.bound(wanted) > TOLERANCE) | ~_holds(body, terms, wanted)
    second, third = surface[1].copy(), surface[2].copy()
    largest, bound = wanted.copy(), estimate.bound(wanted)
    is_polished = np.zeros(len(freedoms), dtype=bool)
    at = np.flatnonzero(needs_polish)
    if at.size and may_polish:
        chosen = [term[:, :, at] for term in terms]
        settled, ends = _polished_ends(body, loads[:, :, at], chosen, wanted[at])
        done = at[settled]
        plus, minus = (end[:, :, settled] for end in ends)
        second[:, :, done] = (plus + minus) / (2 * wanted[done] ** 2)
        odd = (plus - minus) / 2 - surface[0][:, :, done] * wanted[done]
        third[:, :, done] = odd / wanted[done] ** 3
        bound[done] = POLISHED_ERROR
        is_polished[done] = True
    is_short = needs_polish & ~is_polished
    if is_short.any():
        shorter = [term[:, :, is_short] for term in terms]
        largest[is_short] = _shortened(body, shorter, estimate.within(TOLERANCE)[is_short])
        bound[is_short] = estimate.bound(largest)[is_short]
    count = len(freedoms)
    return SeriesEntries(
        second.reshape(-1, count),
        third.reshape(-1, count),
        _norms(surface[0]),
        largest,
        bound,
        is_polished,
        is_short,
    )


def trusted_share(terms: list[NDArray[np.float64]], third_share: float) -> NDArray[np.float64]:
    """The shares s (k,) of loads at which a_3 s^3 is ``third_share`` of a_1 s; terms (n, 3, k).

    By the Euclidean norm of the whole and by the largest displacement of a node, so that neither a
    bend of the whole nor a dent in one place goes further. Infinite where there is no third order.
    """
    ratio = np.maximum(
        _norms(terms[2]) / _positive(_norms(terms[0])),
        _farthest(terms[2]) / _positive(_farthest(terms[0])),
    )
    with np.errstate(divide="ignore"):
        share: NDArray[np.float64] = np.sqrt(third_share / ratio)
    return share


@dataclass(frozen=True, eq=False)
class SeriesReach:
    """How far series of order three hold.

    Attributes
    ----------
    fourth : (k,), |a_4| / |a_1|.
    ratio : (k,), q, the largest ratio of an order to the one before.
    """

    fourth: NDArray[np.float64]
    ratio: NDArray[np.float64]

    @classmethod
    def of(cls, terms: list[NDArray[np.float64]]) -> SeriesReach:
        """Of a_1 ... a_4, (n, 3, k) each, on the free surface."""
        first, second, third, fourth = (_norms(term) for term in terms)
        far = [_farthest(term) for term in terms]
        ratios = [
            third / _positive(second),
            fourth / _positive(third),
            far[2] / _positive(far[1]),
            far[3] / _positive(far[2]),
        ]
        return cls(fourth / _positive(first), np.max(ratios, axis=0))

    def bound(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """The claimed relative error at shares s (k,); infinite where q s is too large."""
        grown = self.ratio * share
        error = SAFETY * self.fourth * share**3 / np.maximum(1.0 - grown, 1.0 - LARGEST_RATIO)
        return np.where(grown < LARGEST_RATIO, error, np.inf)

    def within(self, tolerance: float) -> NDArray[np.float64]:
        """Shares (k,) up to which the claimed error stays below a tolerance."""
        most = 0.999 * LARGEST_RATIO / _positive(self.ratio)
        share = most.copy()
        for _ in range(200):
            above = self.bound(share) > tolerance
            if not above.any():
                break
            share[above] *= 0.9
        return share


def _holds(
    body: SeriesSolid, terms: list[NDArray[np.float64]], share: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Whether no domain is nearly flat at either end, (k,)."""
    smallest = np.minimum(
        *(body.smallest_volume_ratio(value(terms[:ORDER], sign * share)) for sign in (1.0, -1.0))
    )
    held: NDArray[np.bool_] = smallest > SMALLEST_VOLUME_RATIO
    return held


def _shortened(
    body: SeriesSolid, terms: list[NDArray[np.float64]], share: NDArray[np.float64]
) -> NDArray[np.float64]:
    share = share.copy()
    while len(share) and not (held := _holds(body, terms, share)).all():
        share[~held] *= 0.8
    return share


def _polished_ends(
    body: SeriesSolid,
    loads: NDArray[np.float64],
    terms: list[NDArray[np.float64]],
    share: NDArray[np.float64],
) -> tuple[NDArray[np.bool_], list[NDArray[np.float64]]]:
    settled, ends = np.ones(len(share), dtype=bool), []
    for sign in (1.0, -1.0):
        start = value(terms, sign * share)
        inverted = body.smallest_volume_ratio(start) <= 0
        start[:, :, inverted] = (terms[0] * sign * share)[:, :, inverted]
        end = polished(body, loads * (sign * share), start)
        settled &= end.is_settled
        ends.append(end.displacements[body.body.surface])
    return settled, ends


def _norms(field: NDArray[np.float64]) -> NDArray[np.float64]:
    norms: NDArray[np.float64] = np.sqrt(np.einsum("nik,nik->k", field, field))
    return norms


def _farthest(field: NDArray[np.float64]) -> NDArray[np.float64]:
    farthest: NDArray[np.float64] = np.sqrt(np.einsum("nik,nik->nk", field, field).max(axis=0))
    return farthest


def _positive(norms: NDArray[np.float64]) -> NDArray[np.float64]:
    """Norms to divide by: where they vanish, so does what is divided."""
    return np.maximum(norms, np.finfo(np.float64).tiny)
