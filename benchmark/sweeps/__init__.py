"""Sweeps: one scenario at many points of its parameters, here or on a cluster, resumable, with report.

`benchmark.sweeps.sweep_run` is the way in. Nothing is imported here, since each process that computes points
begins here.
"""
