"""Numbers, rotations, identities, Ctrl-C: what knows neither units nor partners."""
