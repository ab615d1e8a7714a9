"""Recording to Animation: what was pressed by hand becomes an Empty with keyframes."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from ...core.errors import PalpateError
from ...core.record.resampling import Frames, frames_of, touched_part
from ..press.modal_press import Pressing
from ..press.save_recording import NOTHING, recorded, refusal_unrecorded
from ..reporting.translated import reported
from ..scene import curves, drawn_surface
from ..scene.body_frame import BodyFrame
from ..tool.tool_sizes import chosen_sizes

PROBE_NAME = "Palpate Probe"


class PALPATE_OT_animate_recording(Pressing, bpy.types.Operator):
    bl_idname = "palpate.animate_recording"
    bl_label = "Recording to Animation"
    bl_description = (
        "Make an Empty that moves as the recorded finger did, from the current frame on, with its "
        "force and depth as animated properties. It leads the tool of Bake Animation"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        return super().refusal(context) or refusal_unrecorded()

    def act(self, context: bpy.types.Context) -> None:
        thing, scene, kept = context.object, context.scene, recorded()
        if not len(kept.samples):
            raise PalpateError(NOTHING)
        if kept.pressed is not None and kept.pressed.find() != thing:
            raise PalpateError(
                "{pressed} was recorded, not {name}; select that to animate its recording",
                pressed=kept.pressed.name,
                name=thing.name,
            )
        frame = drawn_surface.frame_of(thing, scene)
        if kept.in_world:
            frame = replace(frame, rotation=np.eye(3), stretch=np.eye(3), origin=np.zeros(3))
        rate = scene.render.fps / scene.render.fps_base
        first = scene.frame_current
        made, size, touched = [], drawn_surface.size_of(thing, scene), touched_part(kept.samples)
        for finger in np.unique(touched["finger"])[:2]:
            depths = None if kept.depths is None else kept.depths[:, [0, 1 + finger]]
            frames = frames_of(touched, int(finger), rate, depths)
            made.append(_probe(None if kept.in_world else thing, scene, frame, frames, size))
        # What was recorded was pressed by the finger alone.
        thing.palpate.pressers = None
        chosen = scene.palpate
        chosen.source, chosen.source_empty = "EMPTY", made[0]
        if len(made) > 1:
            chosen.second, chosen.second_empty = "EMPTY", made[1]
        last = first + len(frames.depth) - 1
        scene.frame_end = max(scene.frame_end, last)
        self.report(
            {"INFO"},
            reported("{name}: frames {first} to {last}", name=made[0].name, first=first, last=last),
        )


def _probe(
    parent: bpy.types.Object | None,
    scene: bpy.types.Scene,
    frame: BodyFrame,
    frames: Frames,
    size: float,
) -> bpy.types.Object:
    """Empty that moves as the finger did, with its ``parent`` if it has one, in the frame of that;
    force in world axes. ``size`` of the object, metres.
    """
    probe = bpy.data.objects.new(PROBE_NAME, None)
    scene.collection.objects.link(probe)
    probe.empty_display_type = "SPHERE"
    # In the units of its parent, whose scale it has.
    metres = float(np.cbrt(abs(np.linalg.det(frame.metric))))
    sizes = chosen_sizes(scene, size)
    probe.empty_display_size = sizes.tip_radius / metres
    probe.parent = parent
    force = frame.turn_to_world(frames.force)
    probe["force_N"] = force[0].tolist()
    probe["strength_N"] = 0.0
    probe["depth_m"] = 0.0
    start = scene.frame_current
    curves.key_straight(probe, "location", start, frame.local_from_body(frames.probe))
    curves.key_straight(probe, '["force_N"]', start, force)
    curves.key_straight(probe, '["strength_N"]', start, np.linalg.norm(force, axis=1))
    curves.key_straight(probe, '["depth_m"]', start, frames.depth)
    return probe


classes = (PALPATE_OT_animate_recording,)
