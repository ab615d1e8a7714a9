"""Pictures of the documents that show Blender's window: cut out of what scenarios have kept.

Run as python window_pictures.py, after the scenarios were played (`make pictures` does both). A
scenario that was not played leaves its picture as it was, and is told.
"""

import sys
from pathlib import Path

from PIL import Image

PROJECT = Path(__file__).resolve().parent.parent
PLAYED, SHOWN = PROJECT / "build" / "gui", PROJECT / "docs" / "images"
# Left, upper, right and lower edge, pixels of the window; None for all of it.
Box = tuple[int, int, int, int] | None
# The view beside the toolbar and the sidebar.
IN_VIEW = (56, 100, 764, 716)
NEWCOMER = "newcomer-from_the_default_cube_to_a_rendered_animation_in_eight_clicks"
STEPS = ("tool", "soft", "stroke", "kept", "animated", "rendered")
# What becomes of which picture of a scenario.
PICTURES: dict[str, tuple[str, Box]] = {
    "device.png": (
        "pressing-the_simulated_device_presses_is_unplugged_and_comes_back-device",
        (56, 100, 1020, 716),
    ),
    "fingertip.png": (
        "fingers-a_fingertip_led_by_the_mouse_shows_its_patch_and_force-pressed",
        IN_VIEW,
    ),
    "pinch.png": (
        "fingers-two_handles_pinch_and_escape_restores_every_bit-pinched",
        IN_VIEW,
    ),
    **{
        f"tutorial-{step}.png": (f"{NEWCOMER}-{number}-{step}", None)
        for number, step in enumerate(STEPS, start=1)
    },
}


def main() -> int:
    """Cut all; 1 where a scenario was not played."""
    missing = 0
    for name, (scenario, box) in PICTURES.items():
        played = PLAYED / f"{scenario}.png"
        if not played.is_file():
            print(f"{name}: {played.name} was not played; it stays as it is")
            missing += 1
            continue
        with Image.open(played) as whole:
            (whole if box is None else whole.crop(box)).save(SHOWN / name, optimize=True)
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
