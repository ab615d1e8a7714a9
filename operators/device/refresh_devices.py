"""Refresh Devices: look for serial ports again."""

import bpy

from ...core.servo.ports import list_ports
from ..reporting.acting import Acting
from ..reporting.translated import reported

_ports: list[tuple[str, str]] = []


def known_ports() -> list[tuple[str, str]]:
    """Latest ports, as (path, description)."""
    return list(_ports)


class PALPATE_OT_refresh_devices(Acting, bpy.types.Operator):
    bl_idname = "palpate.refresh_devices"
    bl_label = "Refresh Devices"
    bl_description = "Look for serial ports again"

    def act(self, context: bpy.types.Context) -> None:
        _ports[:] = [(port.path, port.description) for port in list_ports()]
        self.report({"INFO"}, reported("{count} serial ports found", count=len(_ports)))


classes = (PALPATE_OT_refresh_devices,)
