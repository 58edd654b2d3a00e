"""Waves of a stack of layers under a disc-shaped tool: the model, its set-up, its runs and its fields in space."""
