"""Recordings by strangers: read as they are, or refused by name and in their own size."""

from __future__ import annotations

import io
import json
import tracemalloc
import zipfile
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.lib import format as npy
from palpate_servo import STATES

from palpate.core.errors import PalpateError
from palpate.core.files.npz_archive import ArchiveError, read_array, write_arrays
from palpate.core.record.read_recording import RecordingError, read_recording
from palpate.core.record.recording import DTYPE, write_recording

TICKS = 50


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    path = tmp_path_factory.mktemp("recorded") / "sound.npz"
    samples = np.zeros(TICKS, DTYPE)
    samples["tick"] = np.arange(TICKS)
    for suffix in (".npz", ".csv"):
        write_recording(path.with_suffix(suffix), samples, STATES, 1000)
    return path


@pytest.fixture
def changed(sound, tmp_path):
    """The recording with other arrays, written as it is."""
    with np.load(sound) as stored:
        arrays = dict(stored)

    def write(**others):
        kept = {name: array for name, array in (arrays | others).items() if array is not None}
        with (tmp_path / "odd.npz").open("wb") as file:
            write_arrays(file, kept)
        return tmp_path / "odd.npz"

    return write


def about(**others):
    fields = {"format": "palpate recording 1", "rate_hz": 1000} | others
    return np.array(json.dumps(fields))


@pytest.mark.parametrize(
    ("name", "array", "said"),
    [
        ("about", np.array("[" * 50_000), "nested"),
        ("about", np.array("[]"), "is no recording"),
        ("about", about(rate_hz=0), "rate of 0"),
        ("about", about(rate_hz=10**400), "rate of 1000"),
        ("about", about(rate_hz=float("inf")), "rate of inf"),
        ("about", about(rate_hz="1000"), "is no recording|rate"),
        ("about", None, "about"),
        ("tick", np.zeros(10 * TICKS), "shape"),
        ("tick", np.zeros(()), "is no recording"),
        ("tick", None, "tick"),
        ("probe", np.zeros((TICKS, 4)), "probe is of the shape"),
        ("probe", np.zeros((TICKS, 3), "U4"), "probe is of the shape"),
        ("force", np.full((TICKS, 3), np.nan), "force is not finite"),
        ("time", np.full(TICKS, np.inf), "time is not finite"),
        ("state", np.full(TICKS, 99), "state 99 has no name"),
        ("states", np.zeros((0,), "U3"), "state 0 has no name"),
    ],
)
def test_a_recording_that_cannot_be_is_refused(changed, name, array, said):
    path = changed(**{name: array})
    with pytest.raises(RecordingError, match=said) as told:
        read_recording(path)
    assert "odd.npz: " in str(told.value)
    assert "; " in str(told.value)


def test_few_bytes_become_no_large_recording(changed, tmp_path):
    """Only one column is long: 2 MB of ticks would be 40 MB of samples."""
    with np.load(changed()) as stored:
        arrays = dict(stored)
    path = tmp_path / "odd.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in (arrays | {"tick": np.zeros(250_000)}).items():
            stream = io.BytesIO()
            npy.write_array(stream, array)
            archive.writestr(f"{name}.npy", stream.getvalue())
    tracemalloc.start()
    try:
        with pytest.raises(RecordingError, match="shape"):
            read_recording(path)
        assert tracemalloc.get_traced_memory()[1] < 1_000_000
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (b"\n1,", b"\n-1,", "damaged"),
        (b"\n1,", b"\n" + b"9" * 50 + b",", "damaged"),
        (b"\n1,0.0", b"\n1,inf", "time is not finite"),
        (b"\n1,0.0", b"\n1,zero", "damaged"),
        (b"tick,", b"tock," * 1_000_000, "first line"),
        (b"tick,", b"\xff\xfe", "damaged|first line"),
        (b"\n1,", b"\n1" + b"0" * 5000 + b",", "over 3999 characters"),
        (b"\n1,0.0", b"\n1,7e9", "go back"),
    ],
)
def test_a_line_that_cannot_be_is_refused(sound, tmp_path, old, new, said):
    path = tmp_path / "odd.csv"
    path.write_bytes(sound.with_suffix(".csv").read_bytes().replace(old, new, 1))
    with pytest.raises(RecordingError, match=said):
        read_recording(path)


@given(
    suffix=st.sampled_from([".npz", ".csv"]),
    places=st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), max_size=8),
    cut=st.floats(0, 1),
    is_cut=st.booleans(),
)
def test_bytes_changed_and_cut(sound, suffix, places, cut, is_cut):
    content = bytearray(sound.with_suffix(suffix).read_bytes())
    for place, value in places:
        content[int(place * (len(content) - 1))] = value
    path = sound.with_name(f"any{suffix}")
    path.write_bytes(content[: int(cut * len(content))] if is_cut else content)
    with suppress(PalpateError):
        recording = read_recording(path)
        assert np.isfinite(recording.samples["force"]).all()
        assert recording.samples["state"].max(initial=0) < len(recording.states) or not len(
            recording.samples
        )


@pytest.mark.parametrize("shape", [(10**15,), (2**40, 2**40), (-1,), (3,)])
def test_an_array_that_is_not_as_long_as_it_says_is_refused(tmp_path, shape):
    path = tmp_path / "numbers.npy"
    with path.open("wb") as file:
        npy.write_array_header_1_0(file, {"descr": "<i8", "fortran_order": False, "shape": shape})
    with pytest.raises(ArchiveError, match=r"numbers\.npy: cannot be read"):
        read_array(path)
    np.save(path, [[1, 2], [3, 4]])
    assert read_array(path).tolist() == [[1, 2], [3, 4]]
