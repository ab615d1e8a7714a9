"""Point caches, read back by what the PC2 format says."""

import struct

import numpy as np
import pytest

from palpate.core.files.point_cache import CacheSize, is_own_cache, point_cache

SAMPLES = np.arange(24, dtype=np.float32).reshape(2, 12)


def test_samples_are_where_the_format_has_them(tmp_path):
    target = tmp_path / "new" / "soft.pc2"
    with point_cache(target, CacheSize(points=4, samples=2, first_frame=5, step=2)) as cache:
        for sample in SAMPLES:
            cache.write(sample)
    data = target.read_bytes()
    assert struct.unpack_from("<12siiffi", data) == (b"POINTCACHE2\0", 1, 4, 5.0, 2.0, 2)
    read = np.frombuffer(data, "<f4", count=24, offset=32).reshape(2, 12)
    np.testing.assert_array_equal(read, SAMPLES)
    assert is_own_cache(target)


def test_a_cache_that_is_not_whole_leaves_nothing(tmp_path):
    target = tmp_path / "soft.pc2"
    size = CacheSize(points=4, samples=2)
    with pytest.raises(ValueError, match="1 samples of 2"), point_cache(target, size) as cache:
        cache.write(SAMPLES[0])
    with pytest.raises(ValueError, match="does not fit"), point_cache(target, size) as cache:
        cache.write(SAMPLES[0, :9])
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("data", [b"", b"POINTCACHE2\0", b"x" * 100])
def test_files_of_others_are_not_taken_for_own(tmp_path, data):
    other = tmp_path / "other.pc2"
    other.write_bytes(data)
    assert not is_own_cache(other)
    assert not is_own_cache(tmp_path / "missing.pc2")
