"""What the bad wire loses, flips and delays."""

from palpate.core.servo import link
from palpate.simulated.wire.wire_faults import BadWire

FRAME = link.encode(link.Force(7, (0, -500, 1000)))


def test_a_good_wire_changes_nothing():
    wire = BadWire(0.0, 0.0, 0.0, seed=1)
    wire.put(FRAME[:5], 0.0)
    assert wire.take(0.0) == b""
    wire.put(FRAME[5:] + FRAME, 0.1)
    assert wire.take(0.1) == FRAME + FRAME
    assert wire.take(0.2) == b""


def test_loss_takes_whole_frames_and_about_its_fraction():
    wire = BadWire(0.25, 0.0, 0.0, seed=1)
    wire.put(FRAME * 4000, 0.0)
    arrived = wire.take(0.0)
    assert arrived == FRAME * (4000 - wire.lost)
    # Five standard deviations around the mean.
    assert abs(wire.lost - 1000) < 5 * (4000 * 0.25 * 0.75) ** 0.5
    everything = BadWire(1.0, 0.0, 0.0, seed=1)
    everything.put(FRAME * 10, 0.0)
    assert everything.take(0.0) == b""


def test_noise_flips_about_its_fraction_of_the_bits():
    wire = BadWire(0.0, 0.01, 0.0, seed=3)
    wire.put(FRAME * 2000, 0.0)
    arrived = wire.take(0.0)
    flipped = sum((a ^ b).bit_count() for a, b in zip(arrived, FRAME * 2000, strict=True))
    assert flipped == wire.flipped
    mean = 0.01 * 8 * len(FRAME) * 2000
    assert abs(flipped - mean) < 5 * mean**0.5


def test_the_worst_noise_flips_every_bit():
    wire = BadWire(0.0, 1.0, 0.0, seed=3)
    wire.put(FRAME, 0.0)
    assert wire.take(0.0) == bytes(byte ^ 0xFF for byte in FRAME)


def test_the_same_seed_is_the_same_weather():
    arrivals = []
    for _ in range(2):
        wire = BadWire(0.1, 0.001, 0.0, seed=42)
        wire.put(FRAME * 100, 0.0)
        arrivals.append(wire.take(0.0))
    assert arrivals[0] == arrivals[1] != FRAME * 100


def test_delay_holds_each_frame_for_its_time_and_keeps_the_order():
    wire = BadWire(0.0, 0.0, 0.01, seed=1)
    first, second = FRAME, link.encode(link.HostHello())
    wire.put(first, 0.0)
    wire.put(second, 0.005)
    assert wire.take(0.009) == b""
    assert wire.take(0.0101) == first
    assert wire.take(0.016) == second


def test_jitter_delays_each_frame_by_chance_and_keeps_the_order():
    wire = BadWire(0.0, 0.0, 0.010, seed=1, jitter=0.004)
    sent = [link.encode(link.Force(number, (0, 0, 0))) for number in range(400)]
    arrived, times = b"", []
    for millisecond in range(430):
        if millisecond < len(sent):
            wire.put(sent[millisecond], millisecond * 1e-3)
        for tenth in range(10):
            now = (millisecond + 0.1 * tenth) * 1e-3
            heard = wire.take(now)
            times += [now] * heard.count(b"\0")
            arrived += heard
    assert arrived == b"".join(sent)
    delays = [time - number * 1e-3 for number, time in enumerate(times)]
    assert 0.0099 < min(delays) < 0.0103
    assert 0.0137 < max(delays) < 0.0141
    assert len({round(delay, 5) for delay in delays}) > 20
