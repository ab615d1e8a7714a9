"""The entries of the tables of (16): each freedom of the surface loaded alone by +F0 and by -F0.

They are found by the power series of the freedom, summed as a quotient, and checked by Newton's
method: forces that are not balanced are put into a step of it, and where the step is too large to
be a rounding, Newton's method goes on from there. Where the solid does not carry F0 - St.
Venant-Kirchhoff bodies collapse under strong compression, and a corner that only one tetrahedron
holds folds over - F0 is halved for that freedom and sign until it does. Where only the series does
not reach so far, as in large turns, further series begin at its end and double the load.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...compliance.elimination.cholesky import NotPositiveDefiniteError
from ...mesh.tet_mesh import TetMesh
from ...progress import unwatched
from ..solid.free_solid import FreeSolid
from ..solid.inversion import is_upright
from ..solid.newton import equilibrium_near
from .power_series import SeriesStart
from .rational_sum import RationalSum

SIGNS = (1.0, -1.0)

# Of the series; more reach little farther, and cost with their square.
ORDER = 12
# What the last order may change of a sum at most before Newton's method is handed it, relative.
TRUSTED_CHANGE = 0.03
# Where the first pole of a sum lies ahead at least, in multiples of the load, for another series to
# begin there and double it.
LEAST_REACH = 2.1
# The largest first step of Newton's method, by the stiffness at rest, after which an entry stays
# as the series has it; relative.
SETTLED = 1e-4
# Forces that Newton's method leaves unbalanced, as a share of F0.
RESIDUAL_SHARE = 1e-6

# After so many halvings a freedom is left linear: F0 is a millionth of what was wanted.
MOST_HALVINGS = 20

# F0 when no other is asked for: the paper's 2 N on its cube of 50 mm and 10 kPa, as a share of
# Young's modulus times the square of the body's smallest extent.
PAPER_SHARE = 2.0 / (10_000.0 * 0.05**2)


@dataclass(frozen=True, eq=False)
class PaperEntries:
    """One freedom's entries for both signs, at unit modulus.

    Attributes
    ----------
    per_force : float32 (2, 3n), displacements of the free surface nodes under +F0 and -F0, divided
        by +F0 and -F0.
    largest : float64 (2,), those F0; newton per pascal of Young's modulus.
    by_series : bool (2,), whether they are the series' own, with no step of Newton's added.
    """

    per_force: NDArray[np.float32]
    largest: NDArray[np.float64]
    by_series: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class _End:
    """An equilibrium: the load, displacements (f, 3), and whether the series is all it took."""

    load: float
    moved: NDArray[np.float64]
    by_series: bool


@dataclass(frozen=True, eq=False)
class EntryFinder:
    """Finds entries of a body; what serves all of them is made once."""

    body: FreeSolid

    @cached_property
    def at_rest(self) -> SeriesStart:
        """Start of the series."""
        return SeriesStart.at_rest(self.body)

    def entries(
        self, freedom: int, wanted: float, may_go_on: Callable[[], None] = unwatched
    ) -> PaperEntries:
        """Entries of surface freedom ``3 * (place in free_surface) + axis``, for F0 = ``wanted``.

        ``wanted`` is in newton per pascal of Young's modulus. ``may_go_on`` is called now and then;
        it may raise to cancel.

        Raises
        ------
        PalpateError
            The pins do not hold the body.
        """
        node, axis = divmod(freedom, 3)
        unit = np.zeros((self.body.node_count, 3))
        unit[self.body.surface[node], axis] = 1.0
        may_go_on()
        series = RationalSum.of(self.at_rest.series(unit, ORDER))
        ends = [self._end(series, sign * wanted, unit, may_go_on) for sign in SIGNS]
        rows = [end.moved[self.body.surface].ravel() / end.load for end in ends]
        return PaperEntries(
            np.array(rows, dtype=np.float32),
            np.array([abs(end.load) for end in ends]),
            np.array([end.by_series for end in ends]),
        )

    def _end(
        self,
        series: RationalSum,
        wanted: float,
        unit: NDArray[np.float64],
        may_go_on: Callable[[], None],
    ) -> _End:
        rest = _End(0.0, np.zeros_like(unit), by_series=True)
        for halvings in range(MOST_HALVINGS + 1):
            load = wanted * 0.5**halvings
            found = self._added(series, rest, load, unit, may_go_on)
            if found is None:
                continue
            while abs(found.load) < abs(wanted) and series.gives_way(load) > LEAST_REACH:
                further = self._doubled(found, unit, may_go_on)
                if further is None:
                    break
                found, series, load = further
            return found
        return _End(wanted, wanted * self.body.linear(unit), by_series=True)

    def _doubled(
        self, reached: _End, unit: NDArray[np.float64], may_go_on: Callable[[], None]
    ) -> tuple[_End, RationalSum, float] | None:
        """Twice the load by a series that begins there, that series, and what it added."""
        try:
            start = self.at_rest.moved(self.body, reached.moved)
        except NotPositiveDefiniteError:
            return None
        series = RationalSum.of(start.series(unit, ORDER))
        found = self._added(series, reached, reached.load, unit, may_go_on)
        return None if found is None else (found, series, reached.load)

    def _added(
        self,
        series: RationalSum,
        start: _End,
        added: float,
        unit: NDArray[np.float64],
        may_go_on: Callable[[], None],
    ) -> _End | None:
        """The equilibrium under so much more load, checked; None where there is none."""
        flat, changed = series.at(added)
        moved, load = start.moved + flat.reshape(unit.shape), start.load + added
        if not changed < TRUSTED_CHANGE or not is_upright(self.body.solid, moved):
            return None
        step = self.body.linear(load * unit - self.body.forces(moved))
        if np.linalg.norm(step) <= SETTLED * np.linalg.norm(moved):
            return _End(load, moved, start.by_series)
        found = equilibrium_near(self.body, load * unit, moved, RESIDUAL_SHARE, may_go_on)
        return None if found is None else _End(load, found.displacements, by_series=False)


def usual_largest_force(mesh: TetMesh) -> float:
    """F0 at unit modulus, square metres, for a body of any size: the paper's cube's, scaled."""
    extent = float(np.ptp(mesh.nodes, axis=0).min())
    return PAPER_SHARE * extent**2
