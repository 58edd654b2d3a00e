"""Protocols of motion: what the tool does in one trial, as a list of segments in a TOML file.

`protocol_file` is what a file may say and how it is read, `plan` is the dry run, `steps` carries it out one observation
at a time without touching a device.
"""
