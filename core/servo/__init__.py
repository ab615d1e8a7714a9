"""Sessions with the native thread, its devices and recordings."""
