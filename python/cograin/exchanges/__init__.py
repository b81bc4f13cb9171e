"""How both sides agree on a step, and the run through time with its record."""
