"""Shore values, presets, durometer, curves and maps on the command line."""

import json

import numpy as np
import pytest
import trimesh

from palpate.core.body import body_file


def test_a_shore_value_is_told_as_young_modulus_by_every_relation(figures_of):
    figures = figures_of("shore", "00-30")
    assert figures["young_modulus"] == figures["young_by_mix"] == pytest.approx(103_400, rel=1e-3)
    assert figures["young_by_ball"] == pytest.approx(121_400, rel=1e-3)


def test_young_modulus_is_told_on_the_scales_that_reach_it(figures_of):
    assert set(figures_of("shore", "--young", "60e3")) == {"young_modulus", "shore_00"}
    assert figures_of("shore", "--young", "1.142e6")["shore_a"] == pytest.approx(30, abs=0.1)


@pytest.mark.at_length
def test_foam_is_told_by_the_force_that_it_is_sold_by(figures_of, refusal):
    figures = figures_of("ild", "80")
    assert figures["ild_25_n"] == pytest.approx(80.0)
    assert figures["young_modulus_in_the_mean"] == pytest.approx(7000.0, rel=0.05)
    assert "positive" in refusal("ild", "0")


@pytest.mark.parametrize(("young", "nearest"), [(1000, "00-10 to 00-90"), (1e9, "A 10 to A 90")])
def test_what_no_scale_reaches_is_refused_in_one_line(refusal, young, nearest):
    assert nearest in refusal("shore", "--young", young)


def test_every_material_is_listed_with_its_source(palpate, figures_of):
    _, printed, _ = palpate("materials")
    assert "ecoflex-30" in printed
    assert "51 kPa" in printed
    assert "Silber and Then" in printed
    assert figures_of("materials")["DRAGON_SKIN_10"]["shore"] == "A 10"


@pytest.mark.parametrize(
    ("options", "young", "ratio", "law"),
    [
        ([], 10_000, 0.3, "rubber"),
        (["--material", "ecoflex-30"], 51_000, 0.48, "rubber"),
        (["--material", "ecoflex-30", "--poisson", 0.3, "--young", 5], 5, 0.3, "rubber"),
        (["--material", "pu-foam-soft"], 25_000, 0.2, "foam"),
        (["--material", "plush", "--young", 300], 300, 0.3, "fibres"),
        (["--shore", "A20", "--poisson", 0.49], 741_600, 0.49, "rubber"),
    ],
)
def test_a_bake_takes_presets_and_shore_values(tets, tmp_path, palpate, options, young, ratio, law):
    out = tmp_path / "cube.npz"
    assert palpate("bake", tets, "-o", out, *options)[0] == 0
    body = body_file.load(out)
    assert body.young_modulus == pytest.approx(young, rel=1e-3)
    assert (body.poisson_ratio, body.law) == (ratio, law)


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--material", "custard"], "palpate materials"),
        (["--shore", "A20", "--young", "5"], "not allowed with"),
        (["--shore", "A3"], "from 10 to 90"),
    ],
)
def test_what_cannot_be_a_material_is_refused(tets, tmp_path, refusal, options, reason):
    out = tmp_path / "cube.npz"
    assert reason in refusal("bake", tets, "-o", out, *options)
    assert not out.exists()


TOP = ["--at", 0.024, 0.026, 0.05]


def test_a_durometer_is_read(cube_file, palpate):
    status, printed, said = palpate("durometer", cube_file, *TOP, "--shore", "00-50", "--json")
    figures = json.loads(printed)
    assert (status, said) == (0, "")
    # Geometry reads three points less than Hertz there; the cube's pinned base, a little more.
    assert 46 < figures["on_a_thick_block"] < 48
    assert figures["value"] == pytest.approx(figures["on_a_thick_block"], abs=2)
    assert figures["place"] == pytest.approx(TOP[1:])


def test_a_stand_presses_harder_and_doubts_are_told(cube_file, palpate, figures_of):
    words = ["durometer", cube_file, *TOP, "--young", 20_000]
    light = figures_of(*words)
    _, printed, said = palpate(*words, "--stand", "--json")
    stand = json.loads(printed)
    assert stand["value"] > light["value"]
    total = stand["foot_force_n"] + stand["indenter_force_n"]
    assert total == pytest.approx(0.4 * 9.81, rel=1e-3)
    assert "warning" in said


def test_a_curve_becomes_table_and_picture(cube_file, tmp_path, figures_of):
    table, picture = tmp_path / "curve.csv", tmp_path / "curve.svg"
    words = ["--tool", "sphere:0.016", "--depth", 0.002, "--steps", 4]
    words += ["--csv", table, "--picture", picture]
    figures = figures_of("curve", cube_file, *TOP, *words)
    assert figures["tool"] == "sphere:0.016"
    assert len(table.read_text().splitlines()) == 6
    assert picture.read_text().startswith("<svg")
    assert float(table.read_text().splitlines()[-1].split(",")[1]) == pytest.approx(
        figures["force_n"][-1], rel=1e-5
    )


def test_a_point_curve_ends_with_its_stiffness(cube_file, palpate):
    _, printed, _ = palpate("curve", cube_file, *TOP, "--tool", "point", "--steps", 2)
    assert printed.splitlines()[0].startswith("depth_mm,force_n")
    assert "N/mm over" in printed.splitlines()[-1]


def test_a_map_is_written_as_numbers_and_as_colours(cube_file, cube, tmp_path, palpate, figures_of):
    numbers, colours = tmp_path / "map.npy", tmp_path / "map.ply"
    figures = figures_of("softness", cube_file, "-o", numbers)
    values = np.load(numbers)
    assert len(values) == len(cube.mesh.surface_nodes)
    assert figures["softest_n_per_mm"] == pytest.approx(values.min() / 1000)
    assert palpate("softness", cube_file, "-o", colours)[0] == 0
    assert trimesh.load(colours).volume == pytest.approx(0.05**3, rel=1e-5)


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["durometer", *TOP, "--young", "-1"], "Young"),
        (["durometer", *TOP, "--load", "0"], "load is 0"),
        (["durometer", "--at", "nan", "0", "0"], "not finite"),
        (["curve", *TOP, "--picture", "curve.gif"], "end it in .svg"),
        (["curve", *TOP, "--steps", "0"], "from 1 to"),
        (["curve", *TOP, "--tool", "spoon"], "'spoon' is no tool"),
        (["softness", "-o", "map.txt"], "end it in .npy or .ply"),
        (["softness", "-o", "map.ply", "--pad", "-1"], "pad radius is -1"),
    ],
)
def test_what_these_commands_cannot_do_is_refused_in_one_line(
    cube_file, refusal, monkeypatch, tmp_path, words, reason
):
    monkeypatch.chdir(tmp_path)
    assert reason in refusal(words[0], cube_file, *words[1:])
    assert not list(tmp_path.iterdir())
