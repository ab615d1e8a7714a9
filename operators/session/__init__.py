"""Running press: its state machine, force loop and fingers."""
