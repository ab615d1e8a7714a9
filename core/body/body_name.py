"""Names of body files: an object's name and the start of its body's key.

A file may come from a stranger, and so may the name that it gives its body: what has another form
than these is no name of a body, and nothing is looked up, written or deleted under it.
"""

from __future__ import annotations

import re

KEY_LETTERS = 12
SUFFIX = ".npz"
# File systems hold names of 255 bytes, and a table's name is longer than its body's.
MOST_BYTES_OF_WORD = 180
# Blender's clean_name leaves of ASCII and Latin-1 only these, and everything behind them. Halves of
# surrogate pairs are no text, and line separators would break messages.
WORD = re.compile(r"[0-9A-Za-z_\-\u00ff-\u2027\u202a-\ud7ff\ue000-\U0010ffff]+")
NAME = re.compile(rf"({WORD.pattern})-([0-9a-f]{{{KEY_LETTERS}}})\.npz")
KEY = re.compile(r"[0-9a-f]{64}")


def body_name(word: str, key: str, number: int = 1) -> str:
    """``<word>-<start of the key>.npz``, with a ``number`` from 2 on ``<word>_<number>-...``.

    Parameters
    ----------
    word : such as an object's name by Blender's ``clean_name``; what is not allowed becomes ``_``.
    key : of the body; see :func:`.body_key.body_key`.

    Raises
    ------
    ValueError
        A key of another form.
    """
    clean = "".join(letter if WORD.fullmatch(letter) else "_" for letter in word) or "_"
    short = clean.encode()[:MOST_BYTES_OF_WORD].decode(errors="ignore")
    numbered = short if number == 1 else f"{short}_{number}"
    name = f"{numbered}-{key[:KEY_LETTERS]}{SUFFIX}"
    if not is_body_name(name, key):
        raise ValueError(f"{name!r} is no name for a body of the key {key!r}")
    return name


def is_body_name(name: str, key: str) -> bool:
    """Whether ``name`` is one that :func:`body_name` gives a body of this ``key``."""
    found = NAME.fullmatch(name)
    return (
        found is not None
        and KEY.fullmatch(key) is not None
        and found[2] == key[:KEY_LETTERS]
        and len(name.encode()) <= MOST_BYTES_OF_WORD + len(f"_1000-{SUFFIX}") + KEY_LETTERS
    )
