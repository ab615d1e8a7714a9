"""A stranger's .blend: what it says of its body reaches no file but Palpate's own."""

from __future__ import annotations

import itertools
import json
import shutil
from pathlib import Path

import bpy
import numpy as np
import pytest
from soft_scene import error_of, layer_names, locate, part, press_down, said_by, select, status
from users_home import KEY, fill_home, outside, save_soft_cube


@pytest.fixture
def saved(palpate, tmp_path):
    """A soft cube in a saved file, beside a home with things that are nobody's business."""
    fill_home(tmp_path)
    return save_soft_cube(tmp_path)


def hostile_names(home: Path) -> list[str]:
    """Some hundred ways to name a file that is not ours."""
    victims = [".ssh/id_rsa", "letter.odt", f"body-{KEY}.npz", ".config/autostart/new.desktop"]
    ways = ["../../home/{}", "{home}/{}", "./../../home/{}", "//../home/{}", "file://{home}/{}"]
    ways += ["../palpate/../../home/{}", "x/../../../home/{}", "~/{}", "\\\\host\\share\\{}"]
    ways += ["%2e%2e/%2e%2e/home/{}", "..%2f..%2fhome%2f{}", "\uff0e\uff0e/home/{}", "\\\\?\\{}"]
    ways += ["C:\\{}", "C:{}", "..\\..\\home\\{}", "{home}//{}", "/proc/self/root{home}/{}"]
    names = [way.format(victim, home=home) for way, victim in itertools.product(ways, victims)]
    names += [f"{way.format(f'body-{KEY}', home=home)}.npz" for way in ways]
    reserved = ["CON", "PRN", "AUX", "NUL", "COM1", "COM9", "LPT1", "CONIN$", "con.npz", "nul.npz"]
    names += [*reserved, ".", "..", "...", "", " ", "~", "-", ".npz", f"-{KEY}.npz", "*", "?"]
    body = f"Cube-{KEY}.npz"
    names += [f"{sign}{body}" for sign in "/\\.~ \t\n\r\x01\x7f:*?\"<>|$`;&'%!#@+=,()[]{}"]
    names += [f"Cube{sign}{body}" for sign in '/\\\t\n\x01\x1f:*?"<>|.\u2028\u2029\x85\xa0']
    names += [f"{body}{sign}" for sign in "/\\. \n:$*"] + [f"{body}:stream", f"{body}/../x"]
    names += [f"Cube-{KEY[:n]}.npz" for n in range(12)] + [f"Cube-{KEY}{n}.npz" for n in range(10)]
    names += [f"Cube-{KEY.upper()}.npz", f"Cube-{KEY}.NPZ", f"Cube-{KEY}.npy", f"Cube_{KEY}.npz"]
    names += ["a" * length + f"-{KEY}.npz" for length in (250, 400, 900)]
    names += [f"{up}etc/passwd" for up in ("/", *("../" * n for n in range(1, 20)))]
    return list(dict.fromkeys(names))


def test_no_name_leads_any_operator_or_handler_to_another_file(saved, tmp_path, monkeypatch):
    names = hostile_names(tmp_path / "home")
    assert len(names) >= 200
    store, targets = part("operators.object.body_store"), []

    def baked(_mesh, _settings, target, **_):
        targets.append(target)
        raise part("core.errors").PalpateError("not now")

    monkeypatch.setattr(store, "run_bake", baked)
    key, own, before = saved.palpate.body_key, locate(saved), outside(tmp_path)
    for name in names:
        saved.palpate.body_file = name
        assert locate(saved) is None, name
        assert status(saved).fit.name == "FILE_MISSING", name
        assert "not now" in error_of(bpy.ops.palpate.press, by=(0.0, 0.0, -0.005)), name
        bpy.ops.wm.save_mainfile()
        assert outside(tmp_path) == before, name
    assert {target.parent for target in targets} == {own.parent}
    assert {target.name for target in targets} == {own.name}
    for name in names:
        saved.palpate.body_file, saved.palpate.body_key = name, key
        assert bpy.ops.palpate.remove_softness() == {"FINISHED"}
        assert outside(tmp_path) == before, name
    assert own.is_file()


def test_saved_elsewhere_a_hostile_name_brings_nothing_along(saved, tmp_path):
    before = outside(tmp_path)
    for number, name in enumerate(hostile_names(tmp_path / "home")[::10]):
        saved.palpate.body_file = name
        (tmp_path / f"copy{number}").mkdir()
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / f"copy{number}" / "copy.blend"))
        assert not (tmp_path / f"copy{number}" / "palpate").exists(), name
        assert outside(tmp_path) == before, name


def test_press_heals_a_hostile_name_by_one_of_its_own(saved, tmp_path):
    name, before = saved.palpate.body_file, outside(tmp_path)
    saved.palpate.body_file = "../../home/.config/autostart/new.desktop"
    press_down(saved)
    assert saved.palpate.body_file == name
    assert outside(tmp_path) == before


@pytest.mark.parametrize("to", [".ssh/id_rsa", "letter.odt", "nowhere"])
def test_links_are_not_followed(saved, tmp_path, link, to):
    path, before = locate(saved), outside(tmp_path)
    path.unlink()
    link(path, tmp_path / "home" / to)
    assert locate(saved) is None
    press_down(saved)
    assert locate(saved) == path.with_name(path.name.replace("-", "_2-"))
    assert path.is_symlink()
    assert outside(tmp_path) == before
    bpy.ops.palpate.remove_softness()
    assert path.is_symlink()
    assert outside(tmp_path) == before


def test_a_link_beside_a_new_place_is_not_written_through(saved, tmp_path, link):
    other = tmp_path / "other"
    (other / "palpate").mkdir(parents=True)
    link(other / "palpate" / locate(saved).name, tmp_path / "home" / "new.desktop")
    bpy.ops.wm.save_as_mainfile(filepath=str(other / "copy.blend"))
    assert not (tmp_path / "home" / "new.desktop").exists()


def test_a_folder_that_leads_elsewhere_is_neither_read_nor_written(saved, tmp_path, link):
    folder = locate(saved).parent
    shutil.rmtree(folder)
    link(folder, tmp_path / "home")
    before = outside(tmp_path)
    assert locate(saved) is None
    assert "another place" in error_of(bpy.ops.palpate.press, by=(0.0, 0.0, -0.005))
    assert "another place" in error_of(bpy.ops.palpate.make_soft)
    bpy.ops.wm.save_mainfile()
    bpy.ops.palpate.remove_softness()
    assert outside(tmp_path) == before


def test_what_is_no_body_is_never_copied_replaced_or_deleted(saved, tmp_path):
    path, saved_name = locate(saved), saved.name
    path.write_text("a letter under the body's name")
    (tmp_path / "other").mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "other" / "copy.blend"))
    assert not (tmp_path / "other" / "palpate").exists()
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene" / "scene.blend"))
    thing = select(bpy.data.objects[saved_name])
    assert "a letter" not in error_of(bpy.ops.palpate.press, by=(0.0, 0.0, -0.005))
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    press_down(thing)
    assert bpy.ops.palpate.remove_softness() == {"FINISHED"}
    assert path.read_text() == "a letter under the body's name"


def hostile_arrays(thing: bpy.types.Object) -> list[tuple[str, object]]:
    """ID properties of the wrong length, type, range, or of no use."""
    nodes, tets = np.array(thing.palpate["nodes"]), np.array(thing.palpate["tets"])
    broken = [(np.nan, 0), (np.inf, 1), (-np.inf, 2), (1e300, 3)]
    changed = [("nodes", np.where(np.arange(len(nodes)) == at, bad, nodes)) for bad, at in broken]
    far = [
        ("tets", np.where(np.arange(len(tets)) == 0, bad, tets).astype(np.int32))
        for bad in (-1, 2**31 - 1, len(nodes), -(2**31))
    ]
    lengths = [
        (name, kind[:length])
        for name, kind in (("nodes", nodes), ("tets", tets))
        for length in (1, 2, 5, 12)
    ]
    return [
        *changed,
        *far,
        *lengths,
        *(
            (name, value)
            for name in ("nodes", "tets", "fixed", "young_scale")
            for value in ("text", 5, 2.5, True, {"a": 1}, [[1.0, 2.0], [3.0]], thing, [{"b": 2}])
        ),
        ("nodes", tets),
        ("tets", nodes),
        ("tets", tets.reshape(-1, 4)[:, [1, 0, 2, 3]].ravel()),
        ("tets", np.zeros_like(tets)),
        ("fixed", np.array([-1, 0, 1], np.int32)),
        ("fixed", np.array([2**31 - 1], np.int32)),
        ("fixed", np.array([0.0, np.nan])),
        ("young_scale", np.array([np.nan])),
        ("young_scale", np.full(len(tets) // 4, -1.0)),
        ("young_scale", np.full(len(tets) // 4, np.inf)),
    ]


def test_hostile_tetrahedra_are_refused_and_nothing_changes(saved):
    path = locate(saved)
    path.unlink()
    good = {name: np.array(saved.palpate[name]) for name in ("nodes", "tets", "fixed")}
    for name, value in hostile_arrays(saved):
        for word in ("nodes", "tets", "fixed", "young_scale"):
            if word in saved.palpate:
                del saved.palpate[word]
        for word, numbers in good.items():
            saved.palpate[word] = numbers
        if name in saved.palpate:
            del saved.palpate[name]
        try:
            saved.palpate[name] = value
        except (TypeError, ValueError, OverflowError):
            continue  # Blender itself does not take it.
        for act, given in (("rebuild_body", {}), ("press", {"by": (0.0, 0.0, -0.005)})):
            message = error_of(getattr(bpy.ops.palpate, act), **given)
            assert "Make Soft" in message, (name, value, message)
            assert "Traceback" not in message, (name, value)
        saved.palpate.pin_fraction = 0.2
        status(saved)
        saved.palpate.pin_fraction = 0.1
        assert not path.exists()
        assert layer_names(saved) == []


def hostile_fingerprints(text: str) -> list[str]:
    """What a file may say instead of a fingerprint."""
    fields = json.loads(text)
    values = [None, "x", [], {}, float("nan"), float("inf"), -1, 10**400, True, [1] * 9, ["a"] * 8]
    return [
        "", "x", "[", "null", "5", "[]", "{}", '"text"', "[" * 5000, "{" * 20_000, "\x00",
        "1" * 5000,
        json.dumps({**fields, "more": 1}),
        *(json.dumps({word: field for word, field in fields.items() if word != left_out})
          for left_out in fields),
        *(json.dumps({**fields, word: value}) for word in fields for value in values),
    ]  # fmt: skip


def test_hostile_fingerprints_are_refused_without_a_traceback(saved):
    good, known = saved.palpate.fingerprint, part("addon.known_status").body_status
    texts = hostile_fingerprints(good)
    for text in texts:
        saved.palpate.fingerprint = text
        part("addon.known_status").forget()
        fit = known(saved, bpy.context.scene).fit.name
        for act, given in (("press", {"by": (0.0, 0.0, -0.005)}), ("update_pins", {})):
            if fit == "READY" and act == "press":
                continue
            message = error_of(getattr(bpy.ops.palpate, act), **given)
            assert "Traceback" not in message, (text[:80], message)
    saved.palpate.fingerprint = good
    press_down(saved)


FIGURES = {
    "baked_poisson_ratio": [float("nan"), float("inf"), -1.0, 0.5, 7.0],
    "baked_formulation": ["", "x", "auto"],
    "baked_form": ["", "x", "../x"],
    "baked_tolerance": [float("nan"), -1.0, 0.0, 1e30],
    "body_key": ["x", "../../home/x", "0" * 63, "G" * 64],
    "compliance_megabytes": [float("nan"), float("inf"), -1.0],
    "free_surface_count": [-1, 2**31 - 1, -(2**31)],
    "bake_warnings": ["[", "[1, 2]", '["{a.__class__}", {"a": 1}]', '["{a:999999999}", {"a": 1}]'],
}


@pytest.mark.parametrize("name", FIGURES)
def test_hostile_figures_of_a_body_make_no_traceback(saved, tmp_path, name):
    before, good = outside(tmp_path), getattr(saved.palpate, name)
    saved.palpate.pin_fraction = 0.2
    for value in FIGURES[name]:
        setattr(saved.palpate, name, value)
        part("addon.known_status").forget()
        part("addon.known_status").body_status(saved, bpy.context.scene)
        for line in saved.palpate.bake_warnings.split("\n"):
            assert "class 'int'" not in part("core.sentence").Sentence.of_line(line)
        for act in ("update_pins", "press"):
            given = {"by": (0.0, 0.0, -0.005)} if act == "press" else {}
            assert "Traceback" not in said_by(act, given), value
        assert outside(tmp_path) == before
    setattr(saved.palpate, name, good)
