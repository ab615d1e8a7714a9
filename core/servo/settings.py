"""What may be changed while a servo runs: one value, handed over by ``Servo.set``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from ..contact.equations import ContactMode


class Frame(Protocol):
    """From device to body, metres: ``scale * rotation @ device + translation``."""

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Orthonormal, (3, 3)."""

    @property
    def translation(self) -> NDArray[np.float64]:
        """(3,), metres."""

    @property
    def scale(self) -> float:
        """Metres of the body that one of the device is."""


@dataclass(frozen=True)
class Coupling:
    """What lies between body and motors.

    Attributes
    ----------
    stiffness : the most that a device may see, N/m; infinite for the body's own.
    damping : that goes with it, N s/m; a softer body has its share.
    passivity_control : whether energy that the contact would make is taken back.
    """

    stiffness: float
    damping: float
    passivity_control: bool


@dataclass(frozen=True, eq=False)
class Settings:
    """All that a running servo can be told; it takes over what is new with its next tick.

    Attributes
    ----------
    young_modulus : pascal.
    enabled : False for no force from the next tick on; back on, the force ramps up.
    shading : force shading, from normals interpolated over the facets.
    static_friction, dynamic_friction : 0 <= dynamic <= static.
    mode : how a contact inside a triangle becomes a force.
    felt : which relation between displacement and force points feel. The other one comes in over
        50 ms while touching; linear where the native body was not told its softenings.
    coupling : for all fingers; None for what the rate and the device's encoders ask for.
    frames : by finger, where its device is; a new one lifts its probe off and sets it down anew.
        None, as for those behind the last: as its device was opened with.
    orientations : by finger, (3, 3), how its tool is turned: tool to body for a pointer, tool to
        stylus for a device. Those behind the last are not turned.
    """

    young_modulus: float
    enabled: bool = True
    shading: bool = False
    static_friction: float = 0.0
    dynamic_friction: float = 0.0
    mode: ContactMode = "consistent"
    felt: Literal["linear", "corrected"] = "linear"
    coupling: Coupling | None = None
    frames: Sequence[Frame | None] = ()
    orientations: Sequence[NDArray[np.float64]] = ()
