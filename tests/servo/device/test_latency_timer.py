"""STATE that an adapter holds back, as the servo's own counters see it."""

import pytest
from palpate_servo import LinkDevice

from palpate.core.servo.latency_timer import explain
from palpate.core.servo.session import native_body, servo_on
from palpate.core.servo.settings import Settings
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice


@pytest.fixture
def counted(cube, eventually):
    """The link's counters after a while with a device."""

    def run(states, **options):
        with (
            SimulatedDevice(SimulatedOptions(**options)) as device,
            servo_on(native_body(cube), Settings(1e4)) as servo,
        ):
            servo.start(LinkDevice(device.port))
            eventually(lambda: servo.counters()["link"]["states"] > states)
            return servo.counters()["link"], device.port

    return run


@pytest.mark.in_time
@pytest.mark.parametrize("timer_ms", [10, 16])
def test_a_latency_timer_is_recognised_and_explained(counted, timer_ms):
    link, port = counted(700, latency_timer=timer_ms * 1e-3)
    assert link["bursts"] > 700 / timer_ms / 2
    # Lower bounds only: a busy machine may hold everything up for longer.
    assert link["burst_ms"] > 0.9 * timer_ms
    assert 2 * link["burst_states"] > link["states"]
    interval = link["state_interval_us"]
    # Bytes of a burst may come in two ticks, so the mean can be half the timer's.
    assert interval["max"] >= interval["mean"] > 400.0 * timer_ms
    assert 900.0 < interval["device"] < 0.5 * interval["mean"]
    assert f"{port}: STATE arrives in bursts" in explain(link, port)
