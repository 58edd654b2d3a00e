"""What other finite-element codes print, read as a user's own FEA: by the ending of the file."""

from benchmark.models.fea_results.calculix_results import read_dat, read_frd
from benchmark.models.fea_results.febio_results import read_febio

READERS = {".dat": read_dat, ".frd": read_frd, ".log": read_febio, ".txt": read_febio}
"""Readers of (text, scenario) by the ending of the file."""

__all__ = ["READERS"]
