"""A unit by names, its nodes and cells, and its interface with a partner."""
