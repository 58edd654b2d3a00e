"""Protocols of motion: what the tool does in one trial, as a list of segments in a TOML file.

`protocol` is what a file may say, `loading` finds and reads it, `plan` and `preview` are the dry run, `steps`
carries it out one observation at a time without touching a device.
"""
