"""Round trip of a line in protocol 2 of the link: zero forces sent, and when STATE names them."""

from __future__ import annotations

from statistics import fmean

from . import link


class RoundTrip:
    """Zero forces on their way; times in s of any clock that does not run backwards."""

    def __init__(self) -> None:
        self._sent: dict[int, float] = {}
        self._sequence = 0
        self._seconds: list[float] = []

    @property
    def milliseconds(self) -> float | None:
        """Average so far; None as long as nothing was named."""
        return 1e3 * fmean(self._seconds) if self._seconds else None

    def answer(self, state: link.State, now: float) -> bytes:
        """Take a STATE heard at `now`; returns the frame to answer with, empty in protocol 1."""
        if state.taken is None:
            return b""
        if state.flags & link.StateFlag.TAKEN and state.taken in self._sent:
            self._seconds.append(now - self._sent[state.taken])
            sent = list(self._sent)
            # Those before it were lost.
            for named in sent[: sent.index(state.taken) + 1]:
                del self._sent[named]
        sequence = self._sequence
        self._sequence = (sequence + 1) % link.SEQUENCES
        self._sent[sequence] = now
        answer = link.Answer(state.device_time_us)
        return link.encode(link.Force(sequence, (0, 0, 0), link.ForceFlag(0), answer))
