"""Options and connection of a Haply 2DIY for ``palpate servo``."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...core.errors import PalpateError
from ...core.servo.haply_models import DEFAULT_MODEL, HAPLY_MODELS
from ...core.servo.port_error import PortError
from ...core.servo.session import HaplyDevice
from ...simulated.hand.plant import Vector

if TYPE_CHECKING:
    from ...core.servo.session import Servo

ANSWER_SECONDS = 5.0
LOOK_EVERY_SECONDS = 0.02
STANDING = ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))
"""Rotation of the device's plane, upright in the body: x stays, y becomes z."""


def add_haply_options(
    parser: argparse.ArgumentParser, device: argparse._MutuallyExclusiveGroup
) -> None:
    """Add options for a 2DIY."""
    device.add_argument(
        "--haply",
        metavar="PORT",
        help="a Haply 2DIY; start with its handle in the rest pose, it then moves in an upright "
        "plane over the body's highest place",
    )
    parser.add_argument(
        "--model",
        choices=HAPLY_MODELS,
        default=DEFAULT_MODEL,
        help="model of the 2DIY (default: %(default)s)",
    )
    parser.add_argument(
        "--recalibrate",
        action="store_true",
        help="the 2DIY's handle is in its rest pose now, whatever its board believes",
    )


def connect_haply(
    servo: Servo, arguments: argparse.Namespace, at: Vector, stopped: Sequence[int]
) -> None:
    """Start with the 2DIY at `arguments.haply`, the centre of its workspace at `at` (m).

    Raises PalpateError when the port cannot be opened, PortError when no board answers.
    """
    port = arguments.haply
    try:
        servo.start(
            HaplyDevice(
                port,
                model=arguments.model,
                recalibrate=arguments.recalibrate,
                rotation=STANDING,
                translation=at,
            )
        )
    except OSError as error:
        raise PalpateError(str(error)) from error
    deadline = time.monotonic() + ANSWER_SECONDS
    while servo.running and servo.snapshot().state in {"stopped", "waiting"} and not stopped:
        if time.monotonic() > deadline:
            raise PortError(
                port,
                f"no Haply 2DIY within {ANSWER_SECONDS:g} s ({servo.snapshot().reason}); check "
                "its power, its firmware and --model",
            )
        time.sleep(LOOK_EVERY_SECONDS)
