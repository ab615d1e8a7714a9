"""What the command line says of meshes that are too thin, too far away, open or of odd size."""

import json

import numpy as np
import pytest
import trimesh


@pytest.fixture
def written(tmp_path):
    """Write a mesh as a file of some kind."""

    def write(mesh, kind="obj"):
        path = tmp_path / f"mesh.{kind}"
        options = {"digits": 12} if kind == "obj" else {}
        content = mesh.export(file_type=kind, **options)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


@pytest.mark.parametrize("edge_length", [0.05, 0.02])
def test_a_needle_is_told_its_tolerance_not_holes_or_pins(written, refusal, tmp_path, edge_length):
    needle = trimesh.creation.cylinder(radius=0.00025, height=0.2, sections=12)
    needle.apply_transform(trimesh.transformations.rotation_matrix(0.5, [0.3, 0.8, 0.1]))
    words = ["--edge-length", edge_length, "-o", tmp_path / "body.npz"]
    said = refusal("bake", written(needle), *words)
    assert "too thin for a tolerance of 60" in said
    assert "--epsilon" in said
    assert "hole" not in said
    assert "pin" not in said


@pytest.mark.parametrize("kind", ["stl", "ply"])
def test_detail_that_a_file_has_lost_far_away_is_named(written, refusal, tmp_path, kind):
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.05)
    ball.apply_translation([1e4, 0, 0])
    ball.vertices = np.round(ball.vertices, 6)
    if kind == "ply":
        # Single precision, as most programs write it.
        ball.vertices = ball.vertices.astype(np.float32)
    said = refusal("bake", written(ball, kind), "-o", tmp_path / "body.npz")
    assert "times its size from the origin" in said
    assert "detail is lost" in said


@pytest.mark.parametrize(
    ("unit", "size"),
    [
        (1e4, "1 km"),
        pytest.param(1e-5, "1 µm", marks=pytest.mark.at_length),
        pytest.param(1.0, None, marks=pytest.mark.at_length),
    ],
)
def test_the_fit_is_told_by_bake_and_info_and_odd_sizes_by_both(
    written, palpate, tmp_path, unit, size
):
    edge = 0.1 / np.sqrt(3)
    block = written(trimesh.creation.box((edge, edge, edge)))
    words = ["--edge-length", 0.3, "--pin-below", 0.05, "--metres-per-unit", unit, "--json"]
    status, printed, said = palpate("bake", block, "-o", tmp_path / "body.npz", *words)
    assert status == 0
    baked = json.loads(printed)["fit"]
    assert 0 <= baked["body_to_input"] < 0.004 * 0.1 * unit
    assert 0 <= baked["input_to_body"] < 0.004 * 0.1 * unit
    status, printed, again = palpate("info", tmp_path / "body.npz", "--json")
    assert status == 0
    assert json.loads(printed)["fit"] == baked
    for told in (said, again):
        assert ("the body is" in told) == bool(size)
        assert size is None or f"{size} large" in told
