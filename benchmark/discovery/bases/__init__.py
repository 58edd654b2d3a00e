"""Elastic bases of a set-up: force over depth and the motion of the lower face, as tables.

The finite elements of the set-up give them; where they stop, the wave model goes on.
"""
