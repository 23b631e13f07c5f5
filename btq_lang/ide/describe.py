"""Markdown descriptions for hovers and for the documentation of completions."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from btq_lang.catalog.language import phrases_of
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import KNOWN_WORDS, NodeKind, PortKind, spellings
from btq_lang.catalog.qualities import EDITIONS, Quality, parts, siblings
from btq_lang.catalog.units import BASES, Unit, convert, dimension_name, parse_unit, to_si
from btq_lang.checks.includes import include_line
from btq_lang.checks.lookups import head
from btq_lang.diagnostics.rules import RULES, page
from btq_lang.ide.external import described
from btq_lang.ide.meaning import (
    ROOT_BLACKBOARD,
    ReferenceAt,
    Subject,
    everywhere,
    home_of,
    quality_match,
    quality_of,
)
from btq_lang.ide.meaning import own_quality as declared_quality
from btq_lang.ide.outline import clauses_detail
from btq_lang.ide.ports import builtin_named, cpp_link, ports_of_kind, ports_of_tree, signature
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tree import (
    Apply,
    Context,
    Hazard,
    Model,
    QualityDecl,
    Requirement,
    Scenario,
    Signal,
    Tree,
    Word,
    walk,
)
from btq_lang.util.text import Edit, Span, counted
from btq_lang.workspace import inputs
from btq_lang.workspace.file import Definition
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace

_MOST_USES = 12


def node_kind(workspace: Workspace, path: str, name: str, quoted: bool = False, children: int | None = None) -> str:
    """A built-in node, a model in scope, or what is known of any other node kind."""
    kind = builtin_named(workspace, path, name, quoted, children)
    if kind is not None:
        ports = ports_of_kind(workspace, path, name, quoted, children)
        return "\n\n".join(filter(None, (_head(kind), kind.doc, kind.semantics, _ports(ports))))
    target = workspace.scope(path).target(Kind.MODEL, name)
    if isinstance(target, Model):
        text = target.text.text if target.text else ""
        shown = f"```btq\n{target.category.raw} {name}\n```"
        _, behavior, _ = workspace.store.ask(inputs.declared, path, name)
        semantics = behavior.semantics if behavior is not None else ""
        shown_ports = _ports(ports_of_kind(workspace, path, name))
        return "\n\n".join(filter(None, (shown, text, semantics, shown_ports, cpp_link(workspace, path, name))))
    if not quoted and name in KNOWN_WORDS:
        return f"`{name}`: {KNOWN_WORDS[name].why}."
    return f"`{name}`: a custom node without a model in this file or its includes."


def _head(kind: NodeKind) -> str:
    least, most = kind.children
    count = f"{least}" if least == most else f"{least} or more" if most is None else f"{least} to {most}"
    children = f" · children: {count}" if kind.category in ("Control", "Decorator") else ""
    spelt = " ".join(f"`{word}`" for word in spellings(kind))
    return f"**{kind.tag}** ({kind.category}) · {spelt}{children} · since {kind.since}"


def _ports(ports: Iterable[PortKind]) -> str:
    return "\n".join(f"- {port(one)}" for one in ports)


def port(port_kind: PortKind) -> str:
    """A port on one line: `` `input msec : unsigned int` in ms, required: how long ``."""
    notes = [f"in {port_kind.unit}"] if port_kind.unit else []
    notes += ["required"] if port_kind.required else []
    remark = f" ({', '.join(notes)})" if notes else ""
    return f"`{signature(port_kind)}`{remark}{f': {port_kind.doc}' if port_kind.doc else ''}"


def tree(workspace: Workspace, path: str, name: str) -> str:
    """A tree: its ports, what is attached to it, and its callers."""
    definition = _definition(workspace, path, Kind.TREE, name)
    if definition is None:
        return f"`{name}`: unknown tree."
    item = definition.symbol.target
    shown = f"```btq\nBehaviorTree {name}\n```"
    attached = clauses_detail(item.clauses) if isinstance(item, Tree) else ""
    ports = _ports(ports_of_tree(workspace, definition.path, name))
    count = sum(1 for _ in item.walk()) if isinstance(item, Tree) else 0
    size = f"{counted(count, 'node')} · {workspace.project.shown(definition.path)}"
    referent = Subject(What.TREE, name, home_of(definition))
    return "\n\n".join(filter(None, (shown, attached, size, ports, used(workspace, referent, "Run by"))))


def requirement(workspace: Workspace, path: str, definition: Definition) -> str:
    """A requirement as it is written, with its values in SI units, its quality, what a build does about each clause,
    where it is used, and the scenarios that verify it."""
    item = definition.symbol.target
    assert isinstance(item, Requirement), "a requirement's symbol defines one"
    lines = [f"**{definition.symbol.name}**{_parameters(workspace, definition, item)}"]
    quality = quality_of(definition)
    qualities = item.qualities or (() if quality is None else (quality,))
    if qualities:
        lines[0] += f" · {' and '.join(one.text for one in qualities)}"
    if item.text is not None:
        lines.append(" ".join(item.text.text.split()))
    if item.clauses:
        lines.append(
            "```btq\n"
            + "\n".join(_clause(workspace, definition, Span(clause.start, clause.end)) for clause in item.clauses)
            + "\n```"
        )
    referent = Subject(What.REQUIREMENT, definition.symbol.name, home_of(definition))
    attached = used(workspace, referent, "Attached to", lambda use: not (is_refinement(use) or _is_in_scenario(use)))
    refined = used(workspace, referent, "Refined by", is_refinement)
    verified = used(workspace, referent, "Verified by", _is_verification)
    if item.clauses or item.text is not None:
        from btq_lang.ide.clause_enforcement import enforcement_lines  # most hovers need no plan of a build

        enforcement = enforcement_lines(workspace, path, definition, is_attached=bool(attached))
        lines.append(f"Enforcement by `btq build`:\n{enforcement}" if enforcement else "")
    return "\n\n".join(filter(None, (*lines, attached, refined, verified)))


def hazard(workspace: Workspace, definition: Definition) -> str:
    """A hazard as it is written, and the requirements that mitigate it."""
    item = definition.symbol.target
    assert isinstance(item, Hazard), "a hazard's symbol defines one"
    file = workspace.files[definition.path]
    clauses = [file.on_one_line(definition.entry, Span(clause.start, clause.end)) for clause in item.clauses]
    shown = "\n".join(("```btq", *clauses, "```")) if clauses else ""
    title = " ".join(item.text.text.split()) if item.text is not None else ""
    referent = Subject(What.HAZARD, definition.symbol.name, home_of(definition))
    mitigated = used(workspace, referent, "Mitigated by")
    return "\n\n".join(filter(None, (f"**{definition.symbol.name}** · hazard", title, shown, mitigated)))


def _parameters(workspace: Workspace, definition: Definition, item: Requirement) -> str:
    """`` `(limit : m/s = 0.25 m/s)` ``, as it is written; empty if it has none."""
    file = workspace.files[definition.path]
    shown = []
    for parameter in item.parameters:
        end = max(word.end for word in walk(parameter) if isinstance(word, Word))
        shown.append(file.on_one_line(definition.entry, Span(parameter.name.start, end)))
    return f" `({', '.join(shown)})`" if shown else ""


def _clause(workspace: Workspace, definition: Definition, span: Span) -> str:
    """A clause on one line, and a comment with its quantities in SI units if they are written in others."""
    file = workspace.files[definition.path]
    text = file.on_one_line(definition.entry, span)
    typed = [
        mention.name
        for mention in file.mentions_of(definition.entry)
        if mention.what is What.QUANTITY and span.contains(mention.span)
    ]
    converted = [
        f"{measured} = {si}"
        for measured in dict.fromkeys(typed)
        if (si := in_si(measured)) and si.split() != measured.split()
    ]
    return f"{text}  # {', '.join(converted)}" if converted else text


def is_refinement(use: ReferenceAt) -> bool:
    """Whether a reference to a requirement or a hazard is in a clause of a requirement."""
    mention = use.mention
    is_named = mention.what in (What.REQUIREMENT, What.HAZARD) and not mention.defines
    return is_named and isinstance(mention.owner, Requirement)


def _is_in_scenario(use: ReferenceAt) -> bool:
    return use.entry is not None and isinstance(use.entry.item, Scenario)


def _is_verification(use: ReferenceAt) -> bool:
    """Whether a reference to a requirement is after the `verifies` of a scenario."""
    item = use.entry.item if use.entry is not None else None
    return isinstance(item, Scenario) and any(word is use.mention.word for word in item.verifies)


def used(
    workspace: Workspace, referent: Subject, heading: str, counts: Callable[[ReferenceAt], bool] = lambda _: True
) -> str:
    """Where something is used: a list of nodes; empty if it is not used."""
    uses = [
        reference
        for reference in everywhere(workspace, referent)
        if (not reference.mention.defines or reference.mention.node) and counts(reference)
    ]
    lines = [f"- {place_of(workspace, reference)}" for reference in uses[:_MOST_USES]]
    if len(uses) > _MOST_USES:
        lines.append(f"- and {len(uses) - _MOST_USES} more")
    return "\n".join([f"{heading}:", *lines]) if lines else ""


def place_of(workspace: Workspace, reference: ReferenceAt) -> str:
    """The place of a reference: `` `MoveBase ToWard` in `Deliver` (deliver.btq) ``, or the `apply` that it is in."""
    node, entry = reference.mention.node, reference.entry
    item = entry.item if entry is not None else None
    owner = reference.mention.owner
    if isinstance(owner, Requirement) and is_refinement(reference):
        item = owner
    name = item.name.text if isinstance(item, Tree | Requirement | Signal | Context) and item.name else ""
    where = f"`{node.called}`" + (f" in `{name}`" if name else "") if node is not None else f"`{name}`" if name else ""
    if isinstance(item, Scenario) and item.title is not None:
        where = f"the scenario {item.title.raw}"
    if isinstance(item, Apply) and entry is not None:
        where = f"`{workspace.files[reference.path].on_one_line(entry, item)}`"
    path = workspace.project.shown(reference.path)
    return f"{where} ({path})" if where else path


def quality(workspace: Workspace, path: str, standard: Quality, explanation: str = "") -> str:
    """A quality of the standard: definition, edition, parts and siblings."""
    year = EDITIONS[workspace.edition(path)]
    lines = [f"**{standard.id}** · {standard.name}", standard.definition, f"_{standard.source}_"]
    lines += [explanation] if explanation else []
    lines += [f"Measures: {standard.measures}"] if standard.measures else []
    lines += [f"Nearest in ISO/IEC 25010: `{standard.nearest}`"] if standard.nearest else []
    below = [f"`{part.id.rpartition('.')[2]}`" for part in parts(standard.id, year)]
    lines += [f"Parts: {', '.join(below)}"] if below else []
    beside = [f"`{one.id.rpartition('.')[2]}`" for one in siblings(standard, year)] if standard.parent else []
    lines += [f"Siblings: {', '.join(beside)}"] if beside else []
    return "\n\n".join(lines)


def own_quality(workspace: Workspace, definition: Definition) -> str:
    """A quality that a file declares."""
    item = definition.symbol.target
    assert isinstance(item, QualityDecl), "a quality's symbol declares one"
    parent = f" · {item.parent.text}" if item.parent else ""
    text = item.text.text if item.text else ""
    place = f"_declared in {workspace.project.shown(definition.path)}_"
    return "\n\n".join(filter(None, (f"**{definition.symbol.name}**{parent}", text, place)))


def declared(workspace: Workspace, definition: Definition) -> str:
    """A signal or a context, as it is written."""
    text = workspace.files[definition.path].text[slice(*definition.whole)]
    return f"```btq\n{text}\n```\n\n_{workspace.project.shown(definition.path)}_"


def key(workspace: Workspace, referent: Subject, writes: Iterable[ReferenceAt], reads: Iterable[ReferenceAt]) -> str:
    """An entry of the blackboard: what writes it, and what reads it."""
    where = "of the root blackboard" if referent.home.startswith(ROOT_BLACKBOARD) else "of this tree's blackboard"
    lines = [f"**{referent.name}** · entry {where}"]
    for heading, places in (("Written by", writes), ("Read by", reads)):
        shown = [f"- {place_of(workspace, reference)}" for reference in places]
        lines += ["\n".join([f"{heading}:", *shown[:_MOST_USES]])] if shown else []
    return "\n\n".join(lines)


def quantity(text: str, port_unit: str | None = None) -> str | None:
    """A quantity in SI units, and in the unit of the port that it is assigned to."""
    parsed = parse_quantity(text)
    if parsed is None:
        return None
    shown = f"**{text}** = {in_si(text)} ({dimension_name(parsed[1])})"
    converted = in_unit(text, port_unit)
    return f"{shown}\n\nWritten to the port as `{converted}`, in {port_unit}." if converted else shown


def in_si(text: str) -> str:
    """A quantity in SI units; empty if it is not a quantity."""
    parsed = parse_quantity(text)
    return f"{number(to_si(parsed[0], parsed[1]))} {si_symbol(parsed[1])}".rstrip() if parsed is not None else ""


def unit(text: str) -> str | None:
    """A unit: what it measures, and its value in SI units."""
    parsed = parse_unit(text)
    if parsed is None:
        return None
    converted = (
        f" · 1 {text} = {number(to_si(1.0, parsed))} {si_symbol(parsed)}".rstrip() if text != si_symbol(parsed) else ""
    )
    return f"**{text}** · {dimension_name(parsed)}{converted}"


def in_unit(text: str, port_unit: str | None) -> str | None:
    """The number for a quantity on a port with a unit; None if they do not fit."""
    parsed = parse_quantity(text)
    target = parse_unit(port_unit) if port_unit else None
    if parsed is None or target is None or parsed[1].dimension != target.dimension:
        return None
    return number(convert(parsed[0], parsed[1], target))


def number(value: float) -> str:
    """A number as people write it."""
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else f"{value:.10g}"


def si_symbol(unit: Unit) -> str:
    """The SI unit of what a unit measures; empty for percentages and plain numbers."""
    for symbol in _SI:
        named = parse_unit(symbol)
        if named is not None and named.dimension == unit.dimension and named.factor == 1.0 and named.offset == 0.0:
            return symbol
    powers = zip(BASES, unit.dimension, strict=True)
    factors = [(_BASE_SYMBOLS[base], power) for base, power in powers if power and base in _BASE_SYMBOLS]
    return "*".join([symbol if power == 1 else f"{symbol}^{power}" for symbol, power in factors])


def rule(name: str) -> str | None:
    """The page of a rule; None if it does not exist."""
    return page(name).rstrip() if name in RULES else None


def words(name: str) -> str | None:
    """The meanings of words of the language, in each place where they may occur; None if there are none."""
    descriptions = (
        f"**{phrase.words}** ({phrase.part}) · `{phrase.form}`\n\n{phrase.sentence}" for phrase in phrases_of(name)
    )
    return "\n\n".join(descriptions) or None


def documentation(workspace: Workspace, path: str, kind: str, name: str) -> str | None:
    """A description in Markdown of a proposal of this kind and name, if there is one."""
    if kind == "node":
        definition = _definition(workspace, path, Kind.MODEL, name)
        return node_kind(workspace, definition.path if definition else path, name)
    if kind == "tree":
        return tree(workspace, path, name)
    if kind == "requirement":
        definition = _definition(workspace, path, Kind.REQUIREMENT, name)
        return requirement(workspace, path, definition) if definition else None
    if kind == "hazard":
        definition = _definition(workspace, path, Kind.HAZARD, name)
        return hazard(workspace, definition) if definition else None
    if kind == "external":
        imported = workspace.project.external_requirements
        return described(workspace, imported.by_id[name]) if imported and name in imported.by_id else None
    if kind in ("signal", "context"):
        definition = _definition(workspace, path, Kind.SIGNAL if kind == "signal" else Kind.CONTEXT, name)
        return declared(workspace, definition) if definition else None
    if kind == "quality":
        own = declared_quality(workspace, path, name) or _definition(workspace, path, Kind.QUALITY, name)
        match = quality_match(workspace, path, name)
        if own is not None:
            return own_quality(workspace, own)
        return quality(workspace, path, match.quality) if match.quality else None
    if kind == "keyword":
        return words(name)
    if kind == "rule":
        return rule(name)
    if kind == "port":
        node, _, port_name = name.rpartition("/")
        category, _, called = node.rpartition(" ")
        port_kinds = ports_of_tree(workspace, path, called) if category == "SubTree" else ()
        port_kinds = port_kinds or ports_of_kind(workspace, path, called)
        return next((port(one) for one in port_kinds if one.name == port_name), None)
    return None


def include_edits(workspace: Workspace, path: str, other: str) -> tuple[Edit, ...]:
    """The edits that add a proposal to the file's scope; `other`: the file that defines it, empty if it is in scope."""
    if other not in workspace.files:
        return ()
    offset, line = include_line(workspace.store.ask(head, path), path, other)
    return (Edit(Span(offset, offset), line),)


def _definition(workspace: Workspace, path: str, kind: Kind, name: str) -> Definition | None:
    return workspace.scope(path).find(kind, name) or next(iter(workspace.defined_anywhere(kind, name)), None)


_SI = ("s", "m", "kg", "A", "K", "rad", "bit", "m/s", "m/s^2", "rad/s", "Hz", "N", "Pa", "J", "W", "V", "ohm", "A*s")
_BASE_SYMBOLS = {
    "length": "m",
    "mass": "kg",
    "time": "s",
    "current": "A",
    "temperature": "K",
    "angle": "rad",
    "data": "bit",
    "count": "item",
}
