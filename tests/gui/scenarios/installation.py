"""The extension is there after its installation, where a user looks for it."""

from __future__ import annotations

import bpy
from stage import MODULE, Stage, Wait


def the_extension_is_enabled_after_installation(stage: Stage) -> Wait:
    yield
    assert MODULE in bpy.context.preferences.addons


def the_sidebar_has_a_tab_palpate(stage: Stage) -> Wait:
    yield from stage.open_sidebar("Palpate")
    yield from stage.picture("sidebar")
    assert stage.region("UI").active_panel_category == "Palpate"
