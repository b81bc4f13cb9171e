"""The other side of an interface: structures, bodies, heat, another unit."""
