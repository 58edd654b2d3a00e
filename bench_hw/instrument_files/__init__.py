"""Files as other instruments write them, read as they are: the one reader for every program of the product.

What a file says is recognised and told; what it leaves open is asked for by the name of an option. Nothing is guessed
silently. The bench's own tables (`bench_hw.tables`) are read strictly and elsewhere.
"""

from bench_hw.instrument_files.containers import ending_of
from bench_hw.instrument_files.press_record import PressRecord
from bench_hw.instrument_files.reading import (
    ENDINGS,
    InstrumentFile,
    Reading,
    is_plain_trial,
    is_told_of,
    preview,
    read_instrument_file,
)
from bench_hw.instrument_files.text_sheet import NoNumbersError
from bench_hw.instrument_files.told import Told

__all__ = [
    "ENDINGS",
    "InstrumentFile",
    "NoNumbersError",
    "PressRecord",
    "Reading",
    "Told",
    "ending_of",
    "is_plain_trial",
    "is_told_of",
    "preview",
    "read_instrument_file",
]
