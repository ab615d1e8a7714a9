"""The shared vectors of the link: messages, streams, and what is refused."""

import json
from pathlib import Path

VECTORS = json.loads(
    (Path(__file__).resolve().parent / "vectors" / "link.json").read_text(encoding="utf-8")
)
