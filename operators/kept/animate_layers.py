"""Animate Dents: keyframes that let kept presses come one after the other."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ..layer import layers
from ..reporting.translated import reported
from ..scene import curves
from .layer_operator import OnLayers

FRAMES_A_DENT = 12


class PALPATE_OT_animate_layers(OnLayers, bpy.types.Operator):
    bl_idname = "palpate.animate_layers"
    bl_label = "Animate Dents"
    bl_description = (
        "Let the dents come one after the other from the current frame on, by keyframes of their "
        "strengths. The file plays and renders without Palpate"
    )
    bl_options = {"REGISTER", "UNDO"}

    frames: bpy.props.IntProperty(
        name="Frames",
        description="Frames that each dent takes to come",
        default=FRAMES_A_DENT,
        min=1,
        soft_max=250,
    )

    def act(self, context: bpy.types.Context) -> None:
        thing, scene = context.object, context.scene
        first = frame = scene.frame_current
        still = [
            layer
            for layer in layers.kept_of(thing)
            if not curves.is_animated(thing, layers.strength_path(layer))
        ]
        if not still:
            raise PalpateError(
                "{name}: all its dents are animated; change their keyframes in the Dope Sheet",
                name=thing.name,
            )
        for layer in still:
            full, path = layers.strength(layer), layers.strength_path(layer)
            for value, at in ((0.0, frame), (full, frame + self.frames)):
                layers.set_strength(thing, layer, value)
                thing.keyframe_insert(path, frame=at)
            frame += self.frames
        scene.frame_end = max(scene.frame_end, frame)
        # Where all of them are seen.
        scene.frame_set(frame)
        self.report(
            {"INFO"},
            reported("{name}: frames {first} to {last}", name=thing.name, first=first, last=frame),
        )


classes = (PALPATE_OT_animate_layers,)
