"""Objects that nobody holds under a press: the one that is pressed, and soft ones beside it."""
