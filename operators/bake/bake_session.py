"""Bake of an object: started, polled, then applied to the object or dropped without remains."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import bpy

from ...core.bake.job import BakeJob, JobProgress
from ...core.bake.steps import BakeReport, BakeSettings
from ...core.body.soft_body import SoftBody
from ...core.errors import CancelledError, PalpateError
from ...core.mesh.surface import Surface
from ...core.sentence import Sentence
from ...core.stiffness.pins import held_at
from ..carrier import body_source, carrier, seen_mesh
from ..carrier.seen_mesh import SeenSurface
from ..layer import live_layer
from ..lying import standing
from ..object import baked_record, body_store, kept_body, preview_body, soft_object
from ..object.embedded_body import embedded
from ..object.mesh_look import shape_size
from ..object.preview_body import PreviewBody
from ..pins import pin_group, stiff_region, unchosen_pins
from ..reporting.acting import Acting
from ..scene.drawn_surface import DrawnSurface
from ..scene.fingerprint import Fingerprint, changed_body
from ..scene.object_handle import ObjectHandle
from ..session import press_session
from . import bake_prediction

SECONDS_BETWEEN_POLLS = 0.05
# A bake up to this long needs no preview. More triangles take longer in any case, and to measure.
QUICK_SECONDS, MOST_TRIANGLES_MEASURED = 2.0, 20_000


@dataclass(eq=False)
class BakeSession:
    """Running bake. Make one with :func:`start`; it is :func:`current` until it ends."""

    handle: ObjectHandle
    scene_uid: int
    surface: DrawnSurface
    fingerprint: Fingerprint
    settings: BakeSettings
    job: BakeJob
    progress: JobProgress
    rebuild: bool
    pins_told: Sentence | None
    preview: PreviewBody | None = None

    def poll(self) -> bool:
        """Update the progress; True when there is a result to :meth:`commit`.

        Raises
        ------
        PalpateError
            Out of time, or cancelled by somebody else; the session has ended.
        """
        if current() is not self:
            raise CancelledError(
                "{name}: the bake was cancelled; nothing was changed", name=self.handle.name
            )
        try:
            self.progress = self.job.poll()
        except PalpateError:
            self.end()
            raise
        if self.preview is not None and not self.awaits_scene:
            try:
                self.preview.poll()
            except PalpateError:
                # The bake goes on without one, and says itself what is wrong with the object.
                self._end_preview()
        return self.job.finished

    @property
    def awaits_mode(self) -> bool:
        """Whether the result waits until the object's mode is left."""
        thing = self.handle.find()
        return thing is not None and thing.mode != "OBJECT"

    @property
    def awaits_press(self) -> bool:
        """Whether the result waits until a press of the preview ends: nothing jumps in the hand."""
        thing = self.handle.find()
        return thing is not None and live_layer.find(thing) is not None

    @property
    def awaits_scene(self) -> bool:
        """Whether the result waits until its scene is shown, with the object evaluated in it."""
        thing, scene = self.handle.find(), self._scene
        if thing is None or scene is None:
            return False
        as_seen = isinstance(self.surface, SeenSurface)
        away = scene != bpy.context.scene
        return away or (as_seen and not seen_mesh.is_evaluated(thing))

    @property
    def can_commit(self) -> bool:
        """Whether the result can be applied now."""
        return not self.awaits_mode and not self.awaits_press and not self.awaits_scene

    @property
    def preview_off(self) -> float:
        """How far a preview that can be pressed is off, as a share of the size; 0 without one."""
        return self.preview.off if self.preview is not None and self.preview.key else 0.0

    def commit(self) -> tuple[SoftBody, BakeReport]:
        """Give the object its body. Ends the session in any case.

        Raises
        ------
        PalpateError
            What went wrong in the bake; the object or its scene is gone, or was changed. Nothing is
            changed and no file is left then.
        """
        try:
            thing, scene = self._unchanged_object()
            places: list[Path] = []

            def place_for(found: SoftBody) -> Path:
                kept_body.let_go()
                places.append(body_store.place_for(thing, found.key))
                return places[0]

            body, report = self.job.result(place_for)
            name = places[0].name
            baked_record.record(thing, body, name, self.fingerprint)
            carrier.give(thing, scene, self.surface)
            kept_body.keep(thing, body)
            if not self.rebuild:
                thing.palpate.baked_edge_length = self.settings.edge_length
                thing.palpate.baked_epsilon = self.settings.epsilon
            thing.palpate.bake_seconds = sum(report.seconds.values())
            thing.palpate.bake_warnings = "\n".join(
                warning.as_line() for warning in report.warnings
            )
        finally:
            self.end()
        return body, report

    def end(self) -> None:
        """Stop the child process, and remove its folder and the preview. Safe to repeat."""
        global _current  # noqa: PLW0603  one bake at a time
        self.job.close()
        self._end_preview()
        if _current is self:
            _current = None

    def _end_preview(self) -> None:
        preview, self.preview = self.preview, None
        if preview is None:
            return
        press, thing = press_session.current(), self.handle.find()
        if press is not None and thing is not None and press.handle.find() == thing:
            press_session.give_way("The bake was cancelled, and its preview with it")
        preview.end()

    @property
    def _scene(self) -> bpy.types.Scene | None:
        return next((one for one in bpy.data.scenes if one.session_uid == self.scene_uid), None)

    def _unchanged_object(self) -> tuple[bpy.types.Object, bpy.types.Scene]:
        thing, scene = self.handle.find(), self._scene
        if thing is None or scene is None:
            raise PalpateError(
                "{name}: it was deleted while it was being baked", name=self.handle.name
            )
        if soft_object.refusal(thing):
            raise PalpateError(
                "bake: {refusal}; then bake again", refusal=soft_object.refusal(thing)
            )
        read = body_source.read_again if self.rebuild else body_source.read
        drawn = read(thing, scene)
        now = drawn.fingerprint(self.fingerprint.pins, self.fingerprint.stiffness)
        change = changed_body(self.fingerprint, now)
        if change:
            raise PalpateError(
                "{name}: it was edited while it was being baked; press Make Soft again",
                name=thing.name,
            )
        return thing, scene


_current: BakeSession | None = None


def current() -> BakeSession | None:
    """Running bake, if any."""
    return _current


def start(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    *,
    rebuild: bool = False,
    by_hand: bool = False,
) -> BakeSession:
    """Start to bake an object in a child process.

    Parameters
    ----------
    by_hand : somebody looks on. If nobody chose its pins, an object without a body rests where it
        stands, or is held by its core on a slender foot; and it is given a coarse body, too, if it
        is expected to wait for longer than a preview takes.
    rebuild : only recompute the compliance, from the tetrahedra in the .blend with the present
        pins and material.

    Raises
    ------
    PalpateError
        Another bake is running; the object cannot be baked, with the reason and the remedy.
    """
    global _current  # noqa: PLW0603  see end
    if _current is not None:
        raise PalpateError(
            "{name} is being baked; wait for it or cancel it", name=_current.handle.name
        )
    if soft_object.refusal(thing):
        raise PalpateError(soft_object.refusal(thing))
    drawn = (body_source.read_again if rebuild else body_source.read)(thing, scene)
    is_first = not rebuild and not thing.palpate.body_key
    told, stands = None, partial(standing.stands, thing, drawn, scene)
    if is_first:
        told = unchosen_pins.choose(thing, drawn, by_hand=by_hand, stands=stands)
    surface = drawn.surface()
    fingerprint = drawn.fingerprint(pin_group.pin_rule(thing), stiff_region.stiff_rule(thing))
    settings = bake_prediction.all_settings_of(thing, drawn)
    python = (sys.executable, *bpy.app.python_args)
    if rebuild:
        job = _rebuild_job(thing, fingerprint, settings, surface, python)
    else:
        job = BakeJob(surface, settings, python=python)
    handle, scene_uid = ObjectHandle.of(thing), scene.session_uid
    _current = BakeSession(
        handle, scene_uid, drawn, fingerprint, settings, job, job.poll(), rebuild, told
    )
    if by_hand and is_first and _takes_long(surface, settings):
        _current.preview = preview_body.start(thing, scene, drawn, fingerprint, settings)
    return _current


def _takes_long(surface: Surface, settings: BakeSettings) -> bool:
    """Whether a bake is expected to take longer than its preview."""
    if len(surface.triangles) > MOST_TRIANGLES_MEASURED:
        return True
    return bake_prediction.predict(shape_size(surface), settings).cost.seconds > QUICK_SECONDS


def run(
    thing: bpy.types.Object, scene: bpy.types.Scene, *, rebuild: bool = False
) -> tuple[SoftBody, BakeReport]:
    """Bake and wait; errors as for :func:`start` and :meth:`BakeSession.commit`."""
    session = start(thing, scene, rebuild=rebuild)
    try:
        while not session.poll():
            time.sleep(SECONDS_BETWEEN_POLLS)
    except BaseException:
        session.end()
        raise
    return session.commit()


def _rebuild_job(
    thing: bpy.types.Object,
    now: Fingerprint,
    settings: BakeSettings,
    surface: Surface,
    python: tuple[str, ...],
) -> BakeJob:
    """Job with the same tetrahedra; with unchanged rules also the same nodes, for an equal key."""
    within = embedded(thing)
    old = Fingerprint.from_text(thing.palpate.fingerprint)
    change = changed_body(old, now)
    if change:
        raise PalpateError(
            "{name}: {change}; press Make Soft to bake it anew", name=thing.name, change=change
        )
    if old.pins == now.pins:
        settings = replace(settings, pins=held_at(within.fixed))
    if old.stiffness == now.stiffness:
        settings = replace(settings, stiffness=within.stiffness)
    return BakeJob(within.mesh, settings, surface, python)


class OnSoft(Acting):
    """Mixin for an operator on a soft object that is neither baked nor pressed now."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        reason = soft_object.refusal_unbaked(context.object)
        if not reason and (current() or press_session.current()):
            reason = "Finish baking or pressing first"
        return reason
