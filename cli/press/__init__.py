"""palpate press, servo and devices."""
