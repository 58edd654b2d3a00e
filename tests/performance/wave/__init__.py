"""Speed of the waves beside what else a user would pick, each with its error against the finite elements."""
