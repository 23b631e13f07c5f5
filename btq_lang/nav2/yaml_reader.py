"""YAML as values with their places.

One invariant: every text gives values or a problem with its place.  An alias is the value that it names and not a copy
of it, and the depth of nesting is bounded, so neither makes a small file expensive.  No other module imports PyYAML,
and this one only when a file is read.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType
from typing import Any, Final

from btq_lang.util.text import Span


class YamlValue:
    """A value: a scalar, a list or a mapping.

    Attributes:
        span: of a list or mapping on lines of its own, up to the end of its last value.
        text: of a scalar; None for the others.
        is_plain: whether a scalar has no quotes, so that `true` and `1` are not strings.
        items: of a list.
        entries: of a mapping, in order: key and value.
    """

    __slots__ = ("entries", "is_plain", "items", "span", "text")

    def __init__(self, span: Span, text: str | None = None, is_plain: bool = False) -> None:
        self.span = span
        self.text = text
        self.is_plain = is_plain
        self.items: list[YamlValue] = []
        self.entries: list[tuple[YamlValue, YamlValue]] = []

    def get(self, key: str) -> YamlValue | None:
        """The value of a key of a mapping; of several the last one counts."""
        return next((value for name, value in reversed(self.entries) if name.text == key), None)


class YamlProblem(Exception):
    """Why a text is not YAML, and the offset of the mistake."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.message = message
        self.offset = offset


class YamlMissing(Exception):
    """PyYAML is not installed."""


def read_yaml(text: str) -> YamlValue:
    """The first document of a text; an empty text is an empty mapping.

    Raises:
        YamlProblem: the text is not YAML, or larger or nested deeper than any parameter file.
        YamlMissing: the extra is not installed.
    """
    if len(text) > _MOST_CHARACTERS:
        raise YamlProblem(f"larger than {_MOST_CHARACTERS} characters", 0)
    yaml = _yaml()
    try:
        return _Builder(yaml).document(yaml.parse(text, Loader=yaml.SafeLoader)) or YamlValue(Span(0, 0))
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise YamlProblem(str(error.problem or error.context), mark.index if mark else 0) from error
    except yaml.reader.ReaderError as error:
        raise YamlProblem(f"character U+{ord(text[error.position]):04X} is not allowed", error.position) from error


def _yaml() -> ModuleType:
    try:
        import yaml
    except ImportError as error:
        raise YamlMissing from error
    module: ModuleType = yaml
    return module


class _Builder:
    """Values from the events of a parser, which are in the order of the text; it does not call itself."""

    def __init__(self, yaml: ModuleType) -> None:
        self._yaml = yaml
        self._anchors: dict[str, YamlValue] = {}
        self._open: list[
            tuple[YamlValue, list[YamlValue], bool, str | None]
        ] = []  # with its children, and whether a mapping
        self._copied = 0  # entries, by `<<`

    def document(self, events: Iterator[Any]) -> YamlValue | None:
        """The value of the first document."""
        for event in events:
            value = self._value(event)
            if value is None:
                continue
            if not self._open:
                return value
            self._open[-1][1].append(value)
        return None

    def _value(self, event: Any) -> YamlValue | None:
        """The value that an event completes."""
        yaml = self._yaml
        span = Span(event.start_mark.index, event.end_mark.index)
        if isinstance(event, yaml.ScalarEvent):
            value = YamlValue(span, event.value, event.style is None)
            return self._anchored(value, event.anchor)
        if isinstance(event, yaml.AliasEvent):
            if event.anchor not in self._anchors:
                raise YamlProblem(f"unknown alias `{event.anchor}`", span.start)
            return self._anchors[event.anchor]
        if isinstance(event, yaml.CollectionStartEvent):
            if len(self._open) >= _DEEPEST:
                raise YamlProblem(f"more than {_DEEPEST} nested levels", span.start)
            self._open.append((YamlValue(span), [], isinstance(event, yaml.MappingStartEvent), event.anchor))
        elif isinstance(event, yaml.CollectionEndEvent):
            value, children, is_mapping, anchor = self._open.pop()
            if is_mapping:
                value.entries = self._merged(list(zip(children[::2], children[1::2], strict=True)))
            else:
                value.items = children
            last = max((child.span.end for child in children), default=0)
            value.span = Span(value.span.start, max(last, span.end if span.end > span.start else 0))
            return self._anchored(value, anchor)
        return None

    def _merged(self, entries: list[tuple[YamlValue, YamlValue]]) -> list[tuple[YamlValue, YamlValue]]:
        """The entries that `<<` names, each key once, and then the entries of the mapping itself."""
        merged: dict[str | None, tuple[YamlValue, YamlValue]] = {}
        for _, value in [entry for entry in entries if entry[0].text == "<<" and entry[0].is_plain]:
            for mapping in reversed(value.items or [value]):  # the first of several counts
                merged.update((name.text, (name, below)) for name, below in mapping.entries)
                self._copied += len(mapping.entries)
                if self._copied > _MOST_COPIED:
                    raise YamlProblem(f"more than {_MOST_COPIED} keys by `<<`", value.span.start)
        return [*merged.values(), *entries]

    def _anchored(self, value: YamlValue, anchor: str | None) -> YamlValue:
        if anchor is not None:
            self._anchors[anchor] = value
        return value


_DEEPEST: Final = 50
_MOST_COPIED: Final = 10_000
_MOST_CHARACTERS: Final = 1_000_000
