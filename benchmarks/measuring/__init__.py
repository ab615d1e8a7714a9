"""What benchmarks share: stopwatches, the machine's own speed, memory, and bodies to measure on."""
