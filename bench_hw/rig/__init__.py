"""The rig: which devices a bench has, what is safe on it, and how they are opened.

`schema` is what a rig file may say, `loading` finds and reads it, `opening` makes the drivers (and the twins of
simulated devices), `bench` is what they are together.
"""
