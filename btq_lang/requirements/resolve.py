"""All requirements of a file and of what it includes, resolved."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.requirements.attach import Held, Uses, held_by, uses_in
from btq_lang.requirements.clauses import read_signal, resolve
from btq_lang.requirements.memory import Memory, Table
from btq_lang.requirements.nodes import Nodes
from btq_lang.requirements.paths import Problem
from btq_lang.requirements.reader import Reader
from btq_lang.requirements.resolved import Requirements
from btq_lang.syntax.tokens import NAME
from btq_lang.syntax.tree import Apply, Context, Operand, Tree, walk
from btq_lang.syntax.tree import Requirement as WrittenRequirement
from btq_lang.syntax.tree import Signal as WrittenSignal
from btq_lang.workspace.symbols import Symbol

if TYPE_CHECKING:
    from btq_lang.requirements.model import Applied, Condition, Requirement, Signal, Use
    from btq_lang.requirements.trees import TreeNodes
    from btq_lang.workspace.file import File
    from btq_lang.workspace.workspace import Workspace


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
    before = memory.nodes
    nodes = memory.nodes = Nodes(workspace, scope, before)
    reader = Reader(workspace, path, scope, nodes)
    files = [workspace.files[each] for each in scope.paths]
    problems: list[Problem] = []
    for file, symbol in _counting(files, Kind.SIGNAL):
        table = memory.table(f"signal {symbol.name}", reader)
        reader.signals[symbol.name], told = _one(table, reader, symbol, None, _read_signal, file, symbol)
        problems += told
    for file, symbol, mistake in _ordered_contexts(reader, files):
        table = memory.table(f"context {symbol.name}", reader)
        reader.contexts[symbol.name], told = _one(table, reader, symbol, mistake, _read_context, file, symbol, mistake)
        problems += told
    symbols, homes = memory.once(
        "symbols", (*scope.paths, *[file.names.symbols[Kind.REQUIREMENT] for file in files]), lambda: _homes(files)
    )
    enclosing = memory.once(
        "enclosing", (symbols, nodes.qualities), lambda: [nodes.qualities.get(id(symbol.target)) for symbol in symbols]
    )
    table = memory.table("requirements", reader)
    read = _all(
        table,
        reader,
        symbols,
        enclosing,
        lambda at: _read_requirement(reader, workspace.files[homes[at]], symbols[at], enclosing[at]),
    )
    if table.others is not None:
        gone = [*memory.requirements]  # in the order of the table, which has as many
        reader.news["requirement"] = frozenset([name for at in table.others for name in (gone[at], symbols[at].name)])
    if not table.is_as_before:
        names = [symbol.name for symbol in symbols]
        memory.requirements = dict(zip(names, [each for each, _ in read], strict=True))
    reader.requirements.update(memory.requirements)
    problems += _told(memory, "requirements", table, read)
    items: Sequence[Tree | Apply] = nodes.items
    within: Sequence[TreeNodes | None] = nodes.trees
    if any(file.of_type(Apply) for file in files):
        entries = [entry.item for file in files for entry in file.parsed.entries]
        items = [item for item in entries if type(item) is Tree or type(item) is Apply]
        within = [nodes.within(item) if type(item) is Tree else None for item in items]
    table = memory.table("uses", reader)
    attached = _all(table, reader, items, within, lambda at: _uses_in(reader, files, items[at]))
    uses, mentioned = _by_requirement(attached, table.others, memory)
    problems += _told(memory, "uses", table, attached)
    wanted = memory.once("wanted", (memory.requirements,), lambda: [*memory.requirements.values()])
    of_each = memory.once("uses", (wanted, uses), lambda: [uses.get(name, ()) for name in memory.requirements])
    table = memory.table("held", reader)
    holding = _all(
        table, reader, wanted, of_each, lambda at: held_by(reader, wanted[at], of_each[at], table.before(at))
    )
    problems += _told(memory, "held", table, holding)
    held = memory.held if table.is_as_before else [each for each, _ in holding]
    by_tree = _by_tree(held, table.others, memory)
    if before is not None:
        nodes.let_go(before)
    return Requirements(
        reader.signals,
        reader.contexts,
        reader.requirements,
        held,
        mentioned,
        tuple(problems),
        nodes,
        reader.mission,
        by_tree,
    )


def _all(
    table: Table, reader: Reader, owners: Sequence[object], made_of: Sequence[object], make: Callable[[int], object]
) -> list[tuple[Any, tuple[Problem, ...]]]:
    """As the table's `all`, each with the problems that are found meanwhile."""

    def made(at: int) -> tuple[object, tuple[Problem, ...]]:
        reader.problems = {}
        found = make(at)
        return found, tuple(reader.problems.values())

    return table.all(owners, made_of, made)


def _one(
    table: Table, reader: Reader, owner: object, made_of: object, make: Callable[..., object], *about: object
) -> tuple[Any, tuple[Problem, ...]]:
    """The same of a table for one owner; `make` takes more than the reader."""
    return _all(table, reader, (owner,), (made_of,), lambda _: make(reader, *about))[0]


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


def _told(memory: Memory, name: str, table: Table, rows: list[tuple[Any, tuple[Problem, ...]]]) -> tuple[Problem, ...]:
    """The problems of a table, by its name."""
    if not table.is_as_before:
        memory.problems[name] = tuple([problem for _, told in rows if told for problem in told])
    return memory.problems[name]


def _uses_in(reader: Reader, files: Sequence[File], item: Tree | Apply) -> Uses:
    """What one of the items attaches."""
    file = next(file for file in files if id(item) in file.facts)
    return uses_in(reader, file.path, file.entry_of(item))


def _by_requirement(
    attached: list[tuple[Uses, tuple[Problem, ...]]], others_at: list[int] | None, memory: Memory
) -> tuple[dict[str, tuple[Use, ...]], frozenset[str]]:
    """What entries attach, by the requirement, and which are mentioned: the same objects as before where they are of
    the same.

    Args:
        others_at: where other entries attach something than before; None: nobody knows.
    """
    entries, uses, mentioned = memory.uses
    is_as_long = others_at is not None and len(attached) == len(entries)
    found = [*entries] if is_as_long else [each for each, _ in attached]
    pairs: list[tuple[Uses, Uses]] = []
    for at in others_at if others_at is not None and is_as_long else ():
        found[at] = attached[at][0]
        pairs.append((found[at], entries[at]))
    others = {name for pair in pairs for each in pair for name in each.mentioned}
    if others or not is_as_long:
        lists: dict[str, list[Use]] = {}
        for each in found:
            if each.found and not (is_as_long and others.isdisjoint(each.mentioned)):
                for use in each.found:
                    if not is_as_long or use.requirement in others:
                        lists.setdefault(use.requirement, []).append(use)
        kept = {name: each for name, each in uses.items() if name not in others} if is_as_long else {}
        uses = kept | {name: tuple(each) for name, each in lists.items()}
    if not is_as_long or any(one.mentioned != other.mentioned for one, other in pairs):
        mentioned = frozenset().union(*[each.mentioned for each in found])
    memory.uses = found, uses, mentioned
    return uses, mentioned


def _by_tree(held: list[Held], others: list[int] | None, memory: Memory) -> dict[int, tuple[Applied, ...]]:
    """What holds for nodes of each tree: the same objects as before where it is the same.

    Args:
        others: the requirements that hold for something else than before; None: nobody knows.
    """
    before, known = memory.held, memory.by_tree
    touched: set[int] = set()
    for at in others or ():
        then, now = [{(tree, id(each)) for tree, each in one.by_tree} for one in (before[at], held[at])]
        touched.update([tree for tree, _ in then ^ now])
    lists: dict[int, list[Applied]] = {}
    for each in held if others is None or touched else ():
        for tree, applied in each.by_tree:
            if others is None or tree in touched:
                lists.setdefault(tree, []).append(applied)
    found = {
        tree: old if (old := known.get(tree)) is not None and [*map(id, old)] == [*map(id, each)] else tuple(each)
        for tree, each in lists.items()
    }
    if others is not None:
        found = {tree: each for tree, each in known.items() if tree not in touched} | found if touched else known
    memory.held, memory.by_tree = held, found
    memory.touched = frozenset(touched) if others is not None else None
    return found


def _counting(files: Sequence[File], kind: Kind) -> list[tuple[File, Symbol]]:
    """The definitions that count, of names of a kind: the first one of each."""
    if len(files) == 1:
        return [(files[0], symbol) for symbol in files[0].names.symbols[kind]]
    found: dict[str, tuple[File, Symbol]] = {}
    for file in files:
        for symbol in file.names.symbols[kind]:
            found.setdefault(symbol.name, (file, symbol))
    return [*found.values()]


def _homes(files: Sequence[File]) -> tuple[list[Symbol], list[str]]:
    """The requirements that count, and the files that each of them stands in."""
    if len(files) == 1:
        symbols = files[0].names.symbols[Kind.REQUIREMENT]
        return [*symbols], [files[0].path] * len(symbols)
    defined = _counting(files, Kind.REQUIREMENT)
    return [symbol for _, symbol in defined], [file.path for file, _ in defined]


def _ordered_contexts(reader: Reader, files: Sequence[File]) -> Iterator[tuple[File, Symbol, tuple[str, str] | None]]:
    """Contexts that a context mentions come before it; one that mentions itself means nothing, and comes with what is
    told of it."""
    written = {symbol.name: (file, symbol) for file, symbol in _counting(files, Kind.CONTEXT)}
    depth: dict[str, int] = {}
    open_: set[str] = set()
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
            open_.add(name)
            waiting += reversed(missing)
            continue
        waiting.pop()
        open_.discard(name)
        depth[name] = 1 + max((depth[word] for word in needed if word in depth), default=0)
        mistake = None
        if any(word not in depth or word == name for word in needed):
            mistake = "cyclic-context", f"the context `{name}` refers to itself"
        elif depth[name] > _DEEPEST:
            mistake = "nested-too-deep", f"more than {_DEEPEST} levels of contexts in contexts"
        yield file, symbol, mistake


def _names_in(context: Context) -> list[str]:
    operands = (part.word for part in walk(context.condition) if isinstance(part, Operand))
    return [word.text for word in operands if word.kind == NAME]


_DEEPEST: Final = 50  # contexts in contexts: a condition is a tree, and every reader walks it
