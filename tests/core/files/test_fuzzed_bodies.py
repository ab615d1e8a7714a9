"""Body files with anything anywhere: a body that is sound, or a refusal that names the file."""

from __future__ import annotations

import io
from contextlib import suppress

import numpy as np
import pytest
from bodies.baked_body import baked_body
from hypothesis import given
from hypothesis import strategies as st

from palpate.core.body import body_file
from palpate.core.body.body_file import BodyFileError
from palpate.core.files.npz_archive import write_arrays

ODD = [np.nan, np.inf, -np.inf, -1.0, 0.0, 1e300, 2.0**31, -(2.0**63)]


@pytest.fixture(scope="module", params=["pinned", "free"])
def content(request, cube, tmp_path_factory):
    path = tmp_path_factory.mktemp("fuzzed") / "cube.npz"
    is_free = request.param == "free"
    body_file.save(baked_body(cube.mesh, [], density=1e3) if is_free else cube, path)
    return path.read_bytes()


@pytest.fixture(scope="module")
def target(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzzed") / "any.npz"


def read(target, content):
    """The body in these bytes, checked to be sound, or None where it is refused."""
    target.write_bytes(content)
    with suppress(BodyFileError):
        return sound(body_file.load(target))
    with pytest.raises(BodyFileError, match=r"any\.npz"):
        body_file.load(target)
    return None


def sound(body):
    blocks = body.contact_blocks
    assert np.isfinite(blocks).all()
    assert np.linalg.eigvalsh(blocks).min() > 0.0
    assert not body.is_free or 0.0 < body.mass < np.inf
    return body


@given(
    places=st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), max_size=8),
    cut=st.floats(0, 1),
    is_cut=st.booleans(),
)
def test_bytes_changed_and_cut(content, target, places, cut, is_cut):
    changed = bytearray(content)
    for place, value in places:
        changed[int(place * (len(changed) - 1))] = value
    read(target, bytes(changed[: int(cut * len(changed))] if is_cut else changed))


@given(data=st.data())
def test_arrays_changed_under_a_right_checksum(content, target, data):
    with np.load(io.BytesIO(content)) as stored:
        arrays = dict(stored)
    name = data.draw(st.sampled_from(sorted(arrays)))
    how = data.draw(st.sampled_from(["left out", "kind", "shape", "odd", "shortened"]))
    array = arrays[name]
    if how == "left out":
        del arrays[name]
    elif how == "kind":
        kind = data.draw(st.sampled_from(["f2", "f4", "i1", "u8", "?", "c16", "U3"]))
        arrays[name] = np.zeros(array.shape, kind)
    elif how == "shape":
        shape = data.draw(st.lists(st.integers(0, 5), max_size=4))
        arrays[name] = np.zeros(shape, array.dtype)
    elif how == "shortened":
        arrays[name] = array[: data.draw(st.integers(0, 80))] if array.ndim else array
    elif array.dtype.kind in "fiu" and array.size:
        place = data.draw(st.integers(0, array.size - 1))
        arrays[name] = array.copy()
        with np.errstate(invalid="ignore", over="ignore"):
            odd = np.array(data.draw(st.sampled_from(ODD)))
            arrays[name].flat[place] = odd.astype(array.dtype)
    if "checksum" in arrays:
        arrays["checksum"] = np.array(body_file._checksum(arrays))
    stream = io.BytesIO()
    write_arrays(stream, arrays)
    read(target, stream.getvalue())


@given(noise=st.binary(max_size=300))
def test_anything_at_all(target, noise):
    assert read(target, noise) is None
    assert read(target, b"PK\x03\x04" + noise) is None
