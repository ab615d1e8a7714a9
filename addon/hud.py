"""Force, depth, state and keys, in the lower left of the view."""

import re
from dataclasses import dataclass, replace

import blf
import bpy
import gpu
from gpu_extras.batch import batch_for_shader

from ..operators.press_session import PressSession
from ..operators.press_state import Phase, Source
from ..operators.servo_words import Signal, standing
from .reading import reading

Color = tuple[float, float, float, float]

FONT = 0
MARGIN, PADDING, NARROWEST, BADGE_PADDING = 20, 14, 150, 8
LARGE, BADGE, NORMAL, SMALL = 26, 20, 14, 12
LINE = 1.5
WHITE, GREY, WARNING = (1.0, 1.0, 1.0, 1.0), (0.8, 0.8, 0.8, 1.0), (1.0, 0.72, 0.2, 1.0)
BLACK = (0.0, 0.0, 0.0, 1.0)
BACKGROUND = (0.05, 0.05, 0.06, 0.72)

# Grey: no force. Green: it may come. Orange: it is there. Yellow: it comes back. Red: a fault.
FILLS = {
    Signal.OFF: (0.62, 0.62, 0.62, 1.0),
    Signal.WAITING: (0.62, 0.62, 0.62, 1.0),
    Signal.READY: (0.35, 0.78, 0.35, 1.0),
    Signal.FORCE: (1.0, 0.58, 0.15, 1.0),
    Signal.RETURNING: (0.98, 0.85, 0.25, 1.0),
    Signal.FAULT: (0.95, 0.3, 0.3, 1.0),
}

# A word with what belongs to it (keys have two spaces behind them), and the space where it may end.
BREAKS = re.compile(r"(\S+(?:  \S+)*)( *)")

STATES = {
    Phase.READY: "Press on the surface and drag",
    Phase.DRAGGING: "Pressing",
    Phase.HOLDING: "Held: look around, keep it, or press elsewhere",
}
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
    """A line of the HUD; ``fill`` is the colour behind it, for what must be seen at a glance."""

    text: str
    size: float
    color: Color
    fill: Color | None = None


def draw(context: bpy.types.Context, session: PressSession) -> None:
    """Draw the HUD of a press in the region that is being drawn."""
    scale = context.preferences.system.ui_scale
    left = _covered(context, "TOOLS", "LEFT") + MARGIN * scale
    padding = PADDING * scale
    right = context.region.width - _covered(context, "UI", "RIGHT") - MARGIN * scale
    # In a view that has no room even for words, they are cut rather than broken into letters.
    width = max(NARROWEST * scale, right - left - 2 * padding)
    lines = [
        replace(line, text=part, size=line.size * scale)
        for line in _lines(context, session)
        for part in _wrapped(line.text, line.size * scale, width)
    ]
    heights = [line.size * LINE for line in lines]
    widths = [_width(line.text, line.size) for line in lines]
    bottom = MARGIN * scale
    _rectangle(left, bottom, max(widths) + 2 * padding, sum(heights) + 2 * padding, BACKGROUND)
    y = bottom + padding + sum(heights)
    for line, height, across in zip(lines, heights, widths, strict=True):
        y -= height
        if line.fill is not None:
            beside = BADGE_PADDING * scale
            _rectangle(left + padding - beside, y, across + 2 * beside, height, line.fill)
        blf.size(FONT, line.size)
        blf.color(FONT, *line.color)
        blf.position(FONT, left + padding, y + 0.28 * height, 0)
        blf.draw(FONT, line.text)


def _lines(context: bpy.types.Context, session: PressSession) -> list[Line]:
    """What the HUD says, from the top."""
    figures = reading(session)
    phase, say = _phase(session, touching=figures.touching), bpy.app.translations.pgettext_iface
    force = Line(f"{figures.force:.3f} N     {1000 * figures.depth:.1f} mm", LARGE, WHITE)
    if session.state.source is Source.DEVICE:
        switch = "Space  Force Off" if session.state.force_on else "Space  Force On"
        keys = f"{say(switch)}      {say(KEYS.get(phase, ''))}"
        return [*_device_lines(session, force), Line(keys, SMALL, GREY)]
    above = phase is Phase.DRAGGING and not figures.touching
    lines = [force, Line(say(ABOVE if above else STATES.get(phase, "")), NORMAL, WHITE)]
    if session.state.message:
        lines.append(Line(say(session.state.message), NORMAL, WARNING))
    return [*lines, Line(say(KEYS.get(phase, "")), SMALL, GREY)]


def _device_lines(session: PressSession, force: Line) -> list[Line]:
    """Whether the motors push, first of all, and why."""
    say, snapshot = bpy.app.translations.pgettext_iface, session.snapshot
    if snapshot is None:
        return [Line(say("Starting"), NORMAL, WHITE)]
    now = standing(snapshot)
    fault = now.signal is Signal.FAULT
    lines = [Line(say(now.word), BADGE, BLACK, FILLS[now.signal])]
    if not session.awaits_device and not fault:
        lines.append(force)
    if now.why:
        lines.append(Line(say(now.why), NORMAL, WARNING if fault else WHITE))
    if now.signal in {Signal.FORCE, Signal.RETURNING}:
        given = sum(component**2 for component in snapshot.output_force) ** 0.5
        lines.append(Line(f"{say('The device gives')} {given:.3f} N", NORMAL, WHITE))
    if now.limit:
        lines.append(Line(say(now.limit), NORMAL, WARNING))
    if session.state.message and session.state.phase is not Phase.LOST:
        lines.append(Line(say(session.state.message), NORMAL, WARNING))
    return lines


def _phase(session: PressSession, *, touching: bool) -> Phase:
    """Where the press stands for the user: a probe let go in the air presses nothing yet."""
    phase = session.state.phase
    return Phase.READY if phase is Phase.HOLDING and not touching else phase


def _width(text: str, size: float) -> float:
    blf.size(FONT, size)
    return blf.dimensions(FONT, text)[0]


def _wrapped(text: str, size: float, width: float) -> list[str]:
    """The text on lines that fit ``width`` pixels; words stay whole where they fit at all."""
    if _width(text, size) <= width:
        return [text]
    lines = [""]
    for word, space in BREAKS.findall(text):
        # A script without spaces may break anywhere.
        pieces = [word] if _width(word, size) <= width else list(word)
        for piece in pieces:
            if lines[-1].strip() and _width(lines[-1] + piece, size) > width:
                lines.append("")
            lines[-1] += piece
        lines[-1] += space
    return [line.strip() for line in lines]


def _covered(context: bpy.types.Context, kind: str, side: str) -> float:
    """Pixels of the view that a region of this kind lies upon at its left or right."""
    overlap = context.preferences.system.use_region_overlap
    return sum(
        region.width
        for region in context.area.regions
        if overlap and region.type == kind and region.width > 1 and region.alignment == side
    )


def _rectangle(x: float, y: float, width: float, height: float, color: Color) -> None:
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    batch = batch_for_shader(shader, "TRIS", {"pos": corners}, indices=[(0, 1, 2), (0, 2, 3)])
    gpu.state.blend_set("ALPHA")
    shader.bind()
    shader.uniform_float("color", color)
    batch.draw(shader)
    gpu.state.blend_set("NONE")
