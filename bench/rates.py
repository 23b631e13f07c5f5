"""How fast forms of btq read the three inputs: nodes per second of each, and how they compare."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from forms import Form
from inputs import Input
from report import Goal
from turns import progress, rotated, rounded, row

# Of another commit's interpreted speed; docs/performance.md.
INTERPRETED, COMPILED = 0.33, 2.5


@dataclass(frozen=True)
class Rates:
    """What was measured of one input: seconds of each round by the name of the form."""

    input: Input
    seconds: dict[str, list[float]]

    def rate(self, form: str) -> float:
        """Nodes per second, the median."""
        return self.input.nodes / statistics.median(self.seconds[form])

    def times(self, form: str, other: str) -> float:
        """How many times as fast as another a form is: the median over the rounds, each compared with itself."""
        pairs = zip(self.seconds[form], self.seconds[other], strict=True)
        return statistics.median(theirs / own for own, theirs in pairs)


def measure(forms: Sequence[Form], inputs: Sequence[Input], rounds: int) -> list[Rates]:
    """All forms in turns, in each round on each input; the slowest input first."""
    workers = [(form.name, form.start()) for form in forms]
    measured = [Rates(given, {name: [] for name, _ in workers}) for given in inputs]
    for turn in range(rounds + 1):
        progress(f"round {turn} of {rounds}")
        for each in measured:
            for name, worker in rotated(workers, turn):
                seconds = worker.time(each.input.path, each.input.nodes)
                each.seconds[name] += seconds if turn else []  # the first parse is for caches
    for _, worker in workers:
        worker.close()
    progress("")
    return sorted(measured, key=lambda each: each.rate("interpreted"))


def compare(measured: Sequence[Rates], commit: str = "") -> list[Goal]:
    """The goals of docs/performance.md: the slowest of the inputs counts."""
    goals = []
    for form, wanted in (("interpreted", INTERPRETED), ("compiled", COMPILED)):
        if form not in measured[0].seconds:
            continue
        by_rate = sorted(measured, key=lambda each: each.rate(form))
        slowest, fastest = by_rate[0], by_rate[-1]
        if commit:
            times = slowest.times(form, f"{commit} interpreted")
            text = f"{form}, {slowest.input.name}: times {commit} interpreted >= {wanted}"
            goals.append(Goal(text, times, times >= wanted))
        share = slowest.rate(form) / fastest.rate(form)
        text = f"{form}: {slowest.input.name} beside {fastest.input.name} >= 0.5"
        goals.append(Goal(text, share, share >= 0.5))
    return goals


def as_text(measured: Sequence[Rates], commit: str = "") -> list[str]:
    """A table in Markdown."""
    names = list(measured[0].seconds)
    base = f"{commit} interpreted"
    own = [name for name in names if commit and not name.startswith(commit)]
    lines = [
        row("input", "nodes", *(f"{name}, nodes/s" for name in names), *(f"{name} / {base}" for name in own)),
        "|---" * (2 + len(names) + len(own)) + "|",
    ]
    for each in measured:
        rates = (rounded(each.rate(name)) for name in names)
        quotients = (f"{each.times(name, base):.2f}" for name in own)
        lines.append(row(each.input.name, f"{each.input.nodes:,}", *rates, *quotients))
    return lines


def as_data(measured: Sequence[Rates]) -> list[dict[str, object]]:
    """Every single time, for machines."""
    return [{"input": each.input.name, "nodes": each.input.nodes, "seconds": each.seconds} for each in measured]
