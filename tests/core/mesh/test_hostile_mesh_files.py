"""Mesh files that say more than they hold are refused before memory is asked for."""

from __future__ import annotations

import struct
import sys
import tracemalloc

import numpy as np
import pytest

from palpate.core.errors import PalpateError
from palpate.core.mesh.read_mesh import read_surface

MEGABYTE = 1_000_000
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
AXES = "".join(f"property float {axis}\n" for axis in "xyz")
CORNERS = "property list uchar int vertex_indices\n"


def ply(*elements, kind="binary_little_endian", body=b""):
    lines = "".join(f"element {name} {count}\n{rest}" for name, count, rest in elements)
    return f"ply\nformat {kind} 1.0\n{lines}end_header\n".encode() + body


def stl(count, body):
    return bytes(80) + struct.pack("<I", count) + body


HOSTILE = {
    "many_vertices.ply": (ply(("vertex", 10**12, AXES)), "promises 1,000,000,000,000 'vertex'"),
    "many_lines.ply": (ply(("vertex", 10**12, AXES), kind="ascii"), "promises"),
    "many_faces.ply": (
        ply(("vertex", 1, AXES), ("face", 2**31, CORNERS), body=bytes(12)),
        "promises 2,147,483,648 'face'",
    ),
    "many_others.ply": (
        ply(("x", 10**9, ""), ("vertex", 1, AXES), body=bytes(12)),
        "no properties",
    ),
    "many_digits.ply": (ply(("vertex", "9" * 5000, AXES)), "header has the line"),
    "negative.ply": (ply(("vertex", -5, AXES)), "header has the line"),
    "long_list.ply": (
        ply(
            ("vertex", 1, AXES),
            ("face", 1, "property list uint int vertex_indices\n"),
            body=bytes(12) + struct.pack("<I", 2**31),
        ),
        "longer than the file",
    ),
    "negative_list.ply": (
        ply(
            ("vertex", 1, AXES),
            ("face", 2, "property list char int vertex_indices\n"),
            body=bytes(12) + b"\xff" + bytes(12),
        ),
        "longer than the file",
    ),
    "negative_words.ply": (
        ply(("vertex", 1, AXES), ("face", 1, CORNERS), kind="ascii", body=b"0 0 0\n-1 0 0 0\n"),
        "words",
    ),
    "no_places.ply": (ply(("vertex", 1, "property float x\n"), body=bytes(4)), "x, y, z"),
    "no_corners.ply": (ply(("face", 1, "property int a\n"), body=bytes(4)), "no list"),
    "odd_type.ply": (ply(("vertex", 1, "property object x\n"), body=bytes(9)), "type 'object'"),
    "long_header.ply": (b"ply\n" + b"comment " * MEGABYTE, "64,000 bytes"),
    "many_properties.ply": (
        ply(("vertex", 1, "".join(f"property char a{n}\n" for n in range(300)))),
        "too many properties",
    ),
    "no_magic.ply": (b"plyy\nformat ascii 1.0\nend_header\n", "first line"),
    "faces_beyond.obj": (f"{TRIANGLE}f 1 2 99\n".encode(), "names vertex 98"),
    "faces_before.obj": (f"{TRIANGLE}f -9 1 2\n".encode(), "names vertex -5"),
    "faces_nought.obj": (f"{TRIANGLE}f 0 1 2\n".encode(), "numbered from 1"),
    "faces_huge.obj": (f"{TRIANGLE}f 1 2 {'9' * 30}\n".encode(), "18 digits"),
    "faces_endless.obj": (f"{TRIANGLE}f 1 2 {'9' * 6000}\n".encode(), "names"),
    "faces_words.obj": (f"{TRIANGLE}f one two three\n".encode(), "'one two three'"),
    "places_words.obj": (b"v 0 0 zero\nf 1 1 1\n", "no 3 numbers"),
    "places_few.obj": (b"v 0 0\nf 1 1 1\n", "no 3 numbers"),
    "places_nan.obj": (f"{TRIANGLE}v nan 0 0\nf 1 2 5\n".encode(), "not finite"),
    "places_inf.obj": (f"{TRIANGLE}v 0 -inf 0\nf 1 2 5\n".encode(), "not finite"),
    "places_vast.obj": (f"{TRIANGLE}v 0 1e300 0\nf 1 2 5\n".encode(), "unit"),
    "continued.obj": (b"\\\n" * 200_000, "0 vertices"),
    "nothing.obj": (bytes(MEGABYTE), "0 vertices"),
    "one_line.obj": (b"f" + b" 1" * 6 * MEGABYTE, "line of more than"),
    "lying.stl": (stl(10**9, bytes(500)), "1,000,000,000 triangles would take 50,000,000,084"),
    "lying_small.stl": (stl(1, bytes(500)), "1 triangles"),
    "short.stl": (b"abc", "neither text"),
    "nan.stl": (stl(4, np.full(50, np.nan, "<f4").tobytes()), "not finite"),
    "half.stl": (b"solid\nfacet normal 0 0 1\nvertex 0 0 0\nendfacet\nendsolid", "1 corners"),
    "vast.stl": (b"solid\nfacet\nvertex 0 0 1e60\nvertex 1 0 0\nvertex 0 1 0\n", "not finite"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_is_refused_in_its_own_size(tmp_path, name):
    content, said = HOSTILE[name]
    path = tmp_path / name
    path.write_bytes(content)
    tracemalloc.start()
    try:
        with pytest.raises(PalpateError) as caught:
            read_surface(path)
        taken = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert said in message
    assert ";" in message
    assert "\n" not in message
    assert taken < MEGABYTE + 8 * len(content) + 12 * MEGABYTE * (name == "one_line.obj")


@pytest.mark.skipif(sys.platform == "win32", reason="a file with nothing in it takes room there")
def test_a_vast_file_is_not_opened(tmp_path):
    for suffix in ("obj", "ply", "stl"):
        path = tmp_path / f"vast.{suffix}"
        with path.open("wb") as file:
            file.truncate(10**12)
        with pytest.raises(PalpateError, match=r"1000\.0 GB.*decimate"):
            read_surface(path)
