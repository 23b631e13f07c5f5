"""What requirements mean: their clauses resolved, with units, subjects and scopes.

One invariant: the answer is a function of the workspace and of the file at whose scope it looks.  It does not know what
the engine can enforce, nor what a run of the robot was like.

    requirements(workspace, path)   all of a file and what it includes
    model.py     what a requirement says once its words are resolved
    names.py     by which names a written node is found
    trees.py     the nodes of one tree
    nodes.py     which written nodes a path, a kind or a tag means
    memory.py    what is kept from one edit to the next
    paths.py     the one node that a path names
    reader.py    values and conditions: names, units, what compares with what
    clauses.py   what each verb asks for
    classic.py   SuccessIf and FailureIf in classic descriptions
    attach.py    which requirement holds for which node
    durations.py, composition.py, budgets.py   how long nodes take when all that is demanded below them holds
    spans.py     the node whose time a span is
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from operator import is_

from btq_lang.file import File
from btq_lang.record import Record
from btq_lang.requirements.attach import Held, Uses, held_by, uses_in
from btq_lang.requirements.clauses import read_signal, resolve
from btq_lang.requirements.memory import Memory, Table
from btq_lang.requirements.model import Applied, Claim, Condition, Requirement, Signal, SourceNode, Trace, Use
from btq_lang.requirements.nodes import Nodes
from btq_lang.requirements.paths import Problem
from btq_lang.requirements.reader import Reader
from btq_lang.requirements.trees import TreeNodes
from btq_lang.symbols import Kind, Symbol
from btq_lang.syntax import Apply, Context, Operand, Tree, walk
from btq_lang.syntax import Requirement as WrittenRequirement
from btq_lang.syntax import Signal as WrittenSignal
from btq_lang.tokens import NAME
from btq_lang.workspace import Workspace

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Any, Final, TypeAlias

_About: TypeAlias = "tuple[object, object, tuple[object, ...]]"

__all__ = ["Memory", "Problem", "Requirements", "requirements"]


class Requirements(Record):
    """All requirements that a file sees.

    Attributes:
        signals: by name.
        contexts: by name; None: it could not be understood.
        all: every requirement by name, in the order of their definitions, parameters in it.
        applied: what holds for what, with arguments.
        traces: `satisfies` at a node of a requirement whose claims name their subjects themselves.
        attached: names of requirements that a node or an `apply` refers to.
        problems: everything that was not understood.
        nodes: the written nodes.
        mission: the main tree's root; None where nobody can say which tree runs.
        by_tree: what is applied to nodes, by the tree that they stand in; a span, too, by the node that it begins at.
    """

    signals: dict[str, Signal]
    contexts: dict[str, Condition | None]
    all: dict[str, Requirement]
    applied: tuple[Applied, ...]
    traces: tuple[Trace, ...]
    attached: frozenset[str]
    problems: tuple[Problem, ...]
    nodes: Nodes
    mission: SourceNode | None
    by_tree: dict[int, tuple[Applied, ...]]

    def in_tree(self, tree: TreeNodes) -> tuple[Applied, ...]:
        """What holds for nodes of a tree, in the order of the requirements."""
        return self.by_tree.get(id(tree.item), ())

    def of(self, node: SourceNode) -> tuple[Applied, ...]:
        """What holds for a node."""
        return tuple(each for each in self.applied if each.node is node)

    def about_no_node(self) -> tuple[tuple[Requirement, Claim], ...]:
        """The claims that hold for nothing, of requirements that hold for something by their other claims; a
        requirement that holds for nothing at all is not used, which is another matter."""
        used = {each.requirement.name for each in self.applied}
        # Claims of one text have one subject, or none.
        held = {(each.requirement.name, claim.text) for each in self.applied for claim in each.requirement.claims}
        return tuple(
            (requirement, claim)
            for requirement in self.all.values()
            if requirement.name in used
            for claim in requirement.claims
            if (requirement.name, claim.text) not in held
        )


def requirements(workspace: Workspace, path: str, memory: Memory | None = None) -> Requirements:
    """The requirements of a file and what it includes, resolved.

    Args:
        memory: what was resolved for the same file before some edits: only what these touch is resolved again.

    Raises:
        KeyError: there is no such file.
    """
    memory = memory or Memory()
    memory.begin()
    scope = workspace.scope(path)
    nodes = memory.nodes = Nodes(workspace, scope, memory.nodes)
    reader = Reader(workspace, path, scope, nodes)
    files = [workspace.files[each] for each in scope.paths]
    problems: list[Problem] = []
    for file, symbol in _counting(files, Kind.SIGNAL):
        table = memory.table(f"signal {symbol.name}", reader)
        known = table.take(symbol) or _make(table, symbol, None, _read_signal, reader, file, symbol)
        reader.signals[symbol.name] = known[0]
        problems += known[1]
    for file, symbol, mistake in _ordered_contexts(reader, files):
        table = memory.table(f"context {symbol.name}", reader)
        known = table.take(symbol, mistake) or _make(
            table, symbol, mistake, _read_context, reader, file, symbol, mistake
        )
        reader.contexts[symbol.name] = known[0]
        problems += known[1]
    qualities = {key: quality for tree in nodes.trees if tree.qualities for key, quality in tree.qualities.items()}
    table = memory.table("requirements", reader)
    defined = _counting(files, Kind.REQUIREMENT)
    enclosing = [qualities.get(id(symbol.target)) for _, symbol in defined]
    about: list[_About] = [
        (symbol, quality, (file, symbol, quality)) for (file, symbol), quality in zip(defined, enclosing, strict=True)
    ]
    read = _all(table, reader, _read_requirement, about)
    reader.requirements.update(
        {symbol.name: requirement for (_, symbol), (requirement, _) in zip(defined, read, strict=True)}
    )
    problems += [problem for _, told in read for problem in told]
    about = [
        (entry.item, nodes.within(entry.item) if type(entry.item) is Tree else None, (file.path, entry))
        for file in files
        for entry in file.parsed.entries
        if type(entry.item) is Tree or type(entry.item) is Apply
    ]
    attached = _all(memory.table("uses", reader), reader, uses_in, about)
    found: list[Uses] = [uses for uses, _ in attached]
    problems += [problem for _, told in attached for problem in told]
    of_each = _by_requirement(found, memory)
    table = memory.table("held", reader)
    pairs = [(each, of_each.get(name, ())) for name, each in reader.requirements.items()]
    holding = _all(table, reader, _held_by, [(each, uses, (table, each, uses)) for each, uses in pairs])
    problems += [problem for _, told in holding for problem in told]
    applied: list[Applied] = []
    by_tree: dict[int, list[Applied]] = {}
    traces: list[Trace] = []
    for held, _ in holding:
        applied += held.applied
        traces += held.traces
        for tree, each in held.by_tree:
            by_tree.setdefault(tree, []).append(each)
    return Requirements(
        reader.signals,
        reader.contexts,
        reader.requirements,
        tuple(applied),
        tuple(traces),
        frozenset().union(*(each.mentioned for each in found)),
        tuple(problems),
        nodes,
        reader.mission,
        _as_before(by_tree, memory),
    )


def _make(
    table: Table, owner: object, made_of: object, make: Callable[..., object], reader: Reader, *about: object
) -> tuple[Any, tuple[Problem, ...]]:
    """What is made for an owner, with the problems that are found meanwhile; it is kept."""
    reader.problems = {}
    made = make(reader, *about)
    return table.put(owner, made_of, (made, tuple(reader.problems.values())))


def _all(
    table: Table, reader: Reader, make: Callable[..., object], wanted: list[_About]
) -> list[tuple[Any, tuple[Problem, ...]]]:
    """What a table has, made where it is another one than before.

    Args:
        wanted: each owner, what else it is made of, and with what `make` is called behind the reader.
    """
    found = table.take_all([owner for owner, _, _ in wanted], [made_of for _, made_of, _ in wanted])
    for index, known in enumerate(found):
        if known is None:
            owner, made_of, about = wanted[index]
            found[index] = table.take(owner, made_of) or _make(table, owner, made_of, make, reader, *about)
    return found


def _read_signal(reader: Reader, file: File, symbol: Symbol) -> Signal:
    (definition, *_others) = file.definitions(Kind.SIGNAL, symbol.name)
    assert isinstance(symbol.target, WrittenSignal), "its kind says so"
    return read_signal(reader, definition, symbol.target)


def _read_context(reader: Reader, file: File, symbol: Symbol, mistake: tuple[str, str] | None) -> Condition | None:
    """mistake: a rule, and what it tells of the context instead of what that says."""
    (definition, *_others) = file.definitions(Kind.CONTEXT, symbol.name)
    assert isinstance(symbol.target, Context), "its kind says so"
    reader.begin(definition.path, definition.entry)
    if mistake is None:
        return reader.condition(symbol.target.condition)
    reader.complain(mistake[0], symbol.span, mistake[1])
    return None


def _read_requirement(reader: Reader, file: File, symbol: Symbol, quality: str | None) -> Requirement:
    """quality: the one that encloses it."""
    (definition, *_others) = file.definitions(Kind.REQUIREMENT, symbol.name)
    written = symbol.target
    assert isinstance(written, WrittenRequirement), "its kind says so"
    requirement = resolve(reader, definition, written, quality)
    if written.clauses or written.text is None:
        return requirement
    from btq_lang.requirements.classic import with_constraints  # a requirement that has clauses needs none of it

    return with_constraints(reader, requirement, written.text)


def _held_by(reader: Reader, table: Table, requirement: Requirement, uses: tuple[Use, ...]) -> Held:
    return held_by(reader, requirement, uses, table.before(requirement))


def _by_requirement(found: list[Uses], memory: Memory) -> dict[str, tuple[Use, ...]]:
    """What entries attach, by the requirement: the same objects as before where they are of the same."""
    entries, known = memory.uses
    if len(found) == len(entries):
        pairs = [(one, other) for one, other in zip(found, entries, strict=True) if one is not other]
        others = {name for pair in pairs for each in pair for name in each.mentioned}
        uses = {name: each for name, each in known.items() if name not in others} if others else known
    else:
        others, uses = None, {}
    if others is None or others:
        lists: dict[str, list[Use]] = {}
        for each in found:
            if each.found and (others is None or not others.isdisjoint(each.mentioned)):
                for use in each.found:
                    if others is None or use.requirement in others:
                        lists.setdefault(use.requirement, []).append(use)
        uses.update({name: tuple(each) for name, each in lists.items()})
    memory.uses = found, uses
    return uses


def _as_before(by_tree: dict[int, list[Applied]], memory: Memory) -> dict[int, tuple[Applied, ...]]:
    """What holds for nodes of each tree: the same objects as before where it is the same."""
    known = memory.by_tree
    memory.by_tree = {
        tree: old
        if (old := known.get(tree)) is not None and len(old) == len(each) and all(map(is_, old, each))
        else tuple(each)
        for tree, each in by_tree.items()
    }
    return memory.by_tree


def _counting(files: Iterable[File], kind: Kind) -> list[tuple[File, Symbol]]:
    """The definitions that count, of names of a kind: the first one of each."""
    found: dict[str, tuple[File, Symbol]] = {}
    for file in files:
        known = file.names.found
        for name in file.names.by_kind[kind]:
            if name not in found:
                found[name] = file, known[kind, name][0][1]
    return [*found.values()]


def _ordered_contexts(reader: Reader, files: Iterable[File]) -> Iterator[tuple[File, Symbol, tuple[str, str] | None]]:
    """Those that a context speaks of come before it; one that speaks of itself means nothing, and comes with what is
    told of it."""
    written = {symbol.name: (file, symbol) for file, symbol in _counting(files, Kind.CONTEXT)}
    depth: dict[str, int] = {}
    open_: list[str] = []
    waiting = list(reversed(written))
    reader.contexts.update(dict.fromkeys(written))
    while waiting:
        name = waiting[-1]
        file, symbol = written[name]
        if name in depth or not isinstance(symbol.target, Context):
            waiting.pop()
            continue
        needed = [word for word in _names_in(symbol.target) if word in written]
        missing = [word for word in needed if word not in depth and word not in open_]
        if missing and name not in open_:
            open_.append(name)
            waiting += reversed(missing)
            continue
        waiting.pop()
        if name in open_:
            open_.remove(name)
        depth[name] = 1 + max((depth[word] for word in needed if word in depth), default=0)
        mistake = None
        if any(word not in depth or word == name for word in needed):
            mistake = "cyclic-context", f"the context `{name}` speaks of itself"
        elif depth[name] > _DEEPEST:
            mistake = "nested-too-deep", f"more than {_DEEPEST} contexts that speak of each other"
        yield file, symbol, mistake


def _names_in(context: Context) -> list[str]:
    operands = (part.word for part in walk(context.condition) if isinstance(part, Operand))
    return [word.text for word in operands if word.kind == NAME]


_DEEPEST: Final = 50  # contexts in contexts: a condition is a tree, and every reader walks it
