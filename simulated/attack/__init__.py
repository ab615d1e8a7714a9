"""The adversary: hostile devices for the servo, and a hostile host for devices."""
