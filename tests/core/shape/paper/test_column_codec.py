"""Columns in few bytes."""

import numpy as np
import pytest

from palpate.core.shape.paper.column_codec import ColumnCodec


@pytest.fixture(scope="module")
def codec(mouse):
    return ColumnCodec.of(mouse.mesh.nodes[mouse.compliance.free_surface], mouse.compliance)


def test_the_error_is_what_was_allowed_and_what_is_told(codec, mouse):
    columns = mouse.compliance.columns(np.array([3, 500])).astype(np.float64)
    size = np.linalg.norm(columns, axis=0)
    packed, steps, errors = codec.encode(columns, 1e-3 * size)
    assert (errors <= 1e-3 * size).all()
    for at, (part, step) in enumerate(zip(packed, steps, strict=True)):
        error = np.linalg.norm(codec.decode(part, step) - columns[:, at])
        assert error == pytest.approx(errors[at], rel=0.01)


def test_smooth_columns_take_a_small_part_of_their_numbers(codec, mouse):
    columns = mouse.compliance.columns(np.array([3, 500])).astype(np.float64)
    packed, _, _ = codec.encode(columns, 1e-3 * np.linalg.norm(columns, axis=0))
    assert sum(map(len, packed)) < 0.15 * 4 * columns.size


def test_what_does_not_fit_is_told(codec):
    count = sum(map(len, codec.members))
    column = np.zeros((3 * count, 1))
    column[7] = 1.0
    _, _, errors = codec.encode(column, np.array([1e-5]))
    # Of all steps the best was taken: finer ones cut the largest numbers off.
    assert 1e-5 < errors[0] < 1e-3


def test_nothing_is_nothing(codec):
    count = sum(map(len, codec.members))
    packed, steps, errors = codec.encode(np.zeros((3 * count, 1)), np.zeros(1))
    assert errors[0] == 0.0
    assert not codec.decode(packed[0], steps[0]).any()
