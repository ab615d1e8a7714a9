"""Body files: read back as they were, refused when they are damaged or foreign."""

import os
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from palpate.core.body import body_file
from palpate.core.body.body_file import BodyFileError, body_key
from palpate.core.files.atomic_file import UnwritableError


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


def test_the_law_is_kept_beside_the_key_and_an_unknown_one_refused(cube, file):
    foam = replace(cube, law="foam")
    body_file.save(foam, file)
    found = body_file.load(file)
    assert (found.law, found.key) == ("foam", cube.key)
    body_file.save(cube, file)
    assert body_file.load(file).law == "rubber"
    for name in ("porridge", "foam" * 500):
        body_file.save(replace(cube, law=name), file)
        with pytest.raises(BodyFileError, match=r"bake again|no single word"):
            body_file.load(file)


def test_the_key_follows_all_that_the_compliance_depends_on_and_nothing_else(cube, mouse):
    key = body_key(cube.mesh, cube.fixed, 0.49)
    assert body_key(cube.mesh, cube.fixed[::-1], 0.49) == key
    assert body_key(cube.mesh, cube.fixed[:-1], 0.49) != key
    assert body_key(cube.mesh, cube.fixed, 0.48) != key
    assert body_key(mouse.mesh, cube.fixed, 0.49) != key


def test_the_file_that_a_link_leads_to_is_replaced(cube, file, tmp_path, link):
    place = tmp_path / "link.npz"
    link(place, file)
    file.write_bytes(b"old")
    body_file.save(cube, place)
    assert place.is_symlink()
    assert body_file.load(file).young_modulus == cube.young_modulus


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_what_is_no_ordinary_file_is_never_replaced(cube, tmp_path):
    pipe = tmp_path / "pipe.npz"
    os.mkfifo(pipe)
    with pytest.raises(UnwritableError, match="no ordinary file"):
        body_file.save(cube, pipe)
    assert pipe.is_fifo()


def test_changed_arrays_fail_the_checksum(cube, file, rewrite):
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
def test_a_missing_array_is_named(file, rewrite, name):
    rewrite(file, **{name: None})
    with pytest.raises(BodyFileError, match=name):
        body_file.load(file)


@pytest.mark.parametrize("version", [0, 1, 3, 99, ["x", "y"]])
def test_other_versions_are_told_apart(file, rewrite, version):
    rewrite(file, version=np.array(version))
    told = "version" if isinstance(version, list) else f"version {version}.*bake again"
    with pytest.raises(BodyFileError, match=told):
        body_file.load(file)


def single_array(path):
    with path.open("wb") as stream:
        np.save(stream, np.eye(3))


def letter(path):
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("letter.txt", "hello")


FOREIGN = {
    "empty": (lambda path: path.write_bytes(b""), r"other\.npz"),
    "text": (lambda path: path.write_bytes(b"not an archive"), r"other\.npz"),
    "zip head": (lambda path: path.write_bytes(b"PK\x03\x04broken"), r"other\.npz"),
    "array": (single_array, r"other\.npz.*npz archive"),
    "mesh": (lambda path: np.savez(path, X=np.eye(3)), "not a Palpate body"),
    "letter": (letter, "not a Palpate body"),
    "pickle": (lambda path: np.savez(path, format=np.array([{"a": 1}], dtype=object)), "."),
}


@pytest.mark.parametrize("kind", FOREIGN)
def test_foreign_files_are_refused(tmp_path, kind):
    write, told = FOREIGN[kind]
    write(tmp_path / "other.npz")
    with pytest.raises(BodyFileError, match=told):
        body_file.load(tmp_path / "other.npz")


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
