"""How a result folder is built: beside its place, told from a dead one, read back before it is put there."""
