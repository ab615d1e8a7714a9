"""Texts of a running stroke: status bar and header."""

from __future__ import annotations

import math

import bpy

from ..reporting.quantities import newtons, scene_length
from ..reporting.translated import shown
from .answer.motion import Asked, Motion
from .answer.stroked import Stroked

STATUS = {
    Motion.PUSH: "Drag away in any direction: Deeper     [Ctrl] Along the surface     "
    "[0-9] Depth     [Esc] Restore",
    Motion.GRAB: "Drag: The surface follows     [0-9] Distance     [Esc] Restore",
    Motion.TWIST: "Drag away in any direction: Turn     [0-9] Degrees     [Esc] Restore",
    Motion.PINCH: "Drag away in any direction: Draw in     [0-9] Percent     [Esc] Restore",
}


def status(motion: Motion) -> str:
    """What keys and pointer do during a stroke."""
    return f"Palpate: {shown(STATUS[motion])}"


def figures(scene: bpy.types.Scene, asked: Asked, stroked: Stroked) -> str:
    """Amount and force of a stroke, such as "3.2 mm   1.25 N"."""
    match asked.motion:
        case Motion.TWIST:
            return f"{math.degrees(asked.amount):.1f}°   {newtons(stroked.torque)} m"
        case Motion.PINCH:
            return f"{100.0 * asked.amount:.0f} %   {newtons(stroked.force)}"
        case Motion.GRAB if asked.by is not None:
            return f"{scene_length(scene, math.hypot(*asked.by))}   {newtons(stroked.force)}"
    return f"{scene_length(scene, asked.amount)}   {newtons(stroked.force)}"
