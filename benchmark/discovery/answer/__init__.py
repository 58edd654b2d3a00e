"""From the fits to the answer: estimates, the gap that closed, and the verdict."""
