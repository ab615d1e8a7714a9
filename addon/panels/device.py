"""Device: what presses instead of the pointer, a second finger, and the force loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...core.quantities import microseconds
from ...core.servo import latency_timer
from ...operators.device.device_source import is_planar
from ...operators.device.servo_words import FAULT_NAMES
from ...operators.scene.package_preferences import preferences
from ...operators.session import press_session
from .base import PalpatePanel, draw_box, draw_rows, named_properties, while_idle
from .sentence import say

if TYPE_CHECKING:
    from ...core.servo.session import LinkCounters, ServoCounters

STAGE_NAMES = {"read": "Read", "proxy": "Proxy", "contact": "Contact", "write": "Write"}
NO_PRIORITY = "none: "


class PALPATE_PT_press(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_press"
    bl_label = "Device"
    bl_parent_id = "PALPATE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        chosen = context.scene.palpate
        column = while_idle(layout)
        column.prop(chosen, "source")
        if chosen.source == "POINTER":
            return
        if chosen.source == "EMPTY":
            column.prop(chosen, "source_empty")
            return
        if chosen.source == "SIMULATED":
            column.prop(chosen, "simulated_kind")
        else:
            row = column.row(align=True)
            row.prop(chosen, "port")
            row.operator("palpate.refresh_devices", text="", icon="FILE_REFRESH")
        if chosen.source == "SERIAL":
            column.prop(chosen, "baud")
        if is_planar(context.scene):
            column.prop(chosen, "haply_model")
        if chosen.source == "HAPLY":
            column.prop(chosen, "haply_at_rest")
            if press_session.current() is None:
                text = "Before Press, put the handle in its rest pose and leave it there"
                say(layout, context, text, "INFO")
        layout.prop(chosen, "device_frame")
        layout.prop(chosen, "device_scale")
        layout.prop(preferences(), "stable_contact")
        layout.prop(chosen, "show_workspace")
        draw_adapter_warning(layout, context)


class PALPATE_PT_second_finger(PalpatePanel, bpy.types.Panel):
    bl_label = "Second Finger"
    bl_parent_id = "PALPATE_PT_press"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, chosen = named_properties(self), context.scene.palpate
        layout.enabled = press_session.current() is None
        layout.prop(chosen, "second")
        if chosen.second == "EMPTY":
            layout.prop(chosen, "second_empty")
        elif chosen.second != "NONE":
            if chosen.second in {"SERIAL", "HAPLY"}:
                layout.prop(chosen, "second_port")
            if chosen.second == "HAPLY":
                layout.prop(chosen, "second_haply_model")
                layout.prop(chosen, "second_haply_at_rest")
            layout.prop(chosen, "second_frame")
        say(layout, context, "Pinch leads two fingers with the pointer", "INFO")


class PALPATE_PT_loop(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_loop"
    bl_label = "Force Loop"
    bl_parent_id = "PALPATE_PT_press"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = named_properties(self)
        session = press_session.current()
        while_idle(layout).prop(context.scene.palpate, "rate")
        _draw_coupling(layout, context.scene)
        loop = session.loop if session is not None else None
        counters = loop.figures.counters if loop is not None else None
        if counters is None:
            say(layout, context, "While you press, its figures appear here", "INFO")
            return
        _draw_timing(layout, context, counters)
        _draw_stages(layout, counters)
        _draw_faults(layout, counters)
        link = counters["link"]
        if link["hellos"]:
            _draw_link(layout, link)


def _draw_coupling(layout: bpy.types.UILayout, scene: bpy.types.Scene) -> None:
    """Draw the virtual coupling, which keeps contact with motors stable."""
    chosen = preferences()
    if scene.palpate.source == "POINTER" or not chosen.stable_contact:
        return
    column = layout.column(align=True)
    column.prop(chosen, "own_coupling")
    if chosen.own_coupling:
        column.prop(chosen, "coupling_stiffness", text="Stiffness")
        column.prop(chosen, "coupling_damping")
        column.prop(chosen, "passivity_control")


def draw_adapter_warning(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Warn of a USB adapter that holds bytes back, with the remedy."""
    session = press_session.current()
    loop = session.loop if session is not None else None
    if loop is None or loop.figures.counters is None:
        return
    warning = latency_timer.explain(loop.figures.counters["link"], loop.port)
    if warning:
        say(layout, context, warning, "ERROR")


def _draw_timing(
    layout: bpy.types.UILayout, context: bpy.types.Context, counters: ServoCounters
) -> None:
    priority = counters["realtime"]
    has_priority = not priority.startswith(NO_PRIORITY)
    rows = [
        ("Ticks", f"{counters['ticks']:,}"),
        ("Late by 0.2 ms", f"{counters['late_over_200_us']:,}"),
        ("Late by 1 ms", f"{counters['late_over_1000_us']:,}"),
        ("Longest Gap", microseconds(counters["longest_gap_us"])),
    ]
    if has_priority:
        rows.append(("Priority", priority))
    draw_rows(layout.column(align=True), rows)
    if not has_priority:
        reason = priority.removeprefix(NO_PRIORITY)
        say(layout, context, "No real-time priority: {reason}", "INFO", reason=reason)


def _draw_stages(layout: bpy.types.UILayout, counters: ServoCounters) -> None:
    """Draw the time of a tick by stage: mean and 99th percentile."""
    stages = counters["stages_us"]
    rows = [
        (name, f"{microseconds(stages[stage]['mean'])}, {microseconds(stages[stage]['p99'])}")
        for stage, name in STAGE_NAMES.items()
    ]
    draw_box(layout, "Time in a Tick: Mean, 99 %", rows)


def _draw_faults(layout: bpy.types.UILayout, counters: ServoCounters) -> None:
    rows = [
        (FAULT_NAMES.get(name, name), f"{count:,}")
        for name, count in counters["faults"].items()
        if count
    ]
    if rows:
        draw_box(layout, "Faults", rows, "ERROR")


def _draw_link(layout: bpy.types.UILayout, link: LinkCounters) -> None:
    damaged = link["crc_errors"] + link["cobs_errors"] + link["oversize"] + link["unknown"]
    rows = [
        ("Received", f"{link['states']:,}"),
        ("Sent", f"{link['forces']:,}"),
        ("Lost", f"{link['lost']:,}"),
        ("Damaged", f"{damaged:,}"),
        ("Out of Order", f"{link['duplicates'] + link['out_of_order']:,}"),
        ("Not Sent", f"{link['unsent']:,}"),
        ("Opened Again", f"{link['reopened']:,}"),
        ("Guardian", "\N{CHECK MARK}" if link["guarded"] else "\N{EN DASH}"),
    ]
    if link["state_age_ms"] is not None:
        rows.append(("Age of Position", f"{link['state_age_ms']:.1f} ms"))
    if link["round_trip_ms"] is not None:
        rows.append(("Round Trip", f"{link['round_trip_ms']:.1f} ms"))
        rows.append(("On the Way", f"{link['forces_in_flight']:,}"))
    device = link["device"]
    if device is not None:
        rows.insert(0, ("Device", device["name"]))
    draw_box(layout, "Connection", rows)


classes = (PALPATE_PT_press, PALPATE_PT_second_finger, PALPATE_PT_loop)
