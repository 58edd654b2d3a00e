"""Verbs of what a person does by hand: pressing a tissue, and assessing how it was done."""
