"""Messages of the link and their payloads in both protocols, everything little-endian."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from enum import IntFlag

from .frames import LinkError

FIRST_PROTOCOL = 1
PROTOCOL = 2
"""The one spoken with whoever knows it; the first is spoken with all others."""
SEQUENCES = 1 << 16

HELLO, STATE, FORCE, FAULT, ORIENTATION = 0x01, 0x02, 0x03, 0x04, 0x05

_HOST_HELLO = struct.Struct("<BB")
_DEVICE_HELLO = struct.Struct("<BB16sBffffH")
_STATE = struct.Struct("<BHI3iBB")
_FORCE = struct.Struct("<BH3hB")
# Behind these in protocol 2.
_LARGEST_DAMPING = struct.Struct("<H")
_TAKEN = struct.Struct("<H")
_ANSWER = struct.Struct("<IHH")
_FAULT = struct.Struct("<BBH")
_ORIENTATION = struct.Struct("<BH4h")

NAME_BYTES = 16
DAMPING_STEP = 0.01
"""Step of a damping, N s/m."""
AGE_STEP = 1e-5
"""Step of an age, s."""
_STATE_SIZES = (_STATE.size, _STATE.size + _TAKEN.size)
_FORCE_SIZES = (_FORCE.size, _FORCE.size + _ANSWER.size)
_HELLO_SIZES = {
    FIRST_PROTOCOL: _DEVICE_HELLO.size,
    PROTOCOL: _DEVICE_HELLO.size + _LARGEST_DAMPING.size,
}

QUATERNION_UNIT = 32767
"""Value of 1 in an ORIENTATION."""
QUATERNION_LENGTHS = (32440, 33094)
"""Shortest and longest valid quaternion, in steps: 1 % around a unit's."""


class StateFlag(IntFlag):
    """Flags of a device in STATE; in protocol 2 also whether it took a FORCE in this session."""

    READY = 1
    FAULT = 2
    TAKEN = 4


class ForceFlag(IntFlag):
    """Flags of a host in FORCE: motors on, damping added."""

    ENABLE = 1
    DAMP = 2


@dataclass(frozen=True)
class HostHello:
    """HELLO of the host, a question."""

    protocol: int = FIRST_PROTOCOL


@dataclass(frozen=True)
class DeviceHello:
    """HELLO of the device; force in N, half extents of the workspace in m, rate of STATE in Hz.

    In protocol 2 also the largest damping in steps of 0.01 N s/m, 0 for none.
    """

    name: str
    axes: int
    largest_force: float
    half_extents: tuple[float, float, float]
    rate_hz: int
    protocol: int = FIRST_PROTOCOL
    largest_damping: int = 0


@dataclass(frozen=True)
class OtherHello:
    """HELLO of another protocol, of which only the first two bytes are known."""

    protocol: int


@dataclass(frozen=True)
class State:
    """STATE of the device: device time in us, position in um.

    `taken` is the sequence of the last FORCE that it took, in protocol 2 only; it means nothing
    without `StateFlag.TAKEN`.
    """

    sequence: int
    device_time_us: int
    position_um: tuple[int, int, int]
    buttons: int = 0
    flags: int = StateFlag.READY
    taken: int | None = None


@dataclass(frozen=True)
class Answer:
    """What a FORCE of protocol 2 says of itself: device time of the STATE that it answers (us),
    time since that came (10 us), damping that is asked for (0.01 N s/m).
    """

    state_time_us: int
    age: int = 0
    damping: int = 0


@dataclass(frozen=True)
class Force:
    """FORCE for the device, in mN; with an answer in protocol 2."""

    sequence: int
    force_mn: tuple[int, int, int]
    flags: int = ForceFlag.ENABLE
    answer: Answer | None = None


@dataclass(frozen=True)
class Fault:
    """FAULT of the device; codes in `docs/link.md`."""

    code: int
    detail: int = 0


@dataclass(frozen=True)
class Orientation:
    """Rotation of the stylus in the STATE of the same sequence, which follows: unit quaternion
    w, x, y, z in steps of 1 / 32767, from the stylus' axes to the device's.
    """

    sequence: int
    quaternion: tuple[int, int, int, int]

    @property
    def is_unit(self) -> bool:
        """Whether its length is that of a rotation, within 1 %."""
        shortest, longest = QUATERNION_LENGTHS
        return shortest**2 <= sum(part**2 for part in self.quaternion) <= longest**2


Message = HostHello | DeviceHello | OtherHello | State | Force | Fault | Orientation


def orientation(sequence: int, quaternion: tuple[float, float, float, float]) -> Orientation:
    """ORIENTATION nearest to a unit quaternion w, x, y, z.

    Raises LinkError if not finite, or not of length 1 within 1 %.
    """
    if not all(map(math.isfinite, quaternion)) or abs(math.hypot(*quaternion) - 1.0) > 0.01:
        raise LinkError(f"{quaternion} is no unit quaternion: divide it by its length")
    w, x, y, z = (round(part / math.hypot(*quaternion) * QUATERNION_UNIT) for part in quaternion)
    return Orientation(sequence, (w, x, y, z))


def pack(message: Message) -> bytes:
    """Payload of a message; raises LinkError when a number does not fit its field."""
    try:
        match message:
            case HostHello():
                return _HOST_HELLO.pack(HELLO, message.protocol)
            case DeviceHello():
                return _pack_device_hello(message)
            case State():
                return _pack_state(message)
            case Force():
                return _pack_force(message)
            case Fault():
                return _FAULT.pack(FAULT, message.code, message.detail)
            case Orientation():
                return _ORIENTATION.pack(ORIENTATION, message.sequence, *message.quaternion)
            case OtherHello():
                raise LinkError("a HELLO of another protocol can be read, not written")
    except (struct.error, OverflowError) as error:
        raise LinkError(f"{message} does not fit the link: {error}") from error


def unpack(payload: bytes) -> Message:
    """Message of a payload with checked CRC; raises LinkError for unknown type or length."""
    if len(payload) >= 2 and payload[0] == HELLO:
        return _unpack_hello(payload)
    match (payload[:1], len(payload)):
        case (b"\x02", length) if length in _STATE_SIZES:
            return _unpack_state(payload)
        case (b"\x03", length) if length in _FORCE_SIZES:
            return _unpack_force(payload)
        case (b"\x04", _FAULT.size):
            _, code, detail = _FAULT.unpack(payload)
            return Fault(code, detail)
        case (b"\x05", _ORIENTATION.size):
            return _unpack_orientation(payload)
    raise LinkError(f"no message of the link: {len(payload)} bytes, type {payload[:1].hex()}")


def _pack_state(state: State) -> bytes:
    x, y, z = state.position_um
    common = _STATE.pack(
        STATE, state.sequence, state.device_time_us, x, y, z, state.buttons, state.flags
    )
    return common if state.taken is None else common + _TAKEN.pack(state.taken)


def _unpack_state(payload: bytes) -> State:
    _, sequence, time_us, x, y, z, buttons, flags = _STATE.unpack_from(payload)
    told = payload[_STATE.size :]
    (taken,) = _TAKEN.unpack(told) if told else (None,)
    return State(sequence, time_us, (x, y, z), buttons, flags, taken)


def _pack_force(force: Force) -> bytes:
    common = _FORCE.pack(FORCE, force.sequence, *force.force_mn, force.flags)
    answer = force.answer
    if answer is None:
        return common
    return common + _ANSWER.pack(answer.state_time_us, answer.age, answer.damping)


def _unpack_force(payload: bytes) -> Force:
    _, sequence, x, y, z, flags = _FORCE.unpack_from(payload)
    told = payload[_FORCE.size :]
    return Force(sequence, (x, y, z), flags, Answer(*_ANSWER.unpack(told)) if told else None)


def _pack_device_hello(hello: DeviceHello) -> bytes:
    # Cut between characters.
    name = hello.name.encode()[:NAME_BYTES].decode(errors="ignore").encode()
    common = _DEVICE_HELLO.pack(
        HELLO,
        hello.protocol,
        name,
        hello.axes,
        hello.largest_force,
        *hello.half_extents,
        hello.rate_hz,
    )
    if hello.protocol == FIRST_PROTOCOL:
        return common
    return common + _LARGEST_DAMPING.pack(hello.largest_damping)


def _unpack_hello(payload: bytes) -> HostHello | DeviceHello | OtherHello:
    size = _HELLO_SIZES.get(payload[1])
    if size is None:
        return OtherHello(payload[1])
    if len(payload) == _HOST_HELLO.size:
        return HostHello(payload[1])
    if len(payload) != size:
        raise LinkError(f"a HELLO of protocol {payload[1]} has not {len(payload)} bytes")
    _, protocol, name, axes, largest, x, y, z, rate = _DEVICE_HELLO.unpack_from(payload)
    if not all(math.isfinite(value) and value >= 0.0 for value in (largest, x, y, z)):
        raise LinkError("a HELLO with a force or an extent that is negative or no number")
    text = name.rstrip(b"\0").decode(errors="replace")
    told = payload[_DEVICE_HELLO.size :]
    (damping,) = _LARGEST_DAMPING.unpack(told) if told else (0,)
    return DeviceHello(text, axes, largest, (x, y, z), rate, protocol, damping)


def _unpack_orientation(payload: bytes) -> Orientation:
    _, sequence, w, x, y, z = _ORIENTATION.unpack(payload)
    message = Orientation(sequence, (w, x, y, z))
    if not message.is_unit:
        raise LinkError(f"an ORIENTATION of {message.quaternion}, which is no unit quaternion")
    return message
