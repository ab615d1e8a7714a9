"""Every word of the interface is there in every language."""

from __future__ import annotations

import ast
import itertools
from pathlib import Path

import bpy
import pytest
from soft_scene import part

# Blender translates these itself, or they are the same everywhere.
BLENDERS_OWN = {"Palpate", "Material", "Height", "Group", "Port", "Vertex Group", ""}


def shown_by_blender():
    """Names and tooltips of all properties and operators."""
    properties = part("addon.properties")
    types = [properties.PalpateObject, properties.PalpateScene]
    types.append(part("addon.preferences").PalpatePreferences)
    structs = [cls.bl_rna for cls in types]
    structs += [getattr(bpy.ops.palpate, name).get_rna_type() for name in dir(bpy.ops.palpate)]
    for struct in structs:
        if struct.identifier.startswith("PALPATE_OT"):
            yield from (struct.name, struct.description)
        for prop in struct.properties:
            if prop.identifier in {"rna_type", "name", "bl_idname"} or prop.is_hidden:
                continue
            yield from (prop.name, prop.description)
            for item in prop.enum_items if prop.type == "ENUM" else ():
                yield item.name
                if not item.description[:1].isdigit():
                    yield item.description


def said_in_code(palpate):
    """Sentences of panel and view, read from the source."""
    folder = Path(palpate.__file__).parent
    tree = ast.parse((folder / "addon" / "panels.py").read_text(encoding="utf-8"))
    for call in (node for node in ast.walk(tree) if isinstance(node, ast.Call)):
        name = getattr(call.func, "id", getattr(call.func, "attr", ""))
        if name == "_say" and isinstance(call.args[2], ast.Constant):
            yield call.args[2].value
        yield from (
            word.value.value
            for word in call.keywords
            if word.arg in {"text", "heading"} and isinstance(word.value, ast.Constant)
        )
    hud = part("addon.hud")
    yield from hud.STATES.values()
    yield from hud.KEYS.values()
    yield from (hud.ABOVE, hud.WAITING)
    yield from part("operators.press_session").FAULTS.values()


@pytest.mark.parametrize("language", ["german", "japanese"])
def test_no_word_of_the_interface_is_missing(palpate, language):
    known = part(f"addon.{language}").WORDS
    shown = set(itertools.chain(shown_by_blender(), said_in_code(palpate)))
    assert len(shown) > 90
    assert not {text for text in shown - BLENDERS_OWN if text not in known}


def test_the_languages_know_the_same_words(palpate):
    assert part("addon.german").WORDS.keys() == part("addon.japanese").WORDS.keys()
