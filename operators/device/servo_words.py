"""Texts for the servo's states, faults, reasons and limits.

The keys are the servo's own names (``palpate_servo.STATES`` and ``FAULTS``); a test finds
missing ones. Sentences are translated where they are shown.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ...core.sentence import Sentence
from ...core.servo.session import FingerSnapshot, Snapshot


class Signal(Enum):
    """Signal of whether force may come."""

    OFF = "off"  # none, until switched on
    WAITING = "waiting"  # none yet
    READY = "ready"  # as soon as the surface is touched
    FORCE = "force"  # present
    RETURNING = "returning"  # ramping up
    FAULT = "fault"  # none, something is wrong


@dataclass(frozen=True)
class Standing:
    """Status of the force: a word, the reason with its remedy, and the limit that reduces the
    force now (empty if none).
    """

    signal: Signal
    word: str
    why: str = ""
    limit: str = ""


STATES = {
    "waiting": Standing(Signal.WAITING, "Waiting", "No force yet: the device is not ready"),
    "free": Standing(Signal.READY, "Free", "Force comes as soon as the surface is touched"),
    "touching": Standing(Signal.FORCE, "Touching"),
    "ramping": Standing(Signal.RETURNING, "Force Rises", "The force rises slowly"),
    "fault": Standing(Signal.FAULT, "Fault", "No force until the fault is gone"),
    "disabled": Standing(Signal.OFF, "Force Off", "No force until it is switched on"),
    "stopped": Standing(Signal.OFF, "Stopped", "The force loop does not run"),
}

# With the remedy in the same sentence.
FAULTS = {
    "unplugged": "The device is unplugged; plug it in again and pressing goes on",
    "stale": "The device is silent; check its cable and power, pressing goes on when it speaks",
    "deaf": "The device hears the force too late and was let go; close what keeps the computer "
    "busy, or raise the line's speed at both ends, and pressing goes on",
    "too fast": "The device moved too fast and was let go; hold still and pressing goes on",
    "nan": "The device sent a position that is no number; pressing goes on when it recovers",
    "wrong protocol": "The device speaks another version of the link; update its firmware",
    "device fault": "The device reports a fault of its own; see its manual, or plug it in again",
    "suspended": "The computer stood still for a moment, so the device was let go; "
    "pressing goes on by itself",
    "unguarded": "The process that lets the device go should Blender end was ended, so the device "
    "was let go; pressing goes on when another one runs",
    "internal error": "The force loop has failed, so pressing has ended; press again",
}
# For a list with their counts.
FAULT_NAMES = {
    "unplugged": "Unplugged",
    "stale": "Silent",
    "deaf": "Hears Too Late",
    "too fast": "Too Fast",
    "nan": "Invalid Number",
    "wrong protocol": "Other Version",
    "device fault": "Fault of the Device",
    "suspended": "Stood Still",
    "unguarded": "No Guardian",
    "internal error": "Force Loop Failed",
}
REASONS = {
    "no sound answer to HELLO yet": "Waiting for the device: check its port, cable and power",
    "no STATE yet": "The device answers but tells no position yet; plug it in again if it stays so",
    "the device is not ready": "The device is not ready: calibrate it or switch on its motors",
    "switched off": "The force is switched off; Space or Force On brings it back",
    "no answer from a hAPI board yet": "Waiting for the device: check its port, cable and power",
    "the board is being set up": "The board is being set up; leave the handle where it is",
    "the board has forgotten where its handle is: put the handle in its rest pose and start "
    "again": (
        "The board lost track of its handle: leave, put it in its rest pose, and press again"
    ),
    "no angles yet": (
        "The device answers but tells no position yet; plug it in again if it stays so"
    ),
    "the arms are stretched: bring the handle back to the middle": (
        "The arms are stretched; bring the handle back to the middle"
    ),
    "started": "The force rises slowly",
    "device ready": "The device is ready; the force rises slowly",
    "switched on": "Switched on; the force rises slowly",
    "button released": "The button was let go; the force rises slowly",
    "body replaced": "The body is another one now; the force rises slowly",
    "its tool was made for another body: set it again": (
        "The body was exchanged under the tool; leave with Escape and press again"
    ),
    "the body lies among others, which only tools press: set a tool": (
        "Objects that press each other are pressed by tools alone; choose one instead of a point"
    ),
    "inside the body": "The probe is inside the body: lead it out, then touch from outside",
    "not started": "The force loop has not started yet",
    "asked to stop": "Pressing has ended",
    "device button": "A button of the device is held; let it go and the force comes back",
}
# Of a ramp: "after " and the fault.
AFTER_FAULT = "The fault is gone; the force rises slowly"
LIMITS = {
    "ramp": "Held back: the force rises slowly",
    "clamp": "Held back: the largest force is reached",
    "slew": "Held back: the force changes too fast",
}


# Where the motors may push.
FORCEFUL = {Signal.READY, Signal.FORCE, Signal.RETURNING}
# Where a limit is worth showing: a rising force is shown already.
LIMITABLE = {Signal.READY, Signal.FORCE}


def fault_text(fault: str) -> str:
    """Sentence for a fault, with its remedy."""
    return FAULTS.get(fault, Sentence("The device reports a fault: {fault}", fault=fault))


def standing(snapshot: Snapshot | FingerSnapshot) -> Standing:
    """Status of the force from a snapshot."""
    known = STATES.get(snapshot.state, Standing(Signal.WAITING, snapshot.state))
    why, signal = known.why, known.signal
    if snapshot.fault:
        why, signal = fault_text(snapshot.fault), Signal.FAULT
    elif snapshot.reason.startswith("after "):
        why = AFTER_FAULT
    elif snapshot.reason:
        why = REASONS.get(snapshot.reason, snapshot.reason)
    limit = LIMITS.get(snapshot.limited, snapshot.limited) if signal in LIMITABLE else ""
    return Standing(signal, known.word, why, limit)
