"""Every word of the interface is there in every language."""

from __future__ import annotations

import ast
import itertools
import re
from pathlib import Path

import bpy
import pytest
from soft_scene import part

# Blender translates these itself, or they are the same everywhere.
BLENDERS_OWN = {
    "CSV",
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
    properties = part("addon.properties")
    types = [properties.PalpateObject, part("addon.scene_properties").PalpateScene]
    types.append(part("addon.preferences").PalpatePreferences)
    types.append(part("addon.softness_properties").PalpateSoftness)
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


def sentences(path):
    """What reads like words of the interface in a source file: no docstrings, no parts of texts."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    nodes = list(ast.walk(tree))
    left_out = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    for text in (node for node in nodes if isinstance(node, ast.JoinedStr)):
        left_out |= {id(piece) for piece in text.values}
    texts = [node.value for node in nodes if _is_text(node) and id(node) not in left_out]
    return [text for text in texts if re.match(r"[A-Z{][a-z]", text)]


def _is_text(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def said_in_code(palpate):
    """Sentences of panel and view, read from the source."""
    folder = Path(palpate.__file__).parent
    for path in (folder / "addon").glob("panel*.py"):
        yield from sentences(path)
    for name in ("bake_words", "pin_change", "soft_object"):
        yield from sentences(folder / "operators" / f"{name}.py")
    yield from part("core.bake_job").STEP_TEXTS.values()
    yield from (meaning for _, meaning in part("core.ftetwild_log").STAGES)
    hud = part("addon.hud")
    yield from hud.STATES.values()
    yield from hud.KEYS.values()
    yield from (*hud.PINCH_STATES.values(), *hud.EMPTY_STATES.values())
    yield from (hud.ABOVE, hud.SHAPE, hud.FELT, "Space  Force Off", "Space  Force On", "Starting")
    yield part("operators.press_session").KEPT_EARLY
    yield from ("Contact Area", "Largest Pressure", "Pressure")
    yield from said_of_the_servo()


def said_of_the_servo():
    """Its states, faults, reasons and limits, in words."""
    words = part("operators.servo_words")
    for standing in words.STATES.values():
        yield from (standing.word, standing.why)
    for table in (words.FAULTS, words.FAULT_NAMES, words.REASONS, words.LIMITS):
        yield from table.values()
    yield words.AFTER_FAULT


@pytest.mark.parametrize("language", ["german", "japanese"])
def test_no_word_of_the_interface_is_missing(palpate, language):
    known = part(f"addon.{language}").WORDS
    shown = set(itertools.chain(shown_by_blender(), said_in_code(palpate)))
    assert len(shown) > 90
    assert not {text for text in shown - BLENDERS_OWN if text not in known}


def test_every_state_fault_reason_and_limit_of_the_servo_has_its_words(palpate):
    import palpate_servo

    words = part("operators.servo_words")
    assert set(words.STATES) == set(palpate_servo.STATES)
    assert set(words.FAULTS) == set(words.FAULT_NAMES) == set(palpate_servo.FAULTS)
    told = {reason for reason in palpate_servo.REASONS if not reason.startswith("after ")}
    assert set(words.REASONS) >= told
    assert set(words.LIMITS) >= set(palpate_servo.LIMITERS)


def test_the_languages_know_the_same_words(palpate):
    assert part("addon.german").WORDS.keys() == part("addon.japanese").WORDS.keys()


def test_sentences_fill_lines_also_where_there_are_no_spaces(palpate):
    wrapped = part("addon.sentence").wrapped
    assert wrapped("Less is pinned than before", 12) == ["Less is", "pinned than", "before"]
    text = part("addon.japanese").WORDS["Less is pinned than before: needs a bake"]
    lines = wrapped(text, 12)
    assert "".join(lines) == text
    assert len(lines) > 2
    assert max(map(len, lines)) <= 7
    assert not any(line.startswith("。") for line in lines)
