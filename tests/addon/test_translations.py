"""Blender shows no word of the interface that translators have not seen."""

from __future__ import annotations

import bpy
from soft_scene import part

# Blender translates these itself, or they are the same everywhere.
BLENDERS_OWN = {
    *"XYZ",
    "CSV",
    "USD",
    "npz",
    "Format",
    "Dragon Skin 10",
    "Dragon Skin 20",
    "Dragon Skin 30",
    "Ecoflex 00-10",
    "Ecoflex 00-20",
    "Ecoflex 00-30",
    "Ecoflex 00-50",
    "2DIY 2",
    "2DIY 3.0",
    "2DIY 3.1",
    "Palpate",
    "Material",
    "Height",
    "Group",
    "Port",
    "Vertex Group",
    "Empty",
    "None",
    "",
}


def shown_by_blender():
    """Names and tooltips of all properties and operators."""
    properties = part("addon.properties.soft_object")
    types = [properties.PalpateObject, part("addon.properties.scene").PalpateScene]
    types.append(part("addon.preferences").PalpatePreferences)
    types.append(part("addon.properties.softness").PalpateSoftness)
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


def test_no_name_or_tooltip_is_missing(palpate):
    """The other texts are read from the sources: see tests/release/test_translations.py."""
    for contexts in part("addon.translations").words().values():
        assert not set(shown_by_blender()) - BLENDERS_OWN - set(contexts["*"])


def test_every_state_fault_reason_and_limit_of_the_servo_has_its_words(palpate):
    import palpate_servo

    words = part("operators.device.servo_words")
    assert set(words.STATES) == set(palpate_servo.STATES)
    assert set(words.FAULTS) == set(words.FAULT_NAMES) == set(palpate_servo.FAULTS)
    told = {reason for reason in palpate_servo.REASONS if not reason.startswith("after ")}
    assert set(words.REASONS) >= told
    assert set(words.LIMITS) >= set(palpate_servo.LIMITERS)


def test_sentences_fill_lines_also_where_there_are_no_spaces(palpate):
    wrapped = part("addon.panels.sentence").wrapped
    assert wrapped("Less is pinned than before", 12) == ["Less is", "pinned than", "before"]
    text = part("addon.translations").words()["ja"]["*"]["Less is pinned than before: needs a bake"]
    lines = wrapped(text, 12)
    assert "".join(lines) == text
    assert len(lines) > 2
    assert max(map(len, lines)) <= 7
    assert not any(line.startswith("。") for line in lines)
