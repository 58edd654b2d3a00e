"""How measured processes treat memory: what is freed stays with the process.

Left to itself, glibc gives an array of some hundred kilobytes back to the system and asks for it again at each call, or
does not, as the heap happens to lie. Then one process pays for page faults what another does not, up to half of the
time of an assembly, and no reference sees it.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

KEPT_MEMORY: Mapping[str, str] = MappingProxyType(
    {
        "MALLOC_MMAP_THRESHOLD_": str(2**30),
        "MALLOC_TRIM_THRESHOLD_": str(2**32),
        "MALLOC_TOP_PAD_": str(2**26),
    }
)
"""Environment of a measured process (bytes; mallopt(3)); other systems know none of these names."""
