"""`btq explain`: what a rule, a node, a quality or a word of the language is."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Iterator

from btq_lang.catalog.language import PHRASES, Phrase, phrases_of
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, NodeKind, lookup, spellings
from btq_lang.catalog.qualities import Quality, find, parts, qualities, siblings
from btq_lang.near import near
from btq_lang.render.colour import wants_colour
from btq_lang.rules import RULES, page


def run(options: Namespace) -> int:
    """Print all that goes by the names; without a name, the names there are."""
    names = [name for word in options.subject if (name := word.strip())]
    pages = list(_pages(" ".join(names)))  # a name of several words, as `time behaviour`
    unknown = []
    if not names:
        pages = ["\n".join(_overview())]
    elif not pages:
        by_name = {name: list(_pages(name)) for name in names}
        pages = [text for found in by_name.values() for text in found]
        unknown = [name for name, found in by_name.items() if not found]
    for name in unknown:
        likely = near(name, _names())
        meant = f"; did you mean {', '.join(likely)}?" if likely else "; `btq explain` lists all there is"
        print(f"btq explain: `{name}` is no rule, node, quality or word of the language{meant}", file=sys.stderr)
    bold = options.color == "always" or (options.color == "auto" and wants_colour(sys.stdout.isatty(), os.environ))
    for number, text in enumerate(pages):
        print("\n" * (number > 0) + (_with_bold_headings(text) if bold else text))
    return 2 if unknown else 0


def _pages(name: str) -> Iterator[str]:
    if name in RULES:
        yield page(name).rstrip()
    kind = lookup(name) or lookup(name, quoted=True)
    if kind is not None:
        yield "\n".join(_node(kind))
    elif name in KNOWN_WORDS:
        yield f"# {name}\n\n{KNOWN_WORDS[name].why}."
    match = find(tuple(name.split(".")))
    for quality in (match.quality,) if match.quality else match.candidates:
        yield "\n".join(_quality(quality, name, match.explanation))
    yield from map(_phrase, phrases_of(name))
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
    children = (
        "any number, one at least" if most is None and least == 1 else f"{least} or more" if most is None else None
    )
    yield f"children: {children or (least if least == most else f'{least} to {most}')}"
    yield f"since:    BehaviorTree.CPP {kind.since}"
    for port in kind.ports:
        needed = "required" if port.required else f"default {port.default}" if port.default else "optional"
        yield f"{port.direction + ':':<9} {port.name} : {port.type} ({needed}{', ' + port.unit if port.unit else ''})"
        yield f"          {port.doc}"


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


def _phrase(phrase: Phrase) -> str:
    return f"# {phrase.words} ({phrase.part})\n\n    {phrase.form}\n\n{phrase.sentence}"


def _overview() -> Iterator[str]:
    yield "# Rules"
    for rule in RULES.values():
        yield f"{rule.name:<28} {rule.severity.value:<8} {rule.summary}"
    yield "\n# Nodes"
    for kind in BUILTINS.values():
        yield f"{kind.tag:<28} {'  '.join(spellings(kind)[1:]):<22} {kind.doc}"
    yield "\n# Qualities"
    for quality in qualities():
        yield f"{quality.id:<58} {quality.name}"
    yield "\n# Words of the language"
    for phrase in PHRASES:
        yield f"{phrase.words:<18} {phrase.part:<22} {phrase.brief}"


def _names() -> list[str]:
    words = [spelling for kind in BUILTINS.values() for spelling in spellings(kind)]
    return [*RULES, *words, *(quality.id for quality in qualities()), *(phrase.words for phrase in PHRASES)]


def _with_bold_headings(text: str) -> str:
    lines = text.split("\n")
    return "\n".join(f"\x1b[1m{line}\x1b[0m" if line.startswith("#") else line for line in lines)


_IO_ERROR = """# io-error

A file that cannot be read or written, or that is no UTF-8.

It is no rule: it stands in reports that machines read (JSON, JUnit, GitHub) where a rule would stand. Nothing
selects or silences it, and the command ends with exit code 2."""
