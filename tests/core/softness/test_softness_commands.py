"""Shore values and presets on the command line."""

import json
from pathlib import Path

import numpy as np
import pytest

from palpate.cli.main import main
from palpate.core import cache


def palpate(capsys, *words):
    status = main([str(word) for word in words])
    printed = capsys.readouterr()
    return status, printed.out, printed.err


def test_a_shore_value_is_told_as_young_modulus_by_every_relation(capsys):
    status, printed, _ = palpate(capsys, "shore", "00-30", "--json")
    figures = json.loads(printed)
    assert status == 0
    assert figures["young_modulus"] == figures["young_by_mix"] == pytest.approx(103_400, rel=1e-3)
    assert figures["young_by_ball"] == pytest.approx(121_400, rel=1e-3)


def test_young_modulus_is_told_on_the_scales_that_reach_it(capsys):
    _, soft, _ = palpate(capsys, "shore", "--young", "60e3", "--json")
    assert set(json.loads(soft)) == {"young_modulus", "shore_00"}
    _, firm, _ = palpate(capsys, "shore", "--young", "1.142e6", "--json")
    assert json.loads(firm)["shore_a"] == pytest.approx(30, abs=0.1)


def test_what_no_scale_reaches_is_refused_in_one_line(capsys):
    status, printed, said = palpate(capsys, "shore", "--young", 1000)
    assert (status, printed) == (2, "")
    assert len(said.splitlines()) == 1
    assert "00-10 to 00-90" in said


def test_every_material_is_listed_with_its_source(capsys):
    _, printed, _ = palpate(capsys, "materials")
    assert "ecoflex-30" in printed
    assert "51 kPa" in printed
    _, printed, _ = palpate(capsys, "materials", "--json")
    assert json.loads(printed)["DRAGON_SKIN_10"]["shore"] == "A 10"


@pytest.fixture
def tets(tmp_path, cube_mesh) -> Path:
    mesh, fixed = cube_mesh
    np.savez(tmp_path / "cube-tets.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed)
    return tmp_path / "cube-tets.npz"


@pytest.mark.parametrize(
    ("options", "young", "ratio"),
    [
        ([], 10_000, 0.3),
        (["--material", "ecoflex-30"], 106_000, 0.48),
        (["--material", "ecoflex-30", "--poisson", 0.3, "--young", 5], 5, 0.3),
        (["--shore", "A20", "--poisson", 0.49], 741_600, 0.49),
    ],
)
def test_a_bake_takes_presets_and_shore_values(tets, tmp_path, capsys, options, young, ratio):
    out = tmp_path / "cube.npz"
    assert palpate(capsys, "bake", tets, "-o", out, *options)[0] == 0
    body = cache.load(out)
    assert body.young_modulus == pytest.approx(young, rel=1e-3)
    assert body.poisson_ratio == ratio


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--material", "custard"], "palpate materials"),
        (["--shore", "A20", "--young", "5"], "not allowed with"),
        (["--shore", "A3"], "from 10 to 90"),
    ],
)
def test_what_cannot_be_a_material_is_refused(tets, tmp_path, capsys, options, reason):
    out = tmp_path / "cube.npz"
    try:
        status, _, said = palpate(capsys, "bake", tets, "-o", out, *options)
    except SystemExit as end:
        status, said = end.code, capsys.readouterr().err
    assert status == 2
    assert reason in said
    assert not out.exists()
