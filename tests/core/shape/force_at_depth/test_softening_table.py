"""Softenings on demand: what is known, who is told, what is kept beside the body file."""

import time

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.body.soft_body import SoftBody
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.force_at_depth import softening_table
from palpate.core.shape.force_at_depth.softening_table import SofteningTable
from palpate.core.shape.paper.table_file import table_path


@pytest.fixture(scope="module")
def body():
    return baked_body(*paper_cube(cells=3), dtype=np.float64)


def until(condition):
    end = time.monotonic() + 30
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.002)


def touched(body):
    free = ~np.isin(body.mesh.surface_triangles, body.fixed).any(axis=1)
    return body.mesh.surface_triangles[np.flatnonzero(free)[10]]


def test_what_is_waited_for_is_there(body):
    table = SofteningTable(body)
    nodes = touched(body)
    pinned = np.isin(body.mesh.surface_nodes, body.fixed)
    assert table.share_known == pytest.approx(pinned.mean())
    table.wait_for(nodes)
    table.close()
    places = np.searchsorted(body.mesh.surface_nodes, nodes)
    assert table.values[places].any(axis=1).all()
    assert not table.values[pinned].any()


def test_the_background_begins_at_the_touched_place_and_ends(body):
    table, told = SofteningTable(body), []
    table.listen(lambda places, values: told.append((places, values)))
    nodes = touched(body)
    table.around(nodes)
    until(lambda: table.share_known == 1.0)
    order = [places for places, _ in told]
    assert set(np.searchsorted(body.mesh.surface_nodes, nodes)) == set(order[1])
    assert table.ready == 1.0
    once = np.zeros(len(body.mesh.surface_nodes), dtype=int)
    for places, values in told:
        once[places] += 1
        assert np.array_equal(values, table.values[places])
    assert (once == 1).all()
    whole = SofteningTable(body)
    whole.fill()
    # Blocks of other sizes are multiplied in another order.
    assert np.allclose(whole.values, table.values, rtol=1e-9)
    table.close()


def test_the_background_stops_when_asked(body, monkeypatch):
    slow = softening_table.node_softening

    def slower(*arguments):
        time.sleep(0.05)
        return slow(*arguments)

    monkeypatch.setattr(softening_table, "node_softening", slower)
    table = SofteningTable(body)
    table.around(touched(body))
    until(lambda: table.ready == 1.0)
    table.close()
    known = table.share_known
    assert known < 1.0
    time.sleep(0.1)
    assert table.share_known == known
    table.close()
    with pytest.raises(PalpateError, match="closed"):
        table.fill()


def test_a_failure_in_the_background_is_told_to_who_asks_next(body, monkeypatch):
    def broken(*_):
        raise FloatingPointError("no number")

    monkeypatch.setattr(softening_table, "node_softening", broken)
    table = SofteningTable(body)
    table.around(touched(body))

    def fails():
        try:
            table.around(touched(body))
        except PalpateError as problem:
            return "no number" in str(problem)
        return False

    until(fails)
    table.close()


def test_who_cancels_keeps_what_is_there(body):
    def cancel(share):
        if share > 0.5:
            raise KeyboardInterrupt

    table = SofteningTable(body)
    with pytest.raises(KeyboardInterrupt):
        table.fill(cancel)
    # The thread in the background may have gone on meanwhile: it ends when the table is closed.
    table.close()
    assert table.share_known > 0.5


def test_what_was_made_is_kept_beside_the_body_file(body, tmp_path):
    file = tmp_path / "toy.npz"
    first = SofteningTable(body, file)
    first.wait_for(touched(body))
    first.close()
    again = SofteningTable(body, file)
    assert np.array_equal(again.values, first.values)
    assert again.notice == ""
    assert again.share_known == first.share_known


def test_another_bodys_or_a_damaged_file_is_never_used(body, tmp_path):
    file = tmp_path / "toy.npz"
    first = SofteningTable(body, file)
    first.fill()
    other = SoftBody(body.mesh, body.fixed, 0.2, body.compliance, 1e4)
    foreign = SofteningTable(other, file)
    assert "another body" in foreign.notice
    assert not foreign.values.any()
    path = table_path(file, "softening")
    whole = path.read_bytes()
    value = first.values[first.values != 0].flat[0].tobytes()
    for wrong, reason in (
        (whole[: len(whole) // 2], "cut short"),
        (b"no archive", "not an npz"),
        (whole.replace(value, value[::-1], 1), "damaged"),
    ):
        path.write_bytes(wrong)
        damaged = SofteningTable(body, file)
        assert reason in damaged.notice
        assert not damaged.values.any()
    damaged.fill()
    assert np.array_equal(SofteningTable(body, file).values, damaged.values)


def test_what_another_program_kept_meanwhile_is_not_lost(body, tmp_path):
    file = tmp_path / "toy.npz"
    free = body.compliance.free_surface
    tables = [SofteningTable(body, file) for _ in range(2)]
    told = []
    tables[1].listen(lambda nodes, _: told.extend(nodes.tolist()))
    for table, node in zip(tables, (free[:1], free[-1:]), strict=True):
        table.wait_for(node)
    for table in tables:
        table.close()
    kept = SofteningTable(body, file)
    kept.around(free[[0, -1]])
    assert kept.ready == 1.0
    kept.close()
    assert np.searchsorted(body.mesh.surface_nodes, free[0]) in told
