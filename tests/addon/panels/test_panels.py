"""What the panels Large Deformation and Finger say, before and during a press."""

from __future__ import annotations

from functools import partial
from itertools import pairwise

import bpy
import pytest
from recorded_layout import NARROW_WIDTH, USUAL_WIDTH, drawn
from soft_scene import begin_pressed, cube, part, soft_cube

SHAPES = {
    "LINEAR": "linear",
    "TABLE": "paper",
    "ROTATION_STRAIN": "real",
}
# Nodes, tetrahedra and free surface nodes of larger bodies.
LARGE = (20_000, 103_000, 6_400)


@pytest.fixture
def panel(palpate):
    return part("addon.panels.shape").PALPATE_PT_shape


@pytest.fixture
def press(sessions, states):
    return partial(begin_pressed, sessions, states)


def as_large(thing):
    names = ("node_count", "tet_count", "free_surface_count")
    for name, count in zip(names, LARGE, strict=True):
        setattr(thing.palpate, name, count)


class Halfway:
    """A shape whose table is filled by half, or that had trouble with its file."""

    notice = ""
    ready = 0.5

    def __init__(self, body):
        self.body = body

    def displacements(self, nodes, nodal_forces, young_modulus=None):
        return self.body.deform(nodes, nodal_forces, young_modulus)

    def close(self):
        pass


@pytest.mark.parametrize("name", SHAPES)
def test_each_shape_is_explained_and_its_cost_told_before_the_press(panel, name, thing):
    thing.palpate.shape = name
    shapes = part("core.shape.shapes")
    said = drawn(panel, thing)
    assert said.properties == ["shape"] * len(SHAPES)
    assert shapes.EXPLANATIONS[SHAPES[name]] in said.text
    assert not said.bars
    assert ("A Frame, About" in said.lines) == (name != "LINEAR")
    assert ("Memory, About" in said.lines) == (name != "LINEAR")
    assert ("Whole Table, About" in said.lines) == (name == "TABLE")
    # Of a mesh that is not soft yet nobody knows what it costs.
    thing.palpate.free_surface_count = 0
    assert "A Frame, About" not in drawn(panel, thing).lines


def test_figures_are_those_of_the_prediction_with_their_units(panel, thing):
    thing.palpate.shape = "TABLE"
    as_large(thing)
    cost, size = (
        getattr(part("core.shape.shape_cost"), name) for name in ("shape_cost", "BodySize")
    )
    expected = cost("paper", size(*LARGE))
    quantities = part("core.quantities")
    said = drawn(panel, thing).lines
    rows = dict(pairwise(said))
    assert rows["A Frame, About"] == f"{1000 * expected.frame_seconds:.2g} ms"
    assert rows["First Touch, About"] == quantities.duration(expected.first_seconds)
    assert rows["Whole Table, About"] == quantities.duration(expected.table_seconds)
    assert rows["Memory, About"] == quantities.memory(expected.memory_bytes)


def test_a_body_too_large_for_60_frames_a_second_is_told_so(panel, thing):
    for name in SHAPES:
        thing.palpate.shape = name
        as_large(thing)
        cost = part("addon.panels.shape").cost_now(thing)
        told = "60 times a second" in drawn(panel, thing).text
        assert told == (cost.frame_seconds > 0.012), name
    thing.palpate.shape = "ROTATION_STRAIN"
    thing.palpate.node_count, thing.palpate.tet_count, thing.palpate.free_surface_count = (
        300,
        1000,
        150,
    )
    assert "60 times a second" not in drawn(panel, thing).text


@pytest.mark.parametrize("width", [USUAL_WIDTH, NARROW_WIDTH])
@pytest.mark.parametrize("name", SHAPES)
def test_no_sentence_of_any_panel_is_wider_than_the_sidebar(palpate, name, width):
    sentence, panels = part("addon.panels.sentence"), part("addon.panels.sidebar")
    thing = soft_cube()
    as_large(thing)
    thing.palpate.shape = name
    across = width // sentence.LETTER_PIXELS - sentence.MARGIN_LETTERS
    for cls in panels.classes:
        if not hasattr(cls, "poll") or cls.poll(bpy.context):
            said = drawn(cls, thing, width)
            for line in said.lines:
                assert len(line) <= max(sentence.FEWEST_LETTERS, across), (cls.__name__, line)
            for line in said.boxed:
                # A box takes room at both sides.
                assert len(line) <= max(sentence.FEWEST_LETTERS, across - 3), (cls.__name__, line)


SIZES = {
    "POINT": set(),
    "SPHERE": {"tip_radius"},
    "PLATE": {"plate_width", "plate_depth"},
    "ROD": {"tip_radius", "rod_length"},
    "MESH": set(),
}


@pytest.mark.parametrize("tip", SIZES)
def test_the_finger_panel_asks_a_tool_for_its_size_as_a_share_or_as_lengths(palpate, tip):
    chosen, panel = bpy.context.scene.palpate, part("addon.panels.finger").PALPATE_PT_finger
    thing, known = soft_cube(), set().union(*SIZES.values())
    chosen.tip = tip
    asked = set(drawn(panel, thing).properties)
    assert ("tip_share" in asked) == bool(SIZES[tip])
    assert ("tip_object" in asked) == (tip == "MESH")
    assert ("show_pressure" in asked) == (tip != "POINT")
    assert not asked & known
    chosen.own_sizes = True
    assert set(drawn(panel, thing).properties) & known == SIZES[tip]


@pytest.mark.parametrize("tip", SIZES)
def test_only_a_point_is_asked_for_its_contact_and_only_under_advanced(palpate, tip):
    bpy.context.scene.palpate.tip = tip
    asked = drawn(part("addon.panels.advanced").PALPATE_PT_advanced, soft_cube()).properties
    assert ("contact_mode" in asked) == (tip == "POINT")


def is_offered(cls):
    """Whether a panel is there for the active object."""
    return not hasattr(cls, "poll") or cls.poll(bpy.context)


def open_panels():
    """Panels of the tab that are open at first, with all above them."""
    classes = part("addon.panels.sidebar").classes
    by_name = {getattr(cls, "bl_idname", cls.__name__): cls for cls in classes}

    def is_open(cls):
        above = by_name.get(getattr(cls, "bl_parent_id", ""))
        closed = "DEFAULT_CLOSED" in getattr(cls, "bl_options", ())
        return not closed and (above is None or is_open(above))

    return [cls for cls in classes if is_open(cls) and is_offered(cls)]


def test_at_first_three_panels_are_open_and_ask_nothing_that_takes_reading(palpate):
    thing = cube()
    assert [cls.bl_label for cls in open_panels()] == ["Palpate", "Finger", "Pins"]
    bpy.context.scene.palpate.tip = "SPHERE"
    shown = [drawn(cls, thing) for cls in open_panels()]
    asked = [name for said in shown for name in said.properties if name != "tip"]
    assert asked == [
        "material",
        "tip_share",
        "own_sizes",
        "show_pressure",
        "pin_mode",
        "pin_fraction",
        "show_pins",
    ]
    assert [name for said in shown for name in said.operators] == [
        "palpate.make_soft",
        "palpate.pin_below",
    ]
    words = " ".join(said.text for said in shown).lower()
    for word in ("paper", "point", "formulation", "compliance", "node", "loop", "newton"):
        assert word not in words, word
