"""What the commands refuse, and how they end."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import trimesh


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("bake none.obj -o out.npz", "none.obj"),
        ("bake folder.obj -o out.npz", "a folder, a device or a pipe"),
        ("bake huge.npz -o out.npz", "node 9223372036854775808"),
        ("bake held.npz -o out.npz", "names node 9223372036854775808"),
        ("bake notes.txt -o out.npz", "obj, ply or stl"),
        ("bake broken.stl -o out.npz", "broken.stl"),
        ("bake broken.npz -o out.npz", "broken.npz"),
        ("bake empty.obj -o out.npz", "empty.obj"),
        ("bake plane.obj -o out.npz", "flat"),
        ("bake nan.npz -o out.npz", "finite"),
        ("bake other.npz -o out.npz", "no array"),
        ("bake cube.npz -o out.npz --poisson 0.5", "Poisson"),
        ("bake cube.npz -o out.npz --young 0", "Young"),
        ("bake cube.npz -o out.npz --pin-below 2", "fraction"),
        ("bake cube.npz -o out.npz --metres-per-unit -1", "--metres-per-unit"),
        ("bake cube.npz -o out.npz --edge-length 0.1", "--edge-length"),
        ("bake box.stl -o out.npz --edge-length 0", "edge length"),
        ("bake cube.npz -o nowhere/out.npz", "no folder"),
        ("bake cube.npz", "--output-folder"),
        ("bake cube.npz -o out.npz --form sparse", "--form"),
        ("bake cube.npz -o out.npz --formulation cubic", "--formulation"),
        ("bake cube.npz -o out.npz --tolerance 2", "tolerance"),
        ("bake cube.npz -o out.npz --threads 0", "threads"),
        ("bake none.obj --predict", "none.obj"),
        ("bake single.npz -o out.npz", "single.npz"),
        ("bake halves.npz -o out.npz", "names no nodes"),
        ("bake words.npz -o out.npz", "real numbers"),
        ("bake vast.npz -o out.npz", "check the unit"),
        ("bake short.stl -o out.npz", "neither text nor"),
        ("bake two\nlines.obj -o out.npz", "two lines.obj"),
        ("bake tip.npz -o out.npz --pin-below 0", "could move"),
        ("bake cube.npz -o notes.txt/out.npz", "written"),
        ("info none.npz", "none.npz"),
        ("info notes.txt", "notes.txt"),
        ("pin none.npz --below 0.3 -o out.npz", "none.npz"),
        ("pin {body} --below 2 -o out.npz", "fraction"),
        ("pin {body} --below 1 -o out.npz", "nothing is left to touch"),
        ("pin {body} -o out.npz", "--below"),
        ("pin {body} --nodes none.txt -o out.npz", "none.txt"),
        ("pin {body} --nodes notes.txt -o out.npz", "notes.txt"),
        ("pin {body} --nodes blank.txt -o out.npz", "no node numbers"),
        ("pin {body} --nodes halves.npy -o out.npz", "no node numbers"),
        ("pin {body} --nodes beyond.txt -o out.npz", "not a node"),
        ("pin {body} --nodes inner.txt -o out.npz", "inside the body"),
        ("pin {body} --nodes top.txt -o nowhere/out.npz", "nowhere"),
        ("press {body} --at 0 0 0 --by 0 0 0 --tool convex:cube.npz", "obj, ply or stl"),
        ("servo {body} --simulate --rate 99999999999999", "100 to 8000"),
        ("servo {body} --port ", "its name is empty"),
        ("servo {body} --haply ", "its name is empty"),
        ("servo {body} --simulate --second-port ", "its name is empty"),
        ("press other.npz --at 0 0 0 --by 0 0 0", "other.npz"),
        ("press {body} --at 0 0 nan --by 0 0 0", "--at"),
        ("press {body} --at 0 0 0 --by 0 inf 0", "--by"),
        ("press {body} --at 0 0 1e200 --by 0 0 0", "--at"),
        ("press {body} --at 0 0 0 --by 0 0 1e9 --young 1e308", "number"),
        ("press {body} --at 0 0 0 --by 0 0 0 --displacements no/u.npy", "u.npy"),
        ("press {body} --at 0 0 0 --by 0 0 0 --young -1", "You"),
        ("press {body} --at 0 0 --by 0 0 0", "--at"),
        ("press {body} --at 0 0 0", "--by"),
        (
            "press {body} --at 0 0 0 --by 0 0 1 --tool ball:1",
            "'ball:1' is no tool; give sphere:RADIUS",
        ),
        ("press {body} --at 0 0 0 --by 0 0 1 --tool plate:0.1", "'plate:0.1' is no tool"),
        ("press {body} --at 0 0 0 --by 0 0 1 --tool sphere:-1", "tool sphere:-1: radius"),
        ("press {body} --at 0 0 0 --by 0 0 1 --tool convex:none.obj", "none.obj"),
        ("press {body} --at 0 0 0 --by 0 0 1 --at 0 0 0 --tool sphere:1", "2 times and --by 1"),
        ("press {body} --at 0 0 0 --by 0 0 1 --friction 1", "--friction: points have none"),
        ("press {body} --at 0 0 0 --by 0 0 1 --tool sphere:1 --mode paper", "--mode"),
        ("press {body} --at 0 0 0 --by 0 0 nan --tool sphere:1", "--by"),
        ("press {body} --at 0 0 0 --at 0 0 0 --by 0 0 1", "2 times and --by 1 times"),
        ("fly", "fly"),
        ("", "COMMAND"),
    ],
)
def test_bad_input_gets_one_line_status_2_and_no_file(
    tmp_path, cube_file, cube_mesh, line, said, monkeypatch, refusal
):
    monkeypatch.chdir(tmp_path)
    mesh, fixed = cube_mesh
    np.savez("cube.npz", X=mesh.nodes, T=mesh.tets, fixed=fixed)
    np.savez("nan.npz", X=mesh.nodes * np.nan, T=mesh.tets, fixed=fixed)
    np.savez("other.npz", a=1)
    Path("folder.obj").mkdir()
    huge = np.full(1, 2**63, np.uint64)
    np.savez("huge.npz", X=mesh.nodes, T=np.where(mesh.tets == 0, huge, mesh.tets.astype("u8")))
    np.savez("held.npz", X=mesh.nodes, T=mesh.tets, fixed=huge)
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
    before = contents(tmp_path)
    assert said in refusal(*(word.format(body=cube_file) for word in line.split(" ")))
    assert contents(tmp_path) == before


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


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


@pytest.mark.skipif(sys.platform == "win32", reason="signals are of Unix")
@pytest.mark.parametrize(
    "number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.at_length)]
)
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
