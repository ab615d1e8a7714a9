"""The nonlinear solid, solved."""
