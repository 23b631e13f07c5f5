"""Which requirement holds for which node: `satisfies`, `apply … to … except …`, and the claims' own subjects.

One invariant: of one parameterised requirement a node has one set of arguments, that of the most specific application;
where two are equally specific and differ, a problem says so and neither counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.diagnostics import Place, Related, replace_fix
from btq_lang.near import near
from btq_lang.record import fields_of, record, replace
from btq_lang.requirements.model import (
    Applied,
    Argument,
    Bounded,
    Claim,
    Every,
    Parameter,
    Requirement,
    SourceNode,
    Subject,
    Target,
    Trace,
)
from btq_lang.requirements.reader import Reader
from btq_lang.rules import Severity
from btq_lang.symbols import requirements_at
from btq_lang.syntax import Apply, Entry, NodeClause, ReqRef, Selector, Tree, Word, is_name
from btq_lang.syntax import Argument as WrittenArgument
from btq_lang.syntax import Requirement as WrittenRequirement
from btq_lang.text import Span

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final, Literal


@record
class _Use:
    """An attachment of a requirement to a node, before it is decided which of several counts.

    Attributes:
        rank: how specific it is.
    """

    target: Target
    arguments: tuple[Argument, ...]
    rank: int
    place: Place
    path: str
    entry: Entry
    how: Literal["satisfies", "apply"]


def attach(
    reader: Reader, requirements: dict[str, Requirement]
) -> tuple[tuple[Applied, ...], tuple[Trace, ...], frozenset[str]]:
    """What holds for what, in the order of the definitions; the trace links; and the requirements that something
    attaches, be it only what could not be understood."""
    uses: dict[str, list[_Use]] = {name: [] for name in requirements}
    mentioned: set[str] = set()
    for path, entry in _entries(reader):
        if isinstance(entry.item, Tree):
            _at_nodes(reader, requirements, path, entry, entry.item, uses, mentioned)
        elif isinstance(entry.item, Apply):
            _applies(reader, requirements, path, entry, entry.item, uses, mentioned)
    applied: list[Applied] = []
    traces: list[Trace] = []
    for requirement in requirements.values():
        applied += _by_subject(requirement)
        attached = [claim for claim in requirement.claims if claim.subject is None]
        counting = _most_specific(reader, requirement, uses[requirement.name])
        if requirement.claims and not attached:
            traces += (Trace(requirement.name, use.target.node) for use in counting)
            continue
        alone = replace(requirement, claims=tuple(attached)) if len(attached) < len(requirement.claims) else requirement
        filled: dict[tuple[Argument, ...], Requirement] = {}  # most nodes get the same arguments, or none
        for use in counting:
            if use.arguments not in filled:
                filled[use.arguments] = fill(alone, use.arguments)
            applied.append(Applied(filled[use.arguments], use.target, use.arguments, use.place, use.how))
    return tuple(applied), tuple(traces), frozenset(mentioned)


def fill(requirement: Requirement, arguments: tuple[Argument, ...]) -> Requirement:
    """A requirement with arguments in the place of its parameters."""
    if not arguments:
        return requirement
    values = {argument.name: argument.value for argument in arguments}
    filled = _filled(requirement, values)
    assert isinstance(filled, Requirement), "a part is filled with a part of its kind"
    return replace(filled, parameters=requirement.parameters)


def _filled(part: object, values: dict[str, Bounded]) -> object:
    if isinstance(part, Parameter):
        return values.get(part.name, part)
    if isinstance(part, tuple):
        return tuple([_filled(each, values) for each in part])
    if type(part).__module__ != Requirement.__module__ or isinstance(part, SourceNode):
        return part
    fields = fields_of(part)
    if "signal" in fields and "verb" not in fields:
        return part  # what is read has no parameters in it, and its signal may be large
    changes = {}
    for field in fields:
        old = getattr(part, field)
        new = _filled(old, values)
        if new is not old and new != old:
            changes[field] = new
    return replace(part, **changes) if changes else part


def _by_subject(requirement: Requirement) -> Iterator[Applied]:
    """A claim's own subject wins over whatever the requirement is attached to."""
    arguments = tuple(Argument(each.name, each.default) for each in requirement.parameters if each.default is not None)
    if len(arguments) < len(requirement.parameters):
        return
    groups: dict[object, tuple[Subject, list[Claim]]] = {}
    for claim in requirement.claims:
        subject = claim.subject
        if isinstance(subject, Every):
            for node in subject.nodes:
                groups.setdefault(id(node), (Target(node), []))[1].append(claim)
        elif isinstance(subject, Target) and not subject.through:
            groups.setdefault(id(subject.node), (subject, []))[1].append(claim)
        elif subject is not None:
            groups.setdefault(subject, (subject, []))[1].append(claim)
    for subject, claims in groups.values():
        filled = fill(replace(requirement, claims=tuple(claims)), arguments)
        yield Applied(filled, subject, arguments, claims[0].place, "subject")  # type: ignore[arg-type]  # no Every is left


def _entries(reader: Reader) -> Iterator[tuple[str, Entry]]:
    for path in reader.scope.paths:
        for entry in reader.workspace.files[path].parsed.entries:
            yield path, entry


def _at_nodes(
    reader: Reader,
    requirements: dict[str, Requirement],
    path: str,
    entry: Entry,
    tree: Tree,
    uses: dict[str, list[_Use]],
    mentioned: set[str],
) -> None:
    places: list[tuple[SourceNode | None, tuple[NodeClause, ...]]] = [(reader.nodes.root_of(entry), tree.clauses)]
    places += [(node, node.node.clauses) for node in reader.nodes.within(entry) if node.node.clauses]
    for node, clauses in places:
        for written in requirements_at(clauses):
            word = written.name
            requirement = requirements.get(word.text) if word is not None else None
            if word is None or requirement is None:
                continue
            mentioned.add(requirement.name)
            reader.begin(path, entry)
            arguments = _arguments(reader, requirement, written, word.span)
            if arguments is not None and node is not None:
                place = reader.place(word.span)
                use = _Use(Target(node), arguments, _AT_NODE, place, path, entry, "satisfies")
                uses[requirement.name].append(use)


def _applies(
    reader: Reader,
    requirements: dict[str, Requirement],
    path: str,
    entry: Entry,
    apply: Apply,
    uses: dict[str, list[_Use]],
    mentioned: set[str],
) -> None:
    reader.begin(path, entry)
    targets = [found for selector in apply.targets for found in _selected(reader, selector)]
    excepted = _excepted(reader, apply, {id(target.node) for target, _ in targets})
    for reference in apply.uses:
        requirement = requirements.get(reference.name.text)
        if requirement is None:
            continue
        mentioned.add(requirement.name)
        arguments = _arguments(reader, requirement, reference, reference.name.span)
        if arguments is None:
            continue
        place = reader.place(reference.name.span)
        for target, rank in targets:
            if id(target.node) not in excepted:
                uses[requirement.name].append(_Use(target, arguments, rank, place, path, entry, "apply"))


def _excepted(reader: Reader, apply: Apply, applied_to: set[int]) -> set[int]:
    """The nodes behind `except`; those of a selector should be among the ones applied to."""
    excepted: set[int] = set()
    for selector in apply.exceptions:
        nodes = {id(target.node) for target, _ in _selected(reader, selector)}
        if nodes and applied_to and nodes.isdisjoint(applied_to) and reader.knows_all_nodes:
            message = "nothing of what this excepts is among what is applied to"
            span = Span(selector.start, selector.end)
            reader.complain("unmatched-path", span, message, severity=Severity.WARNING)
        excepted |= nodes
    return excepted


def _selected(reader: Reader, selector: Selector) -> Iterator[tuple[Target, int]]:
    """The nodes that a selector means, and how specific it is."""
    if selector.tag is not None:
        nodes = reader.nodes.tagged(selector.tag.text)
        if not nodes:
            reader.no_tag(selector.tag)
        yield from ((Target(node), _EVERY) for node in nodes)
    elif selector.every is not None:
        nodes = reader.nodes.every(selector.every.text)
        if not nodes:
            reader.none_of(selector.every)
        rank = _EVERY
        if selector.path is not None:
            top = reader.target(selector.path)
            below = reader.nodes.under(nodes, top) if top is not None else ()
            if nodes and top is not None and not below and reader.knows_all_nodes:
                shown = "/".join(name.text for name in selector.path.names)
                message = f"no `{selector.every.text}` stands below `{shown}`"
                reader.complain("unmatched-path", selector.every.span, message)
            nodes, rank = below, _EVERY_UNDER
        yield from ((Target(node), rank) for node in nodes)
    elif selector.path is not None:
        target = reader.target(selector.path)
        if target is not None:
            yield target, _PATH


def _arguments(
    reader: Reader, requirement: Requirement, written: WrittenRequirement | ReqRef, span: Span
) -> tuple[Argument, ...] | None:
    """What the parameters stand for; None: something is missing or wrong, and told."""
    given: dict[str, Bounded] = {}
    complete = True
    parameters = {parameter.name: parameter for parameter in requirement.parameters}
    for argument in written.arguments if isinstance(written, ReqRef) else ():
        parameter = parameters.get(argument.name.text)
        if parameter is None:
            _no_parameter(reader, requirement, argument)
            complete = False
        elif argument.value is not None and (value := reader.argument(parameter, argument.value)) is not None:
            given.setdefault(parameter.name, value)
        else:
            complete = False
    missing = [each.name for each in requirement.parameters if each.name not in given and each.default is None]
    if missing and complete:
        names = " and ".join(f"`{name}`" for name in missing)
        related = (Related(requirement.place, "defined here"),)
        example = ", ".join(f"{name} = …" for name in missing)
        reader.complain(
            "wrong-argument",
            span,
            f"`{requirement.name}` needs a value for {names}",
            related=related,
            notes=(f"write `{requirement.name}({example})`, or give {names} a default where it is defined",),
        )
    if missing or not complete:
        return None
    values = ((each.name, given.get(each.name, each.default)) for each in requirement.parameters)
    return tuple(Argument(name, value) for name, value in values if value is not None)


def _no_parameter(reader: Reader, requirement: Requirement, argument: WrittenArgument) -> None:
    word: Word = argument.name
    known = [parameter.name for parameter in requirement.parameters]
    fixes = tuple(
        replace_fix(f"Replace `{word.text}` by `{name}`", word.span, name)
        for name in near(word.text, known)
        if is_name(name)
    )
    notes = (f"it has {', '.join(f'`{name}`' for name in known)}",) if known else ("it has none",)
    reader.complain(
        "wrong-argument",
        word.span,
        f"`{requirement.name}` has no parameter `{word.text}`",
        related=(Related(requirement.place, "defined here"),),
        notes=notes,
        fixes=fixes,
    )


def _most_specific(reader: Reader, requirement: Requirement, uses: Iterable[_Use]) -> list[_Use]:
    """One use for each node, or for each way that a path leads to it."""
    found: list[_Use] = []
    of_node: dict[tuple[int, tuple[str, ...]], list[_Use]] = {}
    for use in uses:
        of_node.setdefault((id(use.target.node), use.target.through), []).append(use)
    for same in of_node.values():
        rank = max(use.rank for use in same)
        best = [use for use in same if use.rank == rank]
        other = next((use for use in best if _values(use) != _values(best[0])), None)
        if other is None:
            found.append(best[0])
            continue
        reader.begin(other.path, other.entry)
        node = best[0].target.node
        reader.complain(
            "ambiguous-application",
            other.place.span,
            f"{node.shown} gets two values from `{requirement.name}`: {_said(best[0])} and {_said(other)}",
            related=(Related(best[0].place, "the other one"), Related(node.place, "the node")),
            notes=(
                "a path counts before `every … under`, that before `every`, and what stands at the node before all",
            ),
        )
    return found


def _values(use: _Use) -> tuple[object, ...]:
    """Arguments that say the same are equal, however they are typed."""
    return tuple(getattr(argument.value, "si", argument.value) for argument in use.arguments)


def _said(use: _Use) -> str:
    return ", ".join(f"{argument.name} = {argument.value.text}" for argument in use.arguments)


_AT_NODE: Final = 4
_PATH: Final = 3
_EVERY_UNDER: Final = 2
_EVERY: Final = 1
