"""Which signals a part of a requirement reads."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.requirements.model import Signal
from btq_lang.util.record import fields_of


def signals_in(part: object) -> Iterator[Signal]:
    """The signals in a condition, a bound or any other part of the model, or in a tuple of such; each context is
    searched once."""
    waiting = [part]
    contexts: set[int] = set()
    while waiting:
        part = waiting.pop()
        if isinstance(part, Signal):
            yield part
        elif isinstance(part, tuple):
            waiting += reversed(part)
        elif part is not None and type(part).__module__ == Signal.__module__:
            if id(part) in contexts:
                continue
            contexts.add(id(part))
            waiting += [getattr(part, field) for field in reversed(fields_of(part))]
