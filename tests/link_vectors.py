"""The shared vectors of the link: messages, streams, and what is refused; and any message of it."""

import json
import math
from pathlib import Path

from hypothesis import strategies as st

from palpate.core.servo import link

VECTORS = json.loads(
    (Path(__file__).resolve().parent / "vectors" / "link.json").read_text(encoding="utf-8")
)


def bits(size, *, signed=False):
    low, high = (-(1 << size - 1), (1 << size - 1) - 1) if signed else (0, (1 << size) - 1)
    return st.integers(low, high)


def triples(values):
    return st.tuples(values, values, values)


amounts = st.floats(0.0, 1e6, width=32)
names = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"])).filter(
    lambda name: len(name.encode()) <= link.NAME_BYTES
)
rotations = (
    st.tuples(*[st.floats(-1.0, 1.0)] * 4)
    .filter(lambda q: math.hypot(*q) > 0.1)
    .map(lambda q: tuple(part / math.hypot(*q) for part in q))
)
messages = st.one_of(
    st.builds(link.HostHello, st.sampled_from([1, 2])),
    st.builds(link.DeviceHello, names, bits(8), amounts, triples(amounts), bits(16)),
    st.builds(
        link.DeviceHello,
        *(names, bits(8), amounts, triples(amounts), bits(16), st.just(2), bits(16)),
    ),
    st.builds(
        link.State,
        *(bits(16), bits(32), triples(bits(32, signed=True)), bits(8), bits(8)),
        st.none() | bits(16),
    ),
    st.builds(
        link.Force,
        *(bits(16), triples(bits(16, signed=True)), bits(8)),
        st.none() | st.builds(link.Answer, bits(32), bits(16), bits(16)),
    ),
    st.builds(link.Fault, bits(8), bits(16)),
    st.builds(link.orientation, bits(16), rotations),
)
