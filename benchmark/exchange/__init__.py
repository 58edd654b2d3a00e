"""Scenarios and identified specimens as input files of other finite-element codes.

`exported_press` is what is exported, `calculix_deck` and `febio_file` write it; what those codes answer is read by
`benchmark.models.fea_results`.
"""

from benchmark.exchange.export_files import FORMATS, export_text

__all__ = ["FORMATS", "export_text"]
