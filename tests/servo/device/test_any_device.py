"""A device that says anything at all, between sound words of an honest one: the force keeps its
limits and its flag, and a device of the link that is plugged in anew is believed again."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from link_vectors import messages

from palpate.core.servo import link
from palpate.simulated.attack.target import cube_target
from palpate.simulated.attack.virtual.haply_press import HaplyPress
from palpate.simulated.attack.virtual.virtual_press import MAX_FORCE, MAX_SLEW, PERIOD, VirtualPress

DRIVEN = ("ramping", "free", "touching")
ROUNDING = 2e-3
"""A force is told in thousandths of a newton."""

noise = st.binary(max_size=200)
frames = messages.map(link.encode)
sound_nonsense = st.binary(min_size=1, max_size=link.MAX_PAYLOAD).map(link.frame)
said = st.one_of(noise, frames, sound_nonsense, st.just(b""))
ticks = st.lists(
    st.tuples(
        st.lists(said, max_size=4).map(b"".join),
        st.sampled_from(["beside", "instead", "unplugged"]),
        st.sampled_from([PERIOD, PERIOD, PERIOD, 0.015, 0.021, 0.3]),
    ),
    max_size=15,
)


@pytest.mark.parametrize("protocol", [1, 2])
@given(spoilt=ticks)
def test_of_the_link(protocol, spoilt):
    press = VirtualPress(cube_target(), protocol=protocol)
    survived(press, spoilt)
    press.servo.unplug()
    press.tick()
    press.servo.plug_in()
    press.press()


# Its answers have no checksum; where they cannot be told apart it asks for another start.
@given(spoilt=ticks)
def test_of_a_2diy(spoilt):
    survived(HaplyPress(cube_target()), spoilt)


def survived(press, spoilt):
    """Spoil ticks in the middle of a press, each judged."""
    press.press()
    before = press.tick().output
    for words, how, seconds in spoilt:
        if how == "unplugged":
            press.servo.unplug()
        shot = press.tick(spoilt_by(words, how), seconds)
        press.servo.plug_in()
        judge(shot, before, seconds)
        before = shot.output


def spoilt_by(words, how):
    """What arrives of an honest device's bytes."""
    return lambda honest: words if how == "instead" else honest + b"\0" * (how == "beside") + words


def judge(shot, before, seconds):
    """A tick by the rules of docs/safety.md."""
    assert shot.output <= MAX_FORCE + ROUNDING
    assert shot.output <= before + MAX_SLEW * seconds + ROUNDING
    assert shot.said.hollow == 0
    assert shot.output == 0.0 or shot.state in DRIVEN
    assert shot.said.driving == 0 or shot.output > 0.0
