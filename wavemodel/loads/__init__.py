"""Contact tractions of a disc-shaped tool: uniform pressure, and rigid faces whose tractions are solved for."""
