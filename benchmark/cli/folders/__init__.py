"""Verbs about what lies on disk: shipped files, templates to fill in, finished results, litter."""
