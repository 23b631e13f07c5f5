"""The fingerprint of what a requirement means, which an approval has beside its date.

It is `1:` and twelve hexadecimal digits of the SHA-256 of canonical JSON.  One invariant: it depends on what the file
of the definition and those that it includes say, and neither on the layout, nor on the order of clauses, nor on the
units: values are in SI.  Selectors are as written: whether a node is where they say is for the checks.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Final, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.units import parse_unit, to_si
from btq_lang.requirements.model import ResolvedRequirement
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import NAME, NUMBER, QUANTITY, STRING
from btq_lang.util.record import Record, fields_of
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"


def fingerprint(store: Store[Workspace], path: str, resolved: ResolvedRequirement) -> str:
    """The fingerprint of what a requirement means.

    Args:
        path: of the file that defines it.
    """
    written, parts = _parts(store, path, resolved.name)
    return _digest(store, path, resolved, written, [part for _, part in parts])


def added_since(store: Store[Workspace], path: str, resolved: ResolvedRequirement, approved: str) -> str:
    """The text of the clause or the `apply` without which the requirement has the approved fingerprint; empty if there
    is none: a fingerprint does not tell what was changed or removed."""
    written, parts = _parts(store, path, resolved.name)
    for text, added in parts:
        others = [part for _, part in parts if part is not added]
        if _digest(store, path, resolved, written, others) == approved:
            return text
    return ""


class _Use(Record):
    """What one `apply` says of a requirement."""

    arguments: tuple[syntax.Argument, ...]
    targets: tuple[syntax.Selector, ...]
    exceptions: tuple[syntax.Selector, ...]


def _parts(
    store: Store[Workspace], path: str, name: str
) -> tuple[syntax.Requirement, list[tuple[str, syntax.Clause | _Use]]]:
    """A requirement as it is written, and the clauses and applications that count, each with its text."""
    definition = store.ask(inputs.definition, path, Kind.REQUIREMENT, name)
    assert definition is not None, "what is resolved is defined"
    written = inputs.symbol(definition[1], Kind.REQUIREMENT, name).target
    assert isinstance(written, syntax.Requirement), "its kind says so"
    parts: list[tuple[str, syntax.Clause | _Use]] = [
        (_text(store, *definition, clause), clause) for clause in written.clauses if type(clause) not in _LEFT_OUT
    ]
    for other, facts in store.ask(inputs.attaching, path):
        item = facts.item
        for use in item.uses if isinstance(item, syntax.Apply) else ():
            if use.name.text == name and isinstance(item, syntax.Apply):
                parts.append((_text(store, other, facts, item), _Use(use.arguments, item.targets, item.exceptions)))
    return written, parts


def _text(store: Store[Workspace], path: str, facts: Facts, part: syntax.Clause | syntax.Apply) -> str:
    return " ".join(store.ask(inputs.text, path, facts)[part.start : part.end].split())


def _digest(
    store: Store[Workspace],
    path: str,
    resolved: ResolvedRequirement,
    written: syntax.Requirement,
    parts: Sequence[syntax.Clause | _Use],
) -> str:
    import hashlib  # few files have approvals

    names = _names(store, path, (written.parameters, *parts), {one.name.text for one in written.parameters})
    meaning: dict[str, Json] = {
        "title": " ".join(written.text.text.split()) if written.text is not None else "",
        "qualities": [" ".join(quality.split()) for quality in resolved.qualities],
        "parameters": [plain(parameter) for parameter in written.parameters],
        "names": {name: _declared(declaration) for name, declaration in names.items()},
        "parts": sorted((plain(part) for part in parts), key=_canonical),
    }
    return f"1:{hashlib.sha256(_canonical(meaning).encode()).hexdigest()[:12]}"


def _canonical(value: Json) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"))


def _names(
    store: Store[Workspace], path: str, parts: object, parameters: set[str]
) -> dict[str, syntax.Signal | syntax.Context]:
    """The signals and contexts that parts of a requirement name, and those that these contexts name."""
    declared: dict[str, syntax.Signal | syntax.Context] = {}
    waiting: list[object] = [parts]
    while waiting:
        for name in _values(waiting.pop()):
            for kind in (Kind.CONTEXT, Kind.SIGNAL):
                definition = store.ask(inputs.definition, path, kind, name)
                if name in declared or name in parameters or definition is None:
                    continue
                target = inputs.symbol(definition[1], kind, name).target
                if isinstance(target, syntax.Signal | syntax.Context):
                    declared[name] = target
                    waiting += [target.condition] if isinstance(target, syntax.Context) else []
    return declared


def _values(part: object) -> Iterator[str]:
    """The names in conditions and bounds, which may be those of signals and contexts."""
    for piece in syntax.walk(part):
        if isinstance(piece, syntax.Operand | syntax.Amount):
            word: syntax.Word | None = piece.word
        elif isinstance(piece, syntax.Call | syntax.Claim):
            word = piece.signal if isinstance(piece, syntax.Call) else piece.resource
        else:
            continue
        if word is not None and word.kind == NAME:
            yield word.text


def _declared(declaration: syntax.Signal | syntax.Context) -> Json:
    if isinstance(declaration, syntax.Context):
        return plain(declaration.condition)
    unit = declaration.unit.text if declaration.unit is not None else ""
    parsed = parse_unit(unit)
    return {
        "unit": [*parsed.dimension, _rounded(parsed.factor), _rounded(parsed.offset)] if parsed is not None else unit,
        "key": declaration.source.text[1:-1].strip() if declaration.source is not None else None,
        "kind": declaration.behaviour.text if declaration.behaviour is not None else "gauge",
        "fresh": plain(declaration.fresh),
    }


def plain(part: object) -> Json:
    """A part of the tree without its places: values in SI with their dimensions, and no fields that are not given, so
    that a field of a later version changes no fingerprint."""
    if isinstance(part, syntax.Amount) and part.word.kind in (NUMBER, QUANTITY):
        return _value(part.word, "-" if part.negative else "")
    if isinstance(part, syntax.Word):
        if part.kind in (NUMBER, QUANTITY):
            return _value(part)
        return part.text
    if isinstance(part, syntax.Operand) and part.word.kind == STRING:
        return {"text": part.word.text}  # and not a signal of that name
    if isinstance(part, tuple):
        return [plain(element) for element in part]
    if part is None or isinstance(part, str | int):
        return part
    given = {field: value for field in fields_of(part) if field not in _PLACE and (value := getattr(part, field))}
    fields = {"is": type(part).__name__, **{field: plain(value) for field, value in given.items()}}
    if isinstance(part, syntax.Odds):
        fields.setdefault("experiments", "activations")  # which may be left out
    elif isinstance(part, syntax.Claim) and part.verb.raw == "tries" and fields.get("per") == "run":
        del fields["per"]  # likewise
    return fields


def _value(word: syntax.Word, sign: str = "") -> Json:
    if word.kind == NUMBER:
        return _rounded(float(sign + word.raw))
    parsed = parse_quantity(sign + word.raw)
    if parsed is None:
        return sign + word.raw  # of an unknown unit
    return [_rounded(to_si(*parsed[:2])), *parsed[1].dimension]


def _rounded(value: float) -> float:
    """To twelve digits: 20 ms are 0.02 s whatever the last bit of their product with the factor."""
    return float(f"{value:.12g}")


_PLACE: Final = ("start", "end")
_LEFT_OUT: Final = frozenset((syntax.Source, syntax.Priority, syntax.Goal, syntax.Because, syntax.Approval))
