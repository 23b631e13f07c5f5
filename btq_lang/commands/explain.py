"""`btq explain`: explains a rule, a node, a quality, a word of the language, a port, a verdict, an answer or a unit."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from textwrap import wrap
from typing import Final

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES, AttributeKind
from btq_lang.catalog.foreign_names import ForeignName, foreign_name
from btq_lang.catalog.language import PHRASES, SIGNS, phrases_of
from btq_lang.catalog.literals import is_known_type, plain_type
from btq_lang.catalog.nodes import BUILTINS, ELSEWHERE, KNOWN_WORDS, NodeKind, lookup, spellings
from btq_lang.catalog.qualities import Quality, find, parts, qualities, siblings
from btq_lang.catalog.standard_answers import STANDARD_ANSWERS
from btq_lang.catalog.units import dimension_name, nearest_units, parse_unit, symbols
from btq_lang.catalog.verdicts import VERDICTS, Verdict
from btq_lang.commands.explain_nav2 import nav2_nodes, nav2_page
from btq_lang.commands.output import is_coloured
from btq_lang.diagnostics.rules import RULES, by_subject, page
from btq_lang.ide.describe import in_si, si_symbol
from btq_lang.projects.messages import CommandOutput
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tree import is_name, quote
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record
from btq_lang.util.spelling import near


class ExplainOptions(Record):
    """The options of `btq explain`."""

    subject: Sequence[str]
    color: str


def run(options: ExplainOptions, messages: CommandOutput) -> int:
    """Explain everything with the given names; without a name, list the rules."""
    names = [name for word in options.subject if (name := word.strip())]
    pages = list(_pages(" ".join(names)))  # a name of several words: `time behaviour`
    unknown = []
    if not names:
        pages = [_overview()]
    elif not pages:
        by_name = {name: list(_pages(name)) or list(_pages(name.split()[0])) for name in names}  # `takes at most`
        pages = [text for texts in by_name.values() for text in texts]
        unknown = [name for name, texts in by_name.items() if not texts]
    for name in unknown:
        likely = _likely(name)
        meant = f"; did you mean {', '.join(likely)}?" if likely else "; `btq explain` says what there is"
        messages.remark(f"btq explain: unknown name `{name}`{meant}")
    is_bold = is_coloured(options.color, sys.stdout.isatty())
    for number, text in enumerate(pages):
        messages.result("\n" * (number > 0) + (_with_bold_headings(text) if is_bold else text))
    return 2 if unknown else 0


def _pages(name: str) -> Iterator[str]:
    foreign = foreign_name(name)
    own_pages = [*_own_pages(name)]
    yield from own_pages if own_pages or foreign is None else _foreign(name, foreign)


def _own_pages(name: str) -> Iterator[str]:
    if name in RULES:
        yield page(name).rstrip()
    kind = lookup(name) or lookup(name, quoted=True)
    if kind is not None:
        yield "\n".join(_node(kind))
    elif name in KNOWN_WORDS:
        yield f"# {name}\n\n{KNOWN_WORDS[name].why}."
    yield from nav2_page(name)
    match = find(tuple(name.split(".")))
    for quality in (match.quality,) if match.quality else match.candidates:
        yield "\n".join(_quality(quality, name, match.explanation))
    if name in VERDICTS:
        yield _verdict(VERDICTS[name])
    if name in STANDARD_ANSWERS:
        answer = STANDARD_ANSWERS[name]
        meaning, then = (f"{text[0].upper()}{text[1:]}." for text in (answer.meaning, answer.then))
        lines = _wrapped(f"An answer of `btq explore`. {meaning}")
        yield "\n".join((f"# {name}", "", *lines, "", "## What to do", "", *_wrapped(then)))
    for phrase in phrases_of(name):
        yield f"# {phrase.words} ({phrase.part})\n\n    {phrase.form}\n\n{phrase.sentence}"
    if name in ("verdict", "verdicts"):
        yield "\n".join(("# Verdicts of `btq verify`", "", *_verdicts(), "", "`btq explain` explains each of them."))
    if name in RESERVED_ATTRIBUTES:
        yield _attribute(RESERVED_ATTRIBUTES[name])
    yield from _ports(name)
    yield from _type(name)
    yield from _sign(name)
    yield from _unit(name)
    if name in (lists := _lists()) and name != "verdicts":  # those have a page
        yield "\n".join((f"# {name.capitalize()}", *lists[name]()))
    if name == "io-error":
        yield _IO_ERROR


def _node(kind: NodeKind) -> Iterator[str]:
    yield f"# {kind.tag} ({kind.category})"
    yield ""
    yield kind.doc + ("" if kind.doc.endswith(".") else ".")
    yield ""
    yield kind.semantics
    yield ""
    yield f"written:  {'  '.join(spellings(kind))}"
    least, most = kind.children
    children = "one or more" if most is None and least == 1 else f"{least} or more" if most is None else None
    yield f"children: {children or (least if least == most else f'{least} to {most}')}"
    yield f"since:    BehaviorTree.CPP {kind.since}"
    for port in kind.ports:
        needed = "required" if port.required else f"default {port.default}" if port.default else "optional"
        yield f"{port.direction + ':':<9} {port.name} : {port.type} ({needed}{', ' + port.unit if port.unit else ''})"
        yield f"          {port.doc}"


def _foreign(name: str, foreign: ForeignName) -> Iterator[str]:
    note = f"\n{foreign.note[0].upper()}{foreign.note[1:]}." if foreign.note else ""
    doc = BUILTINS[foreign.tag].doc
    yield f"# {name} (of other engines)\n\nThe node of BehaviorTree.CPP is {foreign.tag}. {doc}{note}"


def _quality(quality: Quality, name: str, explanation: str) -> Iterator[str]:
    yield f"# {quality.id}"
    yield ""
    yield f"{quality.name}: {quality.definition}"
    yield f"({quality.source})"
    if explanation:
        yield f"`{name}`: {explanation}"
    if quality.measures:
        yield f"measures: {quality.measures}"
    if quality.nearest:
        yield f"nearest in ISO/IEC 25010: {quality.nearest}"
    below = parts(quality.id)
    if below:
        yield f"parts:    {', '.join(part.id.rpartition('.')[2] for part in below)}"
    beside = siblings(quality)
    if beside and quality.parent:
        yield f"siblings: {', '.join(sibling.id.rpartition('.')[2] for sibling in beside)}"


def _attribute(kind: AttributeKind) -> str:
    value = "true" if kind.group == "engine" else '"done := true"' if kind.group == "post" else '"…"'
    form = f"{'SubTree Dock' if kind.group == 'engine' else 'MoveBase'} ({kind.name} = {value})"
    if kind.group == "pre":
        form = f'MoveBase ({kind.name} = "distance < 0.1")'
    whose = ", which the engine does not read" if kind.group == "tool" else ""
    return f"# {kind.name} (attribute of a node{whose})\n\n    {form}\n\n{kind.doc[0].upper()}{kind.doc[1:]}."


def _ports(name: str) -> Iterator[str]:
    """The pages of ports with this name, of nodes of the engine."""
    ports = [(kind, port) for kind in BUILTINS.values() for port in kind.ports if port.name == name]
    if ports and name not in RESERVED_ATTRIBUTES:
        lines = [f"{f'{kind.tag}:':<24} {port.type:<13} {port.doc}" for kind, port in ports]
        yield "\n".join((f"# {name} (port)", "", *lines))


def _type(name: str) -> Iterator[str]:
    if name and name[0].isalpha() and is_known_type(plain_type(name)):
        yield (
            f"# {name} (type of a port)\n\n    input x : {name if is_name(name.replace('::', '')) else quote(name)}\n\n"
            f"A C++ type that the engine converts from a string, so btq checks the values of such a port."
        )


def _sign(name: str) -> Iterator[str]:
    """The pages of signs: `{pose}` and `{ }` are one, and `btq: ignore[unused-tree]` is a sign with its rule."""
    plain = name.partition("[")[0]
    if name.startswith("{") and name.endswith("}") and name != "{=}":
        plain = "{@ }" if name.startswith("{@") else "{ }"
    for sign, form, meaning in SIGNS:
        parts = [sign, sign.replace(" ", ""), *sign.split(" ")]
        if plain in parts:
            yield f"# {sign} (sign)\n\n    {form}\n\n{meaning[0].upper()}{meaning[1:]}."


def _unit(name: str) -> Iterator[str]:
    quantity = parse_quantity(name)
    unit = parse_unit(name)
    if quantity is not None:
        value = in_si(name)
        converted = f" It is {value}." if value != name else ""
        yield f"# {name} (quantity)\n\nMeasures {dimension_name(quantity[1])}.{converted}"
    elif name in _SORTS:
        yield f"# {name} (in the place of a unit)\n\n    signal x : {name} from {{x}}\n\n{_SORTS[name]}"
    elif unit is not None:
        one = in_si(f"1 {name}")
        same = "" if unit.symbol == name or si_symbol(unit) == name else f", the same as {unit.symbol}"
        value = "" if one in (f"1 {name}", "1") else f" 1 {name} is {one}{same}."
        others = [
            other.symbol for other in symbols() if other.dimension == unit.dimension and other.symbol != unit.symbol
        ]
        beside = f"\n\ncompares with: {', '.join(others)}" if others else ""
        yield f"# {name} (unit)\n\nMeasures {dimension_name(unit)}.{value}{beside}"


def _verdict(verdict: Verdict) -> str:
    return f"# {verdict.name}\n\nA verdict: {verdict.brief}.\n\n{verdict.when}\n\n## What to do\n\n{verdict.then}"


def _verdicts() -> Iterator[str]:
    for verdict in VERDICTS.values():
        yield f"{verdict.name:<20} {verdict.brief}"


def _likely(name: str) -> tuple[str, ...]:
    """Names similar to a name, or else names that contain it, of the kind whose form it has."""
    kind = _nodes if name[:1].isupper() else _rules if "-" in name else _names
    parts = [known_name for known_name in kind() if len(name) > 2 and name.casefold() in known_name.casefold()]
    close = ELSEWHERE.get(name) or near(name, kind()) or near(name, _names())
    return (
        close or tuple(sorted(parts, key=lambda known_name: (len(known_name), known_name))[:5]) or _likely_units(name)
    )


def _likely_units(name: str) -> tuple[str, ...]:
    """The units that a name begins with; without more in common, a unit is a wild guess."""
    return tuple(unit for unit in nearest_units(name) if name.casefold().startswith(unit.casefold()))


def _overview() -> str:
    """All rules on one screen, and how to list what else there is."""
    subjects = {title: "  ".join(rule.name for rule in rules) for title, rules in by_subject().items()}
    lines = [line for title, names in subjects.items() for line in (f"# {title}", *_wrapped(names))]
    return "\n".join((*lines, "", f"Lists: btq explain {' '.join(_lists())}"))


def _wrapped(text: str) -> list[str]:
    return wrap(text, _WIDTH, break_on_hyphens=False, break_long_words=False)


def _lists() -> dict[str, Callable[[], Iterable[str]]]:
    """The lines about all of a kind, by its name."""
    by_dimension = grouped((dimension_name(unit), unit.symbol) for unit in symbols())
    return {
        "rules": lambda: (f"{rule.name:<28} {rule.severity.value:<8} {rule.summary}" for rule in RULES.values()),
        "nodes": lambda: (
            f"{kind.tag:<28} {'  '.join(spellings(kind)[1:]):<22} {kind.doc}" for kind in BUILTINS.values()
        ),
        "qualities": lambda: (f"{quality.id:<58} {quality.name}" for quality in qualities()),
        "words": lambda: (f"{one.words:<20} {one.part:<22} {one.brief}" for one in PHRASES),
        "signs": lambda: (f"{sign:<12} {form:<38} {meaning}" for sign, form, meaning in SIGNS),
        "attributes": lambda: (f"{attribute.name:<20} {attribute.doc}" for attribute in RESERVED_ATTRIBUTES.values()),
        "verdicts": _verdicts,
        "units": lambda: (f"{measured:<22} {' '.join(units)}" for measured, units in by_dimension.items()),
    }


def _rules() -> list[str]:
    return [*RULES, *STANDARD_ANSWERS, *(quality.id for quality in qualities())]


def _nodes() -> list[str]:
    return [*(spelling for kind in BUILTINS.values() for spelling in spellings(kind)), *nav2_nodes()]


def _names() -> list[str]:
    ports = {port.name for kind in BUILTINS.values() for port in kind.ports}
    units = (unit.symbol for unit in symbols())
    others = [*ports, *VERDICTS, *RESERVED_ATTRIBUTES, *units, *(phrase.words for phrase in PHRASES)]
    return [*_rules(), *_nodes(), *others, *_lists()]


def _with_bold_headings(text: str) -> str:
    lines = text.split("\n")
    return "\n".join(f"\x1b[1m{line}\x1b[0m" if line.startswith("#") else line for line in lines)


_WIDTH: Final = 80
_SORTS = {
    "bool": "A signal that is true or false, and a condition by itself: `keeps door_open`.",
    "text": 'A signal that is a text: `keeps zone == "corridor"`.',
    "1": "A plain number, which no unit measures: `signal tries_left : 1 from {tries_left}`.",
}
_IO_ERROR = """# io-error

A file that cannot be read or written, or that is not UTF-8.

It is not a rule: in reports for machines (JSON, JUnit, GitHub) it takes the place of one. Nothing selects or
silences it, and the command ends with exit code 2."""
