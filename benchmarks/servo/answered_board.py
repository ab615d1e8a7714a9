"""A board on a pseudo-terminal that tells how long its STATE waits for the FORCE that answers it.

Started by servo_timing.py: prints the port, and at the end of its standard input the times in us.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import sys
import time
import tty

import numpy as np

from palpate.core.servo import link
from palpate.simulated.board.simulated_firmware import Firmware

PERIOD = 1e-3


def _say(board: int, frames: bytes) -> None:
    """Say what fits now; a host that does not read gets the next STATE."""
    with contextlib.suppress(BlockingIOError):
        os.write(board, frames)


def main() -> None:
    """STATE every millisecond until nobody wants any more."""
    board, host = os.openpty()
    tty.setraw(host)
    os.set_blocking(board, False)
    print(os.ttyname(host), flush=True)
    extents = (0.1, 0.1, 0.1)
    device = Firmware(link.DeviceHello("Answered", 3, 3.0, extents, 1000, link.PROTOCOL))
    ears, waits, answered = link.Decoder(), [], set()
    begin = time.monotonic()
    next_state = 0.0
    while True:
        now = time.monotonic() - begin
        if now >= next_state:
            next_state = max(next_state + PERIOD, now)
            said = device.state(now, (0, 0, 100_000), 0) + device.watch(now)
            if said:
                _say(board, said)
        rest = max(0.0, next_state - (time.monotonic() - begin))
        ready, _, _ = select.select([board, sys.stdin], [], [], rest)
        if sys.stdin in ready and not sys.stdin.readline():
            break
        if board in ready:
            now = time.monotonic() - begin
            heard = os.read(board, 4096)
            _say(board, device.receive(heard, now))
            for message in ears.feed(heard):
                if isinstance(message, link.Force) and message.answer is not None:
                    made = message.answer.state_time_us
                    if made not in answered:
                        answered.add(made)
                        waits.append(now * 1e6 - made)
    # Without the start.
    waits = waits[len(waits) // 10 :]
    parts = dict(zip(("p50", "p99", "p99_9"), np.percentile(waits, [50, 99, 99.9]), strict=True))
    print(json.dumps({"answers": len(waits), **parts, "max": max(waits)}))


if __name__ == "__main__":
    main()
