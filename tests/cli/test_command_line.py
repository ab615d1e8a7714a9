"""The commands bake, info and press as a user runs them, from the mesh file to the figures."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import trimesh

from palpate.cli.bake.status_line import bake_status
from palpate.cli.main import main
from palpate.cli.press.tool_option import tool_from
from palpate.core.bake.job import JobProgress
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import press_points, touch_nearest
from palpate.core.contact.tool.tools import plate, rod
from palpate.core.shape.meeting import FingerLoad, settled
from palpate.core.shape.shapes import MAKERS, shape

MOUSE = Path(__file__).resolve().parents[1] / "meshes" / "mouse-1.7k.npz"
PRESSED = ["--at", *"000", "--by", *"001"]


def palpate(capsys, *words):
    status = main([str(word) for word in words])
    printed = capsys.readouterr()
    return status, printed.out, printed.err


@pytest.fixture(scope="module")
def cube_file(tmp_path_factory, cube_mesh):
    folder = tmp_path_factory.mktemp("cube")
    mesh, fixed = cube_mesh
    np.savez(folder / "cube-tets.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed)
    words = ["--poisson", "0.49", "--formulation", "linear"]
    status = main(["bake", str(folder / "cube-tets.npz"), "-o", str(folder / "cube.npz"), *words])
    assert status == 0
    return folder / "cube.npz"


def test_bake_prints_the_papers_table_for_the_cube(cube_file, capsys):
    tets = cube_file.with_name("cube-tets.npz")
    out = cube_file.with_name("again.npz")
    status, printed, _ = palpate(capsys, "bake", tets, "-o", out, "--poisson", 0.49, "--json")
    figures = json.loads(printed)
    assert status == 0
    assert figures["nodes"] == 125
    assert figures["tets"] == 320
    assert figures["surface_nodes"] == 98
    assert figures["free_surface_nodes"] == 73
    assert figures["surface_triangles"] == 192
    assert figures["compliance_bytes"] == 73 * 73 * 9 * 4
    assert set(figures["seconds"]) == {"stiffness", "plan", "compliance"}
    _, printed, _ = palpate(capsys, "info", out, "--json")
    again = json.loads(printed)
    assert again["key"] == figures["key"]
    assert again["free_surface_nodes"] == 73


def test_bake_fills_a_surface_with_tetrahedra(tmp_path, capsys):
    trimesh.creation.box((50, 50, 50)).export(tmp_path / "box.stl")
    status, printed, _ = palpate(
        capsys, "bake", tmp_path / "box.stl", "-o", tmp_path / "box.npz", "--edge-length", 0.15,
        "--pin-below", 0.05, "--metres-per-unit", 0.001, "--json",
    )  # fmt: skip
    figures = json.loads(printed)
    assert status == 0
    assert figures["volume_m3"] == pytest.approx(0.05**3, rel=0.02)
    assert figures["fixed_nodes"] > 4


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl"])
def test_surfaces_of_every_kind_are_read(tmp_path, capsys, suffix):
    mesh = trimesh.creation.icosphere(subdivisions=1, radius=0.05)
    mesh.export(tmp_path / f"ball.{suffix}")
    status, printed, _ = palpate(
        capsys, "bake", tmp_path / f"ball.{suffix}", "-o", tmp_path / "ball.npz",
        "--edge-length", 0.2, "--epsilon", 0.01, "--pin-below", 0.3, "--json",
    )  # fmt: skip
    assert status == 0
    assert json.loads(printed)["volume_m3"] == pytest.approx(mesh.volume, rel=0.1)


def test_an_obj_with_polygons_is_triangulated(tmp_path, capsys):
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    faces = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (2, 4, 8, 6), (4, 3, 7, 8), (3, 1, 5, 7)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    lines += ["f " + " ".join(map(str, face)) for face in faces]
    (tmp_path / "quads.obj").write_text("\n".join(lines))
    status, printed, _ = palpate(
        capsys, "bake", tmp_path / "quads.obj", "-o", tmp_path / "b.npz",
        "--edge-length", 0.3, "--json",
    )  # fmt: skip
    assert status == 0
    assert json.loads(printed)["volume_m3"] == pytest.approx(1, rel=0.02)


def test_a_ply_that_mixes_polygons_is_read_as_blender_writes_it(tmp_path, capsys):
    """A house: four walls and a floor of four corners, two gables of three, two roof sides."""
    corners = [
        (0, 0, 0),
        (1, 0, 0),
        (1, 1, 0),
        (0, 1, 0),
        (0, 0, 1),
        (1, 0, 1),
        (1, 1, 1),
        (0, 1, 1),
    ]
    corners += [(0.5, 0, 1.5), (0.5, 1, 1.5)]
    faces = [(0, 3, 2, 1), (0, 1, 5, 8, 4), (2, 3, 7, 9, 6), (1, 2, 6, 5), (3, 0, 4, 7)]
    faces += [(4, 8, 9, 7), (5, 6, 9), (5, 9, 8)]
    header = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 10\nproperty float x\n"
        f"property float y\nproperty float z\nelement face {len(faces)}\n"
        "property list uchar uint vertex_indices\nend_header\n"
    )
    content = header.encode() + np.array(corners, dtype="<f4").tobytes()
    for face in faces:
        content += bytes([len(face)]) + np.array(face, dtype="<u4").tobytes()
    (tmp_path / "house.ply").write_bytes(content)
    status, printed, _ = palpate(
        capsys, "bake", tmp_path / "house.ply", "-o", tmp_path / "b.npz",
        "--edge-length", 0.3, "--json",
    )  # fmt: skip
    assert status == 0
    assert json.loads(printed)["volume_m3"] == pytest.approx(1.25, rel=0.02)


@pytest.mark.parametrize("mode", ["paper", "consistent"])
def test_press_reads_the_force_and_writes_displacements(mode, cube_file, tmp_path, capsys, cube):
    out = tmp_path / "u.npy"
    status, printed, _ = palpate(
        capsys, "press", cube_file, "--at", 0.021, 0.024, 0.06, "--by", 0, "1e-3", "-5e-3",
        "--young", 10000, "--mode", mode, "--displacements", out, "--json",
    )  # fmt: skip
    figures = json.loads(printed)
    assert status == 0
    touch = touch_nearest(
        cube, [0.021, 0.024, 0.06], [0, 1e-3, -5e-3], ContactSettings(10000, mode=mode)
    )
    np.testing.assert_allclose(figures["force"], touch.force, rtol=1e-9)
    np.testing.assert_allclose(figures["nodal_forces"], touch.nodal_forces, rtol=1e-9)
    assert figures["mode"] == mode
    assert figures["triangle"] == touch.triangle.tolist()
    assert sum(figures["alpha"]) == pytest.approx(1)
    np.testing.assert_allclose(-np.sum(figures["nodal_forces"], axis=0), figures["force"])
    displacements = np.load(out)
    assert displacements.shape == (73, 3)
    assert displacements.dtype == np.float64
    largest = np.linalg.norm(displacements, axis=1).max()
    assert figures["max_displacement"] == pytest.approx(largest)


def test_press_is_consistent_unless_told_otherwise(cube_file, capsys):
    words = ["press", cube_file, "--at", 0.02, 0.024, 0.05, "--by", 0, 0, "-5e-3", "--json"]
    figures = json.loads(palpate(capsys, *words)[1])
    assert figures["mode"] == "consistent"
    np.testing.assert_allclose(figures["contact_displacement"], [0, 0, -5e-3], atol=1e-8)
    assert json.loads(palpate(capsys, *words, "--mode", "paper")[1])["force"] != figures["force"]


def test_press_takes_several_fingers_in_order(cube_file, tmp_path, capsys, cube):
    at, by = [[0, 0.025, 0.03], [0.05, 0.02, 0.03]], [[0.004, 0, 0], [-0.003, 0, 0]]
    pairs = [
        word
        for a, b in zip(at, by, strict=True)
        for word in ("--at", *a, "--by", *map("{:f}".format, b))
    ]
    out = tmp_path / "u.npy"
    words = ["press", cube_file, *pairs, "--young", 1000, "--displacements", out]
    status, printed, _ = palpate(capsys, *words, "--json")
    figures = json.loads(printed)
    assert status == 0
    touches = press_points(cube, at, by, ContactSettings(1000))
    assert len(figures["contacts"]) == 2
    for contact, touch in zip(figures["contacts"], touches, strict=True):
        np.testing.assert_allclose(contact["force"], touch.force, rtol=1e-9)
        np.testing.assert_allclose(contact["nodal_forces"], touch.nodal_forces, rtol=1e-9)
        np.testing.assert_allclose(contact["contact_displacement"], touch.displacement, atol=1e-7)
    forces = -np.array([contact["force"] for contact in figures["contacts"]])
    moved = np.einsum("pqij,qj->pi", figures["coupling"], forces)
    np.testing.assert_allclose(moved, by, atol=1e-9)
    largest = np.linalg.norm(np.load(out), axis=1).max()
    assert figures["max_displacement"] == pytest.approx(largest)
    status, printed, _ = palpate(capsys, *words)
    assert status == 0
    assert [line for line in printed.splitlines() if not line.startswith(" ")] == [
        "contact 1",
        "contact 2",
        "coupling, m/N (how far each contact moves per newton on each)",
        f"max displacement  {figures['max_displacement']:.6g}",
        "young modulus     1000",
        "shape             linear",
        "mode              consistent",
        "felt              linear",
    ]


@pytest.mark.parametrize("tool", ["sphere:0.015", "convex"])
def test_press_takes_a_tool_instead_of_a_point(tool, cube_file, tmp_path, capsys, cube):
    (tmp_path / "tip.obj").write_text(
        "v -.01 -.01 .02\nv .01 -.01 .02\nv .01 .01 .02\nv -.01 .01 .02\nv 0 0 0\n"
        "f 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n"
    )
    named = f"convex:{tmp_path / 'tip.obj'}" if tool == "convex" else tool
    out = tmp_path / "u.npy"
    words = [
        "press", cube_file, "--at", 0.025, 0.02, 0.06, "--by", 0, 0, "-3e-3",
        "--tool", named, "--displacements", out,
    ]  # fmt: skip
    status, printed, _ = palpate(capsys, *words, "--json")
    figures = json.loads(printed)
    assert status == 0
    assert figures["exact"] is True
    assert figures["force"][2] > 0
    np.testing.assert_allclose(
        -np.sum(figures["nodal_forces"], axis=0), figures["force"], atol=1e-12
    )
    nodes, forces = np.array(figures["nodes"]), np.array(figures["nodal_forces"])
    moved = cube.deform(nodes, forces, figures["young_modulus"])
    largest = np.abs(moved).max()
    np.testing.assert_allclose(np.load(out), moved, rtol=0, atol=1e-6 * largest)
    places = np.array(figures["points"]) + figures["point_displacements"]
    assert len(figures["pressures"]) == len(places)
    if tool.startswith("sphere"):
        # The pressed points have gone to the tool's surface.
        in_tool = (places - figures["position"]) @ np.array(figures["rotation"])
        np.testing.assert_allclose(tool_from(named).distance(in_tool)[0], 0, atol=1e-6)
    if tool.startswith("sphere"):
        printed = palpate(capsys, *words)[1]
        assert f"tool                   {named}" in printed.splitlines()
        assert f"pressed points         {len(places)}" in printed.splitlines()


def test_tools_are_named_by_kind_and_lengths():
    for words, expected in (
        ("rod:0.01:0.02", rod(0.01, 0.02)),
        ("plate:0.04:0.03", plate(0.04, 0.03)),
    ):
        tool = tool_from(words)
        assert tool.name == words
        np.testing.assert_array_equal(tool.core, expected.core)
        assert tool.radius == expected.radius


def test_press_takes_several_tools_and_friction(cube_file, capsys):
    tool = ["--tool", "sphere:0.015"]
    left, right = ([x, 0.025, 0.03] for x in (0, 0.05))
    one = ["press", cube_file, "--at", *left, "--by", "2e-3", "1e-3", 0]
    both = [*one, "--at", *right, "--by", "-2e-3", "1e-3", 0]
    status, printed, _ = palpate(capsys, *both, *tool, "--json")
    assert status == 0
    pinch = [contact["force"] for contact in json.loads(printed)["contacts"]]
    alone = json.loads(palpate(capsys, *one, *tool, "--json")[1])["force"]
    assert pinch[0][0] < 1.02 * alone[0] < 0 < pinch[1][0]  # They press against each other.
    rubbed = json.loads(palpate(capsys, *one, *tool, "--friction", 0.5, "--json")[1])["force"]
    assert rubbed[1] < alone[1] - 0.05 * abs(alone[0])  # Held back by the surface.


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["bake", "none.obj", "-o", "out.npz"], "none.obj"),
        (["bake", "notes.txt", "-o", "out.npz"], "obj, ply, stl or npz"),
        (["bake", "broken.stl", "-o", "out.npz"], "broken.stl"),
        (["bake", "broken.npz", "-o", "out.npz"], "broken.npz"),
        (["bake", "empty.obj", "-o", "out.npz"], "empty.obj"),
        (["bake", "plane.obj", "-o", "out.npz"], "flat"),
        (["bake", "nan.npz", "-o", "out.npz"], "finite"),
        (["bake", "other.npz", "-o", "out.npz"], "no array"),
        (["bake", "cube.npz", "-o", "out.npz", "--poisson", "0.5"], "Poisson"),
        (["bake", "cube.npz", "-o", "out.npz", "--young", "0"], "Young"),
        (["bake", "cube.npz", "-o", "out.npz", "--pin-below", "2"], "fraction"),
        (["bake", "cube.npz", "-o", "out.npz", "--metres-per-unit", "-1"], "--metres-per-unit"),
        (["bake", "cube.npz", "-o", "out.npz", "--edge-length", "0.1"], "--edge-length"),
        (["bake", "box.stl", "-o", "out.npz", "--edge-length", "0"], "edge length"),
        (["bake", "cube.npz", "-o", "nowhere/out.npz"], "no folder"),
        (["bake", "cube.npz"], "--output-folder"),
        (["bake", "cube.npz", "-o", "out.npz", "--form", "sparse"], "--form"),
        (["bake", "cube.npz", "-o", "out.npz", "--formulation", "cubic"], "--formulation"),
        (["bake", "cube.npz", "-o", "out.npz", "--tolerance", "2"], "tolerance"),
        (["bake", "cube.npz", "-o", "out.npz", "--threads", "0"], "threads"),
        (["bake", "none.obj", "--predict"], "none.obj"),
        (["bake", "single.npz", "-o", "out.npz"], "single.npz"),
        (["bake", "halves.npz", "-o", "out.npz"], "names no nodes"),
        (["bake", "words.npz", "-o", "out.npz"], "real numbers"),
        (["bake", "vast.npz", "-o", "out.npz"], "check the unit"),
        (["bake", "short.stl", "-o", "out.npz"], "neither text nor"),
        (["bake", "two\nlines.obj", "-o", "out.npz"], "two lines.obj"),
        (["bake", "tip.npz", "-o", "out.npz", "--pin-below", "0"], "could move"),
        (["bake", "cube.npz", "-o", "notes.txt/out.npz"], "written"),
        (["info", "none.npz"], "none.npz"),
        (["info", "notes.txt"], "notes.txt"),
        (["pin", "none.npz", "--below", "0.3", "-o", "out.npz"], "none.npz"),
        (["pin", "{body}", "--below", "2", "-o", "out.npz"], "fraction"),
        (["pin", "{body}", "--below", "1", "-o", "out.npz"], "nothing is left to touch"),
        (["pin", "{body}", "-o", "out.npz"], "--below"),
        (["pin", "{body}", "--nodes", "none.txt", "-o", "out.npz"], "none.txt"),
        (["pin", "{body}", "--nodes", "notes.txt", "-o", "out.npz"], "notes.txt"),
        (["pin", "{body}", "--nodes", "blank.txt", "-o", "out.npz"], "no node numbers"),
        (["pin", "{body}", "--nodes", "halves.npy", "-o", "out.npz"], "no node numbers"),
        (["pin", "{body}", "--nodes", "beyond.txt", "-o", "out.npz"], "not a node"),
        (["pin", "{body}", "--nodes", "inner.txt", "-o", "out.npz"], "inside the body"),
        (["pin", "{body}", "--nodes", "top.txt", "-o", "nowhere/out.npz"], "nowhere"),
        (["press", "other.npz", "--at", "0", "0", "0", "--by", "0", "0", "0"], "other.npz"),
        (["press", "{body}", "--at", "0", "0", "nan", "--by", "0", "0", "0"], "--at"),
        (["press", "{body}", "--at", "0", "0", "0", "--by", "0", "inf", "0"], "--by"),
        (["press", "{body}", "--at", "0", "0", "1e200", "--by", "0", "0", "0"], "--at"),
        (
            ["press", "{body}", "--at", *"000", "--by", "0", "0", "1e9", "--young", "1e308"],
            "number",
        ),
        (
            ["press", "{body}", "--at", *"000", "--by", *"000", "--displacements", "no/u.npy"],
            "u.npy",
        ),
        (["press", "{body}", "--at", "0", "0", "0", "--by", "0", "0", "0", "--young", "-1"], "You"),
        (["press", "{body}", "--at", "0", "0", "--by", "0", "0", "0"], "--at"),
        (["press", "{body}", "--at", "0", "0", "0"], "--by"),
        (
            ["press", "{body}", *PRESSED, "--tool", "ball:1"],
            "'ball:1' is no tool; give sphere:RADIUS",
        ),
        (["press", "{body}", *PRESSED, "--tool", "plate:0.1"], "'plate:0.1' is no tool"),
        (["press", "{body}", *PRESSED, "--tool", "sphere:-1"], "tool sphere:-1: radius"),
        (["press", "{body}", *PRESSED, "--tool", "convex:none.obj"], "none.obj"),
        (["press", "{body}", *PRESSED, *PRESSED[:4], "--tool", "sphere:1"], "2 times and --by 1"),
        (["press", "{body}", *PRESSED, "--friction", "1"], "--friction: points have none"),
        (["press", "{body}", *PRESSED, "--tool", "sphere:1", "--mode", "paper"], "--mode"),
        (
            ["press", "{body}", "--at", *"000", "--by", "0", "0", "nan", "--tool", "sphere:1"],
            "--by",
        ),
        (["press", "{body}", *2 * ["--at", *"000"], "--by", *"001"], "2 times and --by 1 times"),
        (["fly"], "fly"),
        ([], "COMMAND"),
    ],
)
def test_bad_input_gets_one_line_status_2_and_no_file(
    tmp_path, cube_file, cube_mesh, words, said, monkeypatch, capfd
):
    monkeypatch.chdir(tmp_path)
    mesh, fixed = cube_mesh
    np.savez("cube.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed)
    np.savez("nan.npz", X=mesh.nodes * np.nan, T=mesh.tets, fixed=fixed)
    np.savez("other.npz", a=1)
    with Path("single.npz").open("wb") as stream:
        np.save(stream, mesh.nodes)
    np.savez("halves.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed + 0.5)
    np.savez("words.npz", X=mesh.nodes.astype(str), T=mesh.tets, fixed=fixed)
    np.savez("vast.npz", X=mesh.nodes * 1e200, T=mesh.tets, fixed=fixed)
    box = trimesh.creation.box().export(file_type="stl")
    Path("box.stl").write_bytes(box)
    Path("short.stl").write_bytes(box[:-60])
    on_its_tip = np.array([[0, 0, 0], [1, 0, 1], [0, 1, 1], [1, 1, 3]]) * 0.1
    np.savez("tip.npz", X=on_its_tip, T=np.array([[0, 1, 2, 3]]))
    Path("notes.txt").write_text("hello")
    Path("blank.txt").write_text(" ")
    Path("beyond.txt").write_text("99999")
    Path("top.txt").write_text(str(mesh.surface_nodes[-1]))
    Path("inner.txt").write_text(str(np.setdiff1d(np.arange(125), mesh.surface_nodes)[0]))
    np.save("halves.npy", [0.5, 1.5])
    Path("broken.stl").write_bytes(b"solid\nfacet normal 0 0")
    Path("broken.npz").write_bytes(b"PK\x03\x04")
    Path("empty.obj").write_text("# nothing\n")
    Path("plane.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    words = [word.format(body=cube_file) for word in words]
    try:
        status = main(words)
    except SystemExit as ended:
        status = ended.code
    printed = capfd.readouterr()
    assert status == 2
    assert printed.out == ""
    assert len(printed.err.splitlines()) == 1
    assert printed.err.startswith("palpate: ")
    assert said in printed.err
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_names_in_any_encoding_do_not_hinder(tmp_path, capsys):
    text = trimesh.creation.box((0.1, 0.1, 0.1)).export(file_type="obj")
    (tmp_path / "box.obj").write_bytes(b"o W\xfcrfel\n" + text.encode())
    status, _, _ = palpate(
        capsys, "bake", tmp_path / "box.obj", "-o", tmp_path / "b.npz", "--edge-length", 0.3
    )
    assert status == 0


def test_a_ply_with_more_to_say_of_its_faces_is_read(tmp_path, capsys):
    box = trimesh.creation.box((0.1, 0.1, 0.1))
    lines = [
        *("ply", "format ascii 1.0", "element vertex 8"),
        *(f"property float {axis}" for axis in "xyz"),
        *("element face 12", "property uchar red", "property list uchar int vertex_indices"),
        "end_header",
        *("{} {} {}".format(*vertex) for vertex in box.vertices),
        *("7 3 {} {} {}".format(*face) for face in box.faces),
    ]
    (tmp_path / "box.ply").write_text("\n".join(lines) + "\n")
    status, _, _ = palpate(
        capsys, "bake", tmp_path / "box.ply", "-o", tmp_path / "b.npz", "--edge-length", 0.3
    )
    assert status == 0


def test_pins_may_be_a_mask(tmp_path, capsys, cube_mesh):
    mesh, fixed = cube_mesh
    mask = np.isin(np.arange(len(mesh.nodes)), fixed)
    np.savez(tmp_path / "cube.npz", X=mesh.nodes, T=mesh.tets, fixed=mask)
    status, printed, _ = palpate(
        capsys, "bake", tmp_path / "cube.npz", "-o", tmp_path / "b.npz", "--json"
    )
    assert status == 0
    assert json.loads(printed)["fixed_nodes"] == 25


@pytest.mark.skipif(sys.platform == "win32", reason="signals are of Unix")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_bake_that_is_stopped_leaves_nothing(tmp_path, number):
    trimesh.creation.icosphere(subdivisions=4).export(tmp_path / "ball.stl")
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    words = ["bake", "ball.stl", "-o", "out.npz", "--edge-length", "0.02"]
    with subprocess.Popen(
        [sys.executable, "-m", "palpate.cli.main", *words],
        cwd=tmp_path,
        env=os.environ | {"TMPDIR": str(scratch)},
        stderr=subprocess.PIPE,
        text=True,
    ) as program:
        while not list(scratch.glob("*/progress.jsonl")):
            assert program.poll() is None
            time.sleep(0.05)
        program.send_signal(number)
        _, said = program.communicate(timeout=30)
    assert (program.returncode, said) == (130, "palpate: stopped\n")
    assert [path.name for path in scratch.iterdir()] == []
    assert not (tmp_path / "out.npz").exists()


def test_the_program_ends_with_the_status_and_the_line(tmp_path):
    ended = subprocess.run(
        [sys.executable, "-m", "palpate.cli.main", "info", str(tmp_path / "none.npz")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 2
    assert ended.stdout == ""
    assert ended.stderr.startswith("palpate: ")
    assert len(ended.stderr.splitlines()) == 1


def test_pins_of_the_file_are_taken_unless_told_otherwise(tmp_path, capsys):
    _, printed, _ = palpate(capsys, "bake", MOUSE, "-o", tmp_path / "a.npz", "--json")
    assert json.loads(printed)["fixed_nodes"] == 110
    _, printed, _ = palpate(
        capsys, "bake", MOUSE, "-o", tmp_path / "b.npz", "--pin-below", 0.5, "--json"
    )
    assert json.loads(printed)["fixed_nodes"] > 300


def test_more_of_a_body_is_pinned_without_a_bake(cube_file, tmp_path, capsys, cube_mesh):
    mesh, fixed = cube_mesh
    _, printed, _ = palpate(
        capsys, "pin", cube_file, "--below", 0.3, "-o", tmp_path / "low.npz", "--json"
    )
    figures = json.loads(printed)
    assert (figures["pinned_before"], figures["fixed_nodes"]) == (25, 41)
    both = tmp_path / "both.npz"
    np.savez(both, X=mesh.nodes, T=mesh.tets, fixed=np.append(fixed, mesh.surface_nodes[-1]))
    words = ["--poisson", 0.49, "--formulation", "linear", "--json"]
    _, printed, _ = palpate(capsys, "bake", both, "-o", tmp_path / "baked.npz", *words)
    baked = json.loads(printed)
    (tmp_path / "top.txt").write_text(f"{mesh.surface_nodes[-1]}\n0 0")
    for file in ("top.txt", "top.npy"):
        if file.endswith("npy"):
            np.save(tmp_path / file, mesh.surface_nodes[-1:])
        pin = ["pin", cube_file, "--nodes", tmp_path / file, "-o", tmp_path / "pinned.npz"]
        status, printed, _ = palpate(capsys, *pin, "--json")
        pinned = json.loads(printed)
        assert status == 0
        assert (pinned["key"], pinned["fixed_nodes"]) == (baked["key"], 26)
    press = ["--at", 0.03, 0.03, 0.06, "--by", 0, 0, "-1e-3", "--json"]
    forces = [
        json.loads(palpate(capsys, "press", tmp_path / name, *press)[1])["force"]
        for name in ("baked.npz", "pinned.npz")
    ]
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-4, atol=1e-7)


def test_a_prediction_bakes_nothing(tmp_path, capsys, cube_file):
    trimesh.creation.box((0.1, 0.1, 0.1)).export(tmp_path / "box.stl")
    before = sorted(path.name for path in tmp_path.iterdir())
    tets = cube_file.with_name("cube-tets.npz")
    status, printed, _ = palpate(
        capsys, "bake", tmp_path / "box.stl", tets, "--predict", "--form", "dense", "--json"
    )
    assert status == 0
    box, cube = json.loads(printed)["predictions"]
    assert (cube["nodes"], cube["free_surface_nodes"], cube["spread"]) == (125, 73, 1)
    assert box["spread"] > 1
    assert 500 < box["nodes"] < 5000
    for figures in (box, cube):
        assert figures["form"] == "dense"
        assert figures["file_bytes"] > 36 * figures["free_surface_nodes"] ** 2
        assert figures["peak_bytes"] > 0
        assert figures["seconds"] > 0
        assert figures["refusal"] is None
    status, printed, _ = palpate(capsys, "bake", tets, "--predict")
    assert status == 0
    assert printed.startswith(f"{tets}: 125 nodes, 73 free on the surface; dense, about 1 s")
    assert sorted(path.name for path in tmp_path.iterdir()) == before


def test_formulation_and_stiffness_are_told(tmp_path, capsys, cube_mesh):
    mesh, fixed = cube_mesh
    scale = np.where(np.arange(len(mesh.tets)) < 100, 20.0, 1.0)
    np.savez(tmp_path / "t.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed, young_scale=scale)
    words = ["bake", tmp_path / "t.npz", "-o", tmp_path / "b.npz", "--poisson", 0.49, "--json"]
    told = json.loads(palpate(capsys, *words)[1])
    assert (told["formulation"], told["form"]) == ("smoothed", "dense")
    assert told["young_scale"] == [1, 20]
    told = json.loads(palpate(capsys, *words, "--formulation", "linear")[1])
    assert told["formulation"] == "linear"
    again = json.loads(palpate(capsys, "info", tmp_path / "b.npz", "--json")[1])
    assert (again["formulation"], again["key"]) == ("linear", told["key"])


def test_progress_tells_share_and_remaining_time():
    words = bake_status(JobProgress("compliance", "Inverting the stiffness", 0.42, 130.0, 12.4))
    assert words == "Inverting the stiffness 42 %, 2.2 min, about 12 s left"
    assert bake_status(JobProgress("start", "Starting", None, 0.2)) == "Starting, 0 s"
    words = bake_status(JobProgress("check", "Comparing", 0.01, 7300.0))
    assert words == "Comparing 1 %, 2.0 h"


def test_a_compressed_body_tells_its_tolerance_and_its_error(tmp_path, capsys):
    words = ["bake", MOUSE, "-o", tmp_path / "b.npz", "--form", "compressed", "--json"]
    told = json.loads(palpate(capsys, *words, "--tolerance", "3e-3")[1])
    again = json.loads(palpate(capsys, "info", tmp_path / "b.npz", "--json")[1])
    for figures in (told, again):
        assert (figures["form"], figures["tolerance"]) == ("compressed", 3e-3)
        assert 1e-4 < figures["column_error"] <= 3e-3
        assert figures["dense_bytes"] == 36 * 987**2
        assert figures["compliance_bytes"] < figures["dense_bytes"] / 8


@pytest.mark.parametrize("name", MAKERS)
def test_press_writes_the_shape_that_is_asked_for(name, cube_file, tmp_path, capsys, cube):
    out = tmp_path / "u.npy"
    words = ["press", cube_file, "--at", 0.021, 0.024, 0.06, "--by", 0, 0, "-5e-3", "--json"]
    status, printed, _ = palpate(capsys, *words, "--shape", name, "--displacements", out)
    assert status == 0
    assert json.loads(printed)["shape"] == name
    touch = touch_nearest(cube, [0.021, 0.024, 0.06], [0, 0, -5e-3])
    made = shape(cube, name)
    loads = [FingerLoad(touch.triangle, touch.nodal_forces)]
    wanted = settled(cube, made, loads, cube.young_modulus).displacements
    made.close()
    np.testing.assert_allclose(np.load(out), wanted, atol=1e-6 * np.abs(wanted).max())
