"""Imprint of a press that goes on: it grows, fades, and is added to that of earlier places."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .yielding import Yielding, beneath

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Imprint:
    """Plastic displacements (p, 3), metres: ``earlier`` of places that were pressed before and are
    part of the surface now, ``here`` of the present contact.
    """

    earlier: Array
    here: Array

    @classmethod
    def none(cls, count: int) -> Imprint:
        """None yet, on this many places."""
        return cls(np.zeros((count, 3)), np.zeros((count, 3)))

    @property
    def left(self) -> Array:
        """What stays (p, 3) once it is let go."""
        return self.earlier + self.here

    def with_more(self, count: int) -> Imprint:
        """The same, and so many places without one."""
        more = np.zeros((count, 3))
        return Imprint(np.vstack([self.earlier, more]), np.vstack([self.here, more]))

    def pressed(self, law: Yielding, moved: Array, seconds: float = 0.0) -> Imprint:
        """The imprint some seconds later, with the surface ``moved`` (p, 3) from where the contact
        found it.
        """
        here = law.grown(law.faded(self.here, seconds), moved)
        return Imprint(law.faded(self.earlier, seconds), here)

    def settled(self) -> Imprint:
        """The same for a contact that begins on the imprinted surface."""
        return replace(self, earlier=self.left, here=np.zeros_like(self.here))

    def seen(self, moved: Array) -> Array:
        """Displacements (p, 3) of the surface while the contact has it ``moved`` (p, 3)."""
        return self.earlier + beneath(self.here, moved)
