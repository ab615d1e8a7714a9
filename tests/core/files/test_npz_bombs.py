"""Archives that say more than they hold are refused before anything of them is read."""

from __future__ import annotations

import io
import struct
import tracemalloc
import zipfile

import numpy as np
import pytest
from numpy.lib import format as npy

from palpate.core.body import body_file
from palpate.core.errors import PalpateError
from palpate.core.files import npz_archive, npz_members
from palpate.core.files.npz_archive import ArchiveError, read_arrays
from palpate.core.mesh.read_mesh import read_tets
from palpate.core.record.read_recording import read_recording

MEGABYTE = 1_000_000


def header(shape, descr="<f8"):
    stream = io.BytesIO()
    npy.write_array_header_1_0(stream, {"descr": descr, "fortran_order": False, "shape": shape})
    return stream.getvalue()


def write(path, members, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, content in members:
            archive.writestr(name, content)


def zeros(path):
    """40 MB of zeros in 40 kB: what 3 GB in 3 MB are, so that the test is quick."""
    write(path, [("X.npy", header((5 * MEGABYTE,)) + bytes(40 * MEGABYTE))])


def many_bombs(path):
    write(path, [(f"a{n}.npy", header((MEGABYTE,)) + bytes(8 * MEGABYTE)) for n in range(5)])


def huge_shape(path):
    write(path, [("X.npy", header((10**15, 3)) + bytes(100))], zipfile.ZIP_STORED)


def overflowing_shape(path):
    write(path, [("X.npy", header((2**33, 2**33)) + bytes(100))], zipfile.ZIP_STORED)


def negative_shape(path):
    write(path, [("X.npy", header((-1, 3)) + bytes(100))], zipfile.ZIP_STORED)


def long_header(path):
    text = b"\x93NUMPY\x02\x00" + struct.pack("<I", 8 * MEGABYTE) + b" " * 8 * MEGABYTE
    write(path, [("X.npy", text)], zipfile.ZIP_STORED)


def deep_header(path):
    text = b"(" * 3000
    write(path, [("X.npy", b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text)])


def many_members(path):
    write(path, [(f"a{n}.npy", header(()) + bytes(8)) for n in range(100)])


def long_list(path):
    write(path, [(f"{n:06}" * 100, b"") for n in range(20_000)])


def twice(path):
    with pytest.warns(UserWarning, match="Duplicate"):
        write(path, [("X.npy", header(()) + bytes(8))] * 2)


def bzip2(path):
    write(path, [("X.npy", header((MEGABYTE,)) + bytes(8 * MEGABYTE))], zipfile.ZIP_BZIP2)


def objects(path):
    np.savez(path, X=np.array([{"a": 1}], dtype=object))


def structures(path):
    np.savez(path, X=np.zeros(3, [("a", "f8"), ("b", "O")]))


def long_text(path):
    write(path, [("format.npy", header((), "<U4000000") + bytes(16 * MEGABYTE))])


def overlapping(path):
    """Every member of the list leads to the same packed bytes."""
    write(path, [(f"a{n}.npy", header((100,)) + bytes(800)) for n in range(20)])
    content = bytearray(path.read_bytes())
    at = content.index(b"PK\x01\x02")
    first = content[at + 42 : at + 46]
    while (at := content.find(b"PK\x01\x02", at + 4)) >= 0:
        content[at + 42 : at + 46] = first
    path.write_bytes(content)


def larger_than_said(path):
    """The list says 8 kB; the packed bytes make 8 MB."""
    write(path, [("X.npy", header((1000,)) + bytes(8 * MEGABYTE))])
    content = bytearray(path.read_bytes())
    at = content.index(b"PK\x01\x02")
    content[at + 24 : at + 28] = struct.pack("<I", len(header((1000,))) + 8000)
    path.write_bytes(content)


BOMBS = [
    zeros, many_bombs, huge_shape, overflowing_shape, negative_shape, long_header, deep_header,
    many_members, long_list, twice, bzip2, objects, structures, long_text, overlapping,
    larger_than_said,
]  # fmt: skip


@pytest.fixture
def unpacked(monkeypatch):
    """Bytes that zip members have given so far."""
    given = [0]
    read = zipfile.ZipExtFile.read

    def counted(self, n=-1):
        content = read(self, n)
        given[0] += len(content)
        return content

    monkeypatch.setattr(zipfile.ZipExtFile, "read", counted)
    return given


@pytest.mark.parametrize("reader", [body_file.load, read_tets, read_recording, read_arrays])
@pytest.mark.parametrize("bomb", BOMBS)
def test_a_bomb_is_refused_after_kilobytes(tmp_path, unpacked, bomb, reader):
    path = tmp_path / "bomb.npz"
    bomb(path)
    unpacked[0] = 0
    tracemalloc.start()
    try:
        with pytest.raises(PalpateError, match=r"bomb\.npz"):
            reader(path)
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert unpacked[0] < MEGABYTE
    assert most < 10 * MEGABYTE


def test_the_list_of_members_is_not_read_beyond_its_bound(tmp_path):
    long_list(tmp_path / "long.npz")
    with (tmp_path / "long.npz").open("rb") as file, pytest.raises(npz_members.MembersError):
        npz_members.listed(file)
    with pytest.raises(ArchiveError, match="before it was read"):
        read_arrays(tmp_path / "long.npz")


def test_what_numpy_writes_packed_or_not_is_read(tmp_path, rng):
    arrays = {
        "X": rng.standard_normal((3000, 3)),
        "T": rng.integers(0, 3000, (9000, 4)),
        "fixed": np.zeros(3000, bool),
        "about": np.array("some words"),
    }
    for write_npz in (np.savez, np.savez_compressed):
        write_npz(tmp_path / "mesh.npz", **arrays)
        found = read_arrays(tmp_path / "mesh.npz")
        assert found.keys() == arrays.keys()
        assert all(np.array_equal(found[name], array) for name, array in arrays.items())


def test_no_head_of_an_array_needs_its_numbers(tmp_path, unpacked):
    np.savez(tmp_path / "large.npz", X=np.zeros((100_000, 3)))
    with npz_archive.opened(tmp_path / "large.npz") as archive:
        assert archive.heads["X"].shape == (100_000, 3)
        assert archive.heads["X"].nbytes == 2_400_000
    assert unpacked[0] <= npz_members.MOST_HEAD_BYTES
