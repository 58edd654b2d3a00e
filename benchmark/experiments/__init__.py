"""What to measure next: the menu of experiments that the bench can run, and their design for a fit of parameters."""
