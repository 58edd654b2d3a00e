"""Errors of a sweep that are nobody's scenario."""

from __future__ import annotations

from benchmark.errors import InputError


class ClusterError(InputError):
    """The Dask cluster is not there, cannot serve, or is gone; what is finished is on disk."""
