"""What is promised before the work, against the work as it is done."""

import tracemalloc

import numpy as np
import pytest

from palpate.core.compliance.elimination import inverse, numeric, upper_tiles
from palpate.core.compliance.elimination.plan import plan_factor, plan_surface_inverse
from palpate.core.compliance.elimination.surface_columns import factor_for_columns, planned_columns
from palpate.core.compliance.surface_compliance import planned_compliance, surface_compliance
from palpate.core.machine import available_memory
from palpate.core.stiffness.assembly import assemble


@pytest.fixture(scope="module")
def whole(mouse_mesh):
    mesh, fixed = mouse_mesh
    return plan_surface_inverse(mesh, assemble(mesh, 0.3), fixed)


@pytest.fixture(scope="module")
def factor_alone(mouse_mesh):
    mesh, fixed = mouse_mesh
    return plan_factor(mesh, assemble(mesh, 0.3), fixed)


@pytest.fixture
def asked_flops(monkeypatch):
    """Counts what BLAS and LAPACK are asked for, from the shapes they are handed."""
    counts = []

    def counted(module, name, flops):
        original = getattr(module, name)

        def call(*arguments, **options):
            counts.append(flops(*arguments))
            return original(*arguments, **options)

        monkeypatch.setattr(module, name, call)

    def product(_, a, b, *__):
        return 2.0 * a.shape[0] * a.shape[1] * b.shape[1]

    def gram(_, a, *__):
        return 1.0 * a.shape[0] * a.shape[1] ** 2

    counted(numeric, "dpotrf", lambda a: len(a) ** 3 / 3)
    counted(numeric, "dtrsm", lambda _, a, b: 1.0 * len(a) ** 2 * b.shape[1])
    for module in (numeric, upper_tiles, inverse):
        counted(module, "dgemm", product)
    for module in (upper_tiles, inverse):
        counted(module, "dsyrk", gram)
    return counts


def test_operations_are_counted_exactly(whole, asked_flops):
    planned_compliance(whole)
    assert sum(asked_flops) == pytest.approx(whole.flops, rel=1e-12)


def test_operations_of_the_factor_alone_are_counted_exactly(factor_alone, asked_flops):
    planned_columns(factor_alone)
    assert sum(asked_flops) == pytest.approx(factor_alone.flops, rel=1e-12)


@pytest.mark.parametrize("carry_out", [planned_compliance, planned_columns])
def test_memory_is_predicted(request, monkeypatch, carry_out):
    plan = request.getfixturevalue("whole" if carry_out is planned_compliance else "factor_alone")
    plan.weight, plan.peak_bytes  # noqa: B018 - computed now, not while memory is counted
    # What is not numpy's own is not traced.
    monkeypatch.setattr(available_memory, "APART_ABOVE", 10**12)
    tracemalloc.start()
    try:
        carry_out(plan)
        grown = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    predicted = plan.peak_bytes - plan.matrix.nbytes
    assert predicted == pytest.approx(grown, rel=0.05)


@pytest.mark.parametrize("carry_out", [planned_compliance, planned_columns])
def test_progress_rises_to_one_in_small_steps(request, carry_out):
    plan = request.getfixturevalue("whole" if carry_out is planned_compliance else "factor_alone")
    shares = [0.0]
    carry_out(plan, shares.append)
    steps = np.diff(shares)
    assert (steps >= 0).all()
    assert shares[-2] == pytest.approx(1.0, abs=1e-9)
    assert shares[-1] == 1.0
    assert steps.max() * plan.weight < 3e9


@pytest.mark.parametrize("call", [1, 50, 500, -1])
def test_any_call_of_progress_can_cancel(whole, call):
    calls = []
    planned_compliance(whole, calls.append)
    stop_at = call if call > 0 else len(calls)

    def stop(_share):
        stop.seen += 1
        if stop.seen == stop_at:
            raise InterruptedError

    stop.seen = 0
    with pytest.raises(InterruptedError):
        planned_compliance(whole, stop)
    assert stop.seen == stop_at


def test_a_plan_tells_the_smaller_cost_of_the_factor_alone(whole, factor_alone):
    assert factor_alone.flops < whole.flops
    assert factor_alone.peak_bytes < whole.peak_bytes
    np.testing.assert_array_equal(factor_alone.free_surface, whole.free_surface)


def test_planning_tells_its_progress_and_can_be_cancelled(mouse_mesh):
    mesh, fixed = mouse_mesh
    stiffness = assemble(mesh, 0.3)
    heard = []
    plan_surface_inverse(mesh, stiffness, fixed, progress=heard.append)
    assert heard == sorted(heard)
    assert heard[-1] == 1.0
    # It is told of the cuts, not only of the beginning and the end.
    assert len(set(heard)) > 20
    assert 0.5 < heard[-2] <= 1.0

    def stop(share):
        if share > 0.3:
            raise InterruptedError

    for plan in (plan_surface_inverse, plan_factor):
        with pytest.raises(InterruptedError):
            plan(mesh, stiffness, fixed, progress=stop)


def test_a_whole_inverse_can_be_cancelled_while_it_is_planned(mouse_mesh):
    mesh, fixed = mouse_mesh
    calls = []

    def stop(share):
        calls.append(share)
        raise InterruptedError

    stiffness = assemble(mesh, 0.3)
    for make in (surface_compliance, factor_for_columns):
        with pytest.raises(InterruptedError):
            make(mesh, stiffness, fixed, stop)
    assert calls == [0.0, 0.0]
