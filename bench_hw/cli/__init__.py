"""The bench's command line: every module here whose name does not begin with `_` is one verb."""

from bench_hw.cli._app import app, main

__all__ = ["app", "main"]
