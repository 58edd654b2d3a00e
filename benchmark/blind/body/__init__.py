"""The bodies that blind sessions press: what is told of them, their presses by the solver of their family."""
