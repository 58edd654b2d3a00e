"""The next experiment: what rivals expect, the menu, and the protocol that the bench can run."""
