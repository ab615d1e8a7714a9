"""Amount of a stroke typed while dragging."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import bpy

from .answer.motion import Motion

# What can be part of a number with its unit.
CHARACTERS = set("0123456789.,-+*/()'\"cmkutyfindhr ")
DIGITS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
# What keys mean that come without a character, as from some input methods.
KEYS = {
    **{name: str(digit) for digit, name in enumerate(DIGITS)},
    **{f"NUMPAD_{digit}": str(digit) for digit in range(10)},
    **dict.fromkeys(("PERIOD", "COMMA", "NUMPAD_PERIOD"), "."),
    **dict.fromkeys(("MINUS", "NUMPAD_MINUS"), "-"),
}
UNITS = {
    "KILOMETERS": "km",
    "METERS": "m",
    "CENTIMETERS": "cm",
    "MILLIMETERS": "mm",
    "MICROMETERS": "um",
    "MILES": "mi",
    "FEET": "ft",
    "INCHES": "in",
    "THOU": "thou",
}


@dataclass(frozen=True)
class TypedAmount:
    """Text typed so far, for a kind of motion."""

    motion: Motion
    text: str = ""

    def after(self, event: bpy.types.Event) -> TypedAmount | None:
        """The text after a key; None for a key that is none of it."""
        if event.value != "PRESS" or event.ctrl or event.alt or event.oskey:
            return None
        if event.type == "BACK_SPACE":
            return replace(self, text=self.text[:-1])
        character = event.unicode or KEYS.get(event.type, "")
        if character and character in CHARACTERS:
            return replace(self, text=self.text + character)
        return None

    def value(self, scene: bpy.types.Scene) -> float | None:
        """Metres of a push or grab, radians of a twist, share of a pinch; None if not a number."""
        text = self.text.replace(",", ".").strip()
        if not text:
            return None
        units = scene.unit_settings
        unit = UNITS.get(units.length_unit)
        try:
            if self.motion is Motion.TWIST:
                number = math.radians(float(text))
            elif self.motion is Motion.PINCH:
                number = 0.01 * float(text)
            else:
                number = bpy.utils.units.to_value(units.system, "LENGTH", text, str_ref_unit=unit)
        except ValueError:
            # Not finished yet, such as a minus alone.
            return None
        return number if math.isfinite(number) else None
