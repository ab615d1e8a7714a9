"""Protocol 2 at the device's end, in C++ and simulated: what is named, and what is too late."""

import random
from dataclasses import replace

import pytest
from link_devices import Device, Simulated

from palpate.core.servo import link
from palpate.simulated.board.simulated_firmware import Firmware

HELLO = link.DeviceHello("Test", 3, 2.0, (0.125, 0.125, 0.125), 1000, 2, 500)
ENABLE, DAMP = link.ForceFlag.ENABLE, link.ForceFlag.DAMP
READY, TAKEN = link.StateFlag.READY, link.StateFlag.TAKEN
NO_FORCE = (0.0, 0.0, 0.0)


def force(sequence, state_us, flags=ENABLE, damping=0, z_mn=1000):
    return link.Force(sequence, (0, 0, z_mn), flags, link.Answer(state_us % 2**32, 3, damping))


@pytest.fixture(params=["C++", "simulated"])
def device(request):
    device = Simulated()
    if request.param == "C++":
        device = Device(request.getfixturevalue("checker"))
    device.new(HELLO)
    return device


@pytest.fixture
def greeted(device):
    assert device.hear(link.HostHello(2), 0) == [HELLO]
    return device


def test_either_protocol_is_answered_in_its_own_layout(device):
    older = replace(HELLO, protocol=1, largest_damping=0)
    assert device.hear(link.HostHello(1), 0) == [older]
    assert device.state(0) == [link.State(0, 0, (0, 0, 0))]
    device.hear(link.Force(0, (0, 0, 1000)), 0)
    assert device.force(0) == (0.0, 0.0, 1.0)
    assert device.hear(link.HostHello(2), 0) == [HELLO]
    assert device.force(0) == NO_FORCE
    assert device.state(0) == [link.State(1, 0, (0, 0, 0), taken=0)]
    assert device.hear(link.HostHello(3), 0) == [HELLO, link.Fault(2, 3)]
    assert device.state(0) == []


def test_a_state_names_the_last_force_that_was_taken(greeted):
    greeted.hear(force(65_535, 0), 0)
    greeted.hear(force(65_535, 0), 0)
    assert greeted.state(1000)[0] == link.State(0, 1000, (0, 0, 0), 0, READY | TAKEN, 65_535)
    greeted.hear(force(7, 1000), 1500)
    assert greeted.state(2000)[0].taken == 7
    # Also once it has gone limp, until the next session.
    assert greeted.drive(30_000)[0][0] == "limp"
    assert greeted.state(30_000)[0].taken == 7
    greeted.hear(link.HostHello(2), 30_000)
    assert greeted.state(31_000)[0].flags == READY


@pytest.mark.parametrize("flags", [ENABLE, DAMP, ENABLE | DAMP])
def test_what_answers_a_state_of_more_than_20_ms_ago_is_not_obeyed(greeted, flags):
    begin = 2**32 - 10_000
    greeted.hear(force(0, begin, flags, 100), begin + 20_000)
    assert greeted.drive(begin + 20_000)[0][0] == "driven"
    greeted.hear(force(1, begin, flags, 100), begin + 20_001)
    greeted.hear(force(2, begin + 30_000, flags, 100), begin + 29_999)
    (mode, enabled, damp, newtons), _ = greeted.drive(begin + 40_002)
    assert (mode, enabled, damp, newtons) == ("limp", False, False, NO_FORCE)
    assert greeted.counters()["refused"] == 2
    assert greeted.state(begin + 50_000)[0].taken == 0


def test_a_stored_second_of_forces_is_refused_and_the_zero_behind_it_taken(greeted):
    stored = b"".join(link.encode(force(n, 1000 * n)) for n in range(1000))
    # All but those that answer what was made in the last 20 ms.
    greeted.hear(stored, 1_100_000)
    assert greeted.force(1_100_000) == NO_FORCE
    assert greeted.counters()["refused"] == 1000
    greeted.hear(force(1000, 999_000, flags=0), 1_100_000)
    assert greeted.state(1_101_000)[0].taken == 1000
    assert greeted.counters()["forces"] == 1


def test_what_was_refused_is_as_if_it_had_not_come(greeted):
    # Until its first FORCE the device is limp and says nothing of it.
    assert greeted.drive(500_000) == (("limp", False, False, NO_FORCE), [])
    greeted.hear(force(10, 500_000), 500_000)
    greeted.hear(force(50, 400_000), 510_000)
    # Behind the refused one, ahead of the one that was taken.
    greeted.hear(force(11, 510_000, z_mn=500), 510_000)
    assert greeted.force(510_000) == (0.0, 0.0, 0.5)
    said = []
    for sequence in range(12, 40):
        said += greeted.hear(force(sequence, 400_000), 510_000 + 700 * sequence)
    standing, more = greeted.drive(540_000)
    assert standing == ("limp", False, False, NO_FORCE)
    assert [*said, *more] == [link.Fault(1, 1)]
    # Said once, and then any number is taken, also the one that was.
    assert greeted.drive(600_000)[1] == []
    greeted.hear(force(11, 600_000), 600_000)
    assert greeted.force(600_000) == (0.0, 0.0, 1.0)
    assert greeted.counters()["duplicates"] == 0


def test_layouts_of_the_other_protocol_are_not_used(greeted):
    greeted.hear(link.Force(0, (0, 0, 1000)), 0)
    assert greeted.force(0) == NO_FORCE
    greeted.hear(link.HostHello(1), 0)
    greeted.hear(force(0, 0), 0)
    assert greeted.force(0) == NO_FORCE
    assert greeted.counters()["unexpected"] == 2


def test_damping_is_asked_for_by_how_much(greeted):
    asked = [(DAMP, 300, True), (DAMP, 0, False), (ENABLE, 300, False)]
    for sequence, (flags, damping, brakes) in enumerate(asked):
        greeted.hear(force(sequence, 0, flags, damping), 0)
        assert greeted.drive(0)[0][2] is brakes


def test_they_behave_alike_whatever_the_host_says(checker):
    dice = random.Random(5)  # noqa: S311 - dice for a host's whims, not secrets
    ours, simulated = Device(checker), Firmware(HELLO)
    ours.new(HELLO)
    now, sequence = 0, 65_000
    for _ in range(3000):
        now += dice.choice([300, 999, 1001, 4001, 21_001])
        match dice.randrange(12):
            case 0:
                data = link.encode(link.HostHello(dice.choice([1, 2, 2, 2, 3])))
            case 1:
                data = link.encode(link.Force(sequence, (0, 0, 100)))
            case _:
                sequence = (sequence + dice.choice([0, 1, 1, 1, 2, 40])) % 2**16
                asked = force(sequence, now - dice.choice([0, 900, 19_999, 20_001, 10**6]))
                data = link.encode(replace(asked, flags=dice.randrange(4)))
        said = simulated.watch(now * 1e-6) + simulated.receive(data, now * 1e-6)
        _, ours_said = ours.drive(now)
        assert ours_said + ours.hear(data, now) == link.Decoder().feed(said)
        (mode, _, damp, newtons), _ = ours.drive(now)
        assert newtons == pytest.approx(simulated.force, abs=2e-3)
        if simulated.streaming:
            assert (mode == "limp", damp) == (simulated.limp, simulated.braked)
        stated = simulated.state(now * 1e-6, (0, 0, 0), 0)
        assert ours.state(now) == link.Decoder().feed(stated)
    seen, expected = ours.counters(), simulated.counters
    names = ("forces", "refused", "unexpected", "duplicates")
    assert [seen[name] for name in names] == [vars(expected)[name] for name in names]
    assert min(seen[name] for name in names) > 20
