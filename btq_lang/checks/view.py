"""What a check sees: one file in its workspace, with the look-ups that many checks need made once.

It decides nothing; a check that only one rule needs does not belong here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, Final, TypeVar

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, NodeKind, lookup, spellings
from btq_lang.catalog.qualities import EDITIONS, QualityMatch, find, fold
from btq_lang.checks import lookups
from btq_lang.checks.calls import calls
from btq_lang.checks.seen import NO_NODES, SeenNode, SeenNodes
from btq_lang.diagnostics.model import Place, Related
from btq_lang.grammar.attributes import meant_clause
from btq_lang.syntax.tree import (
    Apply,
    Entry,
    Include,
    Model,
    Node,
    Port,
    Requirement,
    Tree,
    is_name,
)
from btq_lang.util.spelling import near
from btq_lang.workspace.symbols import Summary, Use
from btq_lang.workspace.workspace import Scope, Workspace

if TYPE_CHECKING:
    from btq_lang.checks.answers import Answers
    from btq_lang.checks.entries import Mention
    from btq_lang.checks.ports import KnownPorts
    from btq_lang.diagnostics.model import Diagnostic
    from btq_lang.requirements.budgets import Budgets
    from btq_lang.requirements.constraints import Constraint
    from btq_lang.requirements.memory import Memory
    from btq_lang.requirements.resolved import Requirements
    from btq_lang.syntax.script import Script
    from btq_lang.workspace.file import Definition, File
    from btq_lang.workspace.item_index import Facts

    K = TypeVar("K")
    T = TypeVar("T")


_UNKNOWN: Final = object()  # None is an answer, too


class View:
    """One file in its workspace.

    Where answers are kept, it gives those, and notes who asks for what.  Then `workspace` and `file` are noted as asked
    for everything there is: a check that can say what it wants to know asks for that.

    Attributes:
        scope: the names that the file can use.
        project: what holds for all files.
        text: that of the file, for who looks up what stands at the offsets of an item.
        is_xml: the file is XML that the engine loads as it is: no build comes between.
        keeps_answers: what was found is kept, so after an edit few items are looked at, and it does not pay to look at
            the whole text first.
        model_ports: the ports of models, by the model's id, as far as somebody asked.
    """

    def __init__(self, workspace: Workspace, path: str, answers: Answers | None = None) -> None:
        self._workspace = workspace
        self._file = workspace.files[path]
        self._answers = answers
        self.keeps_answers = answers is not None
        self._given: dict[object, Any] = {}
        self.path = path
        self.project = workspace.project
        self.text = self._file.text
        self.is_xml = self._file.origin is not None
        self._scope = workspace.scope(path)
        self.scope: Scope = self._scope if answers is None else NotingScope(self._scope, answers)
        self._nodes: dict[int, SeenNodes] = {}
        self._scripts: dict[str, Script] = {}
        self._torn: dict[int, list[int]] = {}  # where mistakes begin, by the `id` of the entry
        self.model_ports: dict[int, KnownPorts] = {}
        self._in_order: set[Callable[[View, str], object]] = set()

    def _once(self, make: Callable[[View], T]) -> T:
        """What is made once for this view; properties that Python keeps cannot be compiled."""
        known = self._given.get(make, _UNKNOWN)
        if known is _UNKNOWN:
            known = self._given[make] = make(self)
        return known  # type: ignore[no-any-return]  # it is what `make` returns

    # ---- what is asked, and noted ----

    def ask(self, what: Callable[..., T], *about: object) -> T:
        """What `what(view, *about)` says, which asks this view and looks at nothing else (see answers.py)."""
        question = (what, *about)
        if self._answers is not None:
            return self._answers.conclude(self, question)  # type: ignore[no-any-return]  # it is what `what` returns
        known = self._given.get(question, _UNKNOWN)
        if known is _UNKNOWN:
            known = self._given[question] = what(self, *about)
        return known  # type: ignore[no-any-return]  # as above

    def look_up(self, what: Callable[..., T], *about: object) -> T:
        """What `what(workspace, path, *about)` says, which reads the files and asks nothing."""
        question = (what, *about)
        if self._answers is not None:
            return self._answers.look_up(question, of_name=False)  # type: ignore[no-any-return]  # as above
        known = self._given.get(question, _UNKNOWN)
        if known is _UNKNOWN:
            known = self._given[question] = what(self._workspace, self.path, *about)
        return known  # type: ignore[no-any-return]  # as above

    def look_up_name(self, what: Callable[..., T], kind: Kind, name: str) -> T:
        """The same, of what says nothing but what the items are that define a name."""
        if self._answers is not None:
            return self._answers.look_up((what, kind, name), of_name=True)  # type: ignore[no-any-return]  # as above
        return what(self._workspace, self.path, kind, name)

    def look_up_in(self, table: Callable[[View], Mapping[K, T]], item: K) -> T | None:
        """What a table, which is asked for many things at once, says of one of them."""
        if self._answers is not None:
            return self._answers.look_up_in(self, table, item)  # type: ignore[no-any-return]  # as above
        return self.ask(table).get(item)

    def note_everything(self) -> None:
        """What is asked now is not kept."""
        if self._answers is not None:
            self._answers.note_everything()

    @property
    def workspace(self) -> Workspace:
        self.note_everything()
        return self._workspace

    @property
    def file(self) -> File:
        self.note_everything()
        return self._file

    def facts(self, entry: Entry) -> Facts:
        """What stands for an item of a file in scope where a question is about it."""
        found = self._file.facts.get(id(entry.item))
        if found is None:
            files = (self._workspace.files[path] for path in self._scope.paths)
            found = next(file.facts[id(entry.item)] for file in files if id(entry.item) in file.facts)
        return found

    def entry(self, facts: Facts) -> Entry:
        """The file's entry whose item these are the facts of."""
        return self._file.entry_of(facts.item)

    def watched(
        self, checks: Iterable[Callable[[View, Entry], Iterator[Diagnostic]]], entry: Entry
    ) -> list[Diagnostic] | None:
        """What checks find; None where one looks at more than it says, which is no part of what is asked now."""

        def find() -> list[Diagnostic]:
            return [diagnostic for check in checks for diagnostic in check(self, entry)]

        if self._answers is None:
            return find()
        found, looks_around = self._answers.watch(find)
        return None if looks_around else found

    def summary(self, entry: Entry) -> Summary:
        """What an entry of the file defines and refers to."""
        return self._file.facts[id(entry.item)].summary

    def defines(self, kind: Kind, name: str) -> bool:
        """Whether a name in scope means something."""
        if self._answers is None:
            return self._scope.defines(kind, name)
        return self.look_up_name(lookups.is_defined, kind, name)

    def has_names(self, kind: Kind) -> bool:
        """Whether there is any name of a kind in scope."""
        return self.ask(_has_names, kind)

    def elsewhere(self, kind: Kind, name: str) -> tuple[str, ...]:
        """The files that define a name, whether they are in scope or not."""
        return self.look_up(lookups.elsewhere, kind, name)

    # ---- one entry ----

    def is_torn(self, entry: Entry, start: int, end: int) -> bool:
        """Whether something could not be read that begins between two offsets of an entry, both included."""
        if not entry.diagnostics:
            return False
        from bisect import bisect_left  # most entries have no mistake in them

        starts = self._torn.get(id(entry))
        if starts is None:
            starts = self._torn[id(entry)] = sorted([problem.span.start for problem in entry.diagnostics])
        at = bisect_left(starts, start)
        return at < len(starts) and starts[at] <= end

    def nodes(self, entry: Entry) -> tuple[SeenNode, ...]:
        """The nodes of a tree, depth first, in document order; none for any other item."""
        return self.seen(entry).all

    def seen(self, entry: Entry) -> SeenNodes:
        """The same, and those among them that only some checks look for."""
        if self._answers is None and (known := self._nodes.get(id(entry.item))) is not None:
            return known
        return self.seen_in(self.facts(entry)) if isinstance(entry.item, Tree) else NO_NODES

    def nodes_of(self, tree: Facts) -> tuple[SeenNode, ...]:
        """The nodes of a tree of any file in scope."""
        return self.seen_in(tree).all

    def seen_in(self, tree: Facts) -> SeenNodes:
        """The same, sorted."""
        if self._answers is not None:
            return self.ask(_seen_nodes, tree)
        known = self._nodes.get(id(tree.item))
        if known is None:
            known = self._nodes[id(tree.item)] = _seen_nodes(self, tree)
        return known

    def uses(self, entry: Entry, kind: Kind) -> list[Use]:
        """What an entry refers to, of one kind."""
        return [use for use in self.summary(entry).uses if use.kind is kind]

    @property
    def trees(self) -> tuple[Entry, ...]:
        """The file's trees, in order."""
        self.note_everything()
        return self._once(View._find_trees)

    def _find_trees(self) -> tuple[Entry, ...]:
        return tuple([entry for entry in self._file.parsed.entries if isinstance(entry.item, Tree)])

    @property
    def has_trees(self) -> bool:
        """Whether there is a tree in the file."""
        return self.ask(_has_trees)

    def is_first_tree(self, entry: Entry) -> bool:
        """Whether no other tree of the file stands before this one."""
        return self.ask(_is_first_tree, self.facts(entry))

    @property
    def is_included(self) -> bool:
        """Whether another file includes this one."""
        return self.look_up(lookups.is_included)

    @property
    def main_tree(self) -> str | None:
        """The name of the tree that runs when the engine loads the file."""
        main = self.look_up(lookups.main_tree)
        return main[0] if main is not None else None

    def is_main(self, entry: Entry) -> bool:
        """Whether an entry of the file is the tree that runs when the engine loads the file."""
        name = entry.item.name.text if isinstance(entry.item, Tree) and entry.item.name is not None else ""
        is_only_one = self.look_up_in(_main_trees, name)
        if is_only_one is None:
            return False
        return is_only_one or self.look_up_name(lookups.owner, Kind.TREE, name) is self.facts(entry)

    @property
    def edition(self) -> str:
        """The edition of the quality model that holds for the file."""
        return self.look_up(lookups.edition)

    def quality(self, name: str) -> QualityMatch | None:
        """What the catalog says of a quality's name; None for a quality that a file in scope declares."""
        return self.ask(_quality, name)

    @property
    def is_read(self) -> bool:
        """Whether the whole file could be read: else what seems to be missing may be what could not."""
        return self.look_up(lookups.is_read)

    @property
    def has_torn_tree(self) -> bool:
        """Whether the name of one of the file's trees may be what could not be read."""
        return self.look_up(lookups.has_torn_tree)

    @property
    def names_unknown_requirements(self) -> bool:
        """Whether the file refers to a requirement that is defined nowhere."""
        return self.look_up(lookups.names_unknown_requirements)

    def is_used(self, kind: Kind, name: str) -> bool:
        """Whether something in the file refers to a name."""
        return self.ask(_is_used, kind, name)

    def is_meant_as_requirement(self, name: str) -> bool:
        """Whether a name stands where a quality or a node does, and seems to be a requirement's; each is told."""
        return self.is_used(Kind.QUALITY, name) or self.ask(_is_misspelt_use, name)

    @property
    def has_palette(self) -> bool:
        """Whether the models in scope are meant to be all there are: a TreeNodesModel, or models of another file."""
        return self.look_up(lookups.has_palette)

    def is_first_use(self, entry: Entry, node: Node, name: str) -> bool:
        """Whether no node of the file before this one has an ID."""
        if self.look_up(lookups.first_user, Kind.MODEL, name) is not self.facts(entry):
            return False
        uses = self.summary(entry).uses
        return next((use.node for use in uses if use.kind is Kind.MODEL and use.name == name), None) is node

    def near(self, word: str, kind: Kind | None) -> tuple[str, ...]:
        """The names of a kind that look like a word that is none; a node may have a built-in's name, too.

        In a file where hundreds of names are unknown nobody reads what each of them may mean, so at some point there
        is no answer any more.

        Args:
            kind: None for the project's other files, as an include names them.
        """
        return self.ask(_near_names, kind, word)

    @property
    def other_files(self) -> tuple[str, ...]:
        """The project's other files, as an include in this one names them."""
        return self.look_up(lookups.other_files)

    def script(self, text: str) -> Script:
        """What a script says; several checks ask of each."""
        known = self._scripts.get(text)
        if known is None:
            from btq_lang.syntax.script import parse_script  # most files have no script, and it is large

            known = self._scripts[text] = parse_script(text)
        return known

    def mentions(self, entry: Entry) -> tuple[Mention, ...]:
        """The blackboard entries that a tree names, in document order."""
        from btq_lang.checks.entries import mentions  # it asks views, too

        return self.ask(mentions, self.facts(entry))

    def ask_in_order(self, what: Callable[[View, str], object]) -> None:
        """Ask something of all trees in scope, of each behind those that it runs: where it asks the same of these, no
        chain of trees is too long."""
        if what not in self._in_order:
            self._in_order.add(what)
            trees = self._early(calls).callees_first
            for tree in self._answers.unknown(what, trees) if self._answers is not None else trees:
                self._early(what, tree)

    def _early(self, what: Callable[..., T], *about: object) -> T:
        """Ask for whoever will ask."""
        if self._answers is None:
            return self.ask(what, *about)
        return self._answers.conclude_early(self, (what, *about))  # type: ignore[no-any-return]  # as above

    @property
    def requirements(self) -> Requirements | None:
        """The requirements in scope, resolved; None where none has a clause and nothing is declared for one."""
        self.note_everything()
        return self._once(View._resolve)

    def _resolve(self) -> Requirements | None:
        if not self._has_clauses():
            return None
        from btq_lang.requirements.resolve import requirements  # most files have no use for it, and it is large

        return requirements(self._workspace, self.path, self.resolved)

    @property
    def resolved(self) -> Memory:
        """What was resolved and found of the requirements before; nothing where nobody keeps it."""
        return self._once(View._remember)

    def _remember(self) -> Memory:
        from btq_lang.requirements.memory import Memory  # as above

        memory = self._answers.resolved if self._answers is not None else None
        if memory is None:
            memory = Memory()
            if self._answers is not None:
                self._answers.resolved = memory
        return memory

    @property
    def budgets(self) -> Budgets | None:
        """How long the nodes take if what is demanded of those below them holds; None where nothing is demanded."""
        self.note_everything()
        return self._once(View._find_budgets)

    def _find_budgets(self) -> Budgets | None:
        if self.requirements is None:
            return None
        from btq_lang.requirements.budgets import Budgets  # as above

        return Budgets(self.requirements, self.resolved)

    def _has_clauses(self) -> bool:
        if self._scope.names(Kind.SIGNAL) or self._scope.names(Kind.CONTEXT):
            return True
        for name in self._scope.names(Kind.REQUIREMENT):
            definition = self._scope.find(Kind.REQUIREMENT, name)
            requirement = definition.symbol.target if definition is not None else None
            if isinstance(requirement, Requirement) and (
                requirement.clauses
                or requirement.parameters
                or any(checkable for _, checkable in self.constraints(requirement))
            ):
                return True
        return bool(self._file.of_type(Apply))

    def constraints(self, requirement: Requirement) -> tuple[tuple[Constraint, bool], ...]:
        """What stands behind SuccessIf and FailureIf in a description, and whether it is more than prose."""
        if requirement.text is None or requirement.clauses:
            return ()
        from btq_lang.requirements.constraints import (  # requirements with clauses need none of it
            can_be_checked,
            constraints,
        )

        names = _NodeNames(self)
        return tuple([(each, can_be_checked(each.text, names)) for each in constraints(requirement.text)])

    def _seen(self, tree: Tree) -> Iterator[SeenNode]:
        waiting: list[tuple[Node, SeenNode | None, int]] = []
        waiting += [(node, None, index) for index, node in reversed(_numbered(tree.children))]
        while waiting:
            node, parent, index = waiting.pop()
            seen = self._look_up(node, tree, parent, index)
            yield seen
            if node.children:
                waiting += [(child, seen, number) for number, child in reversed(_numbered(node.children))]

    def _look_up(self, node: Node, tree: Tree, parent: SeenNode | None, index: int) -> SeenNode:
        category: str | None = node.category.raw if node.category else None
        name = node.id
        kind: NodeKind | None = None
        definition: Definition | None = None
        asked = ""
        if name is not None and category != "SubTree":
            text = name.text
            kind = lookup(text, name.quoted, len(node.nodes) if node.children else 0)
            if kind is None:
                asked = text
                definition = self.scope.find(Kind.MODEL, asked)
                if definition is None and not name.quoted and text in KNOWN_WORDS:
                    kind = BUILTINS.get(KNOWN_WORDS[text].replacement or "")
        target = definition.symbol.target if definition is not None else None
        model = target if isinstance(target, Model) else None
        if category is None and kind is not None:
            category = kind.category
        elif category is None and model is not None:
            category = model.category.raw
        return SeenNode(node, tree, parent, index, kind, definition, model, category, asked, name)

    def clashes(self, entry: Entry, *kinds: Kind) -> Sequence[tuple[Definition, Definition]]:
        """The names that a file included here and one included before it both define, each with the definition that
        counts and the other one.  Neither file can see the other, so nobody else says it."""
        if not isinstance(entry.item, Include):
            return ()
        self.note_everything()
        return [clash for clash in self._once(View._find_clashes).get(id(entry), ()) if clash[1].symbol.kind in kinds]

    def _find_clashes(self) -> dict[int, list[tuple[Definition, Definition]]]:
        found: dict[int, list[tuple[Definition, Definition]]] = {}
        includes = [entry for entry in self._file.parsed.entries if isinstance(entry.item, Include)]
        before: set[str] = set()
        for entry in includes if len(includes) > 1 else ():
            target = self._workspace.included_by(self.path, entry.item) if isinstance(entry.item, Include) else None
            brought = self._workspace.closure(target) if target is not None else ()
            for path in brought if before else ():
                for definition in self._workspace.defined_in(path) if path not in before else ():
                    first = self.scope.find(definition.symbol.kind, definition.symbol.name)
                    if first is not None and first.path in before and first.path not in brought:
                        found.setdefault(id(entry), []).append((first, definition))
            before.update(brought)
        return found

    def place(self, definition: Definition) -> Place:
        """Where a definition's name stands, to be shown beside a diagnostic."""
        symbol = definition.symbol
        known = self.look_up_name(lookups.place, symbol.kind, symbol.name) if self._answers is not None else None
        if known is not None and known[0] == definition.path and known[2] == symbol.span:
            return Place(symbol.span, definition.path, known[1].item)
        return Place(symbol.span, definition.path, definition.entry.item)

    def defined_at(self, definition: Definition, message: str) -> Related:
        return Related(self.place(definition), message)

    def is_this(self, definition: Definition, entry: Entry) -> bool:
        """Whether a definition, of those that count, stands in this file's `entry`."""
        if self._answers is None:
            return definition.path == self.path and definition.entry.item is entry.item
        return self.look_up_name(lookups.owner, definition.symbol.kind, definition.symbol.name) is self.facts(entry)


class _NodeNames:
    """Every name in scope by which a path can name a node: of trees, of kinds and of instances."""

    def __init__(self, view: View) -> None:
        self._view = view

    def __contains__(self, name: object) -> bool:
        return self._view.look_up(lookups.is_node_name, name)


class NotingScope(Scope):
    """A scope that notes what it is asked.  It knows no view: one that knows what knows it is garbage that stays until
    Python looks for it, with all that hangs on it, and an editor makes one at every key."""

    def __init__(self, scope: Scope, answers: Answers) -> None:
        self.paths = scope.paths
        self._scope = scope
        self._answers = answers

    @property
    def complete(self) -> bool:
        complete: bool = self._answers.look_up((lookups.is_complete,), of_name=False)
        return complete

    def find(self, kind: Kind, name: str) -> Definition | None:
        self._answers.look_up((lookups.meaning, kind, name), of_name=True)
        return self._scope.find(kind, name)

    def all(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        self._answers.look_up((lookups.owners, kind, name), of_name=True)
        return self._scope.all(kind, name)

    def is_repeated(self, kind: Kind, name: str) -> bool:
        return len(self.all(kind, name)) > 1

    def names(self, kind: Kind) -> tuple[str, ...]:
        names: tuple[str, ...] = self._answers.look_up((lookups.names, kind), of_name=False)
        return names


def subtree_ports(view: View, seen: SeenNode) -> tuple[Port, ...]:
    """The ports that the tree behind a SubTree declares, in its block or in a model of its own."""
    name = seen.node.id
    if name is None:
        return ()
    for kind in (Kind.TREE, Kind.MODEL):
        definition = view.scope.find(kind, name.text)
        if definition is not None and isinstance(target := definition.symbol.target, Tree | Model) and target.ports:
            return target.ports
    return ()


def misspelt_clause(node: Node) -> str | None:
    """What is probably meant by a node that reads `satisfys rq1`: satisfices or satisfies."""
    kind = node.kind
    if kind is None or not kind.raw.startswith("sa") or node.label is None or node.label.quoted:
        return None
    if node.category or node.attributes or node.clauses or node.children:
        return None
    return meant_clause(kind.raw)


def called(node: Node) -> str:
    """A node as a message names it among others: its kind and its instance name."""
    name = node.name
    return f"`{node.head.text}`" if name is None or name.text == node.head.text else f"`{node.head.text} {name.text}`"


def _seen_nodes(view: View, facts: Facts) -> SeenNodes:
    return SeenNodes(tuple(view._seen(facts.item))) if isinstance(facts.item, Tree) else NO_NODES


def _has_trees(view: View) -> bool:
    return view.look_up(lookups.first_tree) is not None


def _is_first_tree(view: View, tree: Facts) -> bool:
    return view.look_up(lookups.first_tree) is tree


def _main_trees(view: View) -> dict[str, bool]:
    """The name of the tree that runs when the engine loads the file, and whether only this file's own can be it."""
    main = view.look_up(lookups.main_tree)
    return {main[0]: main[1]} if main is not None else {}


def _has_names(view: View, kind: Kind) -> bool:
    return bool(view.scope.names(kind))


def _quality(view: View, name: str) -> QualityMatch | None:
    words = tuple(name.split("."))
    if fold(words[-1]) in view.ask(_own_qualities):
        return None
    return find(words, EDITIONS[view.edition])


def _own_qualities(view: View) -> frozenset[str]:
    return frozenset(map(fold, view.scope.names(Kind.QUALITY)))


def _near_names(view: View, kind: Kind | None, word: str) -> tuple[str, ...]:
    if kind is None:
        return near(word, view.other_files)
    if view.look_up(lookups.is_crowded, kind):
        return ()
    names = view.scope.names(kind)
    return near(word, (*_builtin_names(), *names) if kind is Kind.MODEL else names)


def _is_used(view: View, kind: Kind, name: str) -> bool:
    return name in view.look_up(lookups.used, kind)


def _is_misspelt_use(view: View, name: str) -> bool:
    return any(name in view.ask(_misspelt_uses, facts) for facts in view.look_up(lookups.trees))


def _misspelt_uses(_: View, facts: Facts) -> frozenset[str]:
    nodes = facts.item.walk() if isinstance(facts.item, Tree) else ()
    return frozenset(node.label.text for node in nodes if node.label is not None and misspelt_clause(node))


@cache
def _builtin_names() -> tuple[str, ...]:
    return tuple(word for kind in BUILTINS.values() for word in spellings(kind) if is_name(word))


def _numbered(children: tuple[object, ...]) -> list[tuple[int, Node]]:
    return [(index, child) for index, child in enumerate(children) if isinstance(child, Node)]
