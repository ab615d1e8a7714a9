import pytest
from threadpoolctl import ThreadpoolController

from palpate.core.machine import available_cores
from palpate.core.machine import blas_threads as module
from palpate.core.machine.blas_threads import LEAST_FLOPS_FOR_THREADS, blas_threads, threads_by_work


def threads_of_blas():
    return {
        library["num_threads"]
        for library in ThreadpoolController().info()
        if library["user_api"] == "blas"
    }


def test_the_number_holds_within_and_the_old_one_afterwards():
    before = threads_of_blas()
    with blas_threads(1) as count:
        assert count == 1
        assert threads_of_blas() == {1}
    assert threads_of_blas() == before


def test_there_are_never_more_threads_than_cores_for_the_process(monkeypatch):
    monkeypatch.setattr(module, "available_cores", lambda: 1)
    monkeypatch.setattr(available_cores, "available_cores", lambda: 1)
    for wanted in (None, 1, 64):
        with blas_threads(wanted) as count:
            assert count == 1
            assert threads_of_blas() == {1}


@pytest.mark.parametrize(
    ("busy", "idle"),
    [([0, 0, 0, 0], 4), ([100, 100, 3, 5], 2), ([100, 100, 100, 100], 1), ([40, 30, 20, 20], 3)],
)
def test_cores_that_others_keep_busy_are_left_to_them(monkeypatch, busy, idle):
    monkeypatch.setattr(available_cores, "available_cores", lambda: 4)
    monkeypatch.setattr(available_cores.sys, "platform", "any")
    monkeypatch.setattr(available_cores.psutil, "cpu_percent", lambda *_, **__: busy)
    assert available_cores.idle_cores() == idle


def test_a_core_that_may_not_be_used_does_not_count_as_idle(monkeypatch):
    monkeypatch.setattr(available_cores.sys, "platform", "linux")
    monkeypatch.setattr(available_cores.os, "sched_getaffinity", lambda _: {1, 2}, raising=False)
    monkeypatch.setattr(available_cores.psutil, "cpu_percent", lambda *_, **__: [0, 95, 5, 0])
    assert available_cores.idle_cores() == 1


def test_the_number_asked_for_is_taken_without_looking(monkeypatch):
    monkeypatch.setattr(module, "idle_cores", lambda: pytest.fail("looked"))
    with blas_threads(1) as count:
        assert count == 1


def test_the_old_number_holds_again_after_an_error():
    before = threads_of_blas()
    with pytest.raises(InterruptedError), blas_threads(1):
        raise InterruptedError
    assert threads_of_blas() == before


def test_small_work_has_one_thread_and_large_work_all():
    controller = ThreadpoolController()
    with controller.limit(limits=2, user_api="blas"), threads_by_work() as suit:
        suit(1.0)
        assert threads_of_blas() == {1}
        suit(LEAST_FLOPS_FOR_THREADS)
        assert threads_of_blas() == {2}
        suit(1.0)
        assert threads_of_blas() == {1}
    with controller.limit(limits=1, user_api="blas"), threads_by_work() as suit:
        suit(LEAST_FLOPS_FOR_THREADS)
        assert threads_of_blas() == {1}


def test_large_works_threads_hold_again_after_an_error():
    def stopped():
        with threads_by_work() as suit:
            suit(1.0)
            raise InterruptedError

    with ThreadpoolController().limit(limits=2, user_api="blas"):
        with pytest.raises(InterruptedError):
            stopped()
        assert threads_of_blas() == {2}
