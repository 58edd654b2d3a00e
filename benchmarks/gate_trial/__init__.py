"""The trial of the regression gate: `python -m benchmarks.gate_trial --help`."""
