"""Files of tables: whole, of one body, or refused."""

import numpy as np
import pytest

from palpate.core.shape.paper.table_file import TableFileError, read_table, table_path, write_table

ARRAYS = {"numbers": np.arange(5.0), "bytes": np.arange(40, dtype=np.uint8)}
LAYOUT = {"numbers": (np.float64, (5,)), "bytes": (np.uint8, (None,))}


@pytest.fixture
def path(tmp_path):
    path = table_path(tmp_path / "mouse-abc.npz", "series")
    write_table(path, "series", "a key", ARRAYS)
    return path


def test_it_lies_beside_the_body_file_under_its_name(path):
    assert path.name == "mouse-abc.series.npz"


def test_what_was_written_is_read(path):
    found = read_table(path, "series", "a key", LAYOUT)
    assert found.keys() == ARRAYS.keys()
    for name, array in ARRAYS.items():
        np.testing.assert_array_equal(found[name], array)


@pytest.mark.parametrize(
    ("kind", "key", "reason"),
    [("other", "a key", "holds series in version 1, not other"), ("series", "b", "another body")],
)
def test_another_table_or_body_is_refused(path, kind, key, reason):
    with pytest.raises(TableFileError, match=reason):
        read_table(path, kind, key, LAYOUT)


def test_no_damage_goes_unseen(path):
    whole = path.read_bytes()
    for place in range(0, len(whole), 97):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        try:
            found = read_table(path, "series", "a key", LAYOUT)
        except TableFileError:
            continue
        for name, array in ARRAYS.items():
            np.testing.assert_array_equal(found[name], array)
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(TableFileError, match="computed anew"):
        read_table(path, "series", "a key", LAYOUT)


def test_numbers_that_were_changed_are_refused(path):
    arrays = dict(np.load(path))
    arrays["numbers"][2] += 1e-12
    np.savez(path, **arrays)
    with pytest.raises(TableFileError, match="checksum does not match"):
        read_table(path, "series", "a key", LAYOUT)


def test_another_archive_is_refused(path):
    np.savez(path, numbers=np.arange(3))
    with pytest.raises(TableFileError, match="no table of Palpate's"):
        read_table(path, "series", "a key", LAYOUT)


@pytest.mark.parametrize(
    "changed",
    [
        {"numbers": np.arange(4.0)},
        {"numbers": np.arange(5)},
        {"numbers": np.arange(5.0)[:, None]},
        {"numbers": np.array([0.0, 1.0, np.nan, 3.0, 4.0])},
        {"numbers": None},
    ],
)
def test_a_table_that_only_its_checksum_vouches_for_is_refused(path, changed):
    arrays = {name: array for name, array in (ARRAYS | changed).items() if array is not None}
    write_table(path, "series", "a key", arrays)
    with pytest.raises(TableFileError, match="'numbers' cannot be"):
        read_table(path, "series", "a key", LAYOUT)
