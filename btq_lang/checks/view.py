"""What a check sees: one file in its workspace, with the look-ups that many checks need made once.

It decides nothing; a check that only one rule needs does not belong here.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from functools import cache, cached_property

from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, NodeKind, lookup, spellings
from btq_lang.catalog.qualities import EDITIONS, QualityMatch, find, fold
from btq_lang.checks.calls import Calls
from btq_lang.constraints import Constraint, can_be_checked, constraints
from btq_lang.diagnostics import Place, Related
from btq_lang.near import near
from btq_lang.nodes import meant_clause
from btq_lang.record import record
from btq_lang.rules import Severity
from btq_lang.symbols import Kind, Use
from btq_lang.syntax import (
    Apply,
    Entry,
    Include,
    Model,
    Models,
    Node,
    Pair,
    Port,
    Qualities,
    Requirement,
    Tree,
    Word,
    is_name,
)
from btq_lang.workspace import Definition, File, Scope, Workspace

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import TypeAlias

    from btq_lang.checks.entries import Blackboards, Mention
    from btq_lang.checks.mixed_types import EntryTypes
    from btq_lang.checks.results import TreeResults
    from btq_lang.diagnostics import Diagnostic
    from btq_lang.requirements import Requirements
    from btq_lang.requirements.budgets import Budgets
    from btq_lang.script import Script


Question: TypeAlias = tuple[str, Kind | None, str]
Noted: TypeAlias = dict[Question, object]  # questions with their answers


@record
class SeenNode:
    """A node with what is known of it.

    Attributes:
        parent: the node whose child it is; None for a tree's own.
        index: which child of its parent it is.
        kind: the built-in it is, if it is one; for an older engine's word the one of today.
        definition: where its model stands, where one is in scope.
        model: that model.
        category: as written, or as the built-in or the model has it; None where nobody says.
        is_subtree: whether that is SubTree.
        asked: the name that a model was looked for by; nothing where none was.
    """

    node: Node
    tree: Tree
    parent: SeenNode | None
    index: int
    kind: NodeKind | None
    definition: Definition | None
    model: Model | None
    category: str | None
    is_subtree: bool
    asked: str

    @property
    def shown(self) -> str:
        """The node as a message names it."""
        return f"`{self.node.head.text}`"

    def ancestors(self) -> Iterator[SeenNode]:
        """Its parent, the parent's parent, and so on."""
        above = self.parent
        while above is not None:
            yield above
            above = above.parent


class View:
    """One file in its workspace.

    Attributes:
        noted: what was asked of the rest of the file, while that is noted.
    """

    def __init__(self, workspace: Workspace, path: str, *, notes: bool = False) -> None:
        self.workspace = workspace
        self.path = path
        self.file: File = workspace.files[path]
        self.noted: Noted | None = None
        self.scope: Scope = NotingScope(workspace.scope(path), self) if notes else workspace.scope(path)
        self._nodes: dict[int, tuple[SeenNode, ...]] = {}
        self._near: dict[tuple[Kind | None, str], tuple[str, ...]] = {}
        self._compared = 0
        self._constraints: dict[int, tuple[tuple[Constraint, bool], ...]] = {}
        self._mentions: dict[int, tuple[Mention, ...]] = {}
        self._scripts: dict[str, Script] = {}
        self._qualities: dict[str, QualityMatch | None] = {}

    def nodes(self, entry: Entry) -> tuple[SeenNode, ...]:
        """The nodes of a tree, depth first, in document order; none for any other item."""
        if not isinstance(entry.item, Tree):
            return ()
        known = self._nodes.get(id(entry))
        if known is None:
            known = self._nodes[id(entry)] = tuple(self._seen(entry.item))
        elif self.noted is not None:
            for seen in known:  # what was asked for them is asked by whoever looks at them
                if seen.asked:
                    self.scope.find(Kind.MODEL, seen.asked)
        return known

    def uses(self, entry: Entry, kind: Kind) -> Iterator[Use]:
        """What an entry refers to, of one kind."""
        uses = self.file.summary_of(entry).uses
        return (use for use in uses if use.kind is kind) if uses else iter(())

    @property
    def is_xml(self) -> bool:
        """Whether the file is XML that the engine loads as it is: no build comes between."""
        return self.file.origin is not None

    @cached_property
    def trees(self) -> tuple[Entry, ...]:
        """The file's trees, in order."""
        return tuple(entry for entry in self.file.parsed.entries if isinstance(entry.item, Tree))

    @property
    def main_tree(self) -> Definition | None:
        """The tree that runs when the engine loads the file."""
        if self.noted is not None:
            self.noted["main_tree", None, ""] = self._main_tree.symbol if self._main_tree else None
        return self._main_tree

    @cached_property
    def _main_tree(self) -> Definition | None:
        return self.workspace.main_tree(self.path)

    @cached_property
    def edition(self) -> str:
        """The edition of the quality model that holds for the file."""
        for entry in self.file.parsed.entries:
            edition = entry.item.edition if isinstance(entry.item, Qualities) else None
            if edition is not None and edition.text in EDITIONS:
                return edition.text
        return self.workspace.project.qualities

    def quality(self, name: str) -> QualityMatch | None:
        """What the catalog says of a quality's name; None for a quality that a file in scope declares."""
        if self.noted is not None:
            self.scope.names(Kind.QUALITY)
            self.noted["edition", None, ""] = self.edition
        if name not in self._qualities:
            words = tuple(name.split("."))
            is_own = bool(self._own_qualities) and fold(words[-1]) in self._own_qualities
            self._qualities[name] = None if is_own else find(words, EDITIONS[self.edition])
        return self._qualities[name]

    @cached_property
    def _own_qualities(self) -> frozenset[str]:
        return frozenset(map(fold, self.scope.names(Kind.QUALITY)))

    @cached_property
    def is_read(self) -> bool:
        """Whether the whole file could be read: else what seems to be missing may be what could not."""
        problems = (problem for entry in self.file.parsed.entries for problem in entry.diagnostics)
        return all(problem.effective_severity is not Severity.ERROR for problem in problems)

    @cached_property
    def has_torn_tree(self) -> bool:
        """Whether the name of one of the file's trees may be what could not be read."""
        return any(
            problem.span.start <= entry.item.end
            for entry in self.trees
            if isinstance(entry.item, Tree)
            for problem in entry.diagnostics
        )

    @cached_property
    def names_unknown_requirements(self) -> bool:
        """Whether the file refers to a requirement that is defined nowhere."""
        names = {use.name for summary in self.file.summaries for use in summary.uses if use.kind is Kind.REQUIREMENT}
        return any(self.scope.find(Kind.REQUIREMENT, name) is None for name in names)

    @cached_property
    def meant_as_requirements(self) -> frozenset[str]:
        """Names that seem to be requirements, but stand where a quality or a node does; each is told."""
        uses = (use for summary in self.file.summaries for use in summary.uses)
        found = {use.name for use in uses if use.kind is Kind.QUALITY}
        for entry in self.trees:
            nodes = (seen.node for seen in self.nodes(entry))
            found.update(node.label.text for node in nodes if node.label is not None and misspelt_clause(node))
        return frozenset(found)

    @cached_property
    def has_palette(self) -> bool:
        """Whether the models in scope are meant to be all there are: a TreeNodesModel, or models of another file."""
        for path in self.scope.paths:
            for entry in self.workspace.files[path].parsed.entries:
                if isinstance(entry.item, Models) and any(_is_of_node(model) for model in entry.item.models):
                    return True
                if path != self.path and _is_of_node(entry.item):
                    return True
        return False

    @cached_property
    def first_nodes(self) -> dict[str, Node]:
        """The first node of the file for each ID that a node has."""
        found: dict[str, Node] = {}
        for summary in self.file.summaries:
            for use in summary.uses:
                if use.kind is Kind.MODEL and use.node is not None:
                    found.setdefault(use.name, use.node)
        return found

    def near(self, word: str, kind: Kind | None) -> tuple[str, ...]:
        """The names of a kind that look like a word that is none; a node may have a built-in's name, too.

        In a file where hundreds of names are unknown nobody reads what each of them may mean, so at some point there
        is no answer any more.

        Args:
            kind: None for the project's other files, as an include names them.
        """
        if (kind, word) not in self._near:
            names = self.other_files if kind is None else self._names(kind)
            self._compared += len(names)
            self._near[kind, word] = near(word, names) if self._compared <= _MOST_COMPARED else ()
        return self._near[kind, word]

    def _names(self, kind: Kind) -> tuple[str, ...]:
        names = self.scope.names(kind)
        return (*_builtin_names(), *names) if kind is Kind.MODEL else names

    @cached_property
    def other_files(self) -> tuple[str, ...]:
        """The project's other files, as an include in this one names them."""
        folder = posixpath.dirname(self.path) or "."
        return tuple(posixpath.relpath(other, folder) for other in self.workspace.files if other != self.path)

    @cached_property
    def calls(self) -> Calls:
        """Which tree runs which, of all trees in scope."""
        return Calls(self.workspace, self.scope)

    def script(self, text: str) -> Script:
        """What a script says; several checks ask of each."""
        known = self._scripts.get(text)
        if known is None:
            from btq_lang.script import parse_script  # most files have no script, and it is large

            known = self._scripts[text] = parse_script(text)
        return known

    def mentions(self, entry: Entry) -> tuple[Mention, ...]:
        """The blackboard entries that a tree names, in document order."""
        known = self._mentions.get(id(entry))
        if known is None:
            from btq_lang.checks.entries import mentions  # it asks views, too

            known = self._mentions[id(entry)] = tuple(mentions(self, entry))
        return known

    @cached_property
    def blackboards(self) -> Blackboards:
        """Which names in which trees are one blackboard entry, and what is done with it."""
        from btq_lang.checks.entries import Blackboards  # it asks views, too

        return Blackboards(self)

    @cached_property
    def named_output(self) -> Pair | None:
        """The first value for an output, in a file that gives values to outputs as a rule."""
        from btq_lang.checks.outputs import named_output  # it asks views, too

        return named_output(self)

    @cached_property
    def entry_types(self) -> EntryTypes:
        """The types that blackboard entries meet."""
        from btq_lang.checks.mixed_types import EntryTypes  # it asks views, too

        return EntryTypes(self)

    @cached_property
    def results(self) -> TreeResults:
        """What the nodes of a tree can return."""
        from btq_lang.checks.results import TreeResults  # it asks views, too

        return TreeResults(self)

    @cached_property
    def requirements(self) -> Requirements | None:
        """The requirements in scope, resolved; None where none has a clause and nothing is declared for one."""
        if not self._has_clauses:
            return None
        from btq_lang.requirements import requirements  # most files have no use for it, and it is large

        return requirements(self.workspace, self.path)

    @cached_property
    def budgets(self) -> Budgets | None:
        """How long the nodes take if what is demanded of those below them holds; None where nothing is demanded."""
        if self.requirements is None:
            return None
        from btq_lang.requirements.budgets import Budgets  # as above

        return Budgets(self.requirements)

    @cached_property
    def demands(self) -> dict[int, list[Diagnostic]]:
        """What is wrong with what is demanded, by the item it stands in."""
        from btq_lang.checks.demands import all_demands  # it asks views, too

        return all_demands(self)

    @cached_property
    def _has_clauses(self) -> bool:
        if self.scope.names(Kind.SIGNAL) or self.scope.names(Kind.CONTEXT):
            return True
        for name in self.scope.names(Kind.REQUIREMENT):
            definition = self.scope.find(Kind.REQUIREMENT, name)
            requirement = definition.symbol.target if definition is not None else None
            if isinstance(requirement, Requirement) and (
                requirement.clauses
                or requirement.parameters
                or any(checkable for _, checkable in self.constraints(requirement))
            ):
                return True
        return any(isinstance(entry.item, Apply) for entry in self.file.parsed.entries)

    def constraints(self, requirement: Requirement) -> tuple[tuple[Constraint, bool], ...]:
        """What stands behind SuccessIf and FailureIf in a description, and whether it is more than prose."""
        if requirement.text is None or requirement.clauses:
            return ()
        key = id(requirement)
        if key not in self._constraints:
            found = constraints(requirement.text)
            names = self.node_names if found else frozenset()
            self._constraints[key] = tuple((each, can_be_checked(each.text, names)) for each in found)
        return self._constraints[key]

    @cached_property
    def placeholders(self) -> dict[str, tuple[str, Entry, Word]]:
        """The first placeholder in scope that becomes each ID: its file, its tree and its name."""
        from btq_lang.checks.placeholders import first_placeholders  # it asks views, too

        return first_placeholders(self)

    @cached_property
    def node_names(self) -> frozenset[str]:
        """Every name in scope by which a path can name a node: of trees, of kinds and of instances."""
        found: set[str] = set()
        for path in self.scope.paths:
            for entry in self.workspace.files[path].parsed.entries:
                if isinstance(entry.item, Tree):
                    words = [entry.item.name, *(word for node in entry.item.walk() for word in (node.id, node.name))]
                    found.update(word.text for word in words if word is not None)
        return frozenset(found)

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
            kind = lookup(name.text, name.quoted, len(node.nodes))
            if kind is None:
                asked = name.text
                definition = self.scope.find(Kind.MODEL, asked)
            if kind is None and definition is None and not name.quoted and name.text in KNOWN_WORDS:
                kind = BUILTINS.get(KNOWN_WORDS[name.text].replacement or "")
        target = definition.symbol.target if definition is not None else None
        model = target if isinstance(target, Model) else None
        if category is None and kind is not None:
            category = kind.category
        elif category is None and model is not None:
            category = model.category.raw
        return SeenNode(node, tree, parent, index, kind, definition, model, category, category == "SubTree", asked)

    def clashes(self, entry: Entry, *kinds: Kind) -> Iterator[tuple[Definition, Definition]]:
        """The names that a file included here and one included before it both define, each with the definition that
        counts and the other one.  Neither file can see the other, so nobody else says it."""
        for first, second in self._clashes.get(id(entry), ()):
            if second.symbol.kind in kinds:
                yield first, second

    @cached_property
    def _clashes(self) -> dict[int, list[tuple[Definition, Definition]]]:
        found: dict[int, list[tuple[Definition, Definition]]] = {}
        includes = [entry for entry in self.file.parsed.entries if isinstance(entry.item, Include)]
        before: set[str] = set()
        for entry in includes if len(includes) > 1 else ():
            target = self.workspace.included_by(self.path, entry.item) if isinstance(entry.item, Include) else None
            brought = self.workspace.closure(target) if target is not None else ()
            for path in brought if before else ():
                for definition in self.workspace.defined_in(path) if path not in before else ():
                    first = self.scope.find(definition.symbol.kind, definition.symbol.name)
                    if first is not None and first.path in before and first.path not in brought:
                        found.setdefault(id(entry), []).append((first, definition))
            before.update(brought)
        return found

    def place(self, definition: Definition) -> Place:
        """Where a definition's name stands, to be shown beside a diagnostic."""
        return Place(definition.symbol.span, definition.path, definition.entry.item)

    def defined_at(self, definition: Definition, message: str) -> Related:
        return Related(self.place(definition), message)

    def is_this(self, definition: Definition, entry: Entry) -> bool:
        """Whether a definition stands in this file's `entry`."""
        return definition.path == self.path and definition.entry is entry

    def answer(self, question: Question) -> object:
        """What the answer to a noted question is here."""
        what, kind, name = question
        if kind is None:
            return (self.main_tree.symbol if self.main_tree else None) if what == "main_tree" else self.edition
        if what == "find":
            found = self.scope.find(kind, name)
            return found.symbol if found is not None else None
        if what == "names":
            return self.scope.names(kind)
        return self.scope.complete if what == "complete" else None  # of all definitions of a name: another answer


class NotingScope(Scope):
    """A scope that notes what it is asked."""

    def __init__(self, scope: Scope, view: View) -> None:
        self.paths = scope.paths
        self._scope = scope
        self._view = view

    def _note(self, what: str, kind: Kind, name: str, answer: object) -> None:
        if self._view.noted is not None:
            self._view.noted[what, kind, name] = answer

    @property
    def complete(self) -> bool:
        self._note("complete", Kind.TREE, "", self._scope.complete)
        return self._scope.complete

    def find(self, kind: Kind, name: str) -> Definition | None:
        found = self._scope.find(kind, name)
        self._note("find", kind, name, found.symbol if found is not None else None)
        return found

    def all(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        found = self._scope.all(kind, name)
        self._note("all", kind, name, [one.symbol for one in found])
        return found

    def names(self, kind: Kind) -> tuple[str, ...]:
        names = self._scope.names(kind)
        self._note("names", kind, "", names)
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


def _is_of_node(item: object) -> bool:
    return isinstance(item, Model) and item.category.raw != "SubTree"


@cache
def _builtin_names() -> tuple[str, ...]:
    return tuple(word for kind in BUILTINS.values() for word in spellings(kind) if is_name(word))


# How many names one file's misspelt ones are compared with: 30 ms of work, a second where all look alike (rq_0001 …).
_MOST_COMPARED = 20_000


def _numbered(children: tuple[object, ...]) -> list[tuple[int, Node]]:
    return [(index, child) for index, child in enumerate(children) if isinstance(child, Node)]
