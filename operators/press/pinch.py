"""Pinch: two fingers on one soft object, each a handle that the pointer drags."""

import bpy

from ...core.errors import PalpateError
from ..session.press_events import Source
from .modal_press import ModalPress
from .press import report
from .press_once import press_several


def _place(name: str, description: str) -> object:
    return bpy.props.FloatVectorProperty(
        name=name, description=description, subtype="TRANSLATION", options={"SKIP_SAVE"}
    )


class PALPATE_OT_pinch(ModalPress, bpy.types.Operator):
    bl_idname = "palpate.pinch"
    bl_label = "Pinch"
    # Blender's own dictionary, where a pinch is a sculpting brush, has precedence.
    bl_translation_context = "Palpate"
    bl_description = (
        "Squeeze the soft object between two fingers: drag each handle, the other stays where it "
        "is. Enter keeps the shape, Escape restores it. From scripts: EXEC_DEFAULT with at_1, "
        "by_1, at_2 and by_2"
    )
    bl_options = {"UNDO"}

    at_1: _place("At", "The surface point nearest to this is touched, world coordinates")
    by_1: _place("By", "How far it is moved, world axes")
    at_2: _place("At 2", "Where the second finger touches, world coordinates")
    by_2: _place("By 2", "How far the second finger moves, world axes")
    keep: bpy.props.BoolProperty(
        name="Keep",
        description="Keep the shape as a layer, a modifier",
        default=True,
        options={"SKIP_SAVE"},
    )

    def act(self, context: bpy.types.Context) -> None:
        for name in ("by_1", "by_2"):
            if not any(getattr(self, name)):
                raise PalpateError(
                    "pinch: '{name}' is zero; say how far to press, in world units", name=name
                )
        ats, bys = [self.at_1, self.at_2], [self.by_1, self.by_2]
        report(self, press_several(context.object, context.scene, ats, bys, keep=self.keep))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        return self.guarded(lambda: self._start_in_view(context))

    def _start_in_view(self, context: bpy.types.Context) -> set[str]:
        if context.area is None or context.area.type != "VIEW_3D":
            raise PalpateError("pinch: start it in a 3D view, where its handles are drawn")
        return self.start(context, Source.POINTER, pinch=True)


classes = (PALPATE_OT_pinch,)
