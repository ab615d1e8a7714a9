"""Random events at soft objects: whatever comes, the meshes stay, and nothing is left running.

What comes is drawn by lot from a seed; when it comes depends on how quickly Blender draws, so that
a storm is alike when it is repeated, but not the same. Events come in gusts, several between two
frames, as of a hand that is quicker than the screen: what a storm takes is mostly drawing.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Callable, Iterator

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mouse_scene import BACK, mouse, own_copy
from stage import MODULE, Pixel, Stage, Wait

from bl_ext.user_default.palpate.operators.bake import bake_session
from bl_ext.user_default.palpate.operators.layer import layers, live_layer
from bl_ext.user_default.palpate.operators.session import press_session

KEYS = ("RET", "ESC", "ONE", "TWO", "PERIOD", "MINUS", "BACK_SPACE", "F", "N", "T", "G", "R")
TOOLS = ("palpate.tool", "palpate.tool", "palpate.tool", "builtin.select_box", "builtin.move")
MODES = ("EDIT", "SCULPT", "OBJECT")
STROKES = ("PUSH", "GRAB", "TWIST", "PINCH")
# Most of what comes are moves of the pointer, near the object.
SPREAD_PIXELS, ASIDE = 90.0, 0.2
# At the edges of the view Blender takes drags to join and split its areas.
EDGE_PIXELS = 30
# A mouse tells of up to a thousand moves a second, and a screen shows sixty frames.
MOST_IN_A_GUST = 64
EVENTS_A_LINE = 500


class Storm:
    """Events by lot; ``counts`` says of each kind how many came."""

    def __init__(self, stage: Stage, seed: int) -> None:
        self.stage = stage
        self.rng = np.random.default_rng(seed)
        self.counts: Counter[str] = Counter()
        self.held = False
        self.kinds: dict[Callable[[], None], float] = {
            self.move: 45.0,
            self.button: 20.0,
            self.wheel: 4.0,
            self.key: 10.0,
            self.undo: 4.0,
            self.redo: 3.0,
            self.press: 4.0,
            self.pinch: 2.0,
            self.tool: 2.0,
            self.mode: 1.5,
            self.make_soft: 0.5,
            self.choose: 1.0,
            self.save: 0.5,
            self.reload: 0.5,
        }

    def rage(self, count: int) -> Wait:
        """Send so many events, in gusts."""
        kinds = list(self.kinds)
        weights = np.array(list(self.kinds.values()))
        gust, turned = 0, False
        lot = self.rng.choice(len(kinds), count, p=weights / weights.sum())
        for sent, number in enumerate(lot, 1):
            kind = kinds[number]
            # What was sent to one file or mode is not for the next; undo may change the mode, too.
            if gust <= 0 or turned or kind in (self.mode, self.reload):
                yield 0.0
                gust = int(self.rng.integers(1, MOST_IN_A_GUST))
            # Elsewhere clicks and keys are there to change the mesh.
            if bpy.context.mode != "OBJECT":
                kind = self.leave_mode
            gust -= 1
            turned = kind in (self.undo, self.redo, self.mode, self.leave_mode)
            self.counts[kind.__name__] += 1
            kind()
            if sent % EVENTS_A_LINE == 0:
                print(f"storm: {sent:,} events {bpy.context.mode} {self.others()}", flush=True)
        yield 0.0

    def move(self) -> None:
        self.send("MOUSEMOVE", "NOTHING", self.place())

    def button(self) -> None:
        self.held = not self.held
        shift = bool(self.rng.random() < 0.2)
        value = "PRESS" if self.held else "RELEASE"
        self.send("LEFTMOUSE", value, self.place(), shift=shift)

    def wheel(self) -> None:
        self.send(self.one_of(("WHEELUPMOUSE", "WHEELDOWNMOUSE")), "PRESS")

    def key(self) -> None:
        self.type(self.one_of(KEYS))

    def undo(self) -> None:
        self.type("Z", ctrl=True)

    def redo(self) -> None:
        self.type("Z", ctrl=True, shift=True)

    def press(self) -> None:
        self.call(lambda: bpy.ops.palpate.press("INVOKE_DEFAULT"))

    def pinch(self) -> None:
        self.call(lambda: bpy.ops.palpate.pinch("INVOKE_DEFAULT"))

    def make_soft(self) -> None:
        self.call(lambda: bpy.ops.palpate.make_soft("INVOKE_DEFAULT"))

    def tool(self) -> None:
        name, stroke = self.one_of(TOOLS), self.one_of(STROKES)
        self.call(lambda: bpy.ops.wm.tool_set_by_id(name=name))
        bpy.context.scene.palpate.stroke = stroke

    def mode(self) -> None:
        """Change the mode, as a key would: not while a transform or the like has the keys."""
        mode = self.one_of(MODES)
        if not self.others():
            self.call(lambda: bpy.ops.object.mode_set(mode=mode))

    def leave_mode(self) -> None:
        """Back to Object Mode; what runs there is ended first."""
        if self.others():
            # Some end by this, some by that; nothing is held any more.
            self.type("ESC")
            self.held = False
            self.send("LEFTMOUSE", "RELEASE")
        else:
            self.call(lambda: bpy.ops.object.mode_set(mode="OBJECT"))

    def others(self) -> list[str]:
        """Modal operators that run and are not Palpate's."""
        running = (one.bl_idname for one in self.stage.window.modal_operators)
        return [name for name in running if not name.startswith("PALPATE")]

    def choose(self) -> None:
        things = [thing for thing in bpy.context.scene.objects if thing.type == "MESH"]
        bpy.context.view_layer.objects.active = things[int(self.rng.integers(len(things)))]

    def save(self) -> None:
        self.call(bpy.ops.wm.save_mainfile)

    def reload(self) -> None:
        """Open the file again, as it was saved last; what is held is let go."""
        self.held = False
        self.call(lambda: bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath))

    def place(self) -> Pixel:
        """A place in the view, mostly near the object."""
        region = self.stage.region("WINDOW")
        if self.rng.random() < ASIDE:
            x, y = self.rng.uniform(size=2) * (region.width, region.height)
            x, y = x + region.x, y + region.y
        else:
            x, y = np.array(self.seen()) + self.rng.normal(scale=SPREAD_PIXELS, size=2)
        left, low = region.x + EDGE_PIXELS, region.y + EDGE_PIXELS
        right, high = region.x + region.width, region.y + region.height
        return (
            float(np.clip(x, left, right - EDGE_PIXELS)),
            float(np.clip(y, low, high - EDGE_PIXELS)),
        )

    def type(self, kind: str, **held: bool) -> None:
        self.send(kind, "PRESS", **held)
        self.send(kind, "RELEASE")

    def seen(self) -> Pixel:
        """Where the object is drawn; the middle of the view where that has turned away."""
        region = self.stage.region("WINDOW")
        view = self.stage.area.spaces.active.region_3d
        found = location_3d_to_region_2d(region, view, BACK)
        if found is None:
            return (region.x + region.width / 2, region.y + region.height / 2)
        return (region.x + found.x, region.y + found.y)

    def send(self, kind: str, value: str, at: Pixel | None = None, **held: bool) -> None:
        """Send an event, which Blender handles before it draws again."""
        if at is not None:
            self.stage.mouse = at
        x, y = (round(coordinate) for coordinate in self.stage.mouse)
        self.stage.window.event_simulate(type=kind, value=value, x=x, y=y, **held)

    def call(self, operator: Callable[[], object]) -> None:
        """Call an operator in the view; one may refuse, by a message."""
        try:
            with self.stage.view():
                operator()
        except RuntimeError as refusal:
            # An exception within an operator comes as such an error, too, with its traceback.
            if "Traceback" in str(refusal):
                raise
            self.counts["refused"] += 1

    def one_of(self, things: tuple[str, ...]) -> str:
        return things[int(self.rng.integers(len(things)))]


def storm(stage: Stage, seed: int, count: int) -> Wait:
    """Send random events to two soft objects that share a mesh, then look at what is left."""
    stage.open_scene(own_copy(stage))
    yield 0.5
    stage.area.spaces.active.shading.show_cavity = False
    twin = mouse().copy()
    twin.location.x += 0.12
    bpy.context.collection.objects.link(twin)
    bpy.context.view_layer.objects.active = mouse()
    bpy.ops.wm.save_mainfile()
    bpy.ops.ed.undo_push(message="Before the storm")
    yield
    before, handlers = _meshes(), list(_handlers())
    events = Storm(stage, seed)
    events.call(lambda: bpy.ops.wm.tool_set_by_id(name=TOOLS[0]))
    try:
        yield from events.rage(count)
    finally:
        stage.note(seed=seed, events=dict(events.counts))
    yield from _calm(stage)
    kept = sum(len(layers.layers_of(thing)) for thing in bpy.data.objects if thing.type == "MESH")
    stage.note(kept_layers=kept)
    now = _meshes()
    assert now == before, [name for name in before if now.get(name) != before[name]]
    assert press_session.current() is None
    assert bake_session.current() is None
    assert not [thing.name for thing in bpy.data.objects if _is_pressed(thing)]
    running = [one.bl_idname for one in stage.window.modal_operators]
    assert not [name for name in running if name.startswith("PALPATE")], running
    assert list(_handlers()) == handlers
    with stage.view():
        bpy.ops.preferences.addon_disable(module=MODULE)
    left = [name for name in _handlers() if MODULE in name]
    bpy.ops.preferences.addon_enable(module=MODULE)
    assert not left


def _calm(stage: Stage) -> Wait:
    """Let go of everything, and end what runs, as a user would."""
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.key("ESC")
    if bpy.context.mode != "OBJECT":
        with stage.view():
            bpy.ops.object.mode_set(mode="OBJECT")
    for _ in range(4):
        yield from stage.key("ESC")
    yield from stage.until(lambda: press_session.current() is None, "the end of the press")
    yield from stage.until(lambda: bake_session.current() is None, "the end of the bake")


def _is_pressed(thing: bpy.types.Object) -> bool:
    return thing.type == "MESH" and live_layer.find(thing) is not None


def _meshes() -> dict[str, str]:
    """Digest of every coordinate, bit for bit, and of all faces, by the meshes' names."""
    found = {}
    for mesh in bpy.data.meshes:
        if "Carrier" in mesh.name:
            continue
        places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", places)
        corners = np.empty(len(mesh.loops), dtype=np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        found[mesh.name] = hashlib.sha256(places.tobytes() + corners.tobytes()).hexdigest()
    return found


def _handlers() -> Iterator[str]:
    """Application handlers by their kinds, modules and names."""
    for kind in sorted(dir(bpy.app.handlers)):
        listed = getattr(bpy.app.handlers, kind)
        if isinstance(listed, list):
            for handler in listed:
                yield f"{kind} {handler.__module__}.{handler.__name__}"
