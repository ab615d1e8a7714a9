"""``--felt`` of the commands: the corrected force where it is asked for, else the linear one."""

import json

import numpy as np
import pytest
from referees.softened_points import corrected_forces

from palpate.cli.main import main
from palpate.core.body import body_file
from palpate.core.shape.force_at_depth.softening_table import SofteningTable
from palpate.core.shape.paper.table_file import table_path

AT, BY = ["0.02", "0.03", "0.05"], ["0", "0", "-0.008"]


@pytest.fixture(scope="module")
def cube_file(tmp_path_factory, cube_mesh):
    mesh, fixed = cube_mesh
    folder = tmp_path_factory.mktemp("cube")
    np.savez(folder / "cube-tets.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed)
    words = ["--poisson", "0.3", "--formulation", "linear"]
    assert (
        main(["bake", str(folder / "cube-tets.npz"), "-o", str(folder / "cube.npz"), *words]) == 0
    )
    return folder / "cube.npz"


def figures_of(capsys, *words):
    capsys.readouterr()
    status = main([str(word) for word in words])
    printed = capsys.readouterr()
    assert status == 0, printed.err
    return json.loads(printed.out)


def test_press_tells_the_corrected_force_and_draws_the_same(cube_file, capsys):
    press = ["press", cube_file, "--at", *AT, "--by", *BY, "--json"]
    linear = figures_of(capsys, *press)
    felt = figures_of(capsys, *press, "--felt", "corrected")
    assert (linear["felt"], felt["felt"]) == ("linear", "corrected")
    body = body_file.load(cube_file)
    table = SofteningTable(body)
    place = body.closest_points.query(np.array([AT], dtype=float))
    by = np.array(BY, dtype=float)
    table.fill()
    expected = corrected_forces(body, table.values, int(place.triangle[0]), place.alpha[0], by)
    assert felt["force"] == pytest.approx((-expected.sum(axis=0)).tolist())
    assert 0 < felt["force"][2] < 0.9 * linear["force"][2]
    assert felt["nodal_forces"] == linear["nodal_forces"]
    assert felt["max_displacement"] == linear["max_displacement"]
    # What was computed is there the next time.
    assert table_path(cube_file, "softening").exists()
    assert figures_of(capsys, *press, "--felt", "corrected") == felt


def test_a_deep_finger_gives_way_and_takes_less_from_a_shallow_one(cube_file, capsys):
    press = ["press", cube_file, "--at", *AT, "--by", *BY]
    press += ["--at", "0.04", "0.03", "0.05", "--by", "0", "0", "-0.003", "--json"]
    linear = figures_of(capsys, *press)["contacts"]
    felt = figures_of(capsys, *press, "--felt", "corrected")["contacts"]
    deep, shallow = (
        (one["force"][2], other["force"][2]) for one, other in zip(linear, felt, strict=True)
    )
    assert 0 < deep[1] < 0.9 * deep[0]
    assert 0 < 1.1 * shallow[0] < shallow[1]


def test_a_point_curve_bends_and_begins_as_the_linear_one(cube_file, capsys):
    curve = ["curve", cube_file, "--at", *AT, "--tool", "point", "--depth", "0.01", "--json"]
    linear = figures_of(capsys, *curve)
    felt = figures_of(capsys, *curve, "--felt", "corrected")
    assert felt["stiffness_n_per_m"][0] == pytest.approx(linear["stiffness_n_per_m"][0])
    assert (np.diff(felt["stiffness_n_per_m"]) < 0).all()
    area = np.trapezoid(felt["stiffness_n_per_m"], felt["depth_m"])
    assert felt["force_n"][-1] == pytest.approx(area, rel=1e-3)


@pytest.mark.parametrize("command", ["press", "curve"])
def test_a_tools_force_is_linear_and_says_so(command, cube_file, capsys):
    by = ["--by", *BY] if command == "press" else []
    words = [command, cube_file, "--at", *AT, *by, "--tool", "sphere:0.008"]
    assert main([str(word) for word in [*words, "--felt", "corrected"]]) != 0
    assert "a tool's force is linear" in capsys.readouterr().err


def test_a_table_that_cannot_be_used_or_kept_is_told_and_the_figures_are_there(
    cube_file, tmp_path, capsys
):
    body_file = tmp_path / "cube.npz"
    body_file.write_bytes(cube_file.read_bytes())
    press = ["press", str(body_file), "--at", *AT, "--by", *BY, "--felt", "corrected", "--json"]
    assert main(press) == 0
    right = capsys.readouterr()
    assert right.err == ""
    table = table_path(body_file, "softening")
    table.write_bytes(table.read_bytes()[:-100])
    assert main(press) == 0
    told = capsys.readouterr()
    assert told.out == right.out
    assert told.err.startswith(f"palpate: warning: {table}: damaged")
    table.unlink()
    table.mkdir()
    assert main(press) == 0
    told = capsys.readouterr()
    assert told.out == right.out
    assert told.err.count("palpate: warning:") == 1
