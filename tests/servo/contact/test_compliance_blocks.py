"""The native compliance against core's, block by block, and what snapshots tell of the surface."""

import os
from functools import cache

import numpy as np
import pytest
from palpate_servo import Body, Compliance, Pointer

from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.body import body_file
from palpate.core.contact.single_press import touch_at
from palpate.core.contact.touches import contact_displacement
from palpate.core.errors import BodyFileError
from palpate.core.servo.session import native_body, native_compliance, servo_on
from palpate.core.servo.settings import Settings
from palpate.core.stiffness.pins import PinNodes


@pytest.fixture(scope="module")
def baked(mouse_mesh):
    mesh, fixed = mouse_mesh

    @cache
    def bake_as(form, tolerance=1e-3):
        settings = BakeSettings(0.3, 1_000.0, PinNodes(fixed), form=form, tolerance=tolerance)
        return bake(mesh, settings)[0]

    return bake_as


@pytest.fixture(params=[("dense", 1e-3), ("compressed", 1e-3), ("compressed", 1e-4)])
def body(request, baked):
    return baked(*request.param)


def test_blocks_are_those_of_core(body):
    rng = np.random.default_rng(1)
    native = native_compliance(body.compliance)
    assert native.form == body.compliance.form
    assert native.node_count == body.compliance.node_count
    for i, j in rng.integers(0, native.node_count, (2_000, 2)):
        expected = body.compliance.block(i, j)
        found = native.block(i, j)
        assert np.abs(found - expected).max() <= 1e-12 * np.abs(expected).max()
        np.testing.assert_array_equal(found, native.block(j, i).T)


def test_blocks_of_neighbours_are_those_of_core(body):
    native = native_compliance(body.compliance)
    for triangle in body.mesh.surface_triangles:
        free = body.free_index(triangle)
        for i in free[free >= 0]:
            for j in free[free >= 0]:
                expected = body.compliance.block(i, j)
                assert np.abs(native.block(i, j) - expected).max() <= 1e-12 * np.abs(expected).max()


def test_the_touched_point_moves_as_the_deformed_surface_does(body):
    rng = np.random.default_rng(2)
    native = native_body(body)
    precision = 1e-6  # deform sums in float32
    for triangle in rng.integers(0, len(body.mesh.surface_triangles), 300):
        touch = touch_at(body, triangle, rng.dirichlet([1, 1, 1]), rng.normal(size=3) * 0.003)
        moved = native.surface_displacement(
            triangle, touch.alpha, touch.nodal_forces, body.young_modulus
        )
        shape = body.deform(touch.triangle, touch.nodal_forces)
        expected = contact_displacement(body, touch, shape)
        assert np.abs(moved - expected).max() <= precision * np.abs(shape).max()


def test_snapshots_and_samples_tell_where_the_surface_is(body, eventually):
    low, high = body.mesh.nodes.min(axis=0), body.mesh.nodes.max(axis=0)
    above = np.array([*(0.5 * (low + high))[:2], high[2] + 0.01])
    pressed = above - [0, 0, 0.02]
    with servo_on(native_body(body), Settings(body.young_modulus)) as servo:
        servo.start(Pointer(above))
        eventually(lambda: servo.snapshot().tick > 0)
        assert servo.snapshot().surface_point is None
        servo.set_target(pressed)
        eventually(lambda: np.allclose(servo.snapshot().probe, pressed))
        snapshot = servo.snapshot()
        samples = servo.samples()
    touch = touch_at(body, snapshot.triangle_index, snapshot.alpha, snapshot.probe - snapshot.proxy)
    shape = body.deform(touch.triangle, snapshot.nodal_forces)
    moved = contact_displacement(body, touch, shape)
    np.testing.assert_allclose(snapshot.surface_point - snapshot.proxy, moved, atol=1e-8)
    assert np.linalg.norm(moved) > 1e-4
    touching = np.abs(samples["force"]).max(axis=1) > 0
    assert np.isnan(samples["surface"][~touching]).all()
    assert np.isfinite(samples["surface"][touching]).all()


def test_a_body_without_a_compliance_does_not_know_where_its_surface_is(cube):
    assert cube.native.surface_displacement(0, [1, 0, 0], np.eye(3), 1.0) is None


def test_pinned_nodes_do_not_move(cube):
    table = np.tile(np.eye(3)[None, :, :], (1, 1, 1))
    one = Compliance.dense(table)
    corner = int(cube.triangles[0, 0])
    body = Body(cube.nodes, cube.triangles, cube.blocks, one, [corner])
    forces = np.array([[1.0, 2, 3], [4, 5, 6], [7, 8, 9]])
    np.testing.assert_array_equal(
        body.surface_displacement(0, [0.5, 0.25, 0.25], forces, 2.0), [0.25, 0.5, 0.75]
    )


def test_tables_are_read_in_place_and_kept(cube):
    table = np.zeros((1, 3, 3))
    view = table[:]
    native = Compliance.dense(table)
    assert not table.flags.writeable
    view[0, 1, 2] = 5.0
    assert native.block(0, 0)[2, 1] == 5.0
    del table, view
    assert native.block(0, 0)[2, 1] == 5.0


def test_the_thread_reads_nothing_that_may_be_written_to_or_lie_in_a_file(cube):
    count = len(cube.nodes)
    table = np.random.default_rng(3).normal(size=(count, 3, 3 * count))
    view = table[:]
    body = Body(cube.nodes, cube.triangles, cube.blocks, Compliance.dense(table))
    before = body.surface_displacement(7, [0.5, 0.25, 0.25], np.eye(3), 1.0)
    view[:] = np.nan
    after = body.surface_displacement(7, [0.5, 0.25, 0.25], np.eye(3), 1.0)
    np.testing.assert_array_equal(after, before)
    assert np.isfinite(after).all()


@pytest.mark.skipif(os.name == "nt", reason="Windows cuts no file that is mapped")
def test_a_table_whose_file_was_cut_short_is_not_read(tmp_path, baked):
    file = tmp_path / "mouse.npz"
    body_file.save(baked("dense"), file)
    body = body_file.load(file, mapped_from_bytes=0)
    assert native_body(body).surface_displacement(7, [1, 0, 0], np.eye(3), 1.0) is not None
    os.truncate(file, 1_000_000)
    with pytest.raises(BodyFileError, match=r"mouse\.npz.*cut short"):
        native_body(body)


@pytest.mark.parametrize(
    ("table", "error", "reason"),
    [
        (np.zeros((2, 3, 5)), ValueError, r"must be \(n, 3, 3n\)"),
        (np.zeros((1, 3, 3), np.int32), TypeError, "no array of"),
        (np.zeros((2, 3, 12))[:, :, ::2], ValueError, "not contiguous"),
    ],
)
def test_a_table_that_cannot_be_read_is_refused(table, error, reason):
    with pytest.raises(error, match=reason):
        Compliance.dense(table)


def test_arrays_that_cannot_be_read_are_refused(baked):
    arrays = baked("compressed").compliance.arrays()
    with pytest.raises(KeyError, match="compressed_basis"):
        Compliance.compressed({k: v for k, v in arrays.items() if k != "compressed_basis"})
    with pytest.raises(ValueError, match="beyond"):
        Compliance.compressed(arrays | {"compressed_places": arrays["compressed_places"] + 1000})
    with pytest.raises(ValueError, match="below zero"):
        Compliance.compressed(arrays | {"compressed_places": -1 - arrays["compressed_places"]})
    with pytest.raises(TypeError, match="basis is no array of"):
        Compliance.compressed(arrays | {"compressed_basis": np.zeros(3)})


@pytest.mark.parametrize("pair", [(1 << 40, 0), (0, 1_000_000)])
def test_blocks_beyond_the_nodes_are_refused(body, pair):
    with pytest.raises(IndexError, match="beyond"):
        native_compliance(body.compliance).block(*pair)


def test_a_compliance_of_other_nodes_is_refused(cube):
    one = Compliance.dense(np.zeros((1, 3, 3)))
    with pytest.raises(ValueError, match="98 free nodes are named for a compliance of 1"):
        Body(cube.nodes, cube.triangles, cube.blocks, one)
    with pytest.raises(ValueError, match="names the node -1"):
        Body(cube.nodes, cube.triangles, cube.blocks, one, [-1])
