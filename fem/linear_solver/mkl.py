"""Where the MKL is: pypardiso would search the whole environment for it, which takes up to a second."""

from __future__ import annotations

import os
import sys
from pathlib import Path

VARIABLE = "PYPARDISO_MKL_RT"


def name_library(prefix: str = sys.prefix) -> None:
    """Tell pypardiso the library of this environment by its variable, unless the user has set it."""
    for pattern in ("lib/libmkl_rt.so*", "Library/bin/mkl_rt*.dll"):
        for path in sorted(Path(prefix).glob(pattern)):
            os.environ.setdefault(VARIABLE, str(path))
