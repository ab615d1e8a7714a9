"""Leads of a press's fingers: the pointer, an Empty of the scene, or a device."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import bpy

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ..device import device_source
from ..scene.object_handle import ObjectHandle
from .press_events import Source


class Lead(Enum):
    """Kind of thing that moves a finger."""

    POINTER = "pointer"
    EMPTY = "empty"
    DEVICE = "device"


@dataclass(frozen=True)
class FingerLead:
    """Lead of a finger, with its ``empty`` for that kind."""

    lead: Lead
    empty: ObjectHandle | None = None


BOTH_POINTER = (FingerLead(Lead.POINTER), FingerLead(Lead.POINTER))
_LEAD_OF = {Source.POINTER: Lead.POINTER, Source.EMPTY: Lead.EMPTY, Source.DEVICE: Lead.DEVICE}


def leads_of(scene: bpy.types.Scene, source: Source) -> tuple[FingerLead, ...]:
    """Leads of all fingers that the scene chooses, the first finger's first.

    Raises
    ------
    PalpateError
        No Empty is chosen, or two fingers are led by the same Empty or device.
    """
    chosen = scene.palpate
    first = _lead(_LEAD_OF[source], chosen.source_empty, "Press With")
    if chosen.second == "NONE":
        return (first,)
    lead = Lead.EMPTY if chosen.second == "EMPTY" else Lead.DEVICE
    second = _lead(lead, chosen.second_empty, "Second Finger")
    if first.empty is not None and first.empty == second.empty:
        raise PalpateError(
            "finger: both fingers are led by {name}; choose another Empty for one",
            name=first.empty.name,
        )
    if chosen.second in {"SERIAL", "HAPLY"}:
        port = second_port(scene)
        if chosen.source in {"SERIAL", "HAPLY"} and port == device_source.port_of(scene):
            raise PalpateError(
                "device: both fingers use {port}; choose another port for one", port=port
            )
    return (first, second)


def second_port(scene: bpy.types.Scene) -> str:
    """Serial port of the second device.

    Raises
    ------
    PalpateError
        None is chosen.
    """
    port: str = scene.palpate.second_port.partition(" (")[0].strip()
    if not port:
        raise PalpateError("device: the second finger has no port; give one under Second Finger")
    return port


def _lead(lead: Lead, empty: bpy.types.Object | None, panel_name: str) -> FingerLead:
    if lead is not Lead.EMPTY:
        return FingerLead(lead)
    if empty is None:
        raise PalpateError(
            "finger: no Empty is chosen; pick one below {panel} (Led By), or add one (Add > Empty)",
            panel=Sentence(panel_name),
        )
    return FingerLead(lead, ObjectHandle.of(empty))
