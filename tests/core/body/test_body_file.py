"""Body files: read back as they were, refused when they are damaged or foreign."""

import os
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from palpate.core.body import body_file
from palpate.core.body.body_file import BodyFileError, body_key
from palpate.core.files.atomic_file import UnwritableError


@pytest.fixture
def file(cube, tmp_path):
    path = tmp_path / "cube.npz"
    body_file.save(cube, path)
    return path


def rewrite(path, **changes):
    """The same file with some arrays changed (or dropped, given None)."""
    with np.load(path, allow_pickle=False) as stored:
        arrays = {**stored, **changes}
    np.savez(path, **{name: value for name, value in arrays.items() if value is not None})


def test_a_body_comes_back_as_it_was(cube, file):
    body = body_file.load(file)
    np.testing.assert_array_equal(body.mesh.nodes, cube.mesh.nodes)
    np.testing.assert_array_equal(body.mesh.tets, cube.mesh.tets)
    np.testing.assert_array_equal(body.fixed, cube.fixed)
    np.testing.assert_array_equal(body.compliance.table, cube.compliance.table)
    assert (body.poisson_ratio, body.young_modulus) == (cube.poisson_ratio, cube.young_modulus)


def test_the_file_has_the_documented_keys_for_plain_numpy(cube, file):
    with np.load(file, allow_pickle=False) as stored:
        assert stored["nodes"].shape == (125, 3)
        assert stored["tets"].shape == (320, 4)
        assert stored["surface_triangles"].shape == (192, 3)
        assert stored["fixed"].shape == (25,)
        assert stored["free_surface"].shape == (73,)
        assert stored["compliance"].shape == (73, 3, 219)
        assert stored["compliance"].dtype == np.float32
        assert float(stored["poisson_ratio"]) == 0.49
        assert str(stored["key"]) == body_key(cube.mesh, cube.fixed, 0.49)
        assert int(stored["version"]) == body_file.VERSION


def test_the_key_follows_all_that_the_compliance_depends_on_and_nothing_else(cube, mouse):
    key = body_key(cube.mesh, cube.fixed, 0.49)
    assert body_key(cube.mesh, cube.fixed[::-1], 0.49) == key
    assert body_key(cube.mesh, cube.fixed[:-1], 0.49) != key
    assert body_key(cube.mesh, cube.fixed, 0.48) != key
    assert body_key(mouse.mesh, cube.fixed, 0.49) != key


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.999])
def test_a_file_cut_short_is_refused_by_name(file, share):
    content = file.read_bytes()
    file.write_bytes(content[: int(share * len(content))])
    with pytest.raises(BodyFileError, match=r"cube\.npz.*bake again"):
        body_file.load(file)


def test_a_flipped_bit_anywhere_is_never_stale_data(cube, file, rng):
    content = bytearray(file.read_bytes())
    for place in rng.integers(0, len(content), 60):
        damaged = bytearray(content)
        damaged[place] ^= 0x10
        file.write_bytes(damaged)
        try:
            body = body_file.load(file)
        except BodyFileError:
            continue
        # A bit in the padding or the date of the archive changes nothing that is read.
        np.testing.assert_array_equal(body.compliance.table, cube.compliance.table)
        np.testing.assert_array_equal(body.mesh.nodes, cube.mesh.nodes)


def test_a_flipped_bit_in_the_archives_own_headers_is_damage_or_nothing(cube, file):
    content = file.read_bytes()
    headers = [place for place in range(len(content) - 31) if content.startswith(b"PK", place)]
    for place in (start + offset for start in headers for offset in (4, 6, 8, 31)):
        damaged = bytearray(content)
        damaged[place] ^= 0x21
        file.write_bytes(damaged)
        try:
            body = body_file.load(file)
        except BodyFileError:
            continue
        np.testing.assert_array_equal(body.compliance.table, cube.compliance.table)


def test_a_single_array_under_the_name_of_an_archive_is_refused(tmp_path):
    with (tmp_path / "single.npz").open("wb") as stream:
        np.save(stream, np.eye(3))
    with pytest.raises(BodyFileError, match=r"single\.npz.*npz archive"):
        body_file.load(tmp_path / "single.npz")


def test_a_version_that_is_no_number_is_another_version(file):
    rewrite(file, version=np.array(["x", "y"]))
    with pytest.raises(BodyFileError, match="version"):
        body_file.load(file)


def test_the_file_that_a_link_leads_to_is_replaced(cube, file, tmp_path):
    link = tmp_path / "link.npz"
    link.symlink_to(file)
    file.write_bytes(b"old")
    body_file.save(cube, link)
    assert link.is_symlink()
    assert body_file.load(file).young_modulus == cube.young_modulus


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_what_is_no_ordinary_file_is_never_replaced(cube, tmp_path):
    pipe = tmp_path / "pipe.npz"
    os.mkfifo(pipe)
    with pytest.raises(UnwritableError, match="no ordinary file"):
        body_file.save(cube, pipe)
    assert pipe.is_fifo()


def test_changed_arrays_fail_the_checksum(cube, file):
    rewrite(file, compliance=2 * cube.compliance.table)
    with pytest.raises(BodyFileError, match="checksum"):
        body_file.load(file)


def test_a_foreign_compliance_with_a_right_checksum_is_refused(file, cube):
    foreign = replace(cube)
    foreign.__dict__["key"] = "0" * 64
    body_file.save(foreign, file)
    with pytest.raises(BodyFileError, match="does not belong"):
        body_file.load(file)


@pytest.mark.parametrize("name", ["checksum", "key", "compliance", "fixed"])
def test_a_missing_array_is_named(file, name):
    rewrite(file, **{name: None})
    with pytest.raises(BodyFileError, match=name):
        body_file.load(file)


@pytest.mark.parametrize("version", [0, 1, 3, 99])
def test_other_versions_are_told_apart(file, version):
    rewrite(file, version=np.int64(version))
    with pytest.raises(BodyFileError, match=f"version {version}.*bake again"):
        body_file.load(file)


@pytest.mark.parametrize(
    "content", [b"", b"not an archive", b"PK\x03\x04broken"], ids=["empty", "text", "zip head"]
)
def test_foreign_files_are_refused(tmp_path, content):
    path = tmp_path / "other.npz"
    path.write_bytes(content)
    with pytest.raises(BodyFileError, match=r"other\.npz"):
        body_file.load(path)


def test_other_archives_are_refused(tmp_path):
    path = tmp_path / "mesh.npz"
    np.savez(path, X=np.eye(3))
    with pytest.raises(BodyFileError, match="not a Palpate body"):
        body_file.load(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("letter.txt", "hello")
    with pytest.raises(BodyFileError, match="not a Palpate body"):
        body_file.load(path)


def test_a_pickle_is_never_opened(tmp_path):
    path = tmp_path / "evil.npz"
    np.savez(path, format=np.array([{"a": 1}], dtype=object))
    with pytest.raises(BodyFileError):
        body_file.load(path)


def test_a_missing_file_says_so(tmp_path):
    with pytest.raises(BodyFileError, match="no such body file"):
        body_file.load(tmp_path / "none.npz")


def test_a_failed_save_leaves_the_old_file_and_nothing_else(cube, file, monkeypatch):
    before = file.read_bytes()

    def full(*_args, **_named):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(body_file, "write_arrays", full)
    with pytest.raises(UnwritableError, match="No space left"):
        body_file.save(cube, file)
    assert file.read_bytes() == before
    assert [path.name for path in file.parent.iterdir()] == ["cube.npz"]


def test_adopting_copies_in_one_step(file, tmp_path):
    target = tmp_path / "deep" / "down" / "body.npz"
    body_file.adopt(file, target)
    assert target.read_bytes() == file.read_bytes()
    assert [path.name for path in target.parent.iterdir()] == ["body.npz"]
