"""palpate info, and figures of bodies."""
