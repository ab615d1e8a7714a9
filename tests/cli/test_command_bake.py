"""The commands bake, info and pin as a user runs them, from the mesh file to the figures."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from palpate.cli.bake.status_line import bake_status
from palpate.core.bake.job import JobProgress

MOUSE = Path(__file__).resolve().parents[1] / "meshes" / "mouse-1.7k.npz"


@pytest.fixture
def filled(tmp_path, figures_of):
    """Write a surface, bake it with coarse tetrahedra, and return the body's figures."""

    def fill(name, content, *words):
        (tmp_path / name).write_bytes(content)
        mesh, out = tmp_path / name, tmp_path / "filled.npz"
        return figures_of("bake", mesh, "-o", out, "--edge-length", 0.3, *words)

    return fill


def test_bake_prints_the_papers_table_for_the_cube(tets, tmp_path, figures_of):
    figures = figures_of("bake", tets, "-o", tmp_path / "cube.npz", "--poisson", 0.49)
    assert figures["nodes"] == 125
    assert figures["tets"] == 320
    assert figures["surface_nodes"] == 98
    assert figures["free_surface_nodes"] == 73
    assert figures["surface_triangles"] == 192
    assert figures["compliance_bytes"] == 73 * 73 * 9 * 4
    assert set(figures["seconds"]) == {"stiffness", "plan", "compliance"}
    again = figures_of("info", tmp_path / "cube.npz")
    assert again["key"] == figures["key"]
    assert again["free_surface_nodes"] == 73


@pytest.mark.parametrize(
    "suffix",
    [
        "obj",
        pytest.param("ply", marks=pytest.mark.at_length),
        pytest.param("stl", marks=pytest.mark.at_length),
    ],
)
def test_surfaces_of_every_kind_are_filled_with_tetrahedra(filled, suffix):
    box = trimesh.creation.box((50, 50, 50)).export(file_type=suffix)
    content = box.encode() if isinstance(box, str) else box
    words = ["--edge-length", "0.15", "--pin-below", "0.05", "--metres-per-unit", "0.001"]
    figures = filled(f"box.{suffix}", content, *words)
    assert figures["volume_m3"] == pytest.approx(0.05**3, rel=0.02)
    assert figures["fixed_nodes"] > 4


def obj_with_polygons():
    """A cube of six squares, named in an encoding of its own."""
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    faces = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (2, 4, 8, 6), (4, 3, 7, 8), (3, 1, 5, 7)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    lines += ["f " + " ".join(map(str, face)) for face in faces]
    return b"o W\xfcrfel\n" + "\n".join(lines).encode()


def ply_with_colours():
    """A cube in text, whose faces have more to say than their corners."""
    box = trimesh.creation.box((1, 1, 1))
    lines = [
        *("ply", "format ascii 1.0", "element vertex 8"),
        *(f"property float {axis}" for axis in "xyz"),
        *("element face 12", "property uchar red", "property list uchar int vertex_indices"),
        "end_header",
        *("{} {} {}".format(*vertex) for vertex in box.vertices),
        *("7 3 {} {} {}".format(*face) for face in box.faces),
    ]
    return "\n".join(lines).encode() + b"\n"


def ply_that_mixes_polygons():
    """A house as Blender writes it: walls and floor of four corners, gables of three."""
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    corners += [(0.5, 0, 1.5), (0.5, 1, 1.5)]
    faces = [(0, 3, 2, 1), (0, 1, 5, 8, 4), (2, 3, 7, 9, 6), (1, 2, 6, 5), (3, 0, 4, 7)]
    faces += [(4, 8, 9, 7), (5, 6, 9), (5, 9, 8)]
    header = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 10\nproperty float x\n"
        f"property float y\nproperty float z\nelement face {len(faces)}\n"
        "property list uchar uint vertex_indices\nend_header\n"
    )
    content = header.encode() + np.array(corners, dtype="<f4").tobytes()
    return content + b"".join(
        bytes([len(face)]) + np.array(face, dtype="<u4").tobytes() for face in faces
    )


@pytest.mark.parametrize(
    ("name", "content", "volume"),
    [
        pytest.param("quads.obj", obj_with_polygons, 1, marks=pytest.mark.at_length),
        pytest.param("colours.ply", ply_with_colours, 1, marks=pytest.mark.at_length),
        ("house.ply", ply_that_mixes_polygons, 1.25),
    ],
)
def test_polygons_and_what_else_files_hold_are_read(filled, name, content, volume):
    assert filled(name, content())["volume_m3"] == pytest.approx(volume, rel=0.02)


def test_pins_may_be_a_mask(tmp_path, figures_of, cube_mesh):
    mesh, fixed = cube_mesh
    mask = np.isin(np.arange(len(mesh.nodes)), fixed)
    np.savez(tmp_path / "cube.npz", X=mesh.nodes, T=mesh.tets, fixed=mask)
    assert figures_of("bake", tmp_path / "cube.npz", "-o", tmp_path / "b.npz")["fixed_nodes"] == 25


def test_pins_of_the_file_are_taken_unless_told_otherwise(tmp_path, figures_of):
    words = ["bake", MOUSE, "-o", tmp_path / "mouse.npz"]
    assert figures_of(*words)["fixed_nodes"] == 110
    assert figures_of(*words, "--pin-below", 0.5)["fixed_nodes"] > 300


@pytest.mark.parametrize("form", ["dense", pytest.param("compressed", marks=pytest.mark.at_length)])
def test_a_body_may_have_no_pins_until_it_is_given_some(form, tets, tmp_path, figures_of):
    free, material = tmp_path / "free.npz", ["--material", "plush", "--form", form]
    figures = figures_of("bake", tets, "-o", free, "--pins", "none", *material)
    assert (figures["fixed_nodes"], figures["density"], figures["form"]) == (0, 40.0, form)
    assert figures["mass_kg"] == pytest.approx(40.0 * figures["volume_m3"], rel=1e-9)
    assert figures_of("info", free)["mass_kg"] == figures["mass_kg"]
    denser = figures_of("bake", tets, "-o", free, "--pins", "none", *material, "--density", 80)
    assert (denser["key"], denser["density"]) == (figures["key"], 80.0)
    pinned, baked = tmp_path / "pinned.npz", tmp_path / "baked.npz"
    numbers = tmp_path / "fixed.npy"
    with np.load(tets) as stored:
        np.save(numbers, stored["fixed"])
    later = figures_of("pin", free, "--nodes", numbers, "-o", pinned)
    once = figures_of("bake", tets, "-o", baked, *material)
    assert (later["key"], later["density"]) == (once["key"], 80.0)
    press = ["--at", 0.03, 0.02, 0.05, "--by", 0, 0, "-1e-3"]
    forces = [figures_of("press", body, *press)["force"] for body in (baked, pinned)]
    np.testing.assert_allclose(forces[1], forces[0], rtol=2e-3)


def test_more_of_a_body_is_pinned_without_a_bake(cube_file, tmp_path, figures_of, cube_mesh):
    mesh, fixed = cube_mesh
    figures = figures_of("pin", cube_file, "--below", 0.3, "-o", tmp_path / "low.npz")
    assert (figures["pinned_before"], figures["fixed_nodes"]) == (25, 41)
    both, top = tmp_path / "both.npz", mesh.surface_nodes[-1]
    np.savez(both, X=mesh.nodes, T=mesh.tets, fixed=np.append(fixed, top))
    words = ["--poisson", 0.49, "--formulation", "linear"]
    baked = figures_of("bake", both, "-o", tmp_path / "baked.npz", *words)
    (tmp_path / "top.txt").write_text(f"{top}\n0 0")
    np.save(tmp_path / "top.npy", [top])
    for file in ("top.txt", "top.npy"):
        pin = ["pin", cube_file, "--nodes", tmp_path / file, "-o", tmp_path / "pinned.npz"]
        pinned = figures_of(*pin)
        assert (pinned["key"], pinned["fixed_nodes"]) == (baked["key"], 26)
    press = ["--at", 0.03, 0.03, 0.06, "--by", 0, 0, "-1e-3"]
    forces = [
        figures_of("press", tmp_path / name, *press)["force"]
        for name in ("baked.npz", "pinned.npz")
    ]
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-4, atol=1e-7)


def test_a_prediction_bakes_nothing(tmp_path, palpate, figures_of, tets):
    mesh = tmp_path / "box.stl"
    trimesh.creation.box((0.1, 0.1, 0.1)).export(mesh)
    box, cube = figures_of("bake", mesh, tets, "--predict", "--form", "dense")["predictions"]
    assert (cube["nodes"], cube["free_surface_nodes"], cube["spread"]) == (125, 73, 1)
    assert box["spread"] > 1
    assert 500 < box["nodes"] < 5000
    for figures in (box, cube):
        assert figures["form"] == "dense"
        assert figures["file_bytes"] > 36 * figures["free_surface_nodes"] ** 2
        assert figures["peak_bytes"] > 0
        assert figures["seconds"] > 0
        assert figures["refusal"] is None
    status, printed, _ = palpate("bake", tets, "--predict")
    assert status == 0
    assert printed.startswith(f"{tets}: 125 nodes, 73 free on the surface; dense, about 1 s")
    assert list(tmp_path.iterdir()) == [mesh]


def test_formulation_and_stiffness_are_told(tmp_path, figures_of, cube_mesh):
    mesh, fixed = cube_mesh
    scale = np.where(np.arange(len(mesh.tets)) < 100, 20.0, 1.0)
    np.savez(tmp_path / "t.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed, young_scale=scale)
    words = ["bake", tmp_path / "t.npz", "-o", tmp_path / "b.npz", "--poisson", 0.49]
    told = figures_of(*words)
    assert (told["formulation"], told["form"]) == ("smoothed", "dense")
    assert told["young_scale"] == [1, 20]
    told = figures_of(*words, "--formulation", "linear")
    assert told["formulation"] == "linear"
    again = figures_of("info", tmp_path / "b.npz")
    assert (again["formulation"], again["key"]) == ("linear", told["key"])


def test_progress_tells_share_and_remaining_time():
    words = bake_status(JobProgress("compliance", "Inverting the stiffness", 0.42, 130.0, 12.4))
    assert words == "Inverting the stiffness 42 %, 2.2 min, about 12 s left"
    assert bake_status(JobProgress("start", "Starting", None, 0.2)) == "Starting, 0 s"
    words = bake_status(JobProgress("check", "Comparing", 0.01, 7300.0))
    assert words == "Comparing 1 %, 2.0 h"


def test_a_compressed_body_tells_its_tolerance_and_its_error(tmp_path, figures_of):
    words = ["bake", MOUSE, "-o", tmp_path / "b.npz", "--form", "compressed"]
    told = figures_of(*words, "--tolerance", "3e-3")
    again = figures_of("info", tmp_path / "b.npz")
    for figures in (told, again):
        assert (figures["form"], figures["tolerance"]) == ("compressed", 3e-3)
        assert 1e-4 < figures["column_error"] <= 3e-3
        assert figures["dense_bytes"] == 36 * 987**2
        assert figures["compliance_bytes"] < figures["dense_bytes"] / 8
