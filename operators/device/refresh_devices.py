"""Refresh Devices: look for serial ports again."""

import bpy

from ...core.errors import PalpateError
from ...core.servo.ports import list_ports
from ..scene.translated import reported

_ports: list[tuple[str, str]] = []


def known_ports() -> list[tuple[str, str]]:
    """Ports found last, as (path, description)."""
    return list(_ports)


class PALPATE_OT_refresh_devices(bpy.types.Operator):
    bl_idname = "palpate.refresh_devices"
    bl_label = "Refresh Devices"
    bl_description = "Look for serial ports again"

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            found = list_ports()
        except PalpateError as problem:
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        _ports[:] = [(port.path, port.description) for port in found]
        self.report({"INFO"}, reported("{count} serial ports found", count=len(_ports)))
        return {"FINISHED"}


classes = (PALPATE_OT_refresh_devices,)
