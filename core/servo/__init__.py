"""The native thread, its devices and recordings."""
