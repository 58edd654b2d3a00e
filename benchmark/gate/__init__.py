"""The regression gate: has accuracy or speed got worse, and only then red.

`checking.check` and `accepting.accept` are the ways in. Nothing is imported here: a measured process takes this package
over another revision's `benchmark`, which need not have what the rest of the gate imports (see `measuring.child`).
"""
