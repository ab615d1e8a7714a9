"""What may be changed while somebody presses: read from Blender, handed to the servo when new."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ..core.servo_session import Servo
from .device_source import DeviceFrame


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
class LiveSettings:
    """``young_modulus`` in pascal; ``device`` is where a device is, None for the pointer."""

    young_modulus: float
    feel: Feel
    device: DeviceFrame | None = None

    def hand_over(self, servo: Servo, before: LiveSettings | None = None) -> None:
        """Tell the servo what is other than before; all of it, if nothing was told."""
        if before is None or self.young_modulus != before.young_modulus:
            servo.set_young_modulus(self.young_modulus)
        if before is None or self.feel != before.feel:
            feel = self.feel
            servo.set_feel(
                shading=feel.shading,
                static_friction=feel.static_friction,
                dynamic_friction=feel.dynamic_friction,
            )
        # A device starts with its frame.
        if before is not None and self.device is not None and self._moved(before):
            frame = self.device
            servo.set_device_frame(frame.rotation, frame.translation, frame.scale)

    def _moved(self, before: LiveSettings) -> bool:
        here, there = self.device, before.device
        return here is not None and (there is None or not here.same_as(there))
