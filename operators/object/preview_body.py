"""Coarse body of an object, to press while its own is baked; in memory only, and taken back."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ...core.bake.preview_job import PreviewJob
from ...core.bake.settings import BakeSettings
from ..carrier import carrier
from ..scene.drawn_surface import DrawnSurface
from ..scene.fingerprint import Fingerprint
from ..scene.object_handle import ObjectHandle
from . import baked_record, body_store, kept_body


@dataclass(eq=False)
class PreviewBody:
    """Preview of an object, baked in the background. Make one with :func:`start`.

    Attributes
    ----------
    off : how far the object's surface lies from it at most, as a share of its size; 0 until the
        object has it.
    key : of the body, once the object has it.
    """

    handle: ObjectHandle
    scene_name: str
    drawn: DrawnSurface
    fingerprint: Fingerprint
    job: PreviewJob | None
    off: float = 0.0
    key: str = ""

    def poll(self) -> None:
        """Give the object its preview as soon as that is baked."""
        if self.job is None or not self.job.finished:
            return
        made, self.job = self.job.result(), None
        thing, scene = self.handle.find(), bpy.data.scenes.get(self.scene_name)
        if made is None or thing is None or scene is None:
            return
        if thing.mode != "OBJECT" or thing.palpate.body_key:
            return
        body = made.body
        baked_record.record(thing, body, "", self.fingerprint)
        baked = thing.palpate
        baked.baked_edge_length = baked.baked_epsilon = 0.0
        self.off = baked.preview_off = made.off
        carrier.give(thing, scene, self.drawn)
        self.key = body.key
        kept_body.keep_unsaved(body)

    def end(self) -> None:
        """Give up the bake, and take the preview back where the object still has it."""
        if self.job is not None:
            self.job.close()
            self.job = None
        thing = self.handle.find()
        if thing is not None and self.key and thing.palpate.body_key == self.key:
            body_store.forget(thing)
            carrier.take_unused(thing)
        kept_body.drop_unsaved()


def start(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    drawn: DrawnSurface,
    fingerprint: Fingerprint,
    settings: BakeSettings,
) -> PreviewBody:
    """Start to bake a preview; there comes none where cells are too coarse for the object."""
    job = PreviewJob(drawn.surface(), settings)
    return PreviewBody(ObjectHandle.of(thing), scene.name, drawn, fingerprint, job)
