"""palpate info, and what commands say of bodies."""
