import sys
from copy import deepcopy

import numpy as np
import pytest
from palpate_servo import Compliance

from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.compression.compress import compress
from palpate.core.compliance.compression.compressed_compliance import CompressedCompliance
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import touch_at
from palpate.core.errors import PalpateError


@pytest.fixture(scope="module")
def compressed(mouse):
    positions = mouse.mesh.nodes[mouse.compliance.free_surface]
    return compress(mouse.compliance, positions, 1e-3)


def pairs(compressed, rng, count=300):
    """Node pairs of all kinds: far, near, and in one cluster."""
    nodes = rng.integers(0, compressed.node_count, (count, 2))
    beside = np.argsort(compressed.places)
    nodes[::3, 1] = beside[(np.argsort(beside)[nodes[::3, 0]] + 5) % compressed.node_count]
    return nodes


def test_it_is_a_compliance_of_its_form(compressed, mouse):
    assert compressed.form == "compressed"
    assert compressed.node_count == mouse.compliance.node_count
    assert compressed.nbytes == sum(array.nbytes for array in compressed.arrays().values())


def test_diagonal_blocks_are_exact(compressed, mouse):
    np.testing.assert_array_equal(compressed.diagonal(), mouse.compliance.diagonal())
    np.testing.assert_array_equal(compressed.block(7, 7), mouse.compliance.block(7, 7))
    np.testing.assert_array_equal(compressed.columns(np.array([7]))[21:24], compressed.block(7, 7))


def test_it_is_symmetric_to_the_last_bit(compressed, rng):
    for i, j in pairs(compressed, rng):
        np.testing.assert_array_equal(compressed.block(i, j), compressed.block(j, i).T)


def test_blocks_of_many_nodes_are_those_of_each_pair(compressed, rng):
    rows, columns = pairs(compressed, rng, 60).T
    rows = np.concatenate([rows, columns[:7]])
    blocks = compressed.blocks(rows, columns)
    for a, i in enumerate(rows):
        for b, j in enumerate(columns):
            expected = compressed.block(i, j)
            atol = 1e-13 * np.abs(expected).max()
            np.testing.assert_allclose(blocks[a, b], expected, rtol=0, atol=atol)


def test_columns_are_made_of_blocks(compressed, rng):
    nodes = pairs(compressed, rng)
    columns = compressed.columns(nodes[:, 1]).reshape(-1, 3, len(nodes), 3)
    for k, (i, j) in enumerate(nodes):
        scale = np.abs(columns[:, :, k]).max()
        np.testing.assert_allclose(columns[i, :, k], compressed.block(i, j), atol=1e-13 * scale)


@pytest.mark.parametrize("native", [True, False])
@pytest.mark.parametrize("count", [1, 3, 40])
def test_displacements_are_columns_times_forces(compressed, rng, count, native, monkeypatch):
    if not native:
        monkeypatch.setitem(sys.modules, "palpate_servo", None)
        compressed = deepcopy(compressed)
    assert (compressed._native is not None) == native
    nodes = rng.integers(0, compressed.node_count, count)  # some of them twice
    forces = rng.normal(size=(count, 3))
    expected = (compressed.columns(nodes) @ forces.ravel()).reshape(-1, 3)
    moved = compressed.apply(forces, nodes)
    assert np.abs(moved - expected).max() < 1e-6 * np.abs(expected).max()


def test_forces_on_all_nodes_need_no_numbers(compressed, mouse, rng):
    forces = rng.normal(size=(compressed.node_count, 3))
    expected = mouse.compliance.apply(forces)
    assert np.linalg.norm(compressed.apply(forces) - expected) < 1e-3 * np.linalg.norm(expected)


def test_a_copy_that_was_sent_elsewhere_works_as_well(compressed):
    compressed.apply(np.ones((1, 3)), np.array([5]))
    copied = deepcopy(compressed)
    np.testing.assert_array_equal(copied.columns(np.array([5])), compressed.columns(np.array([5])))


def test_no_forces_move_nothing(compressed):
    assert not compressed.apply(np.zeros((0, 3)), np.zeros(0, int)).any()
    assert compressed.columns(np.zeros(0, int)).shape == (3 * compressed.node_count, 0)


def test_a_soft_body_feels_the_same_and_moves_nearly_the_same(compressed, mouse):
    body = SoftBody(mouse.mesh, mouse.fixed, mouse.poisson_ratio, compressed, mouse.young_modulus)
    paper = ContactSettings(mode="paper")
    pressed = (50, [0.2, 0.3, 0.5], [0.001, 0, -0.003])
    touch, ours = touch_at(mouse, *pressed), touch_at(body, *pressed)
    np.testing.assert_allclose(ours.nodal_forces, touch.nodal_forces, rtol=1e-3)
    touch, ours = touch_at(mouse, *pressed, paper), touch_at(body, *pressed, paper)
    np.testing.assert_array_equal(ours.nodal_forces, touch.nodal_forces)
    expected = mouse.deform(touch.triangle, touch.nodal_forces)
    moved = body.deform(ours.triangle, ours.nodal_forces)
    assert np.linalg.norm(moved - expected) < 1e-3 * np.linalg.norm(expected)


def test_its_arrays_make_it_again(compressed, rng):
    arrays = compressed.arrays()
    assert all(key.startswith("compressed_") for key in arrays)
    again = CompressedCompliance.from_arrays(
        compressed.free_surface, arrays | {"something else": np.zeros(1)}, compressed.tolerance
    )
    nodes, forces = rng.integers(0, compressed.node_count, 3), rng.normal(size=(3, 3))
    np.testing.assert_array_equal(again.apply(forces, nodes), compressed.apply(forces, nodes))


def changed(name, change):
    def spoil(arrays):
        return arrays | {f"compressed_{name}": change(arrays[f"compressed_{name}"].copy())}

    return spoil


def with_entry(place, value):
    def change(array):
        array[place] = value
        return array

    return change


def without_one_beside_the_diagonal(table):
    rows, columns = np.nonzero(np.triu(table, 1))
    table[rows[0], columns[0]] = 0
    return table


DAMAGE = {
    "missing": lambda arrays: {k: v for k, v in arrays.items() if k != "compressed_basis"},
    "is float64": changed("basis", lambda a: a.astype(np.float64)),
    "not finite": changed("basis", with_entry(5, np.nan)),
    "has the shape": changed("basis", lambda a: a[:-1]),
    "numbers beyond": changed("tile_table", with_entry((0, 5), 1 << 30)),
    "not symmetric": changed("tile_table", without_one_beside_the_diagonal),
    "contradict": changed("places", with_entry(0, 1)),
    "no neighbour": changed("near_table", with_entry((0, 0), 0)),
}


@pytest.mark.parametrize("reason", DAMAGE)
def test_damaged_arrays_are_refused(compressed, reason):
    with pytest.raises(PalpateError, match=reason):
        CompressedCompliance.from_arrays(
            compressed.free_surface, DAMAGE[reason](compressed.arrays()), compressed.tolerance
        )


def spoiled(array, rng):
    """One of many ways in which an array of a file can be wrong."""
    match rng.integers(6):
        case 0:
            return array[: rng.integers(len(array) + 1)] if array.ndim else array[None]
        case 1:
            return array.astype([np.int8, np.int64, np.float64, ">i4", ">f4"][rng.integers(5)])
        case 2:
            return np.swapaxes(array, 0, -1) if array.ndim > 1 else array[..., None]
        case _:
            kinds = {"i": [-(2**31), -1, 0, 1, 40, 2**31 - 1], "f": [np.nan, np.inf, -1.0, 1e-40]}
            values = np.array(kinds[array.dtype.kind]).astype(array.dtype)
            array = array.copy()
            array.reshape(-1)[rng.integers(array.size)] = rng.choice(values)
            return array


@pytest.mark.parametrize("seed", range(3))
def test_whatever_a_file_holds_is_refused_or_can_be_touched(compressed, seed):
    rng = np.random.default_rng(seed)
    refused = 0
    for _ in range(100):
        arrays = compressed.arrays()
        for name in rng.choice(list(arrays), 2, replace=False):
            arrays[name] = spoiled(arrays[name], rng)
        nodes = rng.integers(0, compressed.node_count, 3)
        try:
            found = CompressedCompliance.from_arrays(compressed.free_surface, arrays, 1e-3)
        except PalpateError:
            refused += 1
            try:
                native = Compliance.compressed(arrays)
            except (TypeError, ValueError):
                continue
            # What native code lets pass stays within its arrays.
            native.apply(np.ones((3, 3)), nodes % native.node_count)
        else:
            assert found.apply(np.ones((3, 3)), nodes).shape == (compressed.node_count, 3)
            assert found._applied(np.ones((3, 3)), nodes).shape == (compressed.node_count, 3)
    assert refused > 50
