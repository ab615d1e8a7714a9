"""Two codecs that know nothing of each other, Python's and Rust's, on the same bytes."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from link_vectors import VECTORS
from palpate_servo import harness

from palpate.core.servo import link

payloads = st.binary(min_size=1, max_size=link.MAX_PAYLOAD)


def counted(decoder):
    return (decoder.crc_errors, decoder.cobs_errors + decoder.oversize)


def agree(data, pieces=1):
    ours, theirs = link.Decoder(), harness.Decoder()
    step = max(1, len(data) // pieces)
    for start in range(0, len(data), step):
        piece = data[start : start + step]
        assert ours.feed_payloads(piece) == theirs.feed(piece)
    assert (ours.errors.crc_errors, ours.errors.malformed) == counted(theirs)


@pytest.mark.parametrize("vector", VECTORS["messages"], ids=lambda vector: vector["name"])
def test_the_native_codec_keeps_the_vectors_too(vector):
    payload, frame = bytes.fromhex(vector["payload"]), bytes.fromhex(vector["frame"])
    assert harness.encode_frame(payload) == frame
    assert harness.Decoder().feed(frame) == [payload]


@pytest.mark.parametrize("vector", VECTORS["streams"], ids=lambda vector: vector["name"])
def test_the_native_decoder_reads_the_streams_of_the_vectors(vector):
    decoder = harness.Decoder()
    read = decoder.feed(bytes.fromhex(vector["bytes"]))
    assert [payload.hex() for payload in read] == vector["payloads"]
    assert counted(decoder) == (vector["crc_errors"], vector["malformed"])


@given(payloads)
def test_they_write_the_same_frames(payload):
    assert link.frame(payload) == harness.encode_frame(payload)


@given(payloads)
def test_each_reads_what_the_other_writes(payload):
    assert link.Decoder().feed_payloads(harness.encode_frame(payload)) == [payload]
    assert harness.Decoder().feed(link.frame(payload)) == [payload]


@pytest.mark.parametrize("payload", [b"", bytes(link.MAX_PAYLOAD + 1)])
def test_both_refuse_payloads_that_fit_no_frame(payload):
    with pytest.raises(ValueError, match="bytes"):
        link.frame(payload)
    with pytest.raises(ValueError, match="bytes"):
        harness.encode_frame(payload)


@given(st.binary(max_size=500), st.integers(1, 9))
def test_they_read_noise_alike(noise, pieces):
    agree(noise, pieces)


@given(st.lists(st.sampled_from([0, 1, 2, 3, 61, 62, 63, 255]), max_size=200))
def test_they_read_the_corners_of_the_framing_alike(values):
    agree(bytes(values))
