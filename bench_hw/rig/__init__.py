"""The rig: which devices a bench has, what is safe on it, and how they are opened.

`rig_file` is what a rig file may say and how it is read, `opening` makes the drivers (and the twins of simulated
devices), `bench` is what they are together, `survey` looks for devices.
"""
