"""From the linear displacement towards equilibrium, and to it, by the native code.

Warping (`native/src/solid/warp.rs`) keeps a bend's size, but knows nothing of equilibrium: the
lever of a force shortens as a body bends, and what is crushed or drawn out hardens or softens. So
the total energy is minimised, as a function of the *linear* displacement that is warped
(`native/src/solid/relaxation.rs`). Here the arrays are made that this takes: gradients in domains,
and the factors of the stiffness and of the warp's Poisson equation.

References
----------
T. Liu, S. Bouaziz, L. Kavan: Quasi-Newton Methods for Real-Time Simulation of Hyperelastic
Materials, ACM Transactions on Graphics 36, 2017; there in displacements.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import palpate_servo
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array

from ...compliance.elimination.cholesky import CholeskyFactor, RepeatedElimination
from ...compliance.free_body.inertia import RigidMotions
from ...errors import PalpateError
from ...law.foam import Cells, Foam
from ...law.law import Law
from ...law.neo_hookean import NeoHookean
from ...law.ogden import Ogden
from ...law.principal import Power
from ..solid.free_solid import FreeSolid, linear_under
from ..solid.strain_term import StrainTerm

Array = NDArray[np.float64]
# Shares and exponents of stretches, and of volumes; whether what is pulled goes on as a parabola.
Powers: TypeAlias = tuple[list[tuple[float, float]], list[tuple[float, float]], bool]


@dataclass(frozen=True, eq=False)
class Rest:
    """Where a search for equilibrium ended.

    Attributes
    ----------
    linear : (f, 3), the linear displacements that are warped to it.
    displacements : (f, 3) of the free nodes, metres.
    forces : (k,), of how much of each pattern they are.
    left : what the unbalanced forces would still move, or what is missed of the ways, as a share
        of what the load does, by energy.
    steps : that it took.
    """

    linear: Array
    displacements: Array
    forces: Array
    left: float
    steps: int


@dataclass(frozen=True, eq=False)
class Patterns:
    """What the forces are made of that lead a body.

    Attributes
    ----------
    forces : (k, f, 3), on the free nodes.
    moved : (k, f, 3), the linear displacements under them.
    """

    forces: Array
    moved: Array

    @cached_property
    def compliance(self) -> Array:
        """Work (k, k) of each on the linear displacement under another."""
        found: Array = np.einsum("pfi,qfi->pq", self.forces, self.moved)
        return found

    @cached_property
    def response(self) -> Array:
        """Of how much of each (k, k) a way takes, linearly."""
        found = np.linalg.pinv(self.compliance, rcond=1e-9, hermitian=True)
        return np.asarray(found, dtype=np.float64)


@dataclass(frozen=True, eq=False)
class Relaxation:
    """A body at unit modulus, to be relaxed under forces on its free nodes.

    Attributes
    ----------
    native : it, prepared.
    factor : of the stiffness at rest.
    motions : rigid ones of a body that nothing holds; None of others.
    """

    native: palpate_servo.Relaxation
    factor: CholeskyFactor
    motions: RigidMotions | None = None

    @classmethod
    def of(
        cls,
        terms: Sequence[StrainTerm],
        law: Law,
        factor: CholeskyFactor,
        positions: Array,
        springs: csr_array | None = None,
        motions: RigidMotions | None = None,
    ) -> Relaxation:
        """Relaxation of the terms of a solid on its free nodes, the first of which has shear.

        Parameters
        ----------
        factor : of the stiffness of the terms and the springs; without pins with a hold.
        positions : (f, 3), at rest.
        springs : S (f, f) at unit modulus, symmetric, of an energy u.S u / 2 alike along all axes;
            a turn of all nodes that belong together may cost nothing.
        motions : of a body without pins.

        Raises
        ------
        PalpateError
            A law that the native code does not have.
        """
        native = palpate_servo.Relaxation(
            [_entries(term) for term in terms],
            factor.flat(np.float32),
            _poisson(terms[0], springs, positions, motions).flat(np.float64, every=3),
            law=_powers(law),
            springs=None if springs is None else _rows(springs),
            motions=None if motions is None else (*fields_of(motions), [0.0] * 6),
        )
        return cls(native, factor, motions)

    def another(self) -> Relaxation:
        """The same, for another thread: what both read is shared."""
        return Relaxation(self.native.another(), self.factor, self.motions)

    def relaxed(self, forces: Array, steps: int) -> Array:
        """Displacements (f, 3) of the free nodes under ``forces`` (f, 3), after so many steps.

        A continuous function of the forces. Without steps it is the warped linear displacement.
        """
        # Single precision is enough to begin steps from, and a third of the time.
        linear = None if steps else self.linear(forces)
        return self.native.relaxed(linear, forces, steps)

    def relaxed_from(
        self, linear: Array, forces: Array, steps: int, turning: Array | None = None
    ) -> Array:
        """The same under a load whose linear displacement (f, 3) is known.

        ``turning`` (f, 3): forces on the linear displacements, beside ``forces`` that keep their
        directions; their work does not change where the body turns.
        """
        return self.native.relaxed(linear, forces, steps, turning)

    def led(
        self,
        patterns: Patterns,
        ways: Array,
        close: float,
        most_steps: int,
        after: Rest | None = None,
    ) -> Rest:
        """The body at rest where forces of ``patterns`` have done the work ``ways`` (k,) on it.

        Found to a share ``close``, or as near to it as ``most_steps`` lead. A force that stays may
        have no rest where the body gives way; one that is led has. ``after``: the last rest under
        the same patterns, from which it goes on in proportion.
        """
        if after is None:
            start: Array = np.einsum("p,pfi->fi", patterns.response @ ways, patterns.moved)
        else:
            before = np.einsum("pfi,fi->p", patterns.forces, after.displacements)
            start = after.linear * (float(ways @ ways) / float(ways @ before))
        linear, moved, forces, left, steps = self.native.led(
            start,
            list(patterns.forces),
            list(patterns.moved),
            ways,
            patterns.response,
            close,
            most_steps,
            after is not None,
        )
        return Rest(linear, moved, np.array(forces), left, steps)

    def linear(self, forces: Array) -> Array:
        """Linear displacements (f, 3), K^-1 F."""
        return linear_under(self.factor, self.motions, forces)


def relaxation(solid: FreeSolid) -> Relaxation:
    """Relaxation of a body on its own nodes."""
    inner = solid.solid
    return Relaxation.of(
        inner.terms, inner.law, solid.factor, solid.positions, motions=solid.motions
    )


def _entries(term: StrainTerm) -> tuple[NDArray[np.int64], NDArray[np.int64], Array, Array, Array]:
    """Where each domain's entries begin, their nodes and gradients, and moduli times volumes."""
    blocks = term.gradients.tobsr((3, 1))
    starts, nodes = (part.astype(np.int64) for part in (blocks.indptr, blocks.indices))
    return starts, nodes, blocks.data[:, :, 0], *term.weighted_moduli


def _rows(matrix: csr_array) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    return matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), matrix.data


def fields_of(motions: RigidMotions) -> tuple[list[Array], list[Array]]:
    """Motions and loads, each (f, 3)."""
    both = motions.modes, motions.loads
    modes, loads = ([np.ascontiguousarray(one).reshape(-1, 3) for one in of.T] for of in both)
    return modes, loads


def _poisson(
    term: StrainTerm, springs: csr_array | None, positions: Array, motions: RigidMotions | None
) -> CholeskyFactor:
    """Factor of the warp's equation, for three axes: each number of it three times.

    A domain counts by its volume and stiffness: what does not fit together strains what is soft.
    """
    weights = np.repeat(term.weighted_moduli[1], 3)
    matrix = csr_array(term.gradients.T @ diags_array(weights) @ term.gradients)
    if springs is not None:
        matrix = csr_array(matrix + springs)
    if motions is not None:
        # What gradients ask for balances, so that one held node takes no force.
        matrix[0, 0] += float(np.median(matrix.diagonal()))
    rows = np.repeat(np.arange(len(positions)), np.diff(matrix.indptr))
    elimination = RepeatedElimination.of(rows, matrix.indices.astype(np.int64), positions)
    return elimination.factor(matrix.data[:, None, None] * np.eye(3))


def _powers(law: Law) -> Powers | None:
    """What stretches and volumes cost by the law, as the native code takes it; None for rubber."""
    match law:
        case NeoHookean():
            return None
        case Ogden(terms):
            return _pairs(terms), [], False
        case Cells(terms):
            return _pairs(terms), _pairs(terms), True
        case Foam(_, terms):
            # Without Poisson's ratio there is no energy of volume, and any will do.
            exponents = law.volume_exponents
            volume = [
                (term.share, exponent) for term, exponent in zip(terms, exponents, strict=False)
            ]
            return _pairs(terms), volume, False
    raise PalpateError("relaxation: there is none by the law {law}; use Newton's method", law=law)


def _pairs(terms: Sequence[Power]) -> list[tuple[float, float]]:
    return [(term.share, term.exponent) for term in terms]
