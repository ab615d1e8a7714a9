"""Coarse body of an object, to press while its own is baked; in memory only, and taken back."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...core.bake.job import BakeJob
from ...core.bake.preview.preview import preview
from ...core.bake.settings import BakeSettings
from ...core.errors import PalpateError
from ..carrier import carrier
from ..scene.drawn_surface import DrawnSurface
from ..scene.fingerprint import Fingerprint
from ..scene.object_handle import ObjectHandle
from . import baked_record, body_store, kept_body


@dataclass(eq=False)
class PreviewBody:
    """Preview of an object, baked in a child process. Make one with :func:`start`.

    Attributes
    ----------
    off : how far the object's surface lies from it at most, as a share of its size.
    key : of the body, once the object has it.
    """

    handle: ObjectHandle
    scene_name: str
    drawn: DrawnSurface
    fingerprint: Fingerprint
    job: BakeJob | None
    off: float
    key: str = ""

    def poll(self) -> None:
        """Give the object its preview as soon as that is baked."""
        if self.job is None or not self.job.finished:
            return
        job, self.job = self.job, None
        thing, scene = self.handle.find(), bpy.data.scenes.get(self.scene_name)
        if thing is None or scene is None or thing.mode != "OBJECT" or thing.palpate.body_key:
            job.close()
            return
        with tempfile.TemporaryDirectory(prefix="palpate-preview-") as folder:
            body, _ = job.result(Path(folder) / "preview.npz")
        baked_record.record_body(thing, body, "", self.fingerprint)
        baked = thing.palpate
        baked.baked_edge_length = baked.baked_epsilon = 0.0
        baked.preview_off = self.off
        carrier.give(thing, scene, self.drawn)
        self.key = body.key
        kept_body.keep_unsaved(body)

    def end(self) -> None:
        """Stop the child process, and take the preview back where the object still has it."""
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
    python: tuple[str, ...],
) -> PreviewBody | None:
    """Start to bake a preview; None where cells are too coarse for the object and its pins."""
    try:
        coarse = preview(drawn.surface(), settings)
    except PalpateError:
        # The bake itself says what is wrong, if anything is.
        return None
    job = BakeJob(coarse.mesh, coarse.settings, python=python)
    return PreviewBody(ObjectHandle.of(thing), scene.name, drawn, fingerprint, job, coarse.off)
