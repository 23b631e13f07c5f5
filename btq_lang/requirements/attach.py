"""Which requirement applies to which node: by `satisfies`, by `apply … to … except …`, or by the claims' own subjects.

One invariant: a node has one set of arguments of a parameterised requirement, that of the most specific application; if
two are equally specific and differ, a problem reports it and neither counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final, TypeVar

from btq_lang.catalog.name_kinds import Kind
from btq_lang.diagnostics.model import Diagnostic, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements import model, nodes
from btq_lang.requirements.applied import Applied, Attachment, ResolvedArgument, Trace
from btq_lang.requirements.definitions import requirement
from btq_lang.requirements.paths import Problem
from btq_lang.requirements.reader import Problems, Reader
from btq_lang.syntax import tree as syntax
from btq_lang.util.record import Record, fields_of, replace
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode, tree_nodes
from btq_lang.workspace.symbols import requirements_at
from btq_lang.workspace.workspace import Workspace

T = TypeVar("T")


class Attached(Record):
    """What applies to nodes by attachment.

    Attributes:
        traces: `satisfies` at nodes, for requirements whose claims all name their own subjects.
    """

    applied: tuple[Applied, ...] = ()
    traces: tuple[Trace, ...] = ()
    problems: Problems = ()


# ---- what an item attaches ----


def uses_in(
    store: Store[Workspace], viewpoint: str, path: str, facts: Facts
) -> tuple[tuple[Attachment, ...], Problems]:
    """What a tree or an `apply` attaches to which nodes, and what is wrong with that."""
    reader = Reader(store, viewpoint, path, facts)
    item = facts.item
    attachments = _at_nodes(reader, item) if isinstance(item, syntax.Tree) else ()
    return tuple(_applied_by(reader, item) if isinstance(item, syntax.Apply) else attachments), reader.problems


def attached_names(store: Store[Workspace], viewpoint: str) -> frozenset[str]:
    """The names of the requirements that anything in scope attaches, understood or not."""
    names: set[str] = set()
    for _, facts in store.ask(inputs.attaching, viewpoint):
        names.update(facts.used.get(Kind.REQUIREMENT, ()))
        names.update([symbol.name for symbol in facts.summary.symbols if symbol.kind is Kind.REQUIREMENT])
    return frozenset(names)


# ---- what applies to the nodes of a tree ----


def applied_in(store: Store[Workspace], viewpoint: str, path: str, facts: Facts) -> Attached:
    """What applies to nodes of a tree, in the order of the requirements; a span by the node that it begins at."""
    by_name: dict[str, tuple[list[Applied], list[Attachment]]] = {}
    for applied in store.ask(_claimed_in, viewpoint, facts):
        by_name.setdefault(applied.requirement.name, ([], []))[0].append(applied)
    for use in uses_of_nodes(store, viewpoint, path, facts):
        by_name.setdefault(use.requirement, ([], []))[1].append(use)
    if not by_name:
        return _NOTHING
    names = [*by_name]
    if len(names) > 1:
        names.sort(key=store.ask(_order, viewpoint).__getitem__)
    all_applied: list[Applied] = []
    traces: list[Trace] = []
    problems: list[Problem] = []
    for name in names:
        claimed, uses = by_name[name]
        attached = attached_by(store, viewpoint, name, uses)
        all_applied += (*claimed, *attached.applied)
        traces += attached.traces
        problems += attached.problems
    return Attached(tuple(all_applied), tuple(traces), tuple(problems))


def attached_by(store: Store[Workspace], viewpoint: str, name: str, uses: Sequence[Attachment]) -> Attached:
    """What a requirement applies to by some of its attachments: all of those to certain nodes."""
    resolved, _ = store.ask(requirement, viewpoint, name)
    if not uses or resolved is None:
        return _NOTHING
    indices = tuple([index for index, claim in enumerate(resolved.claims) if claim.subject is None])
    counting, problems = _most_specific(resolved, uses)
    if resolved.claims and not indices:
        return Attached(traces=tuple([Trace(name, use.target.node) for use in counting]), problems=problems)
    filled = [(use, _with(store, viewpoint, resolved, indices, use.arguments)) for use in counting]
    applied = [Applied(part, use.target, use.arguments, use.place, use.how) for use, part in filled]
    return Attached(tuple(applied), problems=problems)


def uses_of_nodes(store: Store[Workspace], viewpoint: str, path: str, facts: Facts) -> Iterable[Attachment]:
    """The attachments to nodes of a tree, in the order of the items that make them."""
    own, _ = store.ask(uses_in, viewpoint, path, facts)
    by_apply = store.ask(_attached_by_apply, viewpoint, facts) if store.ask(inputs.applies, viewpoint) else ()
    if not own or not by_apply:
        return own or by_apply
    order = {id(each.item): index for index, (_, each) in enumerate(store.ask(inputs.attaching, viewpoint))}
    return sorted((*own, *by_apply), key=lambda use: order[id(use.place.anchor)])


def _attached_by_apply(store: Store[Workspace], viewpoint: str, facts: Facts) -> tuple[Attachment, ...]:
    """What `apply` items attach to nodes of a tree."""
    return store.ask(_attached_by_applies, viewpoint).get(facts, ())


def _attached_by_applies(store: Store[Workspace], viewpoint: str) -> dict[Facts, tuple[Attachment, ...]]:
    uses = [use for each in store.ask(inputs.applies, viewpoint) for use in store.ask(uses_in, viewpoint, *each)[0]]
    return _by_tree((use.target.node.facts, use) for use in uses)


# ---- claims with a subject of their own ----


def claimed(store: Store[Workspace], viewpoint: str, name: str) -> tuple[Applied, ...]:
    """What the claims of a requirement with subjects of their own apply to."""
    if name not in store.ask(inputs.claiming, viewpoint):
        return ()
    of_name, _ = store.ask(requirement, viewpoint, name)
    return tuple(by_subject(store, viewpoint, of_name)) if of_name is not None else ()


def claimed_of_no_tree(store: Store[Workspace], viewpoint: str, name: str) -> tuple[Applied, ...]:
    """What `claimed` returns for subjects that are in no tree: sums, and spans that do not begin with a node."""
    return tuple([each for each in store.ask(claimed, viewpoint, name) if _home(each) is None])


def _claimed_in(store: Store[Workspace], viewpoint: str, facts: Facts) -> tuple[Applied, ...]:
    return store.ask(_claimed_by_tree, viewpoint).get(facts, ())


def _claimed_by_tree(store: Store[Workspace], viewpoint: str) -> dict[Facts, tuple[Applied, ...]]:
    names = store.ask(inputs.claiming, viewpoint)
    pairs = [(_home(each), each) for name in names for each in store.ask(claimed, viewpoint, name)]
    return _by_tree((home, each) for home, each in pairs if home is not None)


def _by_tree(pairs: Iterable[tuple[Facts, T]]) -> dict[Facts, tuple[T, ...]]:
    lists: dict[Facts, list[T]] = {}
    for facts, value in pairs:
        lists.setdefault(facts, []).append(value)
    return {facts: tuple(value) for facts, value in lists.items()}


def _home(applied: Applied) -> Facts | None:
    """The tree that a subject is in, or that a span or an event begins in."""
    subjects = [applied.subject if isinstance(applied.subject, model.NodeTarget | model.MissionRun) else None]
    for first in model.events_of(applied.subject)[:1]:
        subjects = [atom.subject for atom in first.atoms]
    return next((each.node.facts for each in subjects if each is not None and each.node is not None), None)


def _order(store: Store[Workspace], viewpoint: str) -> dict[str, int]:
    """The index of each requirement in their order."""
    return {name: index for index, name in enumerate(store.ask(inputs.names, viewpoint, Kind.REQUIREMENT))}


# ---- a requirement with arguments ----


def _with(
    store: Store[Workspace],
    viewpoint: str,
    resolved: model.ResolvedRequirement,
    indices: tuple[int, ...],
    arguments: tuple[ResolvedArgument, ...],
) -> model.ResolvedRequirement:
    """A requirement with some of its claims, and with arguments in place of its parameters; cached, for most nodes get
    the same one."""
    if not arguments and len(indices) == len(resolved.claims):
        return resolved
    return store.ask(_filled, viewpoint, resolved.name, indices, arguments)


def _filled(
    store: Store[Workspace],
    viewpoint: str,
    name: str,
    indices: tuple[int, ...],
    arguments: tuple[ResolvedArgument, ...],
) -> model.ResolvedRequirement:
    resolved, _ = store.ask(requirement, viewpoint, name)
    assert resolved is not None, "the caller has resolved it"
    claims = tuple([resolved.claims[index] for index in indices if index < len(resolved.claims)])
    filled = _filled_part(replace(resolved, claims=claims), {each.name: each.value for each in arguments})
    assert isinstance(filled, model.ResolvedRequirement), "a part is filled with a part of its kind"
    return replace(filled, parameters=resolved.parameters)


def _filled_part(part: object, values: dict[str, model.Bounded]) -> object:
    if isinstance(part, model.ResolvedParameter):
        return values.get(part.name, part)
    if isinstance(part, tuple):
        return tuple([_filled_part(each, values) for each in part])
    if type(part).__module__ != model.__name__ or isinstance(part, model.InContext):
        return part  # a context has no parameters
    fields = fields_of(part)
    if "signal" in fields and "verb" not in fields:
        return part  # a signal has no parameters, and may be large
    changes = {}
    for field in fields:
        old = getattr(part, field)
        new = _filled_part(old, values)
        if new is not old and new != old:
            changes[field] = new
    return replace(part, **changes) if changes else part


def by_subject(store: Store[Workspace], viewpoint: str, resolved: model.ResolvedRequirement) -> Iterator[Applied]:
    """A claim's own subject takes precedence over what the requirement is attached to."""
    arguments = tuple(
        ResolvedArgument(parameter.name, parameter.default)
        for parameter in resolved.parameters
        if parameter.default is not None
    )
    if len(arguments) < len(resolved.parameters):
        return
    groups: dict[object, tuple[model.Subject, list[int]]] = {}
    for index, claim in enumerate(resolved.claims):
        subject = claim.subject
        if isinstance(subject, model.EveryNode):
            for node in store.ask(nodes.every, viewpoint, subject.name):
                groups.setdefault(id(node), (model.NodeTarget(node), []))[1].append(index)
        elif isinstance(subject, model.NodeTarget) and not subject.through:
            groups.setdefault(id(subject.node), (subject, []))[1].append(index)
        elif subject is not None:
            groups.setdefault(subject, (subject, []))[1].append(index)
    for subject, indices in groups.values():
        restricted = _with(store, viewpoint, resolved, tuple(indices), arguments)
        place = resolved.claims[indices[0]].place
        yield Applied(restricted, subject, arguments, place, "subject")  # type: ignore[arg-type]  # no Every is left


def _at_nodes(reader: Reader, tree: syntax.Tree) -> Iterator[Attachment]:
    of_tree = reader.store.ask(tree_nodes, reader.viewpoint, reader.path, reader.facts)
    places: list[tuple[ResolvedNode | None, tuple[syntax.NodeClause, ...]]] = [(of_tree.root, tree.clauses)]
    places += [(node, node.node.clauses) for node in of_tree.all if node.node.clauses]
    for node, clauses in places:
        for written in requirements_at(clauses):
            word = written.name
            resolved = _requirement(reader, word.text) if word is not None else None
            if word is None or resolved is None:
                continue
            arguments = _arguments(reader, resolved, written, word.span)
            if arguments is not None and node is not None:
                place = reader.place(word.span)
                yield Attachment(resolved.name, model.NodeTarget(node), arguments, _AT_NODE, "satisfies", place)


def _applied_by(reader: Reader, apply: syntax.Apply) -> Iterator[Attachment]:
    targets = [selected for selector in apply.targets for selected in _selected(reader, selector)]
    excepted = _excepted(reader, apply, {id(target.node) for target, _ in targets})
    for reference in apply.uses:
        resolved = _requirement(reader, reference.name.text)
        arguments = _arguments(reader, resolved, reference, reference.name.span) if resolved is not None else None
        if resolved is None or arguments is None:
            continue
        place = reader.place(reference.name.span)
        for target, rank in targets:
            if id(target.node) not in excepted:
                yield Attachment(resolved.name, target, arguments, rank, "apply", place)


def _requirement(reader: Reader, name: str) -> model.ResolvedRequirement | None:
    return reader.store.ask(requirement, reader.viewpoint, name)[0]


def _excepted(reader: Reader, apply: syntax.Apply, applied_to: set[int]) -> set[int]:
    """The nodes after `except`; a selector's should be among those that the requirement is applied to."""
    excepted: set[int] = set()
    for selector in apply.exceptions:
        named = {id(target.node) for target, _ in _selected(reader, selector)}
        if named and applied_to and named.isdisjoint(applied_to) and reader.knows_all_nodes:
            message = "`except` has no effect: the selector does not match any of these nodes"
            span = Span(selector.start, selector.end)
            reader.complain("unmatched-path", span, message, severity=Severity.WARNING)
        excepted |= named
    return excepted


def _selected(reader: Reader, selector: syntax.Selector) -> Iterator[tuple[model.NodeTarget, int]]:
    """The nodes of a selector, and how specific it is."""
    if selector.tag is not None:
        matching = reader.store.ask(nodes.tagged, reader.viewpoint, selector.tag.text)
        if not matching:
            reader.report_unknown_tag(selector.tag)
        yield from ((model.NodeTarget(node), _EVERY) for node in matching)
    elif selector.every is not None:
        matching = reader.store.ask(nodes.every, reader.viewpoint, selector.every.text)
        if not matching:
            reader.report_unknown_kind(selector.every)
        rank = _EVERY
        if selector.path is not None:
            top = reader.target(selector.path)
            below = reader.store.ask(nodes.every_under, reader.viewpoint, selector.every.text, top) if top else ()
            if matching and top is not None and not below and reader.knows_all_nodes:
                shown = "/".join(name.text for name in selector.path.names)
                message = f"no node matches `every {selector.every.raw}` below `{shown}`"
                reader.complain("unmatched-path", selector.every.span, message)
            matching, rank = below, _EVERY_UNDER
        yield from ((model.NodeTarget(node), rank) for node in matching)
    elif selector.path is not None:
        target = reader.target(selector.path)
        if target is not None:
            yield target, _PATH


def _arguments(
    reader: Reader, resolved: model.ResolvedRequirement, written: syntax.Requirement | syntax.ReqRef, span: Span
) -> tuple[ResolvedArgument, ...] | None:
    """The values of the parameters; None if one is missing or wrong, which is reported."""
    by_name: dict[str, model.Bounded] = {}
    complete = True
    parameters = {parameter.name: parameter for parameter in resolved.parameters}
    for argument in written.arguments if isinstance(written, syntax.ReqRef) else ():
        parameter = parameters.get(argument.name.text)
        if parameter is None:
            _no_parameter(reader, resolved, argument)
            complete = False
        elif argument.value is not None and (value := reader.argument(parameter, argument.value)) is not None:
            by_name.setdefault(parameter.name, value)
        else:
            complete = False
    missing = [each.name for each in resolved.parameters if each.name not in by_name and each.default is None]
    if missing and complete:
        names = " and ".join(f"`{name}`" for name in missing)
        related = (Related(resolved.place, "defined here"),)
        example = ", ".join(f"{name} = …" for name in missing)
        message = f"`{resolved.name}` requires a value for {names}"
        notes = (f"write `{resolved.name}({example})`, or add a default to its definition",)
        reader.complain("wrong-argument", span, message, related=related, notes=notes)
    if missing or not complete:
        return None
    values = ((each.name, by_name.get(each.name, each.default)) for each in resolved.parameters)
    return tuple(ResolvedArgument(name, value) for name, value in values if value is not None)


def _no_parameter(reader: Reader, resolved: model.ResolvedRequirement, argument: syntax.Argument) -> None:
    word: syntax.Word = argument.name
    names = [parameter.name for parameter in resolved.parameters]
    likely = [name for name in near(word.text, names) if syntax.is_name(name)]
    fixes = tuple(replace_fix(f"Replace `{word.text}` with `{name}`", word.span, name) for name in likely)
    notes = (f"its parameters: {', '.join(f'`{name}`' for name in names)}",) if names else ("it has no parameters",)
    message = f"`{resolved.name}` has no parameter `{word.text}`{did_you_mean(likely)}"
    related = (Related(resolved.place, "defined here"),)
    reader.complain("wrong-argument", word.span, message, related=related, notes=notes, fixes=fixes)


def _most_specific(
    resolved: model.ResolvedRequirement, uses: Sequence[Attachment]
) -> tuple[list[Attachment], Problems]:
    """One use for each node, or for each way that a path leads to it; and the problems where equally specific ones
    differ."""
    counting: list[Attachment] = []
    problems: list[Problem] = []
    of_node: dict[tuple[int, tuple[str, ...]], list[Attachment]] = {}
    for use in uses:
        of_node.setdefault((id(use.target.node), use.target.through), []).append(use)
    for same in of_node.values():
        rank = max(use.rank for use in same)
        best = [use for use in same if use.rank == rank]
        other = next((use for use in best if _values(use) != _values(best[0])), None)
        if other is None:
            counting.append(best[0])
            continue
        node = best[0].target.node
        values = f"{_shown_arguments(best[0])} and {_shown_arguments(other)}"
        message = f"`{resolved.name}` has two values for {node.shown}: {values}"
        related = (Related(best[0].place, "other value"), Related(node.place, "node"))
        notes = ("a clause at the node takes precedence over a path, a path over `every … under`, that over `every`",)
        diagnostic = Diagnostic("ambiguous-application", other.place.span, message, related, notes)
        problems.append(Problem(other.place, diagnostic))
    return counting, tuple(problems)


def _values(use: Attachment) -> tuple[object, ...]:
    """Equal for arguments that mean the same, however they are written."""
    return tuple(getattr(argument.value, "si", argument.value) for argument in use.arguments)


def _shown_arguments(use: Attachment) -> str:
    return ", ".join(f"{argument.name} = {argument.value.text}" for argument in use.arguments)


_AT_NODE: Final = 4
_PATH: Final = 3
_EVERY_UNDER: Final = 2
_EVERY: Final = 1
_NOTHING: Final = Attached()
