"""For which devices, hands and bodies a touch is passive: simulations of the servo's code."""
