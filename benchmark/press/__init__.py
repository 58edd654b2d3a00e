"""Pressing by hand: the page on which a person presses a tissue, and what it is made from."""
