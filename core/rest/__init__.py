"""Free bodies at rest on a floor and fixed tools, pressed by others."""
