"""Rivals of the discovery, and the discovery without one of its parts, on the same blind cases.

Each is a function of a session and a seed for `--discoverer benchmark.blind.rivals.MODULE:FUNCTION`; the ablations by
`--without NAME`. The Gaussian process and SINDy need the extra `rivals` (scikit-learn, pysindy).
"""
