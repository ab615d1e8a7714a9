"""Windows' side of try_com_port.py: a servo that presses a cube by the device at a COM port.

python com_port_host.py COM5 SECONDS
"""

from __future__ import annotations

import sys
import time

from palpate.core.servo.session import LinkDevice, servo_on
from palpate.core.servo.settings import Settings
from palpate.simulated.attack.target import YOUNG_MODULUS, cube

if __name__ == "__main__":
    servo = servo_on(cube(), Settings(YOUNG_MODULUS))
    servo.start(LinkDevice(sys.argv[1]))
    time.sleep(float(sys.argv[2]))
    servo.stop()
