"""A free body laid into a corner, pressed by the servo's own ticks without a clock."""

from dataclasses import dataclass

import numpy as np
from palpate_servo.harness import SteppedFingers
from scipy.spatial.transform import Rotation

from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.support import Floor
from palpate.core.servo.session import Body, native_prop, native_tool
from palpate.core.servo.settings import Coupling, Settings

TIP = sphere(0.01)
# Into a corner of three floors, so that it comes to rest without friction.
INTO_CORNER = (-3.0, -4.0, -8.0)
DOWN = (0.0, 0.0, -9.81)
UPRIGHT = Rotation.identity()


@dataclass(frozen=True)
class Laid:
    """A free cube, its native body, and what it is laid on, by friction and a turn of the world."""

    body: SoftBody
    native: Body

    def settings(self, friction=0.0, turn=UPRIGHT, gravity=INTO_CORNER, steady=False):
        pull = tuple(turn.apply(gravity))
        return RestSettings(friction=friction, gravity=pull, spacing=0.013, steady=steady)

    def corner(self, friction=0.0, turn=UPRIGHT):
        return [Floor(friction=friction, up=tuple(turn.apply(up))) for up in np.eye(3)]

    def servo(
        self,
        start,
        *,
        tip=None,
        friction=0.0,
        turn=UPRIGHT,
        floors=None,
        gravity=INTO_CORNER,
        max_force=None,
        relaxation=(),
        steady=False,
    ):
        """Fingers of the servo, the first of which begins at ``start``, before the world is turned;
        without a ``max_force`` they have no motors.
        """
        settings = self.settings(friction, turn, gravity, steady)
        if floors is None:
            floors = self.corner(friction, turn)
        placement = Pose(np.zeros(3), turn.as_matrix())
        fingers = SteppedFingers(
            self.native,
            turn.apply(start)[None],
            Settings(
                self.body.young_modulus,
                static_friction=friction,
                dynamic_friction=friction,
                coupling=Coupling(800.0, 4.0, True),
                relaxation=relaxation,
            ),
            prop=native_prop(self.body, self.native, floors, placement, settings),
            max_force=max_force,
        )
        if tip is not None:
            fingers.set_tool(native_tool(self.body, self.native, tip), turn.as_matrix())
        return fingers
