"""`python -m bench_hw`."""

from bench_hw.cli import main

main()
