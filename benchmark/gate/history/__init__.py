"""What the checks of a project were, one after the other: the file, its trend, its steps, its page."""
