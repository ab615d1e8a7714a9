"""Recordings as files: exact, whole or not there, and errors that say what to do."""

import json
import shutil

import numpy as np
import palpate_servo
import pytest

from palpate.core.errors import PalpateError
from palpate.core.record.read_recording import read_recording
from palpate.core.record.recording import (
    CSV_GROWTH,
    CSV_HEADER,
    DTYPE,
    VECTORS,
    RecordingError,
    check_recording_path,
    check_room,
    write_recording,
)
from palpate.core.servo.settings import Settings

STATES = palpate_servo.STATES
both = pytest.mark.parametrize("suffix", [".csv", ".npz", ".CSV"])


@pytest.fixture
def samples():
    count = 25_000
    dice = np.random.default_rng(7)
    samples = np.zeros(count, DTYPE)
    samples["tick"] = np.arange(1, count + 1)
    samples["tick"][-1] = 2**63 + 1
    samples["time"] = np.arange(count) / 3e3
    for name in VECTORS:
        samples[name] = dice.normal(size=(count, 3)) * 10.0 ** dice.integers(-12, 3, (count, 3))
    samples["surface"][::2] = np.nan
    samples["force"][:9, 0] = [0.0, -0.0, 5e-324, 1e300, 0.1, 1 / 3, 1e22, 1e-5, 123456.0]
    samples["state"] = dice.integers(0, len(STATES), count)
    return samples


def test_the_servo_records_what_is_written(cube_servo):
    assert cube_servo.samples().dtype == cube_servo.recording().dtype == DTYPE


@pytest.fixture
def cube_servo():
    nodes = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    body = palpate_servo.Body(nodes, triangles, [np.eye(3)] * 4)
    return palpate_servo.Servo(body, Settings(1.0))


@both
def test_what_is_written_is_read_to_the_last_bit(tmp_path, samples, suffix):
    path = tmp_path / f"press{suffix}"
    write_recording(path, samples, STATES, 1000)
    recording = read_recording(path)
    assert recording.samples.dtype == DTYPE
    assert recording.samples.tobytes() == samples.tobytes()
    assert recording.states == STATES
    assert recording.rate_hz == (1000 if suffix == ".npz" else None)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


@both
def test_a_recording_without_ticks_is_one_too(tmp_path, samples, suffix):
    path = tmp_path / f"press{suffix}"
    write_recording(path, samples[:0], STATES, 1000)
    assert len(read_recording(path).samples) == 0


def test_csv_is_for_everyone(tmp_path, samples):
    path = tmp_path / "press.csv"
    write_recording(path, samples[1:3], STATES, 1000)
    header, *lines = path.read_text().splitlines()
    assert header == CSV_HEADER
    columns = header.split(",")
    assert columns[:3] == ["tick", "time_s", "probe_x_m"]
    assert columns[-3:] == ["output_y_N", "output_z_N", "state"]
    row = dict(zip(columns, lines[0].split(","), strict=True))
    assert row["tick"] == "2"
    assert row["state"] == STATES[samples["state"][1]]
    assert float(row["proxy_z_m"]) == samples["proxy"][1, 2]
    surfaces = [line.split(",")[columns.index("surface_x_m")] for line in lines]
    assert surfaces[1] == "nan" != surfaces[0]
    table = np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")
    np.testing.assert_array_equal(table["force_y_N"], samples["force"][1:3, 1])


def test_npz_is_for_numpy_alone(tmp_path, samples):
    path = tmp_path / "press.npz"
    write_recording(path, samples, STATES, 500)
    with np.load(path, allow_pickle=False) as archive:
        np.testing.assert_array_equal(archive["force"], samples["force"])
        names = archive["states"][archive["state"]]
        about = json.loads(str(archive["about"]))
    assert names[3] == STATES[samples["state"][3]]
    assert about["rate_hz"] == 500
    assert about["palpate"] == palpate_servo.__version__
    assert about["units"]["output"] == "N"


def test_an_unknown_state_in_csv_keeps_its_name(tmp_path, samples):
    path = tmp_path / "press.csv"
    states = [*STATES, "dreaming"]
    samples["state"][5] = len(STATES)
    write_recording(path, samples[:10], states, 1000)
    recording = read_recording(path)
    assert recording.states[recording.samples["state"][5]] == "dreaming"


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ("press.txt", "let the name end in .csv or .npz"),
        ("press", "let the name end in .csv or .npz"),
        ("nowhere/press.csv", "there is no folder"),
        ("folder.npz", "is a folder; name a file in it"),
    ],
)
def test_places_that_cannot_be_are_refused_beforehand(tmp_path, samples, place, words):
    (tmp_path / "folder.npz").mkdir()
    for attempt in (
        check_recording_path,
        lambda path: write_recording(path, samples, STATES, 1000),
    ):
        with pytest.raises(PalpateError, match=words):
            attempt(tmp_path / place)


@both
def test_a_full_disk_leaves_the_older_file(tmp_path, samples, suffix):
    resource = pytest.importorskip("resource")
    path = tmp_path / f"press{suffix}"
    write_recording(path, samples[:10], STATES, 1000)
    before = path.read_bytes()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, hard))
    try:
        with pytest.raises(PalpateError, match=r"press.*cannot be written .*enough room"):
            write_recording(path, samples, STATES, 1000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(("suffix", "takes"), [(".npz", 86_000_000), (".csv", 258_000_000)])
def test_a_disk_without_room_is_told_before_anything_is_felt(tmp_path, monkeypatch, suffix, takes):
    path, memory = tmp_path / f"press{suffix}", 86_000_000
    for free, fits in ((takes, True), (takes - 1, False)):
        usage = shutil.disk_usage(tmp_path)._replace(free=free)
        with monkeypatch.context() as patch:
            patch.setattr(shutil, "disk_usage", lambda _, usage=usage: usage)
            if fits:
                check_room(path, memory)
                continue
            with pytest.raises(RecordingError, match="shorter time, or choose a folder") as told:
                check_room(path, memory)
            assert str(tmp_path) in str(told.value)


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_a_csv_of_long_numbers_fits_where_it_was_said_to(tmp_path, samples, suffix):
    many = np.resize(samples, 2000)
    rng = np.random.default_rng(1)
    for name in VECTORS:
        many[name] = rng.normal(size=(2000, 3)) * 1e-3
    path = tmp_path / f"press{suffix}"
    write_recording(path, many, STATES, 1000)
    growth = CSV_GROWTH if suffix == ".csv" else 1.02
    assert path.stat().st_size <= growth * many.nbytes


def test_samples_of_another_kind_are_refused(tmp_path, samples):
    with pytest.raises(ValueError, match="type"):
        write_recording(tmp_path / "a.npz", samples["force"], STATES, 1000)
    with pytest.raises(ValueError, match="none of"):
        write_recording(tmp_path / "a.npz", samples, STATES[:2], 1000)
    assert not list(tmp_path.iterdir())


@both
def test_files_that_are_no_recordings_are_told(tmp_path, samples, suffix):
    path = tmp_path / f"press{suffix}"
    with pytest.raises(PalpateError, match=r"press.*(cannot be|No such)"):
        read_recording(path)
    write_recording(path, samples, STATES, 1000)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2 - 7])
    with pytest.raises(PalpateError, match="damaged"):
        read_recording(path)
    path.write_bytes(b"t,x,y,z\n1,2,3,4\n")
    with pytest.raises(PalpateError, match=r"is no recording|damaged"):
        read_recording(path)


def test_npz_of_something_else_is_told(tmp_path):
    path = tmp_path / "other.npz"
    np.savez(path, X=np.zeros(3))
    with pytest.raises(PalpateError, match="is no recording"):
        read_recording(path)
    np.savez(path, about=np.array(json.dumps({"format": "palpate recording 9"})))
    with pytest.raises(PalpateError, match="update Palpate"):
        read_recording(path)


def test_other_endings_are_not_read(tmp_path):
    with pytest.raises(PalpateError, match="ends in"):
        read_recording(tmp_path / "press.txt")
