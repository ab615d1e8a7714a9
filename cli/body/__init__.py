"""palpate info, figures of bodies, and arguments that commands share."""
