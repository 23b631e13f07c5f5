"""In how many runs each context held: a requirement in a context that never occurred was not tested."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.conditions import truth
from btq_lang.evidence.history import History, Nearby
from btq_lang.evidence.model import ROOT, Activation
from btq_lang.evidence.observed import Observed
from btq_lang.evidence.signals import Signals, UnknownValue
from btq_lang.requirements.model import Condition, InContext, Running, parts_in

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Joined


class Contexts:
    """Counts the runs of a mission's contexts while its logs are read.

    Attributes:
        counts: in how many runs each context held, and in how many others that is unknown.
    """

    def __init__(self, contexts: Mapping[str, Condition | None]) -> None:
        """Count nothing yet; a context that could not be resolved is None."""
        self._contexts: Final = [InContext(name, each) for name, each in contexts.items() if each is not None]
        self.counts: Final = Counter(dict.fromkeys(contexts, 0)), Counter(dict.fromkeys(contexts, 0))

    def join(self, joined: Joined, signals: Signals, history: History) -> None:
        """Begin another log."""
        self._signals, self._nodes = signals, Nearby(ROOT, joined, history)
        for context in self._contexts:
            for part in parts_in(context):
                if isinstance(part, Running):
                    self._nodes.find(part.target)

    def end_run(self, root: Activation) -> None:
        """Count the open run, which has ended; `root`: the activation of its root."""
        observed = Observed(self._signals, self._nodes, root.started, root.ended, root.timing != "latest").in_scope
        held, unknown = self.counts
        for context in self._contexts:
            is_unknown = False
            for moment in observed.moments(context):
                found = truth(context, observed, moment)
                if found is True:
                    held[context.name] += 1
                    break
                is_unknown = is_unknown or isinstance(found, UnknownValue)
            else:
                unknown[context.name] += is_unknown
