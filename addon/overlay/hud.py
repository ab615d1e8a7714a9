"""Force, depth, state and the colours of pressure, in a free corner of the view."""

import re
from dataclasses import dataclass, replace
from itertools import pairwise

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.quantities import area, pressure
from ...operators.device.servo_words import REASONS, Signal, standing
from ...operators.reporting.quantities import newtons, scene_length
from ...operators.reporting.translated import shown
from ...operators.session.press_events import Source
from ...operators.session.press_session import PressSession
from ...operators.session.press_state import Phase
from . import pixels, regions
from .free_corner import free_corner
from .pixels import BACKGROUND, BLACK, WHITE, Color
from .pressure_colors import ANCHORS
from .reading import Reading, readings

Array = NDArray[np.float64]

# Unscaled pixels.
PADDING, NARROWEST, WIDEST, BADGE_PADDING = 8, 90, 300, 5
LARGE, BADGE, NORMAL, SMALL = 16, 14, 12, 11
LEGEND_WIDTH, LEGEND_HEIGHT, BAR_HEIGHT = 170, 30, 8
# Share of a tool's largest depth from which on that is said.
DEEPEST = 0.97
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
}
PINCH_STATES = {
    Phase.READY: "Drag each handle inward",
    Phase.DRAGGING: "Pressing",
    Phase.HOLDING: "Held: drag a handle, look around, or keep it",
}
EMPTY_STATES = {Phase.FEELING: "The Empty leads: move it, or play the animation"}
SHAPE = "Shape {share} %"
ABOVE = "Above the surface: drag inward, or turn the wheel"
TOO_SMALL = "No deeper with this tool: a larger one goes on"
KEYS = {
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


def draw(
    context: bpy.types.Context, session: PressSession, shown: Array, top: float | None
) -> bool:
    """Draw the HUD of a press in the current region, in a corner clear of the pixels ``shown``
    (n, 2), with the colours of pressure up to ``top`` (Pa) where there is a tool's patch.

    Where it finds none, only figures and what must be seen are drawn, and where these find none
    either, the latter in the lower left. Returns whether there are figures.
    """
    scale, room = context.preferences.system.ui_scale, regions.room(context)
    width = min(WIDEST * scale, room.right - room.left - 2 * PADDING * scale)
    if width < NARROWEST * scale:
        return False
    whole = [
        replace(line, text=part, size=line.size * scale)
        for line in _lines(context, session)
        for part in _wrapped(line.text, line.size * scale, width)
    ]
    urgent = [line for line in whole if line.fill or line.color == WARNING]
    short = [line for line in whole if line in urgent or line.size == LARGE * scale]
    for lines, legend in ((whole, top), (short, None)):
        place = free_corner(_size(lines, legend, scale), room, shown) if lines else None
        if place is not None:
            _draw_at(place, lines, legend, scale)
            return True
    if urgent:
        _draw_at((room.left, room.bottom), urgent, None, scale)
    return False


def _size(lines: list[Line], top: float | None, scale: float) -> tuple[float, float]:
    """Width and height of the HUD, pixels."""
    legend = (0.0, 0.0) if top is None else (LEGEND_WIDTH * scale, LEGEND_HEIGHT * scale)
    across = max([legend[0], *(pixels.width_of(line.text, line.size) for line in lines)])
    up = legend[1] + sum(line.size * LINE for line in lines)
    return across + 2 * PADDING * scale, up + 2 * PADDING * scale


def _draw_at(
    place: tuple[float, float], lines: list[Line], top: float | None, scale: float
) -> None:
    width, height = _size(lines, top, scale)
    padding = PADDING * scale
    pixels.rectangle(*place, width, height, BACKGROUND)
    left, y = place[0] + padding, place[1] + height - padding
    for line in lines:
        y -= line.size * LINE
        if line.fill is not None:
            beside, across = BADGE_PADDING * scale, pixels.width_of(line.text, line.size)
            area = (left - beside, y, across + 2 * beside, line.size * LINE)
            pixels.rectangle(*area, line.fill)
        pixels.write(line.text, left, y + 0.28 * line.size * LINE, line.size, line.color)
    if top is not None:
        _draw_legend(left, place[1] + padding, top, scale)


def _draw_legend(left: float, bottom: float, top: float, scale: float) -> None:
    """Draw the colours of pressure from 0 to ``top`` (Pa)."""
    size, width = SMALL * scale, LEGEND_WIDTH * scale
    step = width / (len(ANCHORS) - 1)
    for number, (lower, upper) in enumerate(pairwise(ANCHORS)):
        before, after = (*lower.tolist(), 1.0), (*upper.tolist(), 1.0)
        area = (left + number * step, bottom + 1.4 * size, step, BAR_HEIGHT * scale)
        pixels.shaded(*area, [before, after, after, before])
    figure = pressure(top)
    pixels.write("0", left, bottom + 0.2 * size, size, GREY)
    pixels.write(
        figure, left + width - pixels.width_of(figure, size), bottom + 0.2 * size, size, GREY
    )


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
    # A finger in the air measures nothing.
    lines = measured if touching else []
    say = shown(ABOVE if above else _state(session, phase))
    lines += [Line(say, NORMAL, WHITE)] if say else []
    if session.state.message:
        lines.append(Line(shown(session.state.message), NORMAL, WARNING))
    lines += _shape_lines(session)
    lines += _buried_lines(session)
    lines += _limit_lines(session, figures)
    lines += _second_lines(session)
    keys = shown(KEYS.get(phase, ""))
    return [*lines, Line(keys, SMALL, GREY)] if keys else lines


def _measured(figures: tuple[Reading, ...], session: PressSession) -> list[Line]:
    """Force and depth of each finger, and area and pressure of a tool."""
    lines = []
    for number, one in enumerate(figures, start=1):
        name = f"{number}   " if len(figures) > 1 else ""
        depth = scene_length(bpy.context.scene, one.depth)
        lines.append(Line(f"{name}{newtons(one.force)}     {depth}", LARGE, WHITE))
        if session.tip.tool is not None and one.touching:
            words = f"{shown('Contact Area')} {area(one.area)}     "
            words += f"{shown('Largest Pressure')} {pressure(one.largest_pressure)}"
            lines.append(Line(words, SMALL, GREY))
    return lines


def _state(session: PressSession, phase: Phase) -> str:
    if session.pinches:
        return PINCH_STATES.get(phase, "")
    if session.state.source is Source.EMPTY:
        return EMPTY_STATES.get(phase, "")
    return STATES.get(phase, "")


def _shape_lines(session: PressSession) -> list[Line]:
    """Progress of the tables at the touched place."""
    ready = session.seen.shape.ready
    return [Line(shown(SHAPE, share=f"{100 * ready:.0f}"), NORMAL, GREY)] if ready < 1.0 else []


def _buried_lines(session: PressSession) -> list[Line]:
    """Warning of a finger inside the body, which has no force; once for all fingers."""
    snapshot, inside = session.snapshot, "inside the body"
    if snapshot is None or all(finger.reason != inside for finger in snapshot.fingers):
        return []
    return [Line(shown(REASONS[inside]), NORMAL, WARNING)]


def _limit_lines(session: PressSession, figures: tuple[Reading, ...]) -> list[Line]:
    """Word that a tool is as deep as it may go: the pointer leads it no further, and deeper led by
    others the body may let go of it.
    """
    if all(one.depth < DEEPEST * session.tip.deepest for one in figures):
        return []
    return [Line(shown(TOO_SMALL), NORMAL, WARNING)]


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
        lines.append(Line(f"{shown('The device gives')} {newtons(given)}", NORMAL, WHITE))
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
