"""The servo of one press: started, led, told of changes, watched, recorded and stopped."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy

from ..core.devices.simulated_process import SimulatedDevice
from ..core.errors import PalpateError
from ..core.servo_session import Servo, Snapshot, servo_for
from . import device_source, recording
from .drawn_body import DrawnBody
from .live_settings import LiveSettings
from .loop_figures import LoopFigures
from .package_preferences import preferences
from .press_state import MoveProbe, PlaceProbe, Point, SwitchForce
from .recording import Recorder


@dataclass(eq=False)
class ForceLoop:
    """A servo, and with it the simulated device that leads it, if one does. ``port`` is the
    device's, empty for the pointer.
    """

    servo: Servo
    settings: LiveSettings
    recorder: Recorder
    simulated: SimulatedDevice | None = None
    port: str = ""
    figures: LoopFigures = field(default_factory=LoopFigures)

    @classmethod
    def prepare(cls, drawn: DrawnBody, settings: LiveSettings, rate_hz: int) -> ForceLoop:
        """A loop that does not run yet, with the settings of now.

        Raises
        ------
        PalpateError
            A body that cannot be touched, or a setting that the servo refuses.
        """
        servo = servo_for(
            drawn.body,
            young_modulus=settings.young_modulus,
            rate_hz=rate_hz,
            max_force=preferences().max_force,
        )
        with servo_errors():
            settings.hand_over(servo)
        return cls(servo, settings, Recorder(servo, rate_hz))

    def start_pointer(self, position: Point) -> None:
        """Let the pointer lead, from ``position`` in body coordinates."""
        with servo_errors():
            self.servo.start_pointer(position)

    def start_device(self, scene: bpy.types.Scene, drawn: DrawnBody) -> None:
        """Let the chosen device lead, where the settings have it.

        Raises
        ------
        PalpateError
            There is no such device, or it cannot be used.
        """
        chosen, frame = scene.palpate, self.settings.device
        if frame is None:
            raise PalpateError("device: nothing says where it is; press again")
        haply = chosen.haply_model if device_source.is_planar(scene) else None
        if chosen.source == "SIMULATED":
            self.simulated = device_source.start_simulated(drawn, frame, haply)
            self.port = self.simulated.port
        else:
            self.port = device_source.port_of(scene)
        rotation, translation = frame.rotation, frame.translation
        with servo_errors():
            if haply is None:
                self.servo.start_serial(
                    self.port, rotation=rotation, translation=translation, scale=frame.scale
                )
                return
            self.servo.start_haply(
                self.port,
                model=haply,
                # A simulated one always begins at rest.
                recalibrate=chosen.haply_at_rest or self.simulated is not None,
                rotation=rotation,
                translation=translation,
                scale=frame.scale,
            )

    def follow(self, settings: LiveSettings) -> None:
        """Take over what has been changed.

        Raises
        ------
        PalpateError
            The servo refuses a setting.
        """
        with servo_errors():
            settings.hand_over(self.servo, self.settings)
        self.settings = settings

    def carry_out(self, effect: PlaceProbe | MoveProbe | SwitchForce) -> None:
        """Do what the press wants of the servo."""
        match effect:
            case PlaceProbe(point):
                self.servo.set_target(point, restart=True)
            case MoveProbe(point):
                self.servo.set_target(point)
            case SwitchForce(on):
                self.servo.set_enabled(on)

    def snapshot(self) -> Snapshot:
        """The newest tick; counters and recording are looked at, too."""
        snapshot = self.servo.snapshot()
        self.figures.look(self.servo, time.monotonic())
        self.recorder.follow(snapshot.time)
        return snapshot

    def stop(self) -> None:
        """Zero force, thread and simulated device ended; what was recorded is kept."""
        try:
            self.servo.stop()
            recording.keep(self.recorder)
        finally:
            if self.simulated is not None:
                self.simulated.stop()


@contextmanager
def servo_errors() -> Iterator[None]:
    """What the servo refuses, as a sentence with a remedy."""
    try:
        yield
    except OSError as problem:
        # It names its remedy itself.
        raise PalpateError(f"device: {problem}") from problem
    except (ValueError, OverflowError) as problem:
        raise PalpateError(f"servo: {problem}; set it back and press again") from problem
    except RuntimeError as problem:
        raise PalpateError(f"servo: {problem}; leave with Escape and press again") from problem
