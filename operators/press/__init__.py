"""Press and its operators."""
