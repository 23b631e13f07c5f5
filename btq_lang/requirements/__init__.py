"""What requirements mean: their clauses resolved, with units, subjects and scopes.

One invariant: the answer is a function of the workspace and of the file at whose scope it looks.  It does not know what
the engine can enforce, nor what a run of the robot was like.

    requirements(workspace, path)   all of a file and what it includes
    model.py     what a requirement says once its words are resolved
    nodes.py     which written nodes a path, a kind or a tag means
    paths.py     the one node that a path names
    reader.py    values and conditions: names, units, what compares with what
    clauses.py   what each verb asks for
    classic.py   SuccessIf and FailureIf in classic descriptions
    attach.py    which requirement holds for which node
    durations.py, composition.py, budgets.py   how long nodes take when all that is demanded below them holds
    spans.py     the node whose time a span is
"""

from __future__ import annotations

from btq_lang.record import record
from btq_lang.requirements.attach import attach
from btq_lang.requirements.classic import with_constraints
from btq_lang.requirements.clauses import read_signal, resolve
from btq_lang.requirements.model import Applied, Claim, Condition, Requirement, Signal, SourceNode, Trace
from btq_lang.requirements.nodes import Nodes
from btq_lang.requirements.paths import Problem
from btq_lang.requirements.reader import Reader
from btq_lang.symbols import Kind
from btq_lang.syntax import Context, Operand, Quality, Satisfices, Tree, walk
from btq_lang.syntax import Requirement as WrittenRequirement
from btq_lang.syntax import Signal as WrittenSignal
from btq_lang.tokens import NAME
from btq_lang.workspace import Definition, Scope, Workspace

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

__all__ = ["Problem", "Requirements", "requirements"]


@record
class Requirements:
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


def requirements(workspace: Workspace, path: str) -> Requirements:
    """The requirements of a file and what it includes, resolved.

    Raises:
        KeyError: there is no such file.
    """
    scope = workspace.scope(path)
    nodes = Nodes(workspace, scope)
    reader = Reader(workspace, path, scope, nodes)
    for definition in _definitions(scope, Kind.SIGNAL):
        if isinstance(signal := definition.symbol.target, WrittenSignal):
            reader.signals[definition.symbol.name] = read_signal(reader, definition, signal)
    _read_contexts(reader, scope)
    qualities = _enclosing_qualities(workspace, scope, nodes)
    found: dict[str, Requirement] = {}
    for definition in _definitions(scope, Kind.REQUIREMENT):
        if isinstance(written := definition.symbol.target, WrittenRequirement):
            quality = qualities.get(id(written))
            resolved = resolve(reader, definition, written, quality)
            found[definition.symbol.name] = with_constraints(reader, resolved, written)
    applied, traces, attached = attach(reader, found)
    problems = tuple(reader.problems.values())
    return Requirements(
        reader.signals, reader.contexts, found, applied, traces, attached, problems, nodes, reader.mission
    )


def _definitions(scope: Scope, kind: Kind) -> list[Definition]:
    """The definitions that count."""
    found = (scope.find(kind, name) for name in scope.names(kind))
    return [definition for definition in found if definition is not None]


def _read_contexts(reader: Reader, scope: Scope) -> None:
    """Those that a context speaks of come before it; one that speaks of itself means nothing."""
    written = {definition.symbol.name: definition for definition in _definitions(scope, Kind.CONTEXT)}
    depth: dict[str, int] = {}
    open_: list[str] = []
    waiting = list(reversed(written))
    reader.contexts.update(dict.fromkeys(written))
    while waiting:
        name = waiting[-1]
        context = written[name].symbol.target
        if name in depth or not isinstance(context, Context):
            waiting.pop()
            continue
        needed = [word for word in _names_in(context) if word in written]
        missing = [word for word in needed if word not in depth and word not in open_]
        if missing and name not in open_:
            open_.append(name)
            waiting += reversed(missing)
            continue
        waiting.pop()
        if name in open_:
            open_.remove(name)
        depth[name] = 1 + max((depth[word] for word in needed if word in depth), default=0)
        definition = written[name]
        reader.begin(definition.path, definition.entry)
        if any(word not in depth or word == name for word in needed):
            reader.complain("cyclic-context", definition.symbol.span, f"the context `{name}` speaks of itself")
        elif depth[name] > _DEEPEST:
            message = f"more than {_DEEPEST} contexts that speak of each other"
            reader.complain("nested-too-deep", definition.symbol.span, message)
        else:
            reader.contexts[name] = reader.condition(context.condition)


def _names_in(context: Context) -> list[str]:
    operands = (part.word for part in walk(context.condition) if isinstance(part, Operand))
    return [word.text for word in operands if word.kind == NAME]


def _enclosing_qualities(workspace: Workspace, scope: Scope, nodes: Nodes) -> dict[int, str]:
    """The quality that encloses a requirement in `Quality = performance (QualityReq …)`."""
    found: dict[int, str] = {}
    for path in scope.paths:
        for entry in workspace.files[path].parsed.entries:
            if not isinstance(entry.item, Tree):
                continue
            clauses = [*entry.item.clauses, *(clause for node in nodes.within(entry) for clause in node.node.clauses)]
            for clause in clauses:
                for quality in clause.qualities if isinstance(clause, Satisfices) else ():
                    _note(quality, found)
    return found


def _note(quality: Quality, found: dict[int, str]) -> None:
    for requirement in quality.requirements:
        found[id(requirement)] = ".".join(name.text for name in quality.path.names)


_DEEPEST: Final = 50  # contexts in contexts: a condition is a tree, and every reader walks it
