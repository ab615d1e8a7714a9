"""The conversation in docs/haply.md is what the simulated board says."""

from pathlib import Path

from palpate.simulated.board.haply_firmware import HaplyFirmware

DOCUMENT = Path(__file__).resolve().parents[3] / "docs" / "haply.md"


def test_the_documented_conversation_is_what_the_board_says():
    board, now, heard, compared = HaplyFirmware(), 0.0, b"", 0
    for line in DOCUMENT.read_text(encoding="utf-8").splitlines():
        who, _, bytes_said = line.strip().partition("  ")
        if who == "host":
            assert heard == b"", "the board said more"
            now += 0.01
            board.receive(bytes.fromhex(bytes_said))
            heard = board.run(now)
        elif who == "board":
            assert heard == bytes.fromhex(bytes_said)
            heard, compared = b"", compared + 1
    assert compared == 3
    assert [round(board.torque(port), 3) for port in (0, 1)] == [0.020, -0.050]
