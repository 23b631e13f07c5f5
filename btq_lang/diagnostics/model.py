"""Diagnostics as data: what is wrong, where, related places, and how to fix it.

Nothing here renders or decides: rules detect, `render` prints, editors show.  A span counts from the start of its
`anchor`, the piece of a file that moves as one (a tree, a requirement); `None` is the start of the file itself.
Outside the workspace, diagnostics have no anchors.
"""

from __future__ import annotations

from collections.abc import Callable

from btq_lang.diagnostics.rules import RULES, Severity
from btq_lang.diagnostics.rules import Tag as Tag
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Span


class Place(Record):
    """A span in a file.  Two are equal only if they count from the same item, not from an equal one.

    Attributes:
        path: the file; None is the file of the diagnostic.
        anchor: the item the span counts from; None with a path is that file's start, None without a path is the anchor
            of the diagnostic itself.
    """

    span: Span
    path: str | None = None
    anchor: object | None = None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Place) and (
            (self.span, self.path) == (other.span, other.path) and self.anchor is other.anchor
        )

    def __hash__(self) -> int:
        return hash((self.span, self.path))


class Related(Record):
    """Another place that a reader needs to see to understand the diagnostic."""

    place: Place
    message: str


class FixEdit(Record):
    """One edit of a fix: the text at `place` becomes `text`."""

    place: Place
    text: str


class Fix(Record):
    """A change that fixes a diagnostic.

    Attributes:
        title: what it does, as the label of a button: "Replace `Rety` with `Retry`".
        safe: whether it keeps the meaning and removes the diagnostic; `btq check --fix` applies only these.
    """

    title: str
    changes: tuple[FixEdit, ...]
    safe: bool = False


class Diagnostic(Record):
    """A finding of one rule."""

    rule: str
    span: Span
    message: str
    related: tuple[Related, ...] = ()
    notes: tuple[str, ...] = ()
    fixes: tuple[Fix, ...] = ()
    tags: tuple[Tag, ...] = ()
    severity: Severity | None = None  # None: the rule's own

    @property
    def effective_severity(self) -> Severity:
        return self.severity or RULES[self.rule].severity


def replace_fix(title: str, span: Span, text: str, *, safe: bool = False) -> Fix:
    """The commonest fix: one replacement beside the diagnostic."""
    return Fix(title, (FixEdit(Place(span), text),), safe)


def write_fix(text: str, span: Span, *, safe: bool = False) -> Fix:
    """The replacement whose title says what is written."""
    return replace_fix(f"Write `{text}`", span, text, safe=safe)


def shifted(diagnostic: Diagnostic, by: int) -> Diagnostic:
    """The diagnostic with another origin: its span, and every place that counts from the same, are shifted."""
    if by == 0:
        return diagnostic

    def move(place: Place) -> Place:
        if place.path is not None or place.anchor is not None:
            return place
        return Place(place.span.shifted(by))

    return relocated(diagnostic, diagnostic.span.shifted(by), move)


def relocated(diagnostic: Diagnostic, span: Span, move: Callable[[Place], Place]) -> Diagnostic:
    """The diagnostic at another span, with each of its other places moved; itself if it has none and stays."""
    if span is diagnostic.span and not diagnostic.related and not diagnostic.fixes:
        return diagnostic

    def moved(fix: Fix) -> Fix:
        return Fix(fix.title, tuple([FixEdit(move(each.place), each.text) for each in fix.changes]), fix.safe)

    related = tuple([Related(move(each.place), each.message) for each in diagnostic.related])
    return replace(diagnostic, span=span, related=related, fixes=tuple(map(moved, diagnostic.fixes)))
