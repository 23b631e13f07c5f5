"""Which requirement holds for which node: `satisfies`, `apply … to … except …`, and the claims' own subjects.

One invariant: of one parameterised requirement a node has one set of arguments, that of the most specific application;
where two are equally specific and differ, a problem says so and neither counts.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.diagnostics.model import Diagnostic, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements import model
from btq_lang.requirements.memory import is_same
from btq_lang.requirements.model import (
    Applied,
    Argument,
    Bounded,
    Claim,
    Every,
    InContext,
    Mission,
    Parameter,
    Requirement,
    SourceNode,
    Span,
    Subject,
    Target,
    Trace,
    Use,
)
from btq_lang.requirements.paths import Problem
from btq_lang.syntax.tree import Apply, Entry, NodeClause, ReqRef, Selector, Tree, Word, is_name
from btq_lang.syntax.tree import Argument as WrittenArgument
from btq_lang.syntax.tree import Requirement as WrittenRequirement
from btq_lang.util.record import Record, fields_of, replace
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span as TextSpan
from btq_lang.workspace.symbols import requirements_at

if TYPE_CHECKING:
    from btq_lang.requirements.reader import Reader


class Uses(Record):
    """What a tree or an `apply` attaches.

    Attributes:
        mentioned: the requirements, be it only where not all could be understood.
    """

    found: tuple[Use, ...]
    mentioned: frozenset[str]


class Held(Record):
    """What a requirement holds for.

    Attributes:
        traces: `satisfies` at nodes, where all claims name their subjects themselves.
        by_tree: the same as `applied` with the `id` of the tree that it stands in, if it does in one.
        filled: the requirement with arguments, by these, or with some of its claims, by their `id`s.
    """

    applied: tuple[Applied, ...]
    traces: tuple[Trace, ...]
    by_tree: tuple[tuple[int, Applied], ...]
    filled: dict[object, Requirement]


NO_USES: Final = Uses((), frozenset())


def uses_in(reader: Reader, path: str, entry: Entry) -> Uses:
    """What an entry attaches to which nodes."""
    uses: list[Use] = []
    mentioned: set[str] = set()
    reader.begin(path, entry)
    if isinstance(entry.item, Tree):
        _at_nodes(reader, entry.item, uses, mentioned)
    elif isinstance(entry.item, Apply):
        _applies(reader, entry.item, uses, mentioned)
    return Uses(tuple(uses), frozenset(mentioned)) if mentioned else NO_USES


def held_by(
    reader: Reader, requirement: Requirement, uses: tuple[Use, ...], before: tuple[Held, object] | None
) -> Held:
    """What a requirement holds for.

    Args:
        uses: its attachments, all of them.
        before: what it held for when there were others, to share with; and what was wrong with that.
    """
    known = before[0] if before is not None else None
    filled = _Filled(known.filled if known is not None else {})
    applied = [*_by_subject(reader, requirement, filled)]
    attached = [claim for claim in requirement.claims if claim.subject is None]
    counting = _most_specific(reader, requirement, uses) if uses else []
    if requirement.claims and not attached:
        traces = tuple([Trace(requirement.name, use.target.node) for use in counting])
        return _held(_shared(applied, known), traces, filled)
    is_whole = len(attached) == len(requirement.claims)
    for use in counting:
        claims = requirement.claims if is_whole else tuple(attached)
        made = filled.get(use.arguments, requirement, claims, use.arguments)
        applied.append(Applied(made, use.target, use.arguments, use.place, use.how))
    return _held(_shared(applied, known), (), filled)


class _Filled:
    """A requirement with some of its claims and arguments: most nodes get the same ones, as they did before."""

    def __init__(self, before: dict[object, Requirement]) -> None:
        self.made: dict[object, Requirement] = {}
        self._before = before

    def get(
        self, key: object, requirement: Requirement, claims: tuple[Claim, ...], arguments: tuple[Argument, ...]
    ) -> Requirement:
        made = self.made.get(key) or self._before.get(key)
        if made is None:
            made = requirement if claims is requirement.claims else replace(requirement, claims=claims)
            made = fill(made, arguments)
        self.made[key] = made
        return made


def _held(applied: tuple[Applied, ...], traces: tuple[Trace, ...], filled: _Filled) -> Held:
    placed = [(_home(each), each) for each in applied]
    return Held(applied, traces, tuple([(id(home), each) for home, each in placed if home is not None]), filled.made)


def _home(applied: Applied) -> Tree | None:
    subject = applied.subject.first.subject if isinstance(applied.subject, Span) else applied.subject
    node = subject.node if isinstance(subject, Target | Mission) else None
    return node.item if node is not None else None


def _shared(applied: list[Applied], before: Held | None) -> tuple[Applied, ...]:
    """The same, but what was so before is the same object: what rests on it need not be found out again."""
    if before is None:
        return tuple(applied)
    known = {_node_of(each): each for each in before.applied}
    return tuple([old if (old := known.get(_node_of(each))) and is_same(each, old) else each for each in applied])


def _node_of(applied: Applied) -> object:
    subject = applied.subject
    return (id(subject.node), subject.through) if isinstance(subject, Target) else None


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
    if type(part).__module__ != model.__name__ or isinstance(part, SourceNode | InContext):
        return part  # no parameter is known in a context
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


def _by_subject(reader: Reader, requirement: Requirement, filled: _Filled) -> Iterator[Applied]:
    """A claim's own subject wins over whatever the requirement is attached to."""
    arguments = tuple(Argument(each.name, each.default) for each in requirement.parameters if each.default is not None)
    if len(arguments) < len(requirement.parameters):
        return
    groups: dict[object, tuple[Subject, list[Claim]]] = {}
    for claim in requirement.claims:
        subject = claim.subject
        if isinstance(subject, Every):
            for node in reader.every(subject.name):
                groups.setdefault(id(node), (Target(node), []))[1].append(claim)
        elif isinstance(subject, Target) and not subject.through:
            groups.setdefault(id(subject.node), (subject, []))[1].append(claim)
        elif subject is not None:
            groups.setdefault(subject, (subject, []))[1].append(claim)
    for subject, claims in groups.values():
        made = filled.get(tuple(map(id, claims)), requirement, tuple(claims), arguments)
        yield Applied(made, subject, arguments, claims[0].place, "subject")  # type: ignore[arg-type]  # no Every is left


def _at_nodes(reader: Reader, tree: Tree, uses: list[Use], mentioned: set[str]) -> None:
    nodes = reader.nodes.within(tree)
    places: list[tuple[SourceNode | None, tuple[NodeClause, ...]]] = [(nodes.root, tree.clauses)]
    places += [(node, node.node.clauses) for node in nodes.all if node.node.clauses]
    for node, clauses in places:
        for written in requirements_at(clauses):
            word = written.name
            requirement = reader.requirement(word.text) if word is not None else None
            if word is None or requirement is None:
                continue
            mentioned.add(requirement.name)
            arguments = _arguments(reader, requirement, written, word.span)
            if arguments is not None and node is not None:
                of = Target(node)
                uses.append(Use(requirement.name, of, arguments, _AT_NODE, "satisfies", reader.path, tree, word.span))


def _applies(reader: Reader, apply: Apply, uses: list[Use], mentioned: set[str]) -> None:
    targets = [found for selector in apply.targets for found in _selected(reader, selector)]
    excepted = _excepted(reader, apply, {id(target.node) for target, _ in targets})
    for reference in apply.uses:
        requirement = reader.requirement(reference.name.text)
        if requirement is None:
            continue
        mentioned.add(requirement.name)
        arguments = _arguments(reader, requirement, reference, reference.name.span)
        if arguments is None:
            continue
        span = reference.name.span
        for target, rank in targets:
            if id(target.node) not in excepted:
                uses.append(Use(requirement.name, target, arguments, rank, "apply", reader.path, apply, span))


def _excepted(reader: Reader, apply: Apply, applied_to: set[int]) -> set[int]:
    """The nodes behind `except`; those of a selector should be among the ones applied to."""
    excepted: set[int] = set()
    for selector in apply.exceptions:
        nodes = {id(target.node) for target, _ in _selected(reader, selector)}
        if nodes and applied_to and nodes.isdisjoint(applied_to) and reader.knows_all_nodes:
            message = "`except` has no effect: the selector does not match any of these nodes"
            span = TextSpan(selector.start, selector.end)
            reader.complain("unmatched-path", span, message, severity=Severity.WARNING)
        excepted |= nodes
    return excepted


def _selected(reader: Reader, selector: Selector) -> Iterator[tuple[Target, int]]:
    """The nodes that a selector means, and how specific it is."""
    if selector.tag is not None:
        nodes = reader.ask("tagged", selector.tag.text)
        if not nodes:
            reader.no_tag(selector.tag)
        yield from ((Target(node), _EVERY) for node in nodes)
    elif selector.every is not None:
        nodes = reader.every(selector.every.text)
        if not nodes:
            reader.none_of(selector.every)
        rank = _EVERY
        if selector.path is not None:
            top = reader.target(selector.path)
            below = reader.ask("under", (selector.every.text, top)) if top is not None else ()
            if nodes and top is not None and not below and reader.knows_all_nodes:
                shown = "/".join(name.text for name in selector.path.names)
                message = f"no node matches `every {selector.every.raw}` below `{shown}`"
                reader.complain("unmatched-path", selector.every.span, message)
            nodes, rank = below, _EVERY_UNDER
        yield from ((Target(node), rank) for node in nodes)
    elif selector.path is not None:
        target = reader.target(selector.path)
        if target is not None:
            yield target, _PATH


def _arguments(
    reader: Reader, requirement: Requirement, written: WrittenRequirement | ReqRef, span: TextSpan
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
            f"`{requirement.name}` requires a value for {names}",
            related=related,
            notes=(f"write `{requirement.name}({example})`, or add a default to its definition",),
        )
    if missing or not complete:
        return None
    values = ((each.name, given.get(each.name, each.default)) for each in requirement.parameters)
    return tuple(Argument(name, value) for name, value in values if value is not None)


def _no_parameter(reader: Reader, requirement: Requirement, argument: WrittenArgument) -> None:
    word: Word = argument.name
    known = [parameter.name for parameter in requirement.parameters]
    likely = [name for name in near(word.text, known) if is_name(name)]
    fixes = tuple(replace_fix(f"Replace `{word.text}` with `{name}`", word.span, name) for name in likely)
    notes = (f"its parameters: {', '.join(f'`{name}`' for name in known)}",) if known else ("it has no parameters",)
    reader.complain(
        "wrong-argument",
        word.span,
        f"`{requirement.name}` has no parameter `{word.text}`{did_you_mean(likely)}",
        related=(Related(requirement.place, "defined here"),),
        notes=notes,
        fixes=fixes,
    )


def _most_specific(reader: Reader, requirement: Requirement, uses: tuple[Use, ...]) -> list[Use]:
    """One use for each node, or for each way that a path leads to it."""
    found: list[Use] = []
    of_node: dict[tuple[int, tuple[str, ...]], list[Use]] = {}
    for use in uses:
        of_node.setdefault((id(use.target.node), use.target.through), []).append(use)
    for same in of_node.values():
        rank = max(use.rank for use in same)
        best = [use for use in same if use.rank == rank]
        other = next((use for use in best if _values(use) != _values(best[0])), None)
        if other is None:
            found.append(best[0])
            continue
        node = best[0].target.node
        diagnostic = Diagnostic(
            "ambiguous-application",
            other.span,
            f"`{requirement.name}` has two values for {node.shown}: {_said(best[0])} and {_said(other)}",
            related=(Related(best[0].place, "other value"), Related(node.place, "node")),
            notes=(
                "a clause at the node takes precedence over a path, a path over `every … under`, that over `every`",
            ),
        )
        reader.note(Problem(other.path, other.item, diagnostic))
    return found


def _values(use: Use) -> tuple[object, ...]:
    """Arguments that say the same are equal, however they are typed."""
    return tuple(getattr(argument.value, "si", argument.value) for argument in use.arguments)


def _said(use: Use) -> str:
    return ", ".join(f"{argument.name} = {argument.value.text}" for argument in use.arguments)


_AT_NODE: Final = 4
_PATH: Final = 3
_EVERY_UNDER: Final = 2
_EVERY: Final = 1
