"""Presses of set-ups by the model: their force with its derivatives, and tables that put several together."""
