"""Where the tool Palpate stands among Blender's own."""

from __future__ import annotations

from itertools import groupby
from types import SimpleNamespace
from unittest.mock import MagicMock

from bl_ui.space_toolsystem_common import ToolDef, ToolSelectPanelHelper
from soft_scene import part

TOOL = "palpate.tool"


def tools_between_separators() -> list[list[str]]:
    """Return the tools of Object Mode, first of each button, in the groups that are drawn."""
    toolbar = ToolSelectPanelHelper._tool_class_from_space_type("VIEW_3D")
    firsts = [
        tool if tool is None or isinstance(tool, ToolDef) else tool[0]
        for tool in toolbar._tools["OBJECT"]
    ]
    return [
        [tool.idname for tool in group]
        for separates, group in groupby(firsts, key=lambda tool: tool is None)
        if not separates
    ]


def test_the_tool_is_a_group_of_its_own_and_splits_none_of_blenders(palpate):
    groups = tools_between_separators()
    assert [TOOL] in groups
    groups.remove([TOOL])
    assert ["builtin.move", "builtin.rotate", "builtin.scale", "builtin.transform"] in groups
    assert sum("builtin.measure" in group for group in groups) == 1


def test_the_menu_and_so_f3_has_what_makes_animations(palpate):
    layout = MagicMock()
    part("addon.toolbar.keys").PALPATE_MT_object.draw(SimpleNamespace(layout=layout), None)
    named = {call.args[0] for call in layout.operator.call_args_list}
    assert named >= {"palpate.animate_layers", "palpate.press_frames", "palpate.animate_recording"}
