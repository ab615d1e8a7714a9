"""Servo of a press: start, targets, settings, snapshots, recording, stop."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.pose import Pose
from ...core.errors import PalpateError
from ...core.rest.prop import WORLD
from ...core.servo.firming import Firming
from ...core.servo.session import (
    Body,
    HaplyDevice,
    LinkDevice,
    Pointer,
    Servo,
    Snapshot,
    native_body,
    native_tool,
    servo_on,
)
from ...core.servo.settings import Settings
from ...core.shape.shapes import Shape
from ...simulated.simulated_process import SimulatedDevice
from ..device import device_source
from ..device.device_source import DeviceFrame
from ..device.loop_figures import LoopFigures
from ..device.servo_errors import servo_errors
from ..lying.pressed.pressed_prop import PressedProp
from ..object.drawn_body import DrawnBody
from ..record import recording
from ..record.recording import Recorder
from ..scene.body_frame import BodyFrame
from ..tool.finger_tip import FingerTip
from ..tool.tool_turn import Point, Turn
from .finger_leads import second_port
from .live_settings import LiveSettings
from .press_effects import SwitchForce
from .press_events import Move, SetDown


@dataclass(eq=False)
class ForceLoop:
    """Servo with the simulated devices of the first and the second finger, if any. ``port`` is the
    first device's, empty for the pointer.
    """

    servo: Servo
    settings: LiveSettings
    recorder: Recorder
    drawn: DrawnBody
    touched: Body
    tip: FingerTip
    prop: PressedProp | None = None
    simulated: SimulatedDevice | None = None
    second_simulated: SimulatedDevice | None = None
    port: str = ""
    figures: LoopFigures = field(default_factory=LoopFigures)
    firming: Firming = field(init=False)
    _enabled: bool = True
    _turns: dict[int, NDArray[np.float64]] = field(default_factory=dict)
    _led: dict[int, tuple[Point | None, Turn | None]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.firming = Firming(self.servo, self.drawn.body)
        if self.prop is not None:
            self.firming.supports, self.firming.let_go = self.prop.supports, self.prop.let_go
        self._tell_tool()

    @classmethod
    def prepare(
        cls,
        drawn: DrawnBody,
        settings: LiveSettings,
        rate_hz: int,
        tip: FingerTip,
        fingers: int,
        prop: PressedProp | None = None,
    ) -> ForceLoop:
        """Loop that does not run yet, for a number of fingers, with the present settings; of a
        ``prop`` its hands are in the world.

        Raises
        ------
        PalpateError
            A body that cannot be touched, or a setting that the servo refuses.
        """
        if prop is None:
            gives_way = bool(settings.servo.relaxation)
            is_whole = fingers > 1 or tip.tool is not None or gives_way
            touched, laid = native_body(drawn.body, whole=is_whole), None
        else:
            touched, laid = prop.native
        begun = _under(settings.servo, tip, prop)
        servo = servo_on(touched, begun, rate_hz=rate_hz, prop=laid)
        recorder = Recorder(servo, rate_hz, in_world=prop is not None)
        return cls(servo, settings, recorder, drawn, touched, tip, prop)

    def give_tools(self, fingers: int) -> None:
        """Give the chosen tool to a number of fingers; points need none."""
        if self.tip.tool is None:
            return
        tool = native_tool(self.drawn.body, self.touched, self.tip.tool)
        with servo_errors():
            for finger in range(fingers):
                self.servo.set_tool(tool, finger=finger)

    def add_pointer(self, position: Point) -> None:
        """Add a finger led by :meth:`lead` or the pointer, from ``position`` in body coordinates;
        before the start.
        """
        with servo_errors():
            self.servo.add(Pointer(position))

    def add_device(self, scene: bpy.types.Scene, local: BodyFrame) -> None:
        """Add a finger led by the scene's second device, in its frame of the settings; before the
        start. ``local`` is the finger's frame of the body.

        Raises
        ------
        PalpateError
            There is no such device, or it cannot be used.
        """
        chosen = scene.palpate
        frame = self._device_frame(1)
        if chosen.second == "SIMULATED":
            up = local.turn_to_body(device_source.FROM_THE_SIDE)
            self.second_simulated = device_source.start_simulated(
                self.drawn, frame, up, tip=self.tip, where=self._where
            )
            port = self.second_simulated.port
        else:
            port = second_port(scene)
        haply = chosen.second_haply_model if chosen.second == "HAPLY" else None
        with servo_errors():
            at_rest = chosen.second_haply_at_rest
            baud = chosen.baud if chosen.second == "SERIAL" else 0
            self.servo.add(_device_at(port, baud, frame, haply, at_rest))

    def lead(self, finger: int, place: Point | None, turn: Turn | None) -> None:
        """Set a finger's target and its tool's rotation, where given and new."""
        before = self._led.get(finger, (None, None))
        with servo_errors():
            if turn is not None and turn != before[1]:
                self._turn(finger, turn)
            if place is not None and place != before[0]:
                self.servo.set_target(place, finger=finger)
        self._led[finger] = (place, turn)

    def start_pointer(self, position: Point) -> None:
        """Start with the pointer at ``position`` in body coordinates."""
        with servo_errors():
            self.servo.start(Pointer(position))

    def start_device(self, scene: bpy.types.Scene, local: BodyFrame) -> None:
        """Start with the chosen device, in its frame of the settings. ``local`` is the finger's
        frame of the body.

        Raises
        ------
        PalpateError
            There is no such device, or it cannot be used.
        """
        chosen, frame = scene.palpate, self._device_frame(0)
        haply = chosen.haply_model if device_source.is_planar(scene) else None
        if chosen.source == "SIMULATED":
            up = local.turn_to_body(device_source.FROM_ABOVE)
            self.simulated = device_source.start_simulated(
                self.drawn, frame, up, haply, tip=self.tip, where=self._where
            )
            self.port = self.simulated.port
        else:
            self.port = device_source.port_of(scene)
        # A simulated one always begins in its rest pose.
        at_rest = chosen.haply_at_rest or self.simulated is not None
        with servo_errors():
            baud = chosen.baud if chosen.source == "SERIAL" else 0
            self.servo.start(_device_at(self.port, baud, frame, haply, at_rest))

    @property
    def _where(self) -> Pose:
        """Where the body is as its hands see it, before they press."""
        return WORLD if self.prop is None else self.prop.start

    def _device_frame(self, finger: int) -> DeviceFrame:
        frame = self.settings.devices[finger]
        if frame is None:
            raise PalpateError("device: nothing says where it is; press again")
        return frame

    def follow(self, settings: LiveSettings) -> None:
        """Apply changed settings.

        Raises
        ------
        PalpateError
            The servo refuses a setting.
        """
        self.settings = settings
        with servo_errors():
            self._set()

    def _turn(self, finger: int, turn: Turn) -> None:
        self._turns[finger] = np.array(turn)
        self._set()

    def _tell_tool(self) -> None:
        # Where friction holds it on a pinned body, that is led by its linear forces.
        self.firming.friction = self.settings.servo.static_friction
        is_told = self.firming.friction == 0.0 or self.prop is not None
        self.firming.tool = self.tip.tool if is_told else None

    def _set(self) -> None:
        turns = [self._turns.get(k, np.eye(3)) for k in range(max(self._turns, default=-1) + 1)]
        chosen = _under(self.settings.servo, self.tip, self.prop)
        self._tell_tool()
        self.servo.set(replace(chosen, enabled=self._enabled, orientations=turns))

    def carry_out(self, effect: SetDown | Move | SwitchForce) -> None:
        """Carry out an effect on the servo."""
        match effect:
            case SetDown(point, finger, turn):
                if turn is not None:
                    self._turn(finger, turn)
                self.servo.set_target(point, restart=True, finger=finger)
            case Move(point, finger):
                self.servo.set_target(point, finger=finger)
            case SwitchForce(on):
                self._enabled = on
                self._set()

    def snapshot(self) -> Snapshot:
        """Latest tick; also refreshes counters and recording."""
        snapshot = self.servo.snapshot()
        self.figures.look(self.servo, time.monotonic())
        self.recorder.follow(snapshot.time)
        return snapshot

    def firm(self, snapshot: Snapshot, shape: Shape) -> None:
        """Press as firmly as the drawn shape says, once that is known."""
        with servo_errors():
            self.firming.follow(snapshot, shape, self.settings.servo.young_modulus)

    def stop(self) -> None:
        """Stop thread and simulated devices with zero force; keep the recording."""
        self.firming.close()
        try:
            self.servo.stop()
            recording.keep(self.recorder)
        finally:
            for simulated in (self.simulated, self.second_simulated):
                if simulated is not None:
                    simulated.stop()


def _under(chosen: Settings, tip: FingerTip, prop: PressedProp | None) -> Settings:
    """Settings under a tip: under points what moves does not give way with time as it should."""
    return replace(chosen, relaxation=()) if prop is not None and tip.tool is None else chosen


def _device_at(
    port: str, baud: int, frame: DeviceFrame, haply_model: str | None, at_rest: bool
) -> LinkDevice | HaplyDevice:
    """Device at a port: a 2DIY of a model, ``at_rest`` if its handle is in the rest pose, or a
    device that speaks the link at ``baud``, 0 if that has no meaning.
    """
    if haply_model is None:
        return LinkDevice(
            port,
            baud=baud or None,
            rotation=frame.rotation,
            translation=frame.translation,
            scale=frame.scale,
        )
    return HaplyDevice(
        port,
        model=haply_model,
        recalibrate=at_rest,
        rotation=frame.rotation,
        translation=frame.translation,
        scale=frame.scale,
    )
