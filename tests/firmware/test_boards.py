"""Library and sketch compile for the processors of boards, where their compiler is installed.

`apt install gcc-arm-none-eabi libstdc++-arm-none-eabi-newlib` on Debian; a stand-in for Arduino's
own files is in `arduino`.
"""

import shutil
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
FIRMWARE = HERE.parents[1] / "firmware"
CROSS_COMPILER = "arm-none-eabi-g++"
BOARDS = {
    "RP2040": ["-mcpu=cortex-m0plus"],
    "RP2350": ["-mcpu=cortex-m33"],
    "Teensy 4": ["-mcpu=cortex-m7", "-mfpu=fpv5-d16", "-mfloat-abi=hard"],
}
# Board packages compile like this; nothing may need what it leaves out.
OPTIONS = ["-mthumb", "-Os", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics"]
WARNINGS = ["-Wall", "-Wextra", "-Wdouble-promotion", "-Werror"]


@pytest.mark.skipif(shutil.which(CROSS_COMPILER) is None, reason=f"no {CROSS_COMPILER} here")
@pytest.mark.parametrize("board", BOARDS)
def test_the_sketch_compiles_for_a_board_and_takes_no_heap(tmp_path, board):
    folder = tmp_path / "sketch"
    shutil.copytree(FIRMWARE / "palpate_device", folder)
    shutil.copytree(HERE / "filled_in", folder, dirs_exist_ok=True)
    source, made = tmp_path / "sketch.cpp", tmp_path / "sketch.o"
    source.write_text('#include <Arduino.h>\n#include "palpate_device.ino"\n')
    includes = [f"-I{HERE / 'arduino'}", f"-I{folder}", f"-I{FIRMWARE / 'palpate_link' / 'src'}"]
    command = [CROSS_COMPILER, *BOARDS[board], *OPTIONS, *WARNINGS, *includes, "-std=gnu++17"]
    done = subprocess.run(
        [*command, "-c", source, "-o", made], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    names = made.read_bytes()
    assert b"loop" in names
    for unwanted in (b"malloc", b"_Znw", b"_Zna", b"__cxa_"):
        assert unwanted not in names
