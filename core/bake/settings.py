"""What a bake depends on besides the shape."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..errors import PalpateError
from ..stiffness.assembly import lame_parameters
from ..stiffness.formulation import AUTOMATIC, formulation_for
from ..stiffness.pins import PinBelow, Pins, fraction_checked
from ..stiffness.regions import StiffRegion, TetScale

# How a compliance can be asked for.
FORMS = ("auto", "dense", "compressed")


@dataclass(frozen=True)
class BakeSettings:
    """Material, pins, fineness, and how the compliance is computed and kept.

    Attributes
    ----------
    poisson_ratio, young_modulus : material; the modulus (pascal) is only stored, never baked in.
    pins : which nodes are held.
    edge_length : wanted edge length of tetrahedra, as a share of the bounding box diagonal.
    epsilon : how far the body's surface may lie from the input's, as such a share.
    decimate_above : inputs of more triangles are reduced to this many first.
    time_limit : seconds after which tetrahedralization is given up.
    formulation : of the stiffness; ``auto`` takes what suits Poisson's ratio.
    form : of the compliance, ``dense`` or ``compressed``; ``auto`` compresses large bodies.
    tolerance : largest relative column error that compressing may cause.
    stiffness : where the body is stiffer or softer than elsewhere; None for the same everywhere.
    threads : of BLAS at most; None for as many as there are idle cores for this process.
    """

    poisson_ratio: float = 0.3
    young_modulus: float = 10_000.0
    pins: Pins = field(default_factory=lambda: PinBelow(0.1))
    edge_length: float = 0.05
    epsilon: float = 0.003
    decimate_above: int = 6000
    time_limit: float = 600.0
    formulation: str = AUTOMATIC
    form: str = "auto"
    tolerance: float = 1e-3
    stiffness: StiffRegion | TetScale | None = None
    threads: int | None = None

    def checked(self) -> BakeSettings:
        """These settings, if they can be used.

        Raises
        ------
        PalpateError
            A value outside its range; names it.
        """
        lame_parameters(self.young_modulus, self.poisson_ratio)
        for name, low, high in (
            ("edge_length", 0.002, 0.5),
            ("epsilon", 1e-5, 0.1),
            ("decimate_above", 100, 10_000_000),
            ("time_limit", 1.0, 1e6),
            ("tolerance", 1e-6, 0.1),
            ("threads", 1, 4096),
        ):
            value = getattr(self, name)
            if name == "threads" and value is None:
                continue
            if not low <= value <= high:
                raise PalpateError(
                    "bake: {setting} is {value}, but must lie between {low:g} and {high:g}",
                    setting=name.replace("_", " "),
                    value=value,
                    low=low,
                    high=high,
                )
        formulation_for(self.formulation, self.poisson_ratio)
        if isinstance(self.pins, PinBelow):
            fraction_checked(self.pins.fraction)
        if self.form not in FORMS:
            raise PalpateError(
                "bake: the form is '{form}', but must be one of {forms}",
                form=self.form,
                forms=", ".join(FORMS),
            )
        return self
