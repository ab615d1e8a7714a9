"""Bake Animation: a tool that is animated presses frame by frame, and the file plays by itself."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import bpy

from ...core.errors import PalpateError
from ...core.files.atomic_file import refuse_unwritable
from ...core.sentence import Sentence
from ..imprint import kept_imprint
from ..lying.together import together
from ..object.drawn_body import DrawnBody, open_body
from ..press.modal_press import Pressing
from ..reporting.translated import reported, shown
from ..reporting.wait_cursor import wait_cursor
from ..rest.keyed import refuse_others
from ..scene.modal_progress import ModalProgress
from ..traction.drawn_traction import patches_of, tractions_of
from . import frame_keys
from .all_frames import all_frames
from .force_table import FrameRows
from .frames.piled_frames import refuse_moving
from .frames.pressed_frames import PressedFrame
from .keeping import ITEMS, Baking, collected
from .keeping_all import keep_all

MOST_KEYS = 2000
# Seconds of pressing between two looks at the keyboard.
SLICE_SECONDS = 0.05


class PALPATE_OT_press_frames(Pressing, bpy.types.Operator):
    bl_idname = "palpate.press_frames"
    bl_label = "Bake Animation"
    bl_description = (
        "Let the animated tool press through the frames of the scene, and keep what it does so "
        "that it plays by itself. Escape cancels, and nothing is changed"
    )
    bl_options = {"REGISTER", "UNDO"}

    frame_start: bpy.props.IntProperty(
        name="First Frame",
        description="Where it begins; -1 is the scene's first",
        default=-1,
        options={"SKIP_SAVE"},
    )
    frame_end: bpy.props.IntProperty(
        name="Last Frame",
        description="Where it ends; -1 is the scene's last",
        default=-1,
        options={"SKIP_SAVE"},
    )
    step: bpy.props.IntProperty(
        name="Step",
        description="Keep every so many frames; the shape goes straight between them",
        default=1,
        min=1,
    )
    keep: bpy.props.EnumProperty(
        name="Keep As",
        description="What plays the animation",
        items=ITEMS,
        default="CACHE",
    )
    forces: bpy.props.StringProperty(
        name="Forces",
        description="Table (CSV) of force, area, pressure and depth in each frame; empty for none",
        subtype="FILE_PATH",
        # Without it Blender 5.2 crashes where a script gives a path that begins with "//".
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    current_only: bpy.props.BoolProperty(
        name="This Frame Only",
        description="Press up to the current frame and keep only its shape",
    )

    _progress: ModalProgress
    _baking: Baking
    _told: str = ""

    def act(self, context: bpy.types.Context) -> None:
        for _ in self._bake(context):
            pass
        self.report({"INFO"}, reported(self._told))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        return self.guarded(lambda: self._start(context))

    def _start(self, context: bpy.types.Context) -> set[str]:
        self._baking = self._bake(context)
        # What cannot be baked is refused before the operator becomes modal.
        with wait_cursor(context):
            share = next(self._baking, 1.0)
        self._progress = ModalProgress()
        self._progress.begin(self, context, SLICE_SECONDS)
        self._show(context, share)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, reported("The animation was not baked; nothing was changed"))
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        try:
            share = self._go_on()
        except PalpateError as problem:
            self._progress.end(context)
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        except BaseException:
            self._progress.end(context)
            raise
        if share is not None:
            self._show(context, share)
            return {"RUNNING_MODAL"}
        self._progress.end(context)
        self.report({"INFO"}, reported(self._told))
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """End with the operator: another file, or exit."""
        self._baking.close()
        self._progress.end(context)

    def _go_on(self) -> float | None:
        """Press for a while; the share that is done, None at the end."""
        end = time.monotonic() + SLICE_SECONDS
        for share in self._baking:
            if time.monotonic() > end:
                return share
        return None

    def _show(self, context: bpy.types.Context, share: float) -> None:
        self._progress.show(context, f"{shown(self.bl_label)}: {100 * share:.0f} %", share)

    def _bake(self, context: bpy.types.Context) -> Baking:
        """Press all frames, then keep what came of it; nothing is kept if it is closed before."""
        thing, scene, frames = context.object, context.scene, self._frames(context.scene)
        table = Path(bpy.path.abspath(self.forces)) if self.forces else None
        if table is not None:
            refuse_unwritable(table)
        if self.keep == "KEYS" and not self.current_only:
            frame_keys.refuse(thing)
        drawn = open_body(thing, scene)
        things = [thing]
        if drawn.body.is_free:
            things = together(thing, context.selected_objects)
            self._refuse_free(things)
        opened = [drawn, *(open_body(other, scene) for other in things[1:])]
        rows = FrameRows(drawn, scene.render.fps / scene.render.fps_base)
        pressed = all_frames(things, scene, opened, frames, self.step, rows, self._warn)
        if self.current_only:
            yield from self._keep_last(
                thing, scene, drawn, (here for (here,) in pressed), len(frames)
            )
        else:
            yield from keep_all(things, scene, opened, pressed, self.keep, frames, self.step)
            self._told = Sentence(
                "{count} frames, up to {largest:.3g} N",
                count=len(frames),
                largest=rows.largest_force,
            )
        if table is not None:
            rows.write(table)

    def _warn(self, remark: str) -> None:
        self.report({"WARNING"}, reported(remark))

    def _refuse_free(self, things: Sequence[bpy.types.Object]) -> None:
        """Refuse what cannot be kept of objects that nobody holds."""
        refuse_moving(things)
        for thing in things:
            if thing.palpate.pin_mode == "NONE":
                refuse_others(thing)
            if self.keep == "KEYS":
                frame_keys.refuse(thing)
        if self.current_only or self.keep not in {"CACHE", "KEYS"}:
            raise PalpateError(
                "{name}: nothing pins it, and its animation is kept as Mesh Cache or Shape Keys "
                "with keyframes of its place; choose one of these",
                name=things[0].name,
            )

    def _keep_last(
        self,
        thing: bpy.types.Object,
        scene: bpy.types.Scene,
        drawn: DrawnBody,
        pressed: Iterator[PressedFrame],
        count: int,
    ) -> Baking:
        *_, last = yield from collected(pressed, count)
        if last.moved is None:
            raise PalpateError("The tool touches nothing in this frame; choose another")
        borne = tractions_of(thing, drawn, last.moved, patches_of(last.fingers))
        name = kept_imprint.keep_moved(thing, scene, drawn.frame, last.moved, borne)
        self._told = Sentence("Kept as layer '{layer}'", layer=name)

    def _frames(self, scene: bpy.types.Scene) -> list[int]:
        # The redo panel shows which they were.
        if self.frame_start < 0:
            self.frame_start = scene.frame_start
        if self.frame_end < 0:
            self.frame_end = scene.frame_end
        first, last = self.frame_start, self.frame_end
        if self.current_only:
            return list(range(min(first, scene.frame_current), scene.frame_current + 1))
        frames = list(range(first, last + 1, self.step))
        if not frames:
            raise PalpateError(
                "frames: {first} to {last} is none; let the last frame follow the first",
                first=first,
                last=last,
            )
        if self.keep == "KEYS" and len(frames) > MOST_KEYS:
            raise PalpateError(
                "frames: {count} shape keys are more than {most}; take a larger step",
                count=len(frames),
                most=MOST_KEYS,
            )
        return frames


classes = (PALPATE_OT_press_frames,)
