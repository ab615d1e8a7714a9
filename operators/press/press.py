"""Press: touch a soft object with pointer, pen or device, then keep the shape or restore it."""

import bpy

from ...core.errors import PalpateError
from ..reporting.translated import reported
from ..session.press_events import Source
from .modal_press import ModalPress
from .press_once import press_once
from .pressed import Pressed

SOURCES = {"POINTER": Source.POINTER, "EMPTY": Source.EMPTY}


class PALPATE_OT_press(ModalPress, bpy.types.Operator):
    bl_idname = "palpate.press"
    bl_label = "Press"
    bl_description = (
        "Press the soft object with the pointer or a device. Enter keeps the shape, Escape "
        "restores it. From scripts: EXEC_DEFAULT with at and by"
    )
    bl_options = {"UNDO"}

    at: bpy.props.FloatVectorProperty(
        name="At",
        description="The surface point nearest to this is touched, world coordinates",
        subtype="TRANSLATION",
        options={"SKIP_SAVE"},
    )
    by: bpy.props.FloatVectorProperty(
        name="By",
        description="How far it is moved, world axes",
        subtype="TRANSLATION",
        options={"SKIP_SAVE"},
    )
    keep: bpy.props.BoolProperty(
        name="Keep",
        description="Keep the shape as a layer, a modifier",
        default=True,
        options={"SKIP_SAVE"},
    )

    def act(self, context: bpy.types.Context) -> None:
        if not any(self.by):
            raise PalpateError("press: 'by' is zero; say how far to press, in world units")
        report(self, press_once(context.object, context.scene, self.at, self.by, keep=self.keep))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        source = SOURCES.get(context.scene.palpate.source, Source.DEVICE)
        return self.guarded(lambda: self.start(context, source, pinch=False))


def report(operator: bpy.types.Operator, pressed: Pressed) -> None:
    """Report the measurements of a press without a window."""
    for remark in pressed.remarks:
        operator.report({"WARNING"}, reported(remark))
    figures = [
        reported(
            "{force:.3g} N at {depth:.3g} mm",
            force=sum(part**2 for part in finger.force) ** 0.5,
            depth=1000 * finger.depth,
        )
        for finger in pressed.fingers
    ]
    operator.report({"INFO"}, ", ".join(figures))


classes = (PALPATE_OT_press,)
