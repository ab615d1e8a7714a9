"""Force, depth, state and keys, in the lower left of the view."""

import re

import blf
import bpy
import gpu
from gpu_extras.batch import batch_for_shader

from ..operators.press_session import PressSession
from ..operators.press_state import Phase
from .reading import reading

Color = tuple[float, float, float, float]

FONT = 0
MARGIN, PADDING, NARROWEST = 20, 14, 150
LARGE, NORMAL, SMALL = 26, 14, 12
LINE = 1.5
WHITE, GREY, WARNING = (1.0, 1.0, 1.0, 1.0), (0.8, 0.8, 0.8, 1.0), (1.0, 0.72, 0.2, 1.0)
BACKGROUND = (0.05, 0.05, 0.06, 0.72)

# A word with what belongs to it (keys have two spaces behind them), and the space where it may end.
BREAKS = re.compile(r"(\S+(?:  \S+)*)( *)")

STATES = {
    Phase.READY: "Press on the surface and drag",
    Phase.DRAGGING: "Pressing",
    Phase.HOLDING: "Held: look around, keep it, or press elsewhere",
    Phase.FEELING: "The device presses",
    Phase.LOST: "Device away",
}
ABOVE = "Above the surface: drag inward, or turn the wheel"
WAITING = "Waiting for the device: check its port, cable and power"
KEYS = {
    Phase.READY: "Esc  Leave",
    Phase.DRAGGING: "Wheel  Deeper",
    Phase.HOLDING: "Enter  Keep shape      Esc  Restore",
    Phase.FEELING: "Enter  Keep shape      Esc  Restore",
    Phase.LOST: "Esc  Leave",
}


def draw(context: bpy.types.Context, session: PressSession) -> None:
    """Draw the HUD of a press in the region that is being drawn."""
    scale = context.preferences.system.ui_scale
    left = _covered(context, "TOOLS", "LEFT") + MARGIN * scale
    padding = PADDING * scale
    right = context.region.width - _covered(context, "UI", "RIGHT") - MARGIN * scale
    # In a view that has no room even for words, they are cut rather than broken into letters.
    width = max(NARROWEST * scale, right - left - 2 * padding)
    lines = [
        (part, size, color)
        for text, size, color in _lines(context, session)
        for part in _wrapped(text, size * scale, width)
    ]
    heights = [size * scale * LINE for _, size, _ in lines]
    widths = [_width(text, size * scale) for text, size, _ in lines]
    bottom = MARGIN * scale
    _rectangle(left, bottom, max(widths) + 2 * padding, sum(heights) + 2 * padding)
    y = bottom + padding + sum(heights)
    for (text, size, color), height in zip(lines, heights, strict=True):
        y -= height
        blf.size(FONT, size * scale)
        blf.color(FONT, *color)
        blf.position(FONT, left + padding, y + 0.28 * height, 0)
        blf.draw(FONT, text)


def _lines(context: bpy.types.Context, session: PressSession) -> list[tuple[str, float, Color]]:
    """Text, size and colour of each line, from the top."""
    figures = reading(session)
    phase, say = _phase(session, touching=figures.touching), bpy.app.translations.pgettext_iface
    snapshot = session.snapshot
    lines: list[tuple[str, float, Color]] = [
        (f"{figures.force:.3f} N     {1000 * figures.depth:.1f} mm", LARGE, WHITE)
    ]
    if phase is Phase.LOST:
        lines.append((say(session.state.message), NORMAL, WARNING))
    else:
        above = phase is Phase.DRAGGING and not figures.touching
        text = WAITING if session.awaits_device else ABOVE if above else STATES.get(phase, "")
        lines.append((say(text), NORMAL, WHITE))
        if session.state.message:
            lines.append((say(session.state.message), NORMAL, WARNING))
    if phase is Phase.FEELING and snapshot is not None:
        given = sum(component**2 for component in snapshot.output_force) ** 0.5
        state = snapshot.reason or snapshot.state
        text = f"{say('The device gives')} {given:.3f} N, {say(state)}"
        lines.append((text, SMALL, GREY))
    lines.append((say(KEYS.get(phase, "")), SMALL, GREY))
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


def _rectangle(x: float, y: float, width: float, height: float) -> None:
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    batch = batch_for_shader(shader, "TRIS", {"pos": corners}, indices=[(0, 1, 2), (0, 2, 3)])
    gpu.state.blend_set("ALPHA")
    shader.bind()
    shader.uniform_float("color", BACKGROUND)
    batch.draw(shader)
    gpu.state.blend_set("NONE")
