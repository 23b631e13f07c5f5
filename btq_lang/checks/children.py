"""How many children a node has, and what their number must fit."""

from __future__ import annotations

import re
from collections.abc import Iterator

from btq_lang.checks.view import SeenNode, View
from btq_lang.diagnostics import Diagnostic, Place, Related
from btq_lang.syntax import Entry, Word
from btq_lang.text import Span

_BY_CATEGORY: dict[str, tuple[int, int | None]] = {
    "Action": (0, 0),
    "Condition": (0, 0),
    "SubTree": (0, 0),
    "Decorator": (1, 1),
    "Control": (1, None),
}
_INTEGER = re.compile(r"-?[0-9]+")
_CASE = re.compile(r"case_([0-9]+)")


def child_count(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """More or fewer children than the node takes."""
    for seen in view.nodes(entry):
        if seen.category is None or _is_switch_by_children(seen):
            continue
        least, most = seen.kind.children if seen.kind else _BY_CATEGORY[seen.category]
        count = len(seen.node.children)
        if least <= count and (most is None or count <= most):
            continue
        notes: tuple[str, ...] = ()
        if seen.kind is not None and seen.kind.late_count and count:
            notes = ("the engine loads this and throws when the node is ticked",)
        related: tuple[Related, ...] = ()
        if most is not None and count > most:
            extra = seen.node.children[most]
            related = (Related(Place(Span(extra.start, extra.end)), "the first one too many"),)
        yield Diagnostic(
            "child-count",
            seen.node.head.span,
            f"{seen.shown} takes {_range(least, most)}, it has {count or 'none'}",
            related=related,
            notes=notes,
        )


def switch_cases(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A Switch whose cases and children do not match: a child for each case, and one more for the default."""
    for seen in view.nodes(entry):
        if seen.kind is None or not seen.kind.tag.startswith("Switch"):
            continue
        node = seen.node
        count = len(node.children)
        cases = [pair for pair in node.attributes if _CASE.fullmatch(pair.key.text)]
        if _is_switch_by_children(seen):
            if not 3 <= count <= 7:
                message = f"`Switch` has {count} children; the engine has switches of 2 to 6 cases and a default"
                yield Diagnostic("switch-cases", node.head.span, message, notes=("so it takes 3 to 7 children",))
                continue
            numbers = {int(pair.key.text[5:]) for pair in cases}
            if numbers and numbers != set(range(1, count)):
                message = f"{len(numbers)} cases and {count} children: there must be one child more than cases"
                yield Diagnostic("switch-cases", node.head.span, message, notes=("the last child is the default",))
            continue
        number = int(seen.kind.tag[6:])
        if node.attribute("variable") is None:
            continue  # told as a missing port
        missing = [f"case_{case}" for case in range(1, number + 1) if node.attribute(f"case_{case}") is None]
        if missing:
            message = f"{seen.shown} has no {' and no '.join(f'`{case}`' for case in missing)}"
            note = "the engine runs the default child in that case, without a word"
            yield Diagnostic("switch-cases", node.head.span, message, notes=(note,))


def parallel_threshold(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A threshold that the children of a Parallel cannot reach: the engine throws when it is ticked."""
    for seen in view.nodes(entry):
        if seen.kind is None or seen.kind.tag != "Parallel":
            continue
        count = len(seen.node.children)
        for port in ("success_count", "failure_count"):
            value = seen.node.attribute(port)
            threshold = _integer(value)
            if value is None or threshold is None or threshold <= count:
                continue
            yield Diagnostic(
                "parallel-threshold",
                value.span,
                f"`{port}` is {threshold}, but there are only {count} children",
                notes=("the engine throws when the node is ticked; -1 means all children",),
            )


def _is_switch_by_children(seen: SeenNode) -> bool:
    kind = seen.node.kind
    return kind is not None and kind.raw == "Switch"


def _integer(word: Word | None) -> int | None:
    return int(word.text) if word is not None and _INTEGER.fullmatch(word.text) else None


def _range(least: int, most: int | None) -> str:
    if most == 0:
        return "no children"
    if least == most:
        return f"exactly {least} child{'ren' if least > 1 else ''}"
    if most is None:
        return f"{least} or more children"
    return f"{least} to {most} children"
