"""A stranger's .blend with anything in its properties: messages, never a traceback, nothing written
but Palpate's own bodies.

Blender keeps a file's values as they are: types, ranges and items of a property bind the user
interface, not the file.
"""

from __future__ import annotations

import math

import bpy
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from recorded_layout import drawn
from soft_scene import part, press_down, said_by, select, status
from users_home import fill_home, outside, save_soft_cube

ACTS = (
    ("press", {"at": (0.0, 0.0, 0.025), "by": (0.0, 0.0, -0.005)}),
    ("pinch", {}),
    ("update_pins", {}),
    ("rebuild_body", {}),
    ("pin_below", {}),
    ("fit_memory", {}),
    ("stroke", {"motion": "PUSH", "place": (0.0, 0.0, 0.025), "radius": 0.01, "depth": 0.003}),
    ("add_press_rig", {"use_cursor": False, "at": (0.0, 0.0, 0.025), "radius": 0.02}),
    ("animate_recording", {}),
    ("save_recording", {}),
    ("press_frames", {}),
    ("read_durometer", {}),
    ("convert_layers", {}),
    ("apply_layers", {}),
    ("make_soft", {}),
)
ARRAYS = ("nodes", "tets", "fixed", "young_scale")
HOLDERS = ("object", "scene", "mesh", "custom", "layer", "group", "attribute")
CUSTOM = ["palpate", "nodes", "palpate_rest", "palpate_halved", "palpate_seen", "force_N"]

ATTRIBUTES = ("rest", "at", "pressed", "displacement", "traction", "pressure", "normal", "softness")
KINDS = (
    ("INT", "POINT"),
    ("FLOAT", "FACE"),
    ("FLOAT_VECTOR", "CORNER"),
    ("INT8", "EDGE"),
)

numbers = st.one_of(
    st.sampled_from([0, 1, -1, 2**31 - 1, -(2**31), math.nan, math.inf, -math.inf, 1e300, -0.0]),
    st.integers(-(2**31), 2**31 - 1),
    st.floats(),
)
texts = st.one_of(
    st.text(max_size=40),
    st.sampled_from(["..", "/", "../../home/letter.odt", "[", "{", "{a.__class__}", "x" * 5000]),
)
values = st.recursive(
    st.one_of(
        numbers,
        st.booleans(),
        texts,
        st.binary(max_size=20),
        st.lists(st.floats(), max_size=30),
        st.lists(st.integers(-(2**31), 2**31 - 1), max_size=30),
    ),
    lambda inner: st.dictionaries(st.text(max_size=10), inner, max_size=3),
    max_leaves=5,
)


def names_of(group: bpy.types.PropertyGroup) -> list[str]:
    """All properties of a group, and those that only files and Palpate itself write."""
    named = [one.identifier for one in group.bl_rna.properties if not one.is_readonly]
    return sorted({*named, *group.keys(), *ARRAYS, "palpate", "name"})


def keys_of(owner: bpy.types.bpy_struct) -> list[str]:
    """What users may add to a holder; modifiers of 5.2 take nothing."""
    try:
        return list(owner.keys())
    except TypeError:
        return []


@st.composite
def plants(draw: st.DrawFn) -> tuple[str, int, object]:
    """Whose property, which of them (counted round), and what it is."""
    return draw(st.sampled_from(HOLDERS)), draw(st.integers(0, 200)), draw(values)


def owned(
    thing: bpy.types.Object, holder: str, number: int
) -> tuple[bpy.types.bpy_struct, list[str]]:
    """A holder, counted round where there are several, and names of properties that it may have."""
    groups = {"object": thing.palpate, "scene": bpy.context.scene.palpate}
    if holder in groups:
        return groups[holder], names_of(groups[holder])
    if holder in {"layer", "group"}:
        found = thing.modifiers if holder == "layer" else bpy.data.node_groups
        owner = found[number % len(found)]
        return owner, [*keys_of(owner), "palpate_group"]
    return {"mesh": thing.data, "custom": thing}[holder], CUSTOM


def plant_attribute(mesh: bpy.types.Mesh, number: int) -> None:
    """Give an attribute that Palpate wrote, or would write, another type and domain."""
    own = [one.name for one in mesh.attributes if not one.is_required and not one.is_internal]
    names = [*own, *(f"palpate_{name}" for name in ATTRIBUTES)]
    name = names[number % len(names)]
    if name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, *KINDS[number % len(KINDS)])


def plant(thing: bpy.types.Object, holder: str, number: int, value: object) -> None:
    """Give a property a value as a file has it; what Blender itself does not take is left out."""
    if holder == "attribute":
        plant_attribute(thing.data, number)
        return
    owner, names = owned(thing, holder, number)
    name = names[number % len(names)]
    owners = [owner]
    if hasattr(owner, "bl_system_properties_get"):
        # From 5.0 on what is registered lies apart from what users add.
        owners.append(owner.bl_system_properties_get(do_create=True))
    for one in owners:
        try:
            # Over an old one of another length Blender writes beyond its end.
            if name in one:
                del one[name]
            one[name] = value
        except (TypeError, ValueError, OverflowError, KeyError, AttributeError, UnicodeError):
            continue


def panels() -> list[type]:
    """All panels of the extension."""
    found = bpy.types.Panel.__subclasses__()
    return [panel for panel in found if panel.__name__.startswith("PALPATE_PT")]


@pytest.fixture
def stranger(palpate, tmp_path, monkeypatch):
    """Where a soft cube is saved; a bake that anything asks for does not begin."""

    def refuse(*_):
        raise part("core.errors").PalpateError("not now")

    fill_home(tmp_path)
    thing = save_soft_cube(tmp_path)
    press_down(thing)
    for act in ("stroke", "add_press_rig"):
        assert not said_by(act, dict(ACTS)[act])
    bpy.ops.wm.save_mainfile()
    monkeypatch.setattr(part("core.bake.job").BakeJob, "_start", refuse)
    (tmp_path / "copy").mkdir()
    return tmp_path


@pytest.mark.at_length
@pytest.mark.timeout(600)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(planted=st.lists(plants(), min_size=1, max_size=4))
def test_whatever_a_file_says_there_is_no_traceback(stranger, capfd, planted):
    capfd.readouterr()
    bpy.ops.wm.open_mainfile(filepath=str(stranger / "scene" / "scene.blend"))
    before = outside(stranger)
    thing = select(bpy.context.object)
    for holder, number, value in planted:
        plant(thing, holder, number, value)
    bpy.ops.wm.save_as_mainfile(filepath=str(stranger / "copy" / "copy.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(stranger / "copy" / "copy.blend"))
    thing = select(bpy.context.object)
    part("addon.known_status").forget()
    status(thing)
    for panel in panels():
        drawn(panel, thing)
    for act, given_to in ACTS:
        said = said_by(act, given_to)
        assert "Traceback" not in said, f"{act}: {said}"
    bpy.ops.wm.save_mainfile()
    assert "Traceback" not in said_by("remove_softness", {})
    told = capfd.readouterr()
    assert "Traceback" not in told.out + told.err
    assert outside(stranger) == before
