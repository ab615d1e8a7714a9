"""The interface in the languages that Palpate knows."""

from __future__ import annotations

import bpy
from shown import all_panels_open
from stage import Stage, Wait

from bl_ext.user_default.palpate.addon.translations import words


def panel_and_view_speak_japanese_and_german(stage: Stage) -> Wait:
    with all_panels_open():
        yield from _in_languages(stage)


def _in_languages(stage: Stage) -> Wait:
    stage.open_scene("sample_scenes/mouse.blend")
    yield 0.3
    yield from stage.open_sidebar("Palpate")
    view = bpy.context.preferences.view
    before = view.language
    view.use_translate_interface = True
    try:
        for language, said, refused in (
            ("ja_JP", "柔らかくする", "「by」が 0 です"),
            ("de_DE", "Weich machen", "„by“ ist null"),
        ):
            view.language = language
            label = bpy.app.translations.pgettext_iface("Make Soft", "Operator")
            assert label == said
            assert refused in _refusal()
            assert not _said_otherwise(words()[language.split("_")[0]]["*"])
            yield from stage.picture(language)
    finally:
        view.language = before


def _refusal() -> str:
    """What is reported when there is nothing to press."""
    bpy.context.view_layer.objects.active = bpy.data.objects["Mouse"]
    try:
        bpy.ops.palpate.press("EXEC_DEFAULT")
    except RuntimeError as refusal:
        return str(refusal)
    return ""


def _said_otherwise(known: dict[str, str]) -> list[str]:
    """Labels of operators for which Blender's own dictionary has another word, in its sense."""
    types = [getattr(bpy.ops.palpate, name).get_rna_type() for name in dir(bpy.ops.palpate)]
    return [
        kind.name
        for kind in types
        if bpy.app.translations.pgettext_iface(kind.name, kind.translation_context)
        != known[kind.name]
    ]
