"""Amount of a stroke typed while dragging."""

from __future__ import annotations

import math
import re
from collections import deque
from dataclasses import dataclass, replace

import bpy

from .answer.motion import Motion

# Metres of each unit that can be typed.
METRES = {
    "km": 1e3,
    "m": 1.0,
    "dm": 0.1,
    "cm": 0.01,
    "mm": 1e-3,
    "um": 1e-6,
    "mi": 1609.344,
    "yd": 0.9144,
    "ft": 0.3048,
    "'": 0.3048,
    "in": 0.0254,
    '"': 0.0254,
    "thou": 2.54e-5,
    "mil": 2.54e-5,
}
# What can be part of a number with its unit.
CHARACTERS = set("0123456789.,-+*/()'\" ").union(*METRES)
DIGITS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
# What keys mean that come without a character, as from some input methods.
KEYS = {
    **{name: str(digit) for digit, name in enumerate(DIGITS)},
    **{f"NUMPAD_{digit}": str(digit) for digit in range(10)},
    **dict.fromkeys(("PERIOD", "COMMA", "NUMPAD_PERIOD"), "."),
    **dict.fromkeys(("MINUS", "NUMPAD_MINUS"), "-"),
}
# What a bare number is in where the scene shows lengths in this unit.
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
# A number with its unit, or a sign.
PIECE = re.compile(r"""\s*(?:(\d+\.?\d*|\.\d+)\s*([a-z]+|['"])?|([-+*/()]))""")


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
        try:
            match self.motion:
                case Motion.TWIST:
                    number = math.radians(evaluated(text, 1.0))
                case Motion.PINCH:
                    number = 0.01 * evaluated(text, 1.0)
                case _:
                    number = evaluated(text, _bare(scene))
        except (ValueError, ArithmeticError):
            # Not finished yet, such as a minus alone.
            return None
        return number if math.isfinite(number) else None


def _bare(scene: bpy.types.Scene) -> float:
    """Metres of a length that is typed without a unit."""
    units = scene.unit_settings
    name = UNITS.get(units.length_unit)
    if name is not None and units.system != "NONE":
        return METRES[name]
    return METRES["ft"] if units.system == "IMPERIAL" else 1.0


def evaluated(text: str, bare: float) -> float:
    """Value of a sum of products of numbers, each with a unit or times ``bare``. Blender's own
    evaluation is Python's: it prints what it cannot read, and `9**9**9` never ends.

    Raises
    ------
    ValueError
        It is none.
    ArithmeticError
        It is divided by zero, or too large.
    """
    pieces = _pieces(text, bare)
    value = _sum(pieces)
    if pieces:
        raise ValueError(text)
    return bare * value


def _pieces(text: str, bare: float) -> deque[str | float]:
    """Signs, and numbers in units of ``bare``; 1' 2" is a sum."""
    pieces: deque[str | float] = deque()
    at = 0
    while at < len(text):
        found = PIECE.match(text, at)
        if found is None:
            raise ValueError(text)
        number, unit, sign = found.groups()
        at = found.end()
        if unit and pieces and isinstance(pieces[-1], float):
            pieces.append("+")
        if unit and unit not in METRES:
            raise ValueError(unit)
        pieces.append(sign or float(number) * (METRES[unit] / bare if unit else 1.0))
    return pieces


def _sum(pieces: deque[str | float]) -> float:
    value = _product(pieces)
    while pieces and pieces[0] in ("+", "-"):
        sign = pieces.popleft()
        value += _product(pieces) if sign == "+" else -_product(pieces)
    return value


def _product(pieces: deque[str | float]) -> float:
    value = _factor(pieces)
    while pieces and pieces[0] in ("*", "/"):
        sign = pieces.popleft()
        value = value * _factor(pieces) if sign == "*" else value / _factor(pieces)
    return value


def _factor(pieces: deque[str | float]) -> float:
    first = pieces.popleft() if pieces else ")"
    if isinstance(first, float):
        return first
    if first == "(":
        value = _sum(pieces)
        if not pieces or pieces.popleft() != ")":
            message = "a bracket is open"
            raise ValueError(message)
        return value
    if first in ("+", "-"):
        return _factor(pieces) if first == "+" else -_factor(pieces)
    raise ValueError(first)
