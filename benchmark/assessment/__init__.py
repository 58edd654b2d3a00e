"""How a person pressed: recorded attempts, measures of motion with their sources, and groups compared."""
