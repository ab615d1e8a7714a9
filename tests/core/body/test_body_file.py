import os
import re
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from palpate.core.body import body_file
from palpate.core.body.body_file import BodyFileError, body_key
from palpate.core.compliance.compression.compress import compress
from palpate.core.compliance.mapped import MappedCompliance
from palpate.core.files.npz_archive import opened
from palpate.core.files.whole_file import UnwritableError


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


def mapped(path):
    """The body with its table left in the file, however small."""
    return body_file.load(path, mapped_from_bytes=0)


def test_arrays_lie_aligned_in_the_file_so_that_it_can_be_mapped(file):
    with opened(file) as archive:
        for name in archive.names:
            array = archive.map(name).array
            assert array.ctypes.data % 64 == 0
            np.testing.assert_array_equal(array, archive.read(name))


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
    with opened(path) as archive:
        stored = archive.map("compliance")
        first = stored.array.__array_interface__["data"][0]
        whole = np.frombuffer(stored._mapping, dtype=np.uint8).__array_interface__["data"][0]
        place = first - whole + (node + 1) * stored.array[0].nbytes - 2
    content = bytearray(path.read_bytes())
    content[place] ^= 0x10
    path.write_bytes(content)


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


def test_a_file_cut_short_while_its_body_is_in_use_is_an_error_and_no_crash(cube, file):
    body = mapped(file)
    body.deform(cube.mesh.surface_triangles[0], np.eye(3))
    os.truncate(file, 10_000)
    with pytest.raises(BodyFileError, match=r"cube\.npz.*cut short"):
        body.deform(cube.mesh.surface_triangles[0], np.eye(3))


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.999])
def test_a_file_cut_short_before_is_never_mapped(file, share):
    content = file.read_bytes()
    file.write_bytes(content[: int(share * len(content))])
    with pytest.raises(BodyFileError, match=r"cube\.npz.*bake again"):
        mapped(file)


def test_a_flipped_bit_anywhere_is_never_used_from_a_file_either(cube, file, rng):
    content = bytearray(file.read_bytes())
    headers = [place for place in range(len(content) - 31) if content.startswith(b"PK", place)]
    places = [start + offset for start in headers for offset in (4, 6, 8, 26, 28, 29, 31)]
    for place in (*places, *rng.integers(0, len(content), 60)):
        damaged = bytearray(content)
        damaged[place] ^= 0x10
        file.write_bytes(damaged)
        try:
            body = mapped(file)
            table = body.compliance.table
        except BodyFileError:
            continue
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


@pytest.fixture(scope="module")
def compressed(mouse):
    positions = mouse.mesh.nodes[mouse.compliance.free_surface]
    return replace(mouse, compliance=compress(mouse.compliance, positions, 1e-3))


def test_a_compressed_body_comes_back_as_it_was(compressed, tmp_path):
    path = tmp_path / "mouse.npz"
    body_file.save(compressed, path)
    body = body_file.load(path)
    assert body.compliance.form == "compressed"
    assert body.compliance.tolerance == 1e-3
    stored = body.compliance.arrays()
    for name, array in compressed.compliance.arrays().items():
        np.testing.assert_array_equal(stored[name], array)
    assert body.key == compressed.key
    assert path.stat().st_size < 0.15 * compressed.compliance.node_count**2 * 36


def test_the_form_is_not_part_of_the_key(mouse, compressed):
    assert mouse.key == compressed.key


def test_a_damaged_compressed_body_is_refused(compressed, tmp_path, rng):
    path = tmp_path / "mouse.npz"
    body_file.save(compressed, path)
    content = path.read_bytes()
    for place in rng.integers(0, len(content), 20):
        damaged = bytearray(content)
        damaged[place] ^= 0x10
        path.write_bytes(damaged)
        try:
            body = body_file.load(path)
        except BodyFileError:
            continue
        np.testing.assert_array_equal(body.compliance.diagonal(), compressed.compliance.diagonal())
        np.testing.assert_array_equal(body.compliance.narrow, compressed.compliance.narrow)


@pytest.mark.parametrize("name", ["tolerance", "compressed_basis"])
def test_a_missing_array_of_a_compressed_body_is_refused(compressed, tmp_path, name):
    path = tmp_path / "mouse.npz"
    body_file.save(compressed, path)
    rewrite(path, **{name: None})
    with pytest.raises(BodyFileError, match="damaged"):
        body_file.load(path)


def test_arrays_that_do_not_belong_together_are_refused_with_a_right_checksum(compressed, tmp_path):
    path = tmp_path / "mouse.npz"
    shorter = replace(compressed.compliance, tile_counts=compressed.compliance.tile_counts[:-1])
    body_file.save(replace(compressed, compliance=shorter), path)
    with pytest.raises(BodyFileError, match=r"mouse\.npz.*bake again"):
        body_file.load(path)


def test_an_unknown_form_is_refused(cube, tmp_path):
    path = tmp_path / "cube.npz"
    body_file.save(cube, path)
    with np.load(path) as stored:
        arrays = dict(stored)
    arrays["form"] = np.array("woven")
    arrays["checksum"] = np.array(body_file._checksum(arrays))
    np.savez(path, **arrays)
    with pytest.raises(BodyFileError, match=r"form 'woven'.*bake again"):
        body_file.load(path)


@pytest.mark.parametrize("form", ["dense", "compressed"])
def test_the_documented_example_reads_it_with_plain_numpy(
    form, mouse, compressed, tmp_path, monkeypatch
):
    body = mouse if form == "dense" else compressed
    body_file.save(body, tmp_path / f"{form}.npz")
    monkeypatch.chdir(tmp_path)
    document = Path(__file__).resolve().parents[3] / "docs" / "body-file.md"
    examples = re.findall(r"```python\n(.*?)```", document.read_text(encoding="utf-8"), re.DOTALL)
    found = {}
    exec(next(text for text in examples if f"{form}.npz" in text), found)  # noqa: S102  our own
    node = np.array([17])
    force = np.linalg.solve(mouse.compliance.diagonal()[17] / 1000, [0, 0, -0.005])
    np.testing.assert_allclose(found["force"], force, rtol=1e-5)
    moved = body.compliance.apply(found["force"][None] / 1000, node)
    np.testing.assert_allclose(found["moved"], moved, atol=1e-6 * np.abs(moved).max())
    found["body"].close()
