"""The shapes that can be drawn of a body under forces: one name, one sentence and one maker each.

All of them agree for small forces. They differ in what is drawn; *real* also in how firmly the body
presses back.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, Protocol, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from ..errors import PalpateError
from ..sentence import Sentence
from .paper.paper_shape import PaperShape
from .rotation_strain.finger_load import FingerLoad
from .rotation_strain.pressed import LINEAR, Pressed
from .rotation_strain.rotation_strain_shape import MOST_FELT, RotationStrainShape

ShapeName: TypeAlias = Literal["linear", "paper", "real"]
SHAPES: tuple[ShapeName, ...] = get_args(ShapeName)
EXPLANATIONS: dict[ShapeName, str] = {
    "linear": "As the force is computed; large bends look swollen",
    "paper": "The paper's (16): large deformations of single nodes, stored and added up",
    "real": "By the material's own law, as it is seen and as it is felt: nearest to the truth",
}
# Names that files and scripts may still hold.
FORMER_NAMES: dict[str, ShapeName] = {
    "table": "paper",
    "series": "paper",
    "rotation-strain": "real",
}
SERIES_IS_PAPER = Sentence(
    "the shape Series is no more; Paper is drawn, whose tables are now found by its power series"
)


class Shape(Protocol):
    """Deformed shape of a body under forces on its nodes."""

    @property
    def ready(self) -> float:
        """Share (0 to 1) of what the place touched last needs that is there; 1 without a table.

        What is missing yet is drawn as ``linear``.
        """
        return 1.0

    @property
    def notice(self) -> str:
        """What users should know: which file of a table could not be used or written, and why, or
        that another shape is drawn than the one that was named; empty otherwise.
        """
        return ""

    def displacements(
        self,
        nodes: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None = None,
        let_go: NDArray[np.float64] | None = None,
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) of the free surface nodes, metres; at once, with what is there.

        Arguments as for :meth:`SoftBody.deform`. What a place lacks is asked for: a later call is
        better, until :attr:`ready` is 1. ``let_go``: the only direction (3,) in which a hand that
        steadies a body without pins lets it go; none of one that holds it.
        """
        ...

    def wait_for(self, nodes: NDArray[np.int64]) -> None:
        """Return when all is there that forces on these nodes (k,) of the mesh need.

        Raises
        ------
        PalpateError
            It cannot be computed, or the shape is closed.
        """
        ...

    def close(self) -> None:
        """End what works in the background, and keep what it made. Safe to call twice.

        Where it cannot be kept, :attr:`notice` says why.
        """
        ...


@dataclass(frozen=True, eq=False)
class LinearShape(Shape):
    """Equation (15)."""

    body: SoftBody

    def displacements(
        self,
        nodes: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None = None,
        let_go: NDArray[np.float64] | None = None,  # noqa: ARG002 - it is where its mass is
    ) -> NDArray[np.float64]:
        """Linear displacements, as :meth:`SoftBody.deform`."""
        return self.body.deform(nodes, nodal_forces, young_modulus)

    def wait_for(self, nodes: NDArray[np.int64]) -> None:
        """Nothing is missing."""

    def close(self) -> None:
        """Nothing works in the background."""


# How each is made, of a body and the file it came from, beside which tables may be kept.
MAKERS: dict[ShapeName, Callable[[SoftBody, Path | None], Shape]] = {
    "linear": lambda body, _: LinearShape(body),
    "real": lambda body, _: RotationStrainShape(body),
    "paper": PaperShape,
}


def shape(body: SoftBody, choice: str, body_file: Path | None = None) -> Shape:
    """The shape of this name for a body.

    >>> from palpate.core.bake.settings import BakeSettings
    >>> from palpate.core.bake.steps import bake
    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> body, _ = bake(paper_cube()[0], BakeSettings(poisson_ratio=0.45, young_modulus=1e5))
    >>> top = body.compliance.free_surface[-1:]
    >>> drawn = shape(body, "real").displacements(top, np.array([[0.0, 0.0, -1.0]]))
    >>> drawn.shape, bool(drawn[-1, 2] < 0.0)
    ((73, 3), True)

    Parameters
    ----------
    choice : one of :data:`SHAPES` or :data:`FORMER_NAMES`.
    body_file : where the body came from; tables are kept beside it. Without it they are not kept.

    Raises
    ------
    PalpateError
        An unknown name, or a body for which there is no such shape.
    """
    if choice == "series":
        return PaperShape(body, body_file, remark=SERIES_IS_PAPER)
    return MAKERS[shape_name(choice)](body, body_file)


def is_felt(body: SoftBody) -> bool:
    """Whether *real* tells a body's force, too: it does on the body's own nodes alone."""
    return len(body.mesh.nodes) - len(body.fixed) <= MOST_FELT


def pressed_by(
    shape: Shape, loads: Sequence[FingerLoad], young_modulus: float, ahead: float = 1.0
) -> Pressed:
    """How much more firmly than a linear body this one presses back under these linear loads, and
    where its free surface comes to rest, if that was found; of a press that is deeper, ``ahead``
    times.

    May take some tenths of a second; thread-safe.

    Raises
    ------
    PalpateError
        The shape cannot be computed.
    """
    if isinstance(shape, RotationStrainShape):
        return shape.pressed(loads, young_modulus, ahead)
    return LINEAR


def rest_known(
    shape: Shape, loads: Sequence[FingerLoad], young_modulus: float
) -> NDArray[np.float64] | None:
    """Displacements (n, 3) at rest of a press that was looked for already, metres; at once."""
    if isinstance(shape, RotationStrainShape):
        return shape.known(loads, young_modulus).displacements
    return None


def shape_name(choice: str) -> ShapeName:
    """The name, checked; of a former name, what it means now.

    Raises
    ------
    PalpateError
        An unknown one.
    """
    for name in SHAPES:
        if name == FORMER_NAMES.get(choice, choice):
            return name
    raise PalpateError(
        "shape {choice} is unknown; give {others} or {last}",
        choice=repr(choice),
        others=", ".join(SHAPES[:-1]),
        last=SHAPES[-1],
    )
