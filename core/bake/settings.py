"""Settings of a bake."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..compliance.free_body.density import density_checked
from ..errors import PalpateError
from ..law.of_material import RUBBER, law_checked
from ..stiffness.assembly import lame_parameters
from ..stiffness.formulation import SMOOTHED, formulation_checked
from ..stiffness.pins import PinBelow, Pins, fraction_checked
from ..stiffness.regions import StiffRegion, TetScale

# Choices of the compliance's form.
FORMS = ("auto", "dense", "compressed")


@dataclass(frozen=True)
class BakeSettings:
    """Material, pins, fineness, and how the compliance is computed and kept.

    Attributes
    ----------
    poisson_ratio, young_modulus : material; the modulus (pascal) is only stored, never baked in.
    pins : nodes to hold.
    edge_length : target edge length of tetrahedra, as a share of the bounding box diagonal.
    epsilon : largest distance between the body's surface and the input's, as such a share.
    decimate_above : inputs of more triangles are decimated to this many.
    time_limit : seconds for tetrahedralization.
    formulation : of the stiffness, one of :data:`..stiffness.formulation.FORMULATIONS`.
    form : of the compliance, ``dense`` or ``compressed``; ``auto`` compresses large bodies.
    tolerance : largest relative column error from compression.
    stiffness : stiffer and softer regions; None for the same everywhere.
    threads : of BLAS at most; None for one on each idle core.
    law : a name of :data:`..law.of_material.LAWS`, only stored.
    density : kg/m3, only stored; None for that of water where the body is free, else unknown.
    """

    poisson_ratio: float = 0.3
    young_modulus: float = 10_000.0
    pins: Pins = field(default_factory=lambda: PinBelow(0.1))
    edge_length: float = 0.05
    epsilon: float = 0.003
    decimate_above: int = 6000
    time_limit: float = 600.0
    formulation: str = SMOOTHED
    form: str = "auto"
    tolerance: float = 1e-3
    stiffness: StiffRegion | TetScale | None = None
    threads: int | None = None
    density: float | None = None
    law: str = RUBBER

    def checked(self) -> BakeSettings:
        """These settings, checked.

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
        if self.density is not None:
            density_checked(self.density)
        formulation_checked(self.formulation)
        law_checked(self.law)
        if isinstance(self.pins, PinBelow):
            fraction_checked(self.pins.fraction)
        if self.form not in FORMS:
            raise PalpateError(
                "bake: the form is '{form}', but must be one of {forms}",
                form=self.form,
                forms=", ".join(FORMS),
            )
        return self
