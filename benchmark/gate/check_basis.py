"""What a check compares with: a stored baseline, or another revision measured in the same minutes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from benchmark.errors import NotComparableError
from benchmark.gate.baseline import Baseline, StoredValue, how_to, read_baseline
from benchmark.gate.plan import CheckRequest, GatePlan
from benchmark.gate.processes import Measured
from benchmark.gate.timing import Ratios
from benchmark.gate.versions import Origin, OtherRevision, gated_values


@dataclass(frozen=True)
class CheckBasis:
    """What values and times are compared with.

    Attributes
    ----------
    baseline
        The stored baseline, None where there is none and a revision stands in for it.
    rival
        The other revision; None without `--against`.
    path
        Of the baseline, for messages.
    """

    baseline: Baseline | None
    rival: OtherRevision | None
    path: str

    @property
    def values_from(self) -> str:
        """What gated values are compared with, in words: an accepted baseline goes before a revision."""
        if self.baseline is not None:
            return f"the baseline {self.path} of {self.baseline.made}"
        return self.times_from

    @property
    def times_from(self) -> str:
        """What times are compared with, in words: what runs in the same minutes goes before what is stored."""
        if self.rival is not None:
            return f"revision {self.rival.commit[:12]}, measured in the same minutes"
        return self.values_from

    def values(self) -> Mapping[str, StoredValue]:
        """The values to compare with, measured where they are not stored."""
        if self.baseline is not None:
            return self.baseline.accuracy
        assert self.rival is not None, "one of the two is there"
        return gated_values(self.rival.party)

    def ratios(self, measured: Measured) -> Ratios:
        """The log ratios to compare with."""
        if self.rival is not None:
            return measured.ratios[1]
        assert self.baseline is not None, "one of the two is there"
        return {name: [math.log(ratio) for ratio in each.ratios] for name, each in self.baseline.timing.items()}

    def same_machine(self, origin: Origin) -> bool:
        """Whether the times to compare with come from a machine like this one."""
        if self.rival is not None or self.baseline is None:
            return True
        return self.baseline.machine.same_as(origin.machine)

    def accepted_here(self, origin: Origin) -> tuple[str, ...]:
        """Values that differed from an earlier baseline, where this one was accepted at the revision checked now."""
        if self.baseline is None or self.baseline.revision is None or origin.revision is None:
            return ()
        same = self.baseline.revision.rstrip("+") == origin.revision.rstrip("+")
        return tuple(self.baseline.differed) if same else ()

    def remarks(self, origin: Origin, margin: float) -> list[str]:
        """What a reader must know of a stored baseline whose times are judged; `margin` is that of another machine."""
        if self.rival is not None or self.baseline is None:
            return []
        machine, found = self.baseline.machine, []
        if not machine.same_as(origin.machine):
            found.append(
                f"the baseline's times come from another machine ({machine.processor}, Python {machine.python}), where "
                f"the same code has other ratios: only a slowdown beyond {100 * margin:g} % is called one; "
                "use --against REVISION to compare on one machine"
            )
        changed = machine.differences(origin.machine)
        if changed:
            found.append(f"the baseline was made with other packages: {', '.join(changed)}")
        return found


def stored_baseline(request: CheckRequest, plan: GatePlan) -> Baseline | None:
    """Read the baseline; None where there is none and `--against` asks for none.

    Raises
    ------
    NotComparableError
        It is missing, of another schema, or made with another gate.
    InputError
        It is broken.
    """
    path = request.baseline_path
    if request.against is not None and request.baseline is None and not path.exists():
        return None
    baseline = read_baseline(path, request.gate)
    if baseline.gate != plan.file.name:
        raise NotComparableError(
            f"{path} was made with another gate: {baseline.gate!r}, and this one is {plan.file.name!r}; "
            f"give its own --baseline, or {how_to(path, request.gate)}"
        )
    names = [timed.name for timed in plan.file.timed]
    if request.against is None and not _same_gate(baseline, plan.fingerprint, names):
        raise NotComparableError(
            f"{path} was made with another gate ({baseline.gate}): other timed quantities or scenarios, or another way "
            f"to measure; {how_to(path, request.gate)}"
        )
    return baseline


def _same_gate(baseline: Baseline, fingerprint: str, timed: Sequence[str]) -> bool:
    return baseline.fingerprint == fingerprint and set(baseline.timing) == set(timed)
