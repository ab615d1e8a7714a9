"""Commands about bodies without pins."""
