"""Force, depth, state and keys, in the lower left of the view."""

import re
from dataclasses import dataclass, replace

import bpy

from ...core.quantities import area, pressure
from ...operators.device.servo_words import REASONS, Signal, standing
from ...operators.reporting.translated import shown
from ...operators.session.press_events import Source
from ...operators.session.press_session import PressSession
from ...operators.session.press_state import Phase
from . import pixels
from .pixels import BACKGROUND, BLACK, WHITE, Color
from .reading import Reading, readings

MARGIN, PADDING, NARROWEST, BADGE_PADDING = 20, 14, 150, 8
LARGE, BADGE, NORMAL, SMALL = 26, 20, 14, 12
LINE = 1.5
GREY, WARNING = (0.8, 0.8, 0.8, 1.0), (1.0, 0.72, 0.2, 1.0)

# Grey: no force. Green: it may come. Orange: present. Yellow: ramping up. Red: a fault.
FILLS = {
    Signal.OFF: (0.62, 0.62, 0.62, 1.0),
    Signal.WAITING: (0.62, 0.62, 0.62, 1.0),
    Signal.READY: (0.35, 0.78, 0.35, 1.0),
    Signal.FORCE: (1.0, 0.58, 0.15, 1.0),
    Signal.RETURNING: (0.98, 0.85, 0.25, 1.0),
    Signal.FAULT: (0.95, 0.3, 0.3, 1.0),
}

# A word with its punctuation (keys are followed by two spaces), and the space where a line may end.
BREAKS = re.compile(r"(\S+(?:  \S+)*)( *)")

STATES = {
    Phase.READY: "Press on the surface and drag",
    Phase.DRAGGING: "Pressing",
    Phase.HOLDING: "Held: look around, keep it, or press elsewhere",
}
PINCH_STATES = {
    Phase.READY: "Drag each handle inward",
    Phase.DRAGGING: "Pressing",
    Phase.HOLDING: "Held: drag a handle, look around, or keep it",
}
EMPTY_STATES = {Phase.FEELING: "The Empty leads: move it, or play the animation"}
SHAPE, FELT = "Shape {share} %", "Felt force {share} %"
ABOVE = "Above the surface: drag inward, or turn the wheel"
KEYS = {
    Phase.READY: "Esc  Leave",
    Phase.DRAGGING: "Wheel  Deeper",
    Phase.HOLDING: "Enter  Keep shape      Esc  Restore",
    Phase.FEELING: "Enter  Keep shape      Esc  Restore",
    Phase.LOST: "Esc  Leave",
}


@dataclass(frozen=True)
class Line:
    """Line of the HUD; ``fill`` is its background colour, for what must be seen at a glance."""

    text: str
    size: float
    color: Color
    fill: Color | None = None


def draw(context: bpy.types.Context, session: PressSession) -> None:
    """Draw the HUD of a press in the current region."""
    scale = context.preferences.system.ui_scale
    left = pixels.covered(context, "TOOLS", "LEFT") + MARGIN * scale
    padding = PADDING * scale
    right = context.region.width - pixels.covered(context, "UI", "RIGHT") - MARGIN * scale
    # In a view too narrow for words, they are cut rather than broken into letters.
    width = max(NARROWEST * scale, right - left - 2 * padding)
    lines = [
        replace(line, text=part, size=line.size * scale)
        for line in _lines(context, session)
        for part in _wrapped(line.text, line.size * scale, width)
    ]
    heights = [line.size * LINE for line in lines]
    widths = [pixels.width_of(line.text, line.size) for line in lines]
    bottom = MARGIN * scale
    pixels.rectangle(
        left, bottom, max(widths) + 2 * padding, sum(heights) + 2 * padding, BACKGROUND
    )
    y = bottom + padding + sum(heights)
    for line, height, across in zip(lines, heights, widths, strict=True):
        y -= height
        if line.fill is not None:
            beside = BADGE_PADDING * scale
            pixels.rectangle(left + padding - beside, y, across + 2 * beside, height, line.fill)
        pixels.write(line.text, left + padding, y + 0.28 * height, line.size, line.color)


def _lines(context: bpy.types.Context, session: PressSession) -> list[Line]:
    """Lines of the HUD, from the top."""
    figures = readings(session)
    touching = any(one.touching for one in figures)
    phase = _phase(session, touching=touching)
    measured = _measured(figures, session)
    if session.state.source is Source.DEVICE:
        switch = "Space  Force Off" if session.state.force_on else "Space  Force On"
        keys = f"{shown(switch)}      {shown(KEYS.get(phase, ''))}"
        about = [*_device_lines(session, measured), *_shape_lines(session)]
        return [*about, Line(keys, SMALL, GREY)]
    above = phase is Phase.DRAGGING and not touching
    lines = [*measured, Line(shown(ABOVE if above else _state(session, phase)), NORMAL, WHITE)]
    if session.state.message:
        lines.append(Line(shown(session.state.message), NORMAL, WARNING))
    lines += _shape_lines(session)
    lines += _buried_lines(session)
    lines += _second_lines(session)
    return [*lines, Line(shown(KEYS.get(phase, "")), SMALL, GREY)]


def _measured(figures: tuple[Reading, ...], session: PressSession) -> list[Line]:
    """Force and depth of each finger, and area and pressure of a tool."""
    lines = []
    for number, one in enumerate(figures, start=1):
        name = f"{number}   " if len(figures) > 1 else ""
        lines.append(Line(f"{name}{one.force:.3f} N     {1000 * one.depth:.1f} mm", LARGE, WHITE))
        if session.tip.tool is not None and one.touching:
            words = f"{shown('Contact Area')} {area(one.area)}      "
            words += f"{shown('Largest Pressure')} {pressure(one.largest_pressure)}"
            lines.append(Line(words, NORMAL, WHITE))
    return lines


def _state(session: PressSession, phase: Phase) -> str:
    if session.pinches:
        return PINCH_STATES.get(phase, "")
    if session.state.source is Source.EMPTY:
        return EMPTY_STATES.get(phase, "")
    return STATES.get(phase, "")


def _shape_lines(session: PressSession) -> list[Line]:
    """Progress of the tables at the touched place."""
    felt = 1.0 if session.loop is None else session.loop.felt.ready
    return [
        Line(shown(text, share=f"{100 * ready:.0f}"), NORMAL, GREY)
        for text, ready in ((SHAPE, session.seen.shape.ready), (FELT, felt))
        if ready < 1.0
    ]


def _buried_lines(session: PressSession) -> list[Line]:
    """Warning of a finger inside the body, which has no force; once for all fingers."""
    snapshot, inside = session.snapshot, "inside the body"
    if snapshot is None or all(finger.reason != inside for finger in snapshot.fingers):
        return []
    return [Line(shown(REASONS[inside]), NORMAL, WARNING)]


def _second_lines(session: PressSession) -> list[Line]:
    """Reason why a second finger's device gives no force."""
    snapshot = session.snapshot
    if snapshot is None or not session.state.has_device or len(session.leads) < 2:
        return []
    now = standing(snapshot.fingers[1])
    if now.signal is not Signal.FAULT:
        return []
    return [Line(f"2   {shown(now.word)}: {shown(now.why)}", NORMAL, WARNING)]


def _device_lines(session: PressSession, measured: list[Line]) -> list[Line]:
    """Whether the motors push, and why."""
    snapshot = session.snapshot
    if snapshot is None:
        return [Line(shown("Starting"), NORMAL, WHITE)]
    now = standing(snapshot)
    fault = now.signal is Signal.FAULT
    lines = [Line(shown(now.word), BADGE, BLACK, FILLS[now.signal])]
    if not session.awaits_device and not fault:
        lines += measured
    if now.why:
        lines.append(Line(shown(now.why), NORMAL, WARNING if fault else WHITE))
    if now.signal in {Signal.FORCE, Signal.RETURNING}:
        given = sum(component**2 for component in snapshot.output_force) ** 0.5
        lines.append(Line(f"{shown('The device gives')} {given:.3f} N", NORMAL, WHITE))
    if now.limit:
        lines.append(Line(shown(now.limit), NORMAL, WARNING))
    if session.state.message and session.state.phase is not Phase.LOST:
        lines.append(Line(shown(session.state.message), NORMAL, WARNING))
    return lines + _second_lines(session)


def _phase(session: PressSession, *, touching: bool) -> Phase:
    """Phase of the press for the user: a probe released in the air does not press yet."""
    phase = session.state.phase
    return Phase.READY if phase is Phase.HOLDING and not touching else phase


def _wrapped(text: str, size: float, width: float) -> list[str]:
    """Text on lines that fit ``width`` pixels; words that fit are not broken."""
    if pixels.width_of(text, size) <= width:
        return [text]
    lines = [""]
    for word, space in BREAKS.findall(text):
        # A script without spaces may break anywhere.
        pieces = [word] if pixels.width_of(word, size) <= width else list(word)
        for piece in pieces:
            if lines[-1].strip() and pixels.width_of(lines[-1] + piece, size) > width:
                lines.append("")
            lines[-1] += piece
        lines[-1] += space
    return [line.strip() for line in lines]
