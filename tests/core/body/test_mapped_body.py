"""Bodies whose compliance stays in its file."""

import mmap
import os
from dataclasses import replace

import numpy as np
import pytest

from palpate.core.body import body_file
from palpate.core.body.body_file import BodyFileError, body_key
from palpate.core.compliance.mapped import MappedCompliance
from palpate.core.files.npz_archive import opened


def mapped(path):
    """The body with its table left in the file, however small."""
    return body_file.load(path, mapped_from_bytes=0)


def test_arrays_lie_aligned_in_the_file_so_that_it_can_be_mapped(file):
    with opened(file) as archive:
        for name in archive.names:
            array = archive.map(name).array
            assert array.ctypes.data % 64 == 0
            np.testing.assert_array_equal(array, archive.read(name))


def test_what_is_read_after_a_map_is_what_it_was(file, monkeypatch):
    plain = mmap.mmap

    def as_on_windows(descriptor, *arguments, **named):
        os.lseek(descriptor, 0, os.SEEK_SET)
        return plain(descriptor, *arguments, **named)

    monkeypatch.setattr(mmap, "mmap", as_on_windows)
    with opened(file) as archive:
        for name in archive.names:
            np.testing.assert_array_equal(archive.map(name).array, archive.read(name))


def test_the_same_body_gives_the_same_file(cube, file, tmp_path):
    body_file.save(cube, tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == file.read_bytes()


def test_a_body_left_in_its_file_answers_as_one_in_memory(cube, file, rng):
    body = mapped(file)
    assert isinstance(body.compliance, MappedCompliance)
    forces, triangle = rng.standard_normal((3, 3)), cube.mesh.surface_triangles[70]
    np.testing.assert_array_equal(
        body.deform(triangle, forces, 1.0), cube.deform(triangle, forces, 1.0)
    )
    np.testing.assert_array_equal(body.contact_blocks, cube.contact_blocks)
    for name, arguments in {
        "block": (3, 70),
        "diagonal": (),
        "columns": (np.array([5, 2]),),
        "apply": (rng.standard_normal((73, 3)),),
    }.items():
        ours, theirs = getattr(body.compliance, name), getattr(cube.compliance, name)
        np.testing.assert_array_equal(ours(*arguments), theirs(*arguments))
    assert (body.compliance.form, body.compliance.nbytes) == ("dense", cube.compliance.nbytes)
    np.testing.assert_array_equal(body.compliance.table, cube.compliance.table)


def test_a_body_left_in_its_file_can_be_saved_over_it(cube, file):
    body = mapped(file)
    body_file.save(body, file)
    np.testing.assert_array_equal(body.compliance.table, cube.compliance.table)
    np.testing.assert_array_equal(body_file.load(file).compliance.table, cube.compliance.table)


def test_a_file_may_be_replaced_and_deleted_while_its_body_is_in_use(cube, mouse, file):
    body = mapped(file)
    body_file.save(mouse, file)
    file.unlink()
    np.testing.assert_array_equal(body.compliance.table, cube.compliance.table)


def damage_column(path, node):
    """Flip one bit in the columns of a node (a place among the free surface nodes)."""
    content = bytearray(path.read_bytes())
    content[end_of_column(path, node) - 2] ^= 0x10
    path.write_bytes(content)


def end_of_column(path, node):
    """Where the columns of a node end in the file, bytes."""
    with opened(path) as archive:
        stored = archive.map("compliance")
        first = stored.array.__array_interface__["data"][0]
        whole = np.frombuffer(stored._mapping, dtype=np.uint8).__array_interface__["data"][0]
        return first - whole + (node + 1) * stored.array[0].nbytes


def test_a_damaged_column_is_named_when_it_is_used_and_others_are_not_held_back(cube, file):
    damage_column(file, 20)
    body = mapped(file)
    hurt = int(body.compliance.free_surface[20])
    touched = next(t for t in body.mesh.surface_triangles if hurt in t)
    apart = next(t for t in body.mesh.surface_triangles if hurt not in t)
    assert body.contact_blocks.shape == (98, 3, 3)
    body.deform(apart, np.eye(3))
    for _ in range(2):
        with pytest.raises(BodyFileError, match=rf"cube\.npz.*node {hurt}.*bake again"):
            body.deform(touched, np.eye(3))
    with pytest.raises(BodyFileError):
        _ = body.compliance.table
    with pytest.raises(BodyFileError):
        body_file.load(file)


@pytest.mark.skipif(os.name == "nt", reason="Windows cuts no file that is mapped")
def test_a_file_cut_short_while_its_body_is_in_use_is_an_error_and_no_crash(cube, file):
    body = mapped(file)
    body.deform(cube.mesh.surface_triangles[0], np.eye(3))
    os.truncate(file, 10_000)
    with pytest.raises(BodyFileError, match=r"cube\.npz.*cut short"):
        body.deform(cube.mesh.surface_triangles[0], np.eye(3))


@pytest.mark.parametrize("load", [body_file.load, mapped])
@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.999])
def test_a_file_cut_short_before_is_refused_by_name(file, share, load):
    content = file.read_bytes()
    file.write_bytes(content[: int(share * len(content))])
    with pytest.raises(BodyFileError, match=r"cube\.npz.*bake again"):
        load(file)


@pytest.mark.parametrize("load", [body_file.load, mapped])
def test_a_flipped_bit_anywhere_is_never_used(cube, file, rng, load):
    content = bytearray(file.read_bytes())
    headers = [place for place in range(len(content) - 31) if content.startswith(b"PK", place)]
    places = [start + offset for start in headers for offset in (4, 6, 8, 26, 28, 29, 31)]
    for place in (*places, *rng.integers(0, len(content), 60)):
        damaged = bytearray(content)
        damaged[place] ^= 0x10
        # A new one each time: Windows writes into no file that is mapped.
        copy = file.with_name(f"{place}.npz")
        copy.write_bytes(damaged)
        try:
            body = load(copy)
            table = body.compliance.table
        except BodyFileError:
            continue
        # A bit in the padding or the date of the archive changes nothing that is read.
        np.testing.assert_array_equal(table, cube.compliance.table)
        np.testing.assert_array_equal(body.mesh.nodes, cube.mesh.nodes)


def test_an_archive_that_another_program_packed_is_read_whole_or_refused(cube, file):
    with np.load(file) as stored:
        np.savez_compressed(file, **stored)
    np.testing.assert_array_equal(body_file.load(file).compliance.table, cube.compliance.table)
    with pytest.raises(BodyFileError, match=r"cube\.npz"):
        mapped(file)


def test_formulation_and_stiffness_of_tetrahedra_come_back(cube, file):
    scale = np.linspace(1, 50, len(cube.mesh.tets))
    body_file.save(replace(cube, formulation="smoothed", young_scale=scale), file)
    body = body_file.load(file)
    assert body.formulation == "smoothed"
    np.testing.assert_array_equal(body.young_scale, scale)
    assert body.key == body_key(cube.mesh, cube.fixed, 0.49, "smoothed", scale) != cube.key


def test_a_body_as_stiff_everywhere_has_the_key_it_always_had(cube):
    assert cube.key == body_key(cube.mesh, cube.fixed, 0.49)
    assert cube.key == body_key(cube.mesh, cube.fixed, 0.49, "linear", None)
    assert cube.key == "acd1757aa607f98f2d54b0e8c9aa9b0306671bd61eddb1e179dd8f7c003bb070"
