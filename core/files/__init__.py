"""Files written atomically and read with care."""
