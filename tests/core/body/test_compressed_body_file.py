"""Body files with a compressed compliance."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from palpate.core.body import body_file
from palpate.core.body.body_file import BodyFileError
from palpate.core.compliance.compression.compress import compress


@pytest.fixture(scope="module")
def compressed(mouse):
    positions = mouse.mesh.nodes[mouse.compliance.free_surface]
    return replace(mouse, compliance=compress(mouse.compliance, positions, 1e-3))


@pytest.fixture
def path(compressed, tmp_path):
    path = tmp_path / "mouse.npz"
    body_file.save(compressed, path)
    return path


def test_a_compressed_body_comes_back_as_it_was(compressed, path):
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


def test_a_damaged_compressed_body_is_refused(compressed, path, rng):
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
def test_a_missing_array_of_a_compressed_body_is_refused(path, rewrite, name):
    rewrite(path, **{name: None})
    with pytest.raises(BodyFileError, match="damaged"):
        body_file.load(path)


def test_arrays_that_do_not_belong_together_are_refused_with_a_right_checksum(compressed, path):
    shorter = replace(compressed.compliance, tile_counts=compressed.compliance.tile_counts[:-1])
    body_file.save(replace(compressed, compliance=shorter), path)
    with pytest.raises(BodyFileError, match=r"mouse\.npz.*bake again"):
        body_file.load(path)


def test_an_unknown_form_is_refused(file, rewrite):
    with np.load(file) as stored:
        arrays = {**stored, "form": np.array("woven")}
    rewrite(file, form=arrays["form"], checksum=np.array(body_file._checksum(arrays)))
    with pytest.raises(BodyFileError, match=r"form 'woven'.*bake again"):
        body_file.load(file)


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
