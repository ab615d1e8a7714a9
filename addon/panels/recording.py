"""Recording of a press: start, length, save."""

import bpy

from ...core.quantities import memory
from ...operators.record import recording, recording_writer
from ...operators.record.recording import BYTES_A_TICK
from ...operators.session import press_session
from ...operators.session.press_session import PressSession
from .base import PalpatePanel, named_properties
from .sentence import say


class PALPATE_PT_recording(PalpatePanel, bpy.types.Panel):
    bl_label = "Recording"
    bl_parent_id = "PALPATE_PT_press"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        session = press_session.current()
        if session is not None:
            _draw_now(layout, context, session)
        else:
            _draw_choice(layout, context)
        layout.operator("palpate.save_recording", icon="EXPORT")
        _draw_file(layout, context)


def _draw_now(
    layout: bpy.types.UILayout, context: bpy.types.Context, session: PressSession
) -> None:
    if session.loop is None:
        return
    recorder = session.loop.recorder
    row = layout.row()
    row.scale_y = 1.3
    row.alert = recorder.going_on
    text, icon = ("Stop Recording", "SNAP_FACE") if recorder.going_on else ("Record", "REC")
    row.operator("palpate.record", text=text, icon=icon)
    if not recorder.wanted:
        return
    size = memory(recorder.seconds * recorder.rate_hz * BYTES_A_TICK)
    seconds = f"{recorder.seconds:.1f}"
    say(layout, context, "Recorded: {seconds} s, {size}", "TIME", seconds=seconds, size=size)
    if recorder.full:
        say(layout, context, "The recording is full; save it, or record anew", "ERROR")
    _draw_lost(layout, context, recorder.lost)


def _draw_choice(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    chosen = context.scene.palpate
    layout.prop(chosen, "record_from_start")
    layout.prop(chosen, "record_minutes")
    size = memory(chosen.record_minutes * 60.0 * chosen.rate * BYTES_A_TICK)
    say(layout, context, "Takes at most {size} of memory", "INFO", size=size)
    kept = recording.last()
    if kept is not None:
        seconds = f"{len(kept.samples) / kept.rate_hz:.1f}"
        size = memory(kept.samples.nbytes)
        say(layout, context, "Recorded: {seconds} s, {size}", "TIME", seconds=seconds, size=size)
        _draw_lost(layout, context, kept.lost)


def _draw_file(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    written = recording_writer.latest()
    if written is None:
        return
    name = written.path.name
    if written.going_on:
        say(layout, context, "Writing {name}; go on meanwhile", "SORTTIME", name=name)
    elif written.problem:
        say(layout, context, written.problem, "ERROR")
    else:
        say(layout, context, "Saved: {name}", "CHECKMARK", name=name)


def _draw_lost(layout: bpy.types.UILayout, context: bpy.types.Context, lost: int) -> None:
    if lost:
        text = "{count} ticks are missing: the computer was too busy or its memory full"
        say(layout, context, text, "ERROR", count=f"{lost:,}")


classes = (PALPATE_PT_recording,)
