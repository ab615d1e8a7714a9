"""Springs between nodes and their places at rest, beside the strains of a solid."""

from __future__ import annotations

from dataclasses import dataclass

from scipy.sparse import csr_array


@dataclass(frozen=True, eq=False)
class Springs:
    """The energy u.S u / 2, alike along the three axes.

    Attributes
    ----------
    matrix : csr (f, f), S at unit modulus, symmetric; a turn of all nodes that belong together may
        cost nothing.
    """

    matrix: csr_array
