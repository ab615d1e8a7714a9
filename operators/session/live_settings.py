"""What may be changed while somebody presses: read from Blender, handed to the servo when new."""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy

from ...core.contact.equations import ContactMode
from ...core.servo.session import Servo, device_coupling, haply_encoder_step
from ...core.shape.force_at_depth.felt_force import FeltName
from ..device.device_source import DeviceFrame, is_planar
from ..shape.felt_table import chosen_felt


@dataclass(frozen=True)
class Feel:
    """Force shading, and coefficients of friction; the dynamic one is at most the static one."""

    shading: bool
    static_friction: float
    dynamic_friction: float

    @classmethod
    def of(cls, thing: bpy.types.Object) -> Feel:
        """As set on the object, also where a driver sets the dynamic one above the static one."""
        chosen = thing.palpate
        static = chosen.static_friction
        return cls(chosen.shading, static, min(chosen.dynamic_friction, static))


@dataclass(frozen=True)
class Coupling:
    """Between body and motors: the most stiffness that they see (N/m, infinite for the body's own),
    the damping that goes with it (N s/m), and whether energy that contact makes is taken back.
    """

    stiffness: float
    damping: float
    passivity_control: bool

    @classmethod
    def of(cls, scene: bpy.types.Scene) -> Coupling:
        """As chosen in the scene."""
        chosen = scene.palpate
        if not chosen.stable_contact:
            return cls(math.inf, 0.0, passivity_control=False)
        if not chosen.own_coupling:
            models = [chosen.haply_model] if is_planar(scene) else []
            models += [chosen.second_haply_model] if chosen.second == "HAPLY" else []
            step = max(map(haply_encoder_step, models), default=0.0)
            return cls(**device_coupling(chosen.rate, encoder_step=step))
        return cls(chosen.coupling_stiffness, chosen.coupling_damping, chosen.passivity_control)


def contact_mode(scene: bpy.types.Scene) -> ContactMode:
    """How the scene says that contacts are computed."""
    return "paper" if scene.palpate.contact_mode == "PAPER" else "consistent"


@dataclass(frozen=True)
class LiveSettings:
    """``young_modulus`` in pascal; ``device`` is where the first finger's device is, None where it
    has none; ``mode`` says how the contact is computed, ``felt`` how force follows from depth.
    """

    young_modulus: float
    feel: Feel
    coupling: Coupling
    device: DeviceFrame | None = None
    mode: ContactMode = "consistent"
    felt: FeltName = "linear"

    @classmethod
    def of(
        cls, thing: bpy.types.Object, scene: bpy.types.Scene, device: DeviceFrame | None
    ) -> LiveSettings:
        """As set on the object and in the scene now."""
        return cls(
            thing.palpate.young_modulus,
            Feel.of(thing),
            Coupling.of(scene),
            device,
            contact_mode(scene),
            chosen_felt(thing),
        )

    def hand_over(self, servo: Servo, before: LiveSettings | None = None) -> None:
        """Tell the servo what is other than before; all of it, if nothing was told."""
        if before is None or self.young_modulus != before.young_modulus:
            servo.set_young_modulus(self.young_modulus)
        if before is None or self.mode != before.mode:
            servo.set_mode(self.mode)
        if before is None or self.felt != before.felt:
            servo.set_felt(self.felt)
        if before is None or self.feel != before.feel:
            feel = self.feel
            servo.set_feel(
                shading=feel.shading,
                static_friction=feel.static_friction,
                dynamic_friction=feel.dynamic_friction,
            )
        if before is None or self.coupling != before.coupling:
            coupling = self.coupling
            servo.set_coupling(
                stiffness=coupling.stiffness,
                damping=coupling.damping,
                passivity_control=coupling.passivity_control,
            )
        # A device starts with its frame.
        if before is not None and self.device is not None and self._moved(before):
            frame = self.device
            servo.set_device_frame(frame.rotation, frame.translation, frame.scale)

    def _moved(self, before: LiveSettings) -> bool:
        here, there = self.device, before.device
        return here is not None and (there is None or not here.same_as(there))
