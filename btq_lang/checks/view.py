"""What a check sees: one item in the scope of a viewpoint, with the look-ups that many checks need.

A view decides nothing and caches nothing: every result comes from the query store.  A look-up that only one rule needs
does not belong here.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING, Concatenate, ParamSpec, TypeVar

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import BUILTINS, PortKind, lookup, of_version, spellings
from btq_lang.catalog.qualities import EDITIONS, QualityMatch, find, fold
from btq_lang.catalog.versions import VERSIONS
from btq_lang.checks import lookups
from btq_lang.checks.engines import engines_of
from btq_lang.checks.lookups import Declaration
from btq_lang.checks.sorted_nodes import NO_NODES, SortedNodes, sorted_nodes
from btq_lang.diagnostics.model import Related
from btq_lang.grammar.attributes import meant_clause
from btq_lang.syntax.tree import (
    Entry,
    Include,
    Item,
    Model,
    Node,
    Port,
    Requirement,
    Tree,
    Word,
    is_name,
    models_in,
    port_named,
)
from btq_lang.util.spelling import near
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.config import Project
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.port_types import as_kind
from btq_lang.workspace.queries import Store, hub
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.symbols import Symbol, Use
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.requirements.constraints import Constraint
    from btq_lang.syntax.script.tree import Script
    from btq_lang.workspace.factories import Factory

P = ParamSpec("P")
T = TypeVar("T")

COUNTS = "first definition, which takes effect"
SECOND = "second definition"


class View:
    """An item, or none in particular, in the scope of a viewpoint.

    Attributes:
        store: that caches results.
        path: the file, in whose scope names are looked up.
        facts: of the item that is checked.
        seen: the sorted nodes of a tree; empty for any other item.
    """

    __slots__ = ("facts", "path", "seen", "store")

    def __init__(self, store: Store[Workspace], viewpoint: str, facts: Facts | None = None) -> None:
        self.store = store
        self.path = viewpoint
        self.facts: Facts = facts  # type: ignore[assignment]  # unset only where no caller reads it
        self.seen = self.seen_in(viewpoint, facts) if facts is not None else NO_NODES

    def ask(self, query: Callable[Concatenate[Store[Workspace], str, P], T], /, *key: P.args, **named: P.kwargs) -> T:
        """The answer of a query or of an input from this viewpoint."""
        return self.store.ask(query, self.path, *key, **named)

    # ---- the item ----

    @property
    def item(self) -> Item:
        """The item."""
        return self.facts.item

    @property
    def head(self) -> Span:
        """The span of a diagnostic about the whole item: the name of a tree or the path of an include, if there is
        one."""
        word = self.item.path if isinstance(self.item, Include) else self.tree_name
        return word.span if word is not None else Span(self.item.start, self.item.end)

    @property
    def entry(self) -> Entry:
        """The item and its syntax diagnostics; it begins at 0."""
        return self.ask(inputs.entry, self.facts)

    @property
    def text(self) -> str:
        """The text of the item, up to the next one."""
        return self.ask(inputs.text, self.facts)

    @property
    def nodes(self) -> tuple[ResolvedNode, ...]:
        """The nodes of a tree, depth first, in document order; empty for any other item."""
        return self.seen.all

    @property
    def owners(self) -> Sequence[Tree | Model]:
        """The tree, or the models, whose ports the item declares."""
        return (self.item,) if isinstance(self.item, Tree) else models_in(self.item)

    def uses(self, kind: Kind) -> list[Use]:
        """What the item refers to, of one kind."""
        return [use for use in self.facts.summary.uses if use.kind is kind]

    @property
    def requirements(self) -> Iterator[tuple[Symbol, Requirement]]:
        """The requirements that the item defines, each with its symbol."""
        for symbol in self.facts.summary.symbols:
            if isinstance(symbol.target, Requirement):
                yield symbol, symbol.target

    @property
    def tree_name(self) -> Word | None:
        """The name of the tree; None for one without a name, and for any other item."""
        return self.item.name if isinstance(self.item, Tree) else None

    def is_torn(self, start: int, end: int) -> bool:
        """Whether something could not be read that begins between two offsets of the item, both included."""
        starts = self.ask(_torn_places, self.facts)
        index = bisect_left(starts, start)
        return index < len(starts) and starts[index] <= end

    def node_before(self, offset: int) -> ResolvedNode | None:
        """The last node that begins before an offset of the item."""
        index = bisect_left(self.nodes, offset, key=lambda resolved: resolved.node.start)
        return self.nodes[index - 1] if index else None

    @property
    def is_main(self) -> bool:
        """Whether the item is the tree that runs when the engine loads the file."""
        name = self.tree_name.text if self.tree_name is not None else ""
        is_only_one = self.ask(_is_main_tree, name)
        return bool(is_only_one) or (is_only_one is not None and self.defines_here(Kind.TREE, name))

    def is_first_use(self, node: Node, name: str) -> bool:
        """Whether no earlier node of the file has an ID."""
        if self.ask(lookups.first_user, Kind.MODEL, name) is not self.facts:
            return False
        uses = self.facts.summary.uses
        return next((use.node for use in uses if use.kind is Kind.MODEL and use.name == name), None) is node

    # ---- names ----

    def is_pooled(self, kind: Kind, name: str) -> bool:
        """Whether a name of this XML file is defined in its pool, once or several times."""
        return self.is_xml and self.ask(lookups.is_pooled, kind, name)

    def declared_at(self, kind: Kind, name: str, message: str) -> tuple[Related, ...]:
        """The definition of a name as a related place."""
        declaration = self.ask(lookups.declaration, kind, name)
        return (Related(declaration.place, message),) if declaration is not None else ()

    def defines_here(self, kind: Kind, name: str) -> bool:
        """Whether the item has the definition of a name that counts."""
        definition = self.ask(inputs.definition, kind, name)
        return definition is not None and definition[1] is self.facts

    def repeated(self, *kinds: Kind) -> Iterator[tuple[Symbol, Declaration, bool]]:
        """The names that the item and another one define, with that definition, and whether it is the one that takes
        effect; else it is in another file of the factory."""
        for symbol in self.facts.summary.symbols:
            if symbol.kind in kinds and self.ask(lookups.is_repeated, symbol.kind, symbol.name):
                first = self.ask(lookups.declaration, symbol.kind, symbol.name)
                counts = first is not None and first.symbol is not symbol
                other = first if counts else self.ask(lookups.another_declaration, symbol.kind, symbol.name)
                if other is not None:
                    yield symbol, other, counts

    def clashes(self, *kinds: Kind) -> list[tuple[Declaration, Declaration]]:
        """The names that the file of this include and one included before it both define, each with the definition that
        counts and the other one."""
        if not isinstance(self.item, Include):
            return []
        collisions = self.ask(lookups.clashes)
        return [
            (first, second)
            for include, first, second in collisions
            if include is self.facts and second.symbol.kind in kinds
        ]

    def seen_in(self, path: str, tree: Facts) -> SortedNodes:
        """The nodes of a tree of any file in scope, sorted; empty for any other item."""
        return self.ask(sorted_nodes, path, tree) if isinstance(tree.item, Tree) else NO_NODES

    def nodes_of(self, tree: str) -> SortedNodes:
        """The nodes of the tree with a name, sorted; empty if there is none."""
        definition = self.ask(inputs.definition, Kind.TREE, tree)
        return self.seen_in(*definition) if definition is not None else NO_NODES

    # ---- the file and the project ----

    @property
    def is_xml(self) -> bool:
        """Whether the file is XML that the engine loads as it is, without a build."""
        return self.ask(lookups.is_xml)

    @property
    def is_read(self) -> bool:
        """Whether the whole file could be read."""
        return self.ask(lookups.is_read)

    @property
    def project(self) -> Project:
        """What holds for all files."""
        return self.store.ask(inputs.project)

    @property
    def engines(self) -> tuple[str, ...]:
        """The versions of the engine that the file must hold for, oldest first."""
        return self.ask(engines_of)

    @property
    def target(self) -> str:
        """The newest of them, for which the file is written."""
        return self.engines[-1]

    @property
    def is_pinned(self) -> bool:
        """Whether the file is for particular versions, and not for all known ones."""
        return self.engines != VERSIONS

    @property
    def is_used_elsewhere(self) -> bool:
        """Whether other files can use what this one defines: they include it, or are registered with it."""
        return self.ask(inputs.is_included) or (self.factory is not None and len(self.ask(inputs.paths)) > 1)

    @property
    def factory(self) -> Factory | None:
        """The factory in whose scope the file is checked; None if it is checked by itself."""
        return self.store.ask(inputs.factory)

    @property
    def main_tree(self) -> str | None:
        """The name of the tree that runs when the engine loads the file."""
        main = self.ask(lookups.main_tree)
        return main[0] if main is not None else None

    def spelt(self, symbol: str) -> str:
        """A built-in node as the language of the file writes it: `R->`, in XML `<ReactiveSequence>`."""
        kind = lookup(symbol)
        return f"`<{kind.tag}>`" if self.is_xml and kind is not None else f"`{symbol}`"

    def pin_note(self, accepts: Callable[[str], bool]) -> tuple[str, ...]:
        """The note for XML that only newer versions of the engine refuse: how to name an older one.

        Args:
            accepts: whether a version accepts it.
        """
        older = [version for version in self.engines if accepts(version)]
        if not older or self.is_pinned or not self.is_xml:
            return ()
        return (f'{older[-1]} accepts it: if you run that, set `engine = "{older[-1]}"` in btq.toml',)

    def script(self, text: str) -> Script:
        """A parsed script; several checks need each."""
        return self.store.ask(_script, text)

    def constraints(self, requirement: Requirement) -> tuple[tuple[Constraint, bool], ...]:
        """The constraints after SuccessIf and FailureIf in a description, each with whether a tool can check it."""
        if requirement.text is None or not requirement.is_text:
            return ()
        from btq_lang.requirements.constraints import (  # requirements with clauses need none of it
            can_be_checked,
            constraints,
        )

        def is_name(word: str) -> bool:
            return self.ask(lookups.is_node_name, word)

        return tuple(
            [(constraint, can_be_checked(constraint.text, is_name)) for constraint in constraints(requirement.text)]
        )


def ports_beside(view: View, resolved: ResolvedNode) -> tuple[Port, ...]:
    """The ports that the model of a node declares, or the tree of a SubTree; not those of a built-in."""
    if resolved.is_subtree:
        return declared_ports(view, resolved.id.text) if resolved.id is not None else ()
    model = (
        view.ask(lookups.meaning, Kind.MODEL, resolved.id.text)
        if resolved.is_defined and resolved.id is not None
        else None
    )
    return model.ports if model is not None else ()


def port_names(view: View, resolved: ResolvedNode) -> set[str]:
    """The names of these ports."""
    return {port.id.text for port in ports_beside(view, resolved) if port.id is not None}


def declared_ports(view: View, name: str) -> tuple[Port, ...]:
    """The ports that a tree declares, or if it declares none, a model of the same name."""
    for kind in (Kind.TREE, Kind.MODEL):
        meaning = view.ask(lookups.meaning, kind, name)
        if meaning is not None and meaning.ports:
            return meaning.ports
    return ()


def port_of(view: View, resolved: ResolvedNode, name: str) -> PortKind | None:
    """A node's port of a name; None if nothing declares it."""
    if resolved.kind is not None:
        builtin = resolved.kind.port(name)
        return of_version(builtin, view.target) if builtin is not None else None
    port = port_named(ports_beside(view, resolved), name)
    return as_kind(port) if port is not None else None


def misspelt_clause(node: Node) -> str | None:
    """The clause that a node like `satisfys rq1` probably means: satisfices or satisfies."""
    kind = node.kind
    if kind is None or not kind.raw.startswith("sa") or node.label is None or node.label.quoted:
        return None
    if node.category or node.attributes or node.clauses or node.children:
        return None
    return meant_clause(kind.raw)


def _torn_places(store: Store[Workspace], viewpoint: str, facts: Facts) -> list[int]:
    """The offsets in an item at which something begins that could not be read."""
    entry = store.ask(inputs.entry, viewpoint, facts)
    return sorted([problem.span.start for problem in entry.diagnostics])


def has_trees(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether there is a tree in the file."""
    return store.ask(lookups.first_tree, viewpoint) is not None


def is_first_tree(store: Store[Workspace], viewpoint: str, tree: Facts) -> bool:
    """Whether no other tree of the file is before this one."""
    return store.ask(lookups.first_tree, viewpoint) is tree


@hub
def _is_main_tree(store: Store[Workspace], viewpoint: str, name: str) -> bool | None:
    """Whether this file's own tree of a name runs when the engine loads it; None if no tree of that name does."""
    main = View(store, viewpoint).ask(lookups.main_tree)
    return main[1] if main is not None and main[0] == name else None


def has_names(store: Store[Workspace], viewpoint: str, kind: Kind) -> bool:
    """Whether there is any name of a kind in scope."""
    return bool(View(store, viewpoint).ask(inputs.names, kind))


def quality_named(store: Store[Workspace], viewpoint: str, name: str) -> QualityMatch | None:
    """The catalog's match of a quality name; None for a quality that a file in scope declares."""
    view = View(store, viewpoint)
    words = tuple(name.split("."))
    return None if fold(words[-1]) in view.ask(_own_qualities) else find(words, EDITIONS[view.ask(lookups.edition)])


def _own_qualities(store: Store[Workspace], viewpoint: str) -> frozenset[str]:
    return frozenset(map(fold, View(store, viewpoint).ask(inputs.names, Kind.QUALITY)))


def near_names(store: Store[Workspace], viewpoint: str, kind: Kind, word: str) -> tuple[str, ...]:
    """The names of a kind that are similar to an unknown word; a node may have a built-in's name too.

    In a file with hundreds of unknown names suggestions are of no use, so above a limit the result is empty.
    """
    view = View(store, viewpoint)
    if view.ask(lookups.is_crowded, kind):
        return ()
    names = view.ask(inputs.names, kind)
    return near(word, (*_builtin_names(), *names) if kind is Kind.MODEL else names)


def is_used(store: Store[Workspace], viewpoint: str, kind: Kind, name: str) -> bool:
    """Whether something in the file refers to a name."""
    return name in View(store, viewpoint).ask(lookups.used, kind)


def _script(_: Store[Workspace], text: str) -> Script:
    from btq_lang.syntax.script.parser import parse_script  # most files have no script, and it is large

    return parse_script(text)


@cache
def _builtin_names() -> tuple[str, ...]:
    return tuple(word for kind in BUILTINS.values() for word in spellings(kind) if is_name(word))
