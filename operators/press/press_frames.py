"""Press Along Animation: a tool that is animated presses frame by frame, without a clock.

Every frame's shape becomes a shape key that is at full value in its frame and fades to its
neighbours, so that the file plays and renders without Palpate.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.press import ContactSettings, Press
from ...core.contact.tool.pose import Pose
from ...core.contact.touches import Touch
from ...core.errors import PalpateError
from ...core.shape.meeting import settled
from ...core.shape.shapes import Shape
from ..object.drawn_body import DrawnBody, open_body
from ..reporting.translated import reported
from ..scene.body_frame import BodyFrame
from ..shape.drawn_shape import closing_shape
from ..tool import tool_turn
from ..tool.finger_tip import chosen_tip
from .modal_press import Pressing
from .press_once import keep_shape, loads_of, pressing_tools

Array = NDArray[np.float64]

FRAME_NAME = "Press at"
MOST_FRAMES = 2000


@dataclass(frozen=True, eq=False)
class PressedFrame:
    """Result of a frame: each finger's force (N), and the displacements (n, 3), None if free."""

    frame: int
    fingers: tuple[Touch, ...]
    displacements: Array | None


class PALPATE_OT_press_frames(Pressing, bpy.types.Operator):
    bl_idname = "palpate.press_frames"
    bl_label = "Press Along Animation"
    bl_description = (
        "Let the animated tool press through the frames of the scene, and keep every frame's shape "
        "as a shape key that plays by itself. Escape is not heeded meanwhile; undo takes it back"
    )
    bl_options = {"REGISTER", "UNDO"}

    frame_start: bpy.props.IntProperty(
        name="First Frame", description="Where it begins; -1 is the scene's first", default=-1
    )
    frame_end: bpy.props.IntProperty(
        name="Last Frame", description="Where it ends; -1 is the scene's last", default=-1
    )
    step: bpy.props.IntProperty(
        name="Step",
        description="Keep every so many frames; the shape goes straight between them",
        default=1,
        min=1,
    )
    current_only: bpy.props.BoolProperty(
        name="This Frame Only",
        description="Press up to the current frame and keep only its shape",
    )

    def act(self, context: bpy.types.Context) -> None:
        thing, scene = context.object, context.scene
        frames = self._frames(scene)
        drawn = open_body(thing, scene)
        with _frame_kept(scene), closing_shape(thing, drawn) as shape:
            pressed = list(press_frames(thing, scene, drawn, frames, shape))
        if shape.notice:
            self.report({"WARNING"}, reported(shape.notice))
        touched = [frame for frame in pressed if frame.displacements is not None]
        if not touched:
            raise PalpateError(
                "The tool touches nothing in these frames; move its keyframes to the surface"
            )
        if self.current_only:
            if pressed[-1].displacements is None:
                raise PalpateError("The tool touches nothing in this frame; choose another")
            tools = pressing_tools(pressed[-1].fingers)
            name = keep_shape(thing, drawn, pressed[-1].displacements, tools)
            self.report({"INFO"}, reported("Kept as shape key '{key}'", key=name))
            return
        count = keep_frames(thing, drawn, pressed)
        largest = max(
            float(np.linalg.norm(finger.force)) for frame in touched for finger in frame.fingers
        )
        self.report(
            {"INFO"},
            reported("{count} shape keys, up to {largest:.3g} N", count=count, largest=largest),
        )

    def _frames(self, scene: bpy.types.Scene) -> list[int]:
        first = scene.frame_start if self.frame_start < 0 else self.frame_start
        last = scene.frame_end if self.frame_end < 0 else self.frame_end
        if self.current_only:
            return list(range(min(first, scene.frame_current), scene.frame_current + 1))
        frames = list(range(first, last + 1, self.step))
        if not frames:
            raise PalpateError(
                "frames: {first} to {last} is none; let the last frame follow the first",
                first=first,
                last=last,
            )
        if len(frames) > MOST_FRAMES:
            raise PalpateError(
                "frames: {count} shape keys are more than {most}; take a larger step",
                count=len(frames),
                most=MOST_FRAMES,
            )
        return frames


def press_frames(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    drawn: DrawnBody,
    frames: list[int],
    shape: Shape,
) -> Iterator[PressedFrame]:
    """Lead the scene's tools through these frames, one result each.

    Raises
    ------
    PalpateError
        The finger is a point, or nothing leads it.
    """
    tip = chosen_tip(scene, thing)
    if tip.tool is None:
        raise PalpateError(
            "finger: a point has no shape to press along an animation; choose Fingertip, Plate, "
            "Rod or Mesh"
        )
    guides = leading_objects(scene)
    modulus = thing.palpate.young_modulus
    settings = ContactSettings(modulus, thing.palpate.static_friction)
    press = Press(drawn.body, [tip.tool] * len(guides), settings)
    for frame in frames:
        scene.frame_set(frame)
        touches = press.to([_pose(guide, scene, drawn.frame) for guide in guides])
        loads = loads_of(touches)
        moved = settled(drawn.body, shape, loads, modulus).displacements if loads else None
        yield PressedFrame(frame, touches, moved)


def leading_objects(scene: bpy.types.Scene) -> tuple[bpy.types.Object, ...]:
    """Objects that lead the tools through an animation: the pressing mesh, or the fingers' Empties.

    Raises
    ------
    PalpateError
        Nothing does, or both fingers are led by the same object.
    """
    chosen = scene.palpate
    first = chosen.source_empty
    if chosen.tip == "MESH":
        first = first or chosen.tip_object
    first = first or chosen.turn_object
    if first is None:
        raise PalpateError(
            "finger: nothing leads the tool; choose Press With: Empty and an animated Empty"
        )
    if chosen.second != "EMPTY":
        return (first,)
    if chosen.second_empty is None:
        raise PalpateError("finger: the second finger has no Empty; pick one under Second Finger")
    if chosen.second_empty == first:
        raise PalpateError(
            "finger: both fingers are led by {name}; choose another Empty for one", name=first.name
        )
    return (first, chosen.second_empty)


def keep_frames(thing: bpy.types.Object, drawn: DrawnBody, pressed: list[PressedFrame]) -> int:
    """Keep the frames as shape keys that fade into each other; returns how many."""
    if thing.data.shape_keys is None:
        thing.shape_key_add(name="Basis", from_mix=False)
    _remove_frames(thing)
    count = 0
    for number, here in enumerate(pressed):
        if here.displacements is None:
            continue
        key = thing.shape_key_add(name=f"{FRAME_NAME} {here.frame}", from_mix=False)
        key.relative_key = thing.data.shape_keys.reference_key
        tools = pressing_tools(here.fingers)
        key.points.foreach_set("co", drawn.local_coordinates(here.displacements, tools))
        for other, value in ((number - 1, 0.0), (number, 1.0), (number + 1, 0.0)):
            if 0 <= other < len(pressed):
                key.value = value
                key.keyframe_insert("value", frame=pressed[other].frame)
        count += 1
    _go_straight(thing.data.shape_keys)
    thing.data.update()
    return count


def _remove_frames(thing: bpy.types.Object) -> None:
    """Remove the remains of an earlier press along an animation."""
    keys = thing.data.shape_keys
    for key in [key for key in keys.key_blocks if key.name.startswith(f"{FRAME_NAME} ")]:
        path = f'key_blocks["{key.name}"].value'
        for bag in _bags(keys):
            curve = bag.find(path)
            if curve is not None:
                bag.remove(curve)
        thing.shape_key_remove(key)


def _go_straight(keys: bpy.types.Key) -> None:
    """Values that go in straight lines add up to one between two frames."""
    for curve in (curve for bag in _bags(keys) for curve in bag):
        if curve.data_path.startswith(f'key_blocks["{FRAME_NAME} '):
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"


def _bags(keys: bpy.types.Key) -> list[bpy.types.bpy_prop_collection]:
    """The animation curves of shape keys, in bundles, in files of all Blenders that we know."""
    data = keys.animation_data
    if data is None or data.action is None:
        return []
    if hasattr(data.action, "fcurves"):
        return [data.action.fcurves]
    return [
        bag.fcurves
        for layer in data.action.layers
        for strip in layer.strips
        for bag in strip.channelbags
    ]


@contextmanager
def _frame_kept(scene: bpy.types.Scene) -> Iterator[None]:
    frame = scene.frame_current
    try:
        yield
    finally:
        scene.frame_set(frame)


def _pose(guide: bpy.types.Object, scene: bpy.types.Scene, body: BodyFrame) -> Pose:
    place = body.body_from_world(np.array(guide.matrix_world)[:3, 3])
    turner = tool_turn.guide_of(scene) if scene.palpate.tip_turn == "OBJECT" else None
    return Pose(place, tool_turn.as_object(turner or guide, scene, body))


classes = (PALPATE_OT_press_frames,)
