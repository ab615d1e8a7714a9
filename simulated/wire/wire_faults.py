"""Faults of a cable: lost frames, flipped bits, delay, jitter."""

from __future__ import annotations

import math
import random
from collections import deque


class BadWire:
    """One direction of a faulty link.

    loss: fraction of frames that vanish. noise: fraction of bits that flip. delay: seconds. jitter:
    largest random extra delay of a frame, seconds; frames never overtake each other.
    latency_timer: seconds; bytes are delivered at multiples of this, as by FTDI's adapters; 0 for
    at once.
    """

    def __init__(
        self,
        loss: float,
        noise: float,
        delay: float,
        seed: int,
        latency_timer: float = 0.0,
        jitter: float = 0.0,
    ) -> None:
        self.lost = 0
        self.flipped = 0
        self._loss = loss
        self._delay = delay
        self._jitter = jitter
        self._latency_timer = latency_timer
        self._random = random.Random(seed)  # noqa: S311 - simulation, not secrets
        self._noise = noise
        self._clean_bits = self._draw_clean_bits()
        self._begun = bytearray()
        self._in_flight: deque[tuple[float, bytes]] = deque()

    def put(self, data: bytes, now: float) -> None:
        """Send bytes at time `now`; a frame is complete with its closing zero."""
        *endings, rest = data.split(b"\0")
        for ending in endings:
            frame = bytes(self._begun + ending + b"\0")
            self._begun.clear()
            if self._random.random() < self._loss:
                self.lost += 1
            else:
                self._in_flight.append((self._handed_over(now), self._flip(frame)))
        self._begun += rest

    def take(self, now: float) -> bytes:
        """Bytes that have arrived until `now`."""
        arrived = bytearray()
        while self._in_flight and self._in_flight[0][0] <= now:
            arrived += self._in_flight.popleft()[1]
        return bytes(arrived)

    def _handed_over(self, now: float) -> float:
        arrives = now + self._delay
        if self._jitter > 0.0:
            arrives += self._jitter * self._random.random()
        if self._latency_timer > 0.0:
            arrives = math.ceil(arrives / self._latency_timer) * self._latency_timer
        return max(arrives, self._in_flight[-1][0]) if self._in_flight else arrives

    def _flip(self, frame: bytes) -> bytes:
        bits = 8 * len(frame)
        if self._clean_bits >= bits:
            self._clean_bits -= bits
            return frame
        damaged = bytearray(frame)
        while self._clean_bits < bits:
            place = int(self._clean_bits)
            damaged[place // 8] ^= 1 << place % 8
            self.flipped += 1
            self._clean_bits += 1 + self._draw_clean_bits()
        self._clean_bits -= bits
        return bytes(damaged)

    def _draw_clean_bits(self) -> float:
        # Distance to the next flipped bit, drawn from the geometric distribution.
        if self._noise <= 0.0:
            return math.inf
        if self._noise >= 1.0:
            return 0.0
        return float(math.floor(math.log(1.0 - self._random.random()) / math.log1p(-self._noise)))
