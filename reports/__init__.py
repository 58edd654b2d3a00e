"""Tables, figures and pages from plain results."""
