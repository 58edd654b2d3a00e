"""The trial of the regression gate: `python -m tests.performance.gate_trial --help`."""
