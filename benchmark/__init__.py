"""The harness and the command line: joins fem, wavemodel, bench_hw and reports."""
