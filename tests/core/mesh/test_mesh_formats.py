"""OBJ, PLY and STL files, read as other readers read them."""

from __future__ import annotations

import io
from contextlib import suppress

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from plyfile import PlyData, PlyElement

from palpate.core.errors import PalpateError
from palpate.core.mesh.formats.obj import read_obj
from palpate.core.mesh.formats.ply import read_ply
from palpate.core.mesh.formats.polygons import MeshFormatError, triangulated
from palpate.core.mesh.formats.stl import read_stl
from palpate.core.mesh.read_mesh import READERS, read_surface


@pytest.fixture
def ball():
    return trimesh.creation.icosphere(subdivisions=2, radius=0.05)


def written(mesh, kind):
    content = mesh.export(file_type=kind)
    return content.encode() if isinstance(content, str) else content


def soup(vertices, triangles):
    """The corners' places: what is drawn, whatever the numbers of the vertices."""
    return np.asarray(vertices, dtype=float)[triangles]


@pytest.mark.parametrize("kind", ["obj", "ply", "stl", "stl_ascii"])
def test_files_of_another_writer_are_read_as_it_reads_them(ball, kind):
    content = written(ball, kind)
    theirs = trimesh.load_mesh(io.BytesIO(content), file_type=kind, process=False)
    reader = READERS["." + kind[:3]]
    vertices, triangles = reader(io.BytesIO(content), len(content))
    np.testing.assert_allclose(
        soup(vertices, triangles), soup(theirs.vertices, theirs.faces), atol=1e-9
    )


@pytest.mark.parametrize("text", [True, False])
@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("mixed", [True, False])
def test_ply_in_every_form(text, order, mixed):
    rng = np.random.default_rng(3)
    vertices = np.zeros(30, [("red", "u1"), ("z", "f8"), ("y", "f8"), ("x", "f8"), ("n", "i2")])
    for axis in "xyz":
        vertices[axis] = rng.normal(size=30)
    polygons = [rng.permutation(30)[: rng.integers(3, 7) if mixed else 4] for _ in range(20)]
    faces = np.empty(20, [("flags", "u1"), ("vertex_index", object), ("area", "f4")])
    faces["vertex_index"] = [polygon.astype("i4") for polygon in polygons]
    others = np.empty(3, [("a", "f4"), ("list", object)])
    others["list"] = [np.arange(k, dtype="f4") for k in range(3)]
    elements = [
        PlyElement.describe(others, "first", val_types={"list": "f4"}),
        PlyElement.describe(vertices, "vertex"),
        PlyElement.describe(faces, "face", val_types={"vertex_index": "i4"}),
        PlyElement.describe(vertices.copy(), "last"),
    ]
    stream = io.BytesIO()
    PlyData(elements, text=text, byte_order=order, comments=["end_header is near"]).write(stream)
    size = stream.tell()
    stream.seek(0)
    found, triangles = read_ply(stream, size)
    np.testing.assert_allclose(found, np.column_stack([vertices[a] for a in "xyz"]), rtol=1e-12)
    fans = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    np.testing.assert_array_equal(triangles, fans)


def test_single_precision_stays_single():
    for kind, dtype in (("float", np.float32), ("double", np.float64)):
        head = "ply\nformat ascii 1.0\nelement vertex 1\n"
        head += "".join(f"property {kind} {axis}\n" for axis in "xyz") + "end_header\n1 2 3\n"
        assert read_ply(io.BytesIO(head.encode()), len(head))[0].dtype == dtype


def test_obj_as_people_write_it():
    text = (
        "\ufeff# comment\r\nmtllib nowhere.mtl\r\no Würfel\r\nv 0 0 0 0.5 0.5 0.5\r\nv\t1 0 0\r\n"
        "v 1 1 \\\r\n 0\r\nv 0 1 0 1.0\r\nvt 0 0\r\nvn 0 0 1\r\nf 1/1/1 2//1 3/1 4\r\n"
        "f -4 -3 -2\r\nf 1 2\r\nv 9 9 9\r\nf -1 1 2\r\nl 1 2"
    )
    vertices, triangles = read_obj(io.BytesIO(text.encode()))
    np.testing.assert_array_equal(vertices[:4, 2], 0.0)
    assert len(vertices) == 5
    assert triangles.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 2], [4, 0, 1]]


def test_long_files_are_read_in_parts(ball):
    fine = ball.subdivide().subdivide().subdivide()
    for kind in ("obj", "stl_ascii"):
        content = written(fine, kind)
        vertices, triangles = READERS["." + kind[:3]](io.BytesIO(content), len(content))
        assert trimesh.Trimesh(vertices, triangles).volume == pytest.approx(fine.volume, rel=1e-5)


def test_fans_of_polygons_of_any_size():
    corners, sizes = np.array([7, 8, 1, 2, 3, 4, 5, 6, 9]), np.array([2, 4, 0, 3])
    assert triangulated(corners, sizes).tolist() == [[1, 2, 3], [1, 3, 4], [5, 6, 9]]


@given(
    kind=st.sampled_from(["obj", "ply", "stl", "ply_ascii", "stl_ascii"]),
    places=st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), max_size=8),
    cut=st.floats(0, 1),
    is_cut=st.booleans(),
)
def test_bytes_changed_and_cut(fuzzed, kind, places, cut, is_cut):
    target, contents = fuzzed
    changed = bytearray(contents[kind])
    for place, value in places:
        changed[int(place * (len(changed) - 1))] = value
    content = bytes(changed[: int(cut * len(changed))] if is_cut else changed)
    path = target / f"any.{kind[:3]}"
    path.write_bytes(content)
    with suppress(PalpateError):
        surface = read_surface(path)
        assert np.isfinite(surface.vertices).all()
        assert surface.triangles.max() < len(surface.vertices)
        return
    with pytest.raises(PalpateError, match=path.name):
        read_surface(path)


@given(noise=st.binary(max_size=300), words=st.text(alphabet="vf 0123/-.\\\nen", max_size=200))
def test_anything_at_all(noise, words):
    for content in (noise, words.encode(), b"ply\n" + noise, b"solid\nfacet\nvertex " + noise):
        for reader in (lambda stream, _: read_obj(stream), read_ply, read_stl):
            try:
                vertices, triangles = reader(io.BytesIO(content), len(content))
            except MeshFormatError:
                continue
            assert vertices.shape[1:] == triangles.shape[1:] == (3,)


@pytest.fixture(scope="module")
def fuzzed(tmp_path_factory):
    small = trimesh.creation.icosphere(subdivisions=1, radius=0.05)
    contents = {kind: written(small, kind) for kind in ("obj", "ply", "stl", "stl_ascii")}
    stream = io.BytesIO(contents["ply"])
    data = PlyData.read(stream)
    data.text = True
    text = io.BytesIO()
    data.write(text)
    contents["ply_ascii"] = text.getvalue()
    return tmp_path_factory.mktemp("meshes"), contents
