"""Settings that can change during a press, read from Blender."""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy

from ...core.contact.equations import ContactMode
from ...core.law.relaxation import RELAXATIONS
from ...core.servo.session import device_coupling, haply_encoder_step
from ...core.servo.settings import Coupling, Settings
from ..device.device_source import DeviceFrame, is_planar
from ..scene.package_preferences import preferences


def coupling_of(scene: bpy.types.Scene) -> Coupling:
    """Virtual coupling, as chosen in the preferences, for the scene's devices and rate."""
    kept, chosen = preferences(), scene.palpate
    if not kept.stable_contact:
        return Coupling(math.inf, 0.0, passivity_control=False)
    if not kept.own_coupling:
        models = [chosen.haply_model] if is_planar(scene) else []
        models += [chosen.second_haply_model] if chosen.second == "HAPLY" else []
        step = max(map(haply_encoder_step, models), default=0.0)
        return Coupling(**device_coupling(chosen.rate, encoder_step=step))
    return Coupling(kept.coupling_stiffness, kept.coupling_damping, kept.passivity_control)


def contact_mode(scene: bpy.types.Scene) -> ContactMode:
    """Contact mode, as chosen in the scene."""
    return "paper" if scene.palpate.contact_mode == "PAPER" else "consistent"


@dataclass(frozen=True, eq=False)
class LiveSettings:
    """Settings of the servo, and the frame of each finger's device, None without one."""

    servo: Settings
    devices: tuple[DeviceFrame | None, ...]

    @classmethod
    def of(
        cls,
        thing: bpy.types.Object,
        scene: bpy.types.Scene,
        devices: tuple[DeviceFrame | None, ...],
    ) -> LiveSettings:
        """Present settings of object and scene.

        Dynamic friction is at most static friction, also where a driver sets it higher.
        """
        chosen = thing.palpate
        settings = Settings(
            young_modulus=chosen.young_modulus,
            max_force=preferences().max_force,
            shading=chosen.shading,
            static_friction=chosen.static_friction,
            dynamic_friction=min(chosen.dynamic_friction, chosen.static_friction),
            mode=contact_mode(scene),
            relaxation=RELAXATIONS[chosen.relaxation].pairs,
            coupling=coupling_of(scene),
            frames=devices,
        )
        return cls(settings, devices)
