"""The measuring bench: drivers, simulated twins, trial recording, tables and vision.

Import what is needed from the rooms (`bench_hw.tables`, `bench_hw.trial_file`, ...); nothing is loaded
here, so that the command line starts at once.
"""
