"""Reports and refusals of operators, translated."""
