"""What a scenario has in hand: the mouse, the keyboard, the viewport and a camera on the screen.

Methods that let time pass are generators, to be called with `yield from`. Positions are pixels of
the Blender window, from its lower left corner. Nothing of Blender is kept across steps: everything
is looked up anew, since files are loaded and undone meanwhile.
"""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager
from itertools import pairwise
from pathlib import Path

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d

MODULE = "bl_ext.user_default.palpate"
# Against hanging only: a wait takes some seconds, and many times that on a busy machine.
LONGEST_WAIT_SECONDS = 150.0
# A little less than the side of the smallest button.
BUTTON_PIXELS = 16
Wait = Generator[float | None, None, None]
Pixel = tuple[float, float]


def at_length(scenario: Callable[[Stage], Wait]) -> Callable[[Stage], Wait]:
    """Leave a scenario to `make test-all`: it takes long, and shorter ones keep near promises."""
    return scenario


class Stage:
    """One scenario's hands and eyes."""

    def __init__(
        self,
        repository: Path,
        output: Path,
        files: Path,
        scenario: str,
        arguments: tuple[str, ...] = (),
    ) -> None:
        self.repository = repository
        self.arguments = arguments
        """What the scenario was called with."""
        self.output = output
        """Where pictures are kept."""
        self.files = files
        """A folder of this Blender's own for what a scenario saves."""
        self.scenario = scenario
        self.pictures: list[str] = []
        self.figures: dict[str, object] = {}
        self.mouse: Pixel = (0.0, 0.0)
        """Where the mouse was last."""

    # ---- what there is

    @property
    def window(self) -> bpy.types.Window:
        """Blender's window."""
        return bpy.context.window_manager.windows[0]

    @property
    def area(self) -> bpy.types.Area:
        """The largest 3D viewport."""
        views = [area for area in self.window.screen.areas if area.type == "VIEW_3D"]
        return max(views, key=lambda area: area.width * area.height)

    def region(self, kind: str = "WINDOW") -> bpy.types.Region:
        """Return a region of the viewport: `WINDOW`, the `UI` sidebar, ..."""
        return next(region for region in self.area.regions if region.type == kind)

    def view(self) -> AbstractContextManager[None]:
        """Let operators act in the viewport: `with stage.view(): bpy.ops...`."""
        return bpy.context.temp_override(
            window=self.window, area=self.area, region=self.region("WINDOW")
        )

    def pixel(self, point: Sequence[float]) -> Pixel:
        """Return where a point of the world (metres, scene units) is drawn in the window."""
        region = self.region("WINDOW")
        seen = location_3d_to_region_2d(region, self.area.spaces.active.region_3d, point)
        assert seen is not None, f"{point} is behind the view"
        return (region.x + seen.x, region.y + seen.y)

    # ---- what a user does

    def open_scene(self, path: str) -> None:
        """Open a .blend file, by its path in the repository."""
        with bpy.context.temp_override(window=self.window):
            bpy.ops.wm.open_mainfile(filepath=str(self.repository / path))

    def open_sidebar(self, tab: str) -> Wait:
        """Open the viewport's sidebar at a tab; fails when there is no such tab."""
        self.area.spaces.active.show_region_ui = True
        yield
        yield
        # Blender accepts only the name of a tab that it has.
        self.region("UI").active_panel_category = tab
        yield

    def event(self, kind: str, value: str, at: Pixel, **held: bool) -> Wait:
        """Send one event of the mouse or keyboard, with `shift`, `ctrl` or `alt` held or not."""
        x, y = (round(coordinate) for coordinate in at)
        self.window.event_simulate(type=kind, value=value, x=x, y=y, **held)
        self.mouse = at
        yield 0.02

    def move(self, to: Pixel, **held: bool) -> Wait:
        """Move the mouse without pressing anything."""
        yield from self.event("MOUSEMOVE", "NOTHING", to, **held)

    def click(self, at: Pixel, button: str = "LEFTMOUSE") -> Wait:
        """Click a mouse button somewhere."""
        yield from self.move(at)
        yield from self.event(button, "PRESS", at)
        yield from self.event(button, "RELEASE", at)

    def drag(
        self,
        path: Sequence[Pixel],
        button: str = "LEFTMOUSE",
        *,
        steps: int = 10,
        release: bool = True,
        **held: bool,
    ) -> Wait:
        """Press a button at the first position, move through the others, let go at the last.

        Each stretch is walked in `steps` moves. With `release=False` the button stays down; end it
        with `yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)`.
        """
        yield from self.move(path[0])
        yield from self._modifiers("PRESS", held)
        yield from self.event(button, "PRESS", path[0], **held)
        for (x0, y0), (x1, y1) in pairwise(path):
            for step in range(1, steps + 1):
                part = step / steps
                yield from self.move((x0 + part * (x1 - x0), y0 + part * (y1 - y0)), **held)
        if release:
            yield from self.event(button, "RELEASE", path[-1], **held)
        yield from self._modifiers("RELEASE", held)

    def key(self, kind: str, **held: bool) -> Wait:
        """Type a key (`RET`, `ESC`, `Z`, `WHEELUPMOUSE`, ...) with the mouse where it is."""
        yield from self._modifiers("PRESS", held)
        yield from self.event(kind, "PRESS", self.mouse, **held)
        yield from self.event(kind, "RELEASE", self.mouse, **held)
        yield from self._modifiers("RELEASE", held)

    def _modifiers(self, value: str, held: dict[str, bool]) -> Wait:
        """Press or release shift, ctrl or alt: Blender holds them until it sees them released."""
        for name in held:
            down = held if value == "PRESS" else {}
            yield from self.event(f"LEFT_{name.upper()}", value, self.mouse, **down)

    def button(
        self, area: bpy.types.Area, kind: str, command: str
    ) -> Generator[float, None, Pixel]:
        """Find the button with a Python command (the start of it) in an area's region of a kind.

        The pointer goes over the region, and Blender tells whose button is under it.
        """
        region = next(one for one in area.regions if one.type == kind)
        for at in _line(region):
            yield from self.move(at)
            with bpy.context.temp_override(window=self.window, area=area, region=region):
                if not bpy.ops.ui.copy_python_command_button.poll():
                    continue
                bpy.ops.ui.copy_python_command_button()
            if bpy.context.window_manager.clipboard.startswith(command):
                return at
        raise AssertionError(f"{command} has no button in the {kind} of {area.type}")

    # ---- what a user sees

    def until(
        self, condition: Callable[[], object], what: str, longest: float = LONGEST_WAIT_SECONDS
    ) -> Wait:
        """Wait until a condition holds; fail with `what` was awaited when it never does."""
        end = time.monotonic() + longest
        while not condition():
            assert time.monotonic() < end, f"waited {longest:g} s in vain for {what}"
            yield 0.02

    def picture(self, name: str) -> Wait:
        """Draw everything, then keep a picture of the screen as build/gui/SCENARIO-NAME.png."""
        yield
        yield
        self.photograph(name)

    def photograph(self, name: str) -> None:
        """Keep a picture of the screen as it is at this moment."""
        path = self.output / f"{self.scenario.replace('::', '-')}-{name}.png"
        subprocess.run(["import", "-window", "root", str(path)], check=True)
        self.pictures.append(str(path))

    def note(self, **figures: object) -> None:
        """Keep figures for the report."""
        self.figures.update(figures)


def _line(region: bpy.types.Region) -> Iterator[Pixel]:
    """Places along a header, or down a toolbar, so close together that every button has one."""
    if region.width > region.height:
        middle = region.y + region.height // 2
        yield from ((x, middle) for x in range(region.x, region.x + region.width, BUTTON_PIXELS))
    else:
        middle, top = region.x + region.width // 2, region.y + region.height
        yield from ((middle, y) for y in range(top, region.y, -BUTTON_PIXELS))
