"""Load histories followed: Newton's method, step control, small strain, relaxation, checkpoints."""
