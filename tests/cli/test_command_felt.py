"""``--felt`` of the commands: the corrected force where it is asked for, else the linear one."""

import numpy as np
import pytest
from referees.softened_points import corrected_forces

from palpate.core.body import body_file
from palpate.core.shape.force_at_depth.softening_table import SofteningTable
from palpate.core.shape.paper.table_file import table_path

AT, BY = ["0.02", "0.03", "0.05"], ["0", "0", "-0.008"]


def test_press_tells_the_corrected_force_and_draws_the_same(cube_file, figures_of):
    press = ["press", cube_file, "--at", *AT, "--by", *BY]
    linear = figures_of(*press)
    felt = figures_of(*press, "--felt", "corrected")
    assert (linear["felt"], felt["felt"]) == ("linear", "corrected")
    body = body_file.load(cube_file)
    table = SofteningTable(body)
    place = body.closest_points.query(np.array([AT], dtype=float))
    by = np.array(BY, dtype=float)
    table.fill()
    expected = corrected_forces(body, table.values, int(place.triangle[0]), place.alpha[0], by)
    assert felt["force"] == pytest.approx((-expected.sum(axis=0)).tolist())
    assert felt["force"][2] > 1.05 * linear["force"][2] > 0
    assert felt["nodal_forces"] == linear["nodal_forces"]
    assert felt["max_displacement"] == linear["max_displacement"]
    # What was computed is there the next time.
    assert table_path(cube_file, "softening").exists()
    assert figures_of(*press, "--felt", "corrected") == felt


def test_a_deep_finger_is_firmer_and_takes_more_from_a_shallow_one(cube_file, figures_of):
    press = ["press", cube_file, "--at", *AT, "--by", *BY]
    press += ["--at", "0.04", "0.03", "0.05", "--by", "0", "0", "-0.003"]
    linear = figures_of(*press)["contacts"]
    felt = figures_of(*press, "--felt", "corrected")["contacts"]
    deep, shallow = (
        (one["force"][2], other["force"][2]) for one, other in zip(linear, felt, strict=True)
    )
    assert 0 < 1.03 * deep[0] < deep[1]
    assert 0 < shallow[1] < shallow[0]


def test_a_point_curve_bends_and_begins_as_the_linear_one(cube_file, figures_of):
    curve = ["curve", cube_file, "--at", *AT, "--tool", "point", "--depth", "0.01"]
    linear = figures_of(*curve)
    felt = figures_of(*curve, "--felt", "corrected")
    assert felt["stiffness_n_per_m"][0] == pytest.approx(linear["stiffness_n_per_m"][0])
    assert (np.diff(felt["stiffness_n_per_m"]) > 0).all()
    area = np.trapezoid(felt["stiffness_n_per_m"], felt["depth_m"])
    assert felt["force_n"][-1] == pytest.approx(area, rel=1e-3)


@pytest.mark.parametrize("command", ["press", "curve"])
def test_a_tools_force_is_linear_and_says_so(command, cube_file, refusal):
    by = ["--by", *BY] if command == "press" else []
    words = [command, cube_file, "--at", *AT, *by, "--tool", "sphere:0.008"]
    assert "a tool's force is linear" in refusal(*words, "--felt", "corrected")


def test_a_table_that_cannot_be_used_or_kept_is_told_and_the_figures_are_there(
    cube_file, tmp_path, palpate
):
    body_file = tmp_path / "cube.npz"
    body_file.write_bytes(cube_file.read_bytes())
    press = ["press", body_file, "--at", *AT, "--by", *BY, "--felt", "corrected", "--json"]
    status, right, said = palpate(*press)
    assert (status, said) == (0, "")
    table = table_path(body_file, "softening")
    table.write_bytes(table.read_bytes()[:-100])
    status, printed, said = palpate(*press)
    assert (status, printed) == (0, right)
    assert said.startswith(f"palpate: warning: {table}: damaged")
    table.unlink()
    table.mkdir()
    status, printed, said = palpate(*press)
    assert (status, printed) == (0, right)
    assert said.count("palpate: warning:") == 1
