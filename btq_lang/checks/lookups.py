"""What only checks look up in the files: more inputs of the query store, as in workspace/inputs.py and with the same
invariant."""

from __future__ import annotations

import posixpath
import re
from math import inf
from typing import TYPE_CHECKING

from btq_lang.catalog.literals import plain_type
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import legal_name, model_name_problem
from btq_lang.catalog.nav2 import FILES, distribution_among
from btq_lang.catalog.nodes import BUILTINS, lookup
from btq_lang.diagnostics.model import Place
from btq_lang.diagnostics.rules import UNREADABLE, Severity
from btq_lang.syntax.tree import Apply, Include, Item, Model, Models, Port, Root, Tree, Verbatim, models_in
from btq_lang.util.record import Record
from btq_lang.workspace.file import Definition, Signs
from btq_lang.workspace.inputs import of_name, of_viewpoint
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.port_types import is_text, meetings
from btq_lang.workspace.symbols import Symbol
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.catalog.nav2.navigator import OutsideEntry
    from btq_lang.workspace.custom_nodes import LikelyPort


class VisibleMeaning(Record):
    """What others see of the meaning of a name.

    Attributes:
        owner: the item that defines it; None for trees and models, of which others see only what follows.
        target: its meaning; None for a tree.
        ports: of a tree or a model.
    """

    owner: Facts | None
    target: object
    ports: tuple[Port, ...]


class Declaration(Record):
    """A symbol and the item that defines it."""

    path: str
    owner: Facts
    symbol: Symbol

    @property
    def place(self) -> Place:
        """The place of the name."""
        return Place(self.symbol.span, self.path, self.owner.item)

    @property
    def is_of_nav2(self) -> bool:
        """Whether it is in a file with the nodes of Nav2."""
        return self.path in FILES.values()


# ---- a name: these depend only on the items that define it ----


@of_name
def ports_in_file(workspace: Workspace, path: str, kind: Kind, name: str) -> frozenset[str] | None:
    """The names of the ports of a model in a file itself; None if it has no such model."""
    definitions = workspace.files[path].names.definitions.get((kind, name))
    model = definitions[0][1].target if definitions else None
    if not isinstance(model, Model):
        return None
    return frozenset([port.name.text for port in model.ports if port.name is not None])


@of_name
def is_defined(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> bool:
    """Whether a name is defined."""
    return workspace.scope(viewpoint).defines(kind, name)


@of_name
def is_pooled(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> bool:
    """Whether a name is defined in the pool of an XML file."""
    return bool(workspace.pooled(viewpoint, kind, name))


@of_name
def meaning(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> VisibleMeaning | None:
    """What a name means."""
    definition = workspace.find(viewpoint, kind, name)
    if definition is None:
        return None
    target = definition.symbol.target
    if isinstance(target, Tree):
        return VisibleMeaning(None, None, target.ports)
    if isinstance(target, Model):
        return VisibleMeaning(None, target, target.ports)
    return VisibleMeaning(_declaration(workspace, definition).owner, target, ())


@of_name
def ports_of_models(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> tuple[tuple[Port, ...], ...]:
    """The ports of each model of a node in scope, else of the one that it has in the pool.  If the first is C++ whose
    ports are all seen, only a node of Nav2 counts, too, which a program may register in its place."""
    in_scope = workspace.scope(viewpoint).all(kind, name) or (workspace.find(viewpoint, kind, name),)
    definitions = [definition for definition in in_scope if definition is not None]
    first = workspace.files[definitions[0].path].cpp_nodes.get(name) if definitions else None
    if first is not None and first.complete:
        definitions = [definitions[0], *(each for each in definitions[1:] if each.path in FILES.values())]
    targets = [definition.symbol.target for definition in definitions]
    return tuple([target.ports for target in targets if isinstance(target, Model)])


@of_name
def declaration(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> Declaration | None:
    """Where a name is defined."""
    definition = workspace.find(viewpoint, kind, name)
    return _declaration(workspace, definition) if definition is not None else None


@of_name
def is_torn(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> bool:
    """Whether something could not be read in the tree or model of a name, or in its C++, which may be a port."""
    definition = workspace.find(viewpoint, kind, name)
    if definition is not None and (node := workspace.files[definition.path].cpp_nodes.get(name)) is not None:
        return not node.complete
    if definition is None or not definition.entry.diagnostics:
        return False
    target, item = definition.symbol.target, definition.entry.item
    if not isinstance(target, Tree | Model):
        return False
    starts = [model.start for model in models_in(item)]
    end = min([start for start in starts if start > target.start], default=inf)
    return any(
        problem.rule in UNREADABLE and target.start <= problem.span.start < end
        for problem in definition.entry.diagnostics
    )


@of_name
def another_declaration(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> Declaration | None:
    """Where the first file of a factory after the one at the viewpoint, whose definition of a name counts, defines it
    again; without a factory, where a file of nodes does."""
    scope = workspace.scope(viewpoint)
    others = scope.node_paths if workspace.factory is None else (*scope.paths, *scope.node_paths)
    definitions = scope.all(kind, name) if others else ()
    other = next(
        (definition for definition in definitions if definition.path != viewpoint and definition.path in others), None
    )
    return _declaration(workspace, other) if other is not None and definitions[0].path == viewpoint else None


@of_name
def is_repeated(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> bool:
    """Whether a name has several definitions."""
    return len(workspace.scope(viewpoint).all(kind, name)) > 1


# ---- the scope ----


@of_viewpoint
def outside_entries(workspace: Workspace, viewpoint: str) -> tuple[OutsideEntry, ...]:
    """The known entries of the root blackboard that the program sets or reads."""
    if workspace.factory is not None and workspace.factory.entries:
        return workspace.factory.entries
    nav2 = _distribution(workspace, viewpoint)
    if nav2 is None:
        return ()
    from btq_lang.catalog.nav2.navigator import outside_entries as entries_of  # only for Nav2

    return entries_of(nav2)


@of_viewpoint
def is_of_navigator(workspace: Workspace, viewpoint: str) -> bool:
    """Whether bt_navigator is what loads a file: its factory says so, or there are none and the project names only
    nodes of Nav2."""
    if workspace.factory is not None:
        return bool(workspace.factory.nav2)
    paths = workspace.scope(viewpoint).node_paths
    return bool(paths) and not workspace.project.factories and set(paths).issubset(FILES.values())


@of_viewpoint
def node_paths(workspace: Workspace, viewpoint: str) -> tuple[str, ...]:
    """The files whose models count for a file, and nothing else in them."""
    return workspace.scope(viewpoint).node_paths


@of_viewpoint
def signs(workspace: Workspace, viewpoint: str) -> Signs | None:
    """What an XML file says of its version of the engine; None for any other file."""
    return workspace.files[viewpoint].signs


@of_viewpoint
def has_palette(workspace: Workspace, viewpoint: str) -> bool:
    """Whether the models in scope are meant to be complete: a TreeNodesModel, or models of another file.  Models of
    Nav2 or of C++ sources are not, for programs register nodes of other packages, too."""
    scope = workspace.scope(viewpoint)
    files = workspace.files
    beside = (path for path in scope.node_paths if path not in FILES.values() and not files[path].is_cpp)
    for path in (*scope.paths, *beside):
        for entry in workspace.files[path].parsed.entries:
            if isinstance(entry.item, Models) and any(_is_of_node(model) for model in entry.item.models):
                return True
            if path != viewpoint and _is_of_node(entry.item):
                return True
    return False


@of_viewpoint
def clashes(workspace: Workspace, viewpoint: str) -> tuple[tuple[Facts, Declaration, Declaration], ...]:
    """The names that an included file and one included before it both define: the include, the definition that counts
    and the other one.  The two files do not see each other, so no check of theirs reports it, except in a factory."""
    if workspace.factory is not None:
        return ()
    file = workspace.files[viewpoint]
    collisions: list[tuple[Facts, Declaration, Declaration]] = []
    earlier: set[str] = set()
    for include in file.includes if len(file.includes) > 1 else ():
        target = workspace.included_by(viewpoint, include)
        brought = workspace.closure(target) if target is not None else ()
        for path in brought if earlier else ():
            for second in workspace.files[path].defined if path not in earlier else ():
                first = workspace.scope(viewpoint).find(second.symbol.kind, second.symbol.name)
                if first is not None and first.path in earlier and first.path not in brought:
                    both = _declaration(workspace, first), _declaration(workspace, second)
                    collisions.append((file.facts[id(include)], *both))
        earlier.update(brought)
    return tuple(collisions)


@of_viewpoint
def text_below(
    workspace: Workspace, viewpoint: str, tree: str, port: str, version: str
) -> tuple[Place, str, str] | None:
    """The first text port to which a port of a tree is assigned in that tree or below: its place, its name, its
    node."""
    for met in meetings(workspace.scope(viewpoint), version, tree, port):
        if is_text(met.type):
            place = Place(met.pair.key.span, met.tree.path, met.tree.entry.item)
            return place, met.pair.key.text, met.node.head.text
    return None


@of_viewpoint
def types_below(
    workspace: Workspace, viewpoint: str, tree: str, port: str, version: str
) -> tuple[tuple[Place, str, str, str], ...]:
    """The ports to which a port of a tree is assigned in that tree or below: place, name, node and type of each."""
    return tuple(
        [
            (
                Place(met.pair.key.span, met.tree.path, met.tree.entry.item),
                met.pair.key.text,
                met.node.head.text,
                met.type,
            )
            for met in meetings(workspace.scope(viewpoint), version, tree, port)
        ]
    )


@of_viewpoint
def read_below(
    workspace: Workspace, viewpoint: str, tree: str, port: str, version: str
) -> tuple[Place, str, str, str] | None:
    """The first port that reads what is passed to a port of a tree, in that tree or below: place, name, node and type;
    None if they have several types, or one of them writes it.
    """
    met = list(meetings(workspace.scope(viewpoint), version, tree, port))
    if len({plain_type(one.type) for one in met}) != 1 or any(one.direction != "input" for one in met):
        return None
    first = met[0]
    place = Place(first.pair.key.span, first.tree.path, first.tree.entry.item)
    return place, first.pair.key.text, first.node.head.text, first.type


@of_viewpoint
def is_run_elsewhere(workspace: Workspace, viewpoint: str, tree: str) -> bool:
    """Whether XML outside of an XML file's scope, which may be registered with it, runs a tree."""
    if workspace.project.pool_of(viewpoint) is None or viewpoint not in workspace.xml:
        return False
    scope = workspace.scope(viewpoint).paths
    return any(path not in scope and tree in workspace.files[path].names_used(Kind.TREE) for path in workspace.xml)


@of_viewpoint
def uses_of_tree(workspace: Workspace, viewpoint: str, name: str) -> tuple[Place, ...]:
    """Where any file refers to the tree of a name."""
    meant = workspace.scope(viewpoint).find(Kind.TREE, name)
    if meant is None:
        return ()
    paths = [path for path in workspace.linked(meant.path) if workspace.scope(path).find(Kind.TREE, name) == meant]
    uses = [(path, entry, use) for path in paths for entry, use in workspace.files[path].uses]
    return tuple(
        [Place(use.span, path, entry.item) for path, entry, use in uses if (use.kind, use.name) == (Kind.TREE, name)]
    )


# ---- the file ----


edition = of_viewpoint(Workspace.edition)
closure = of_viewpoint(Workspace.closure)


@of_viewpoint
def items(workspace: Workspace, viewpoint: str) -> tuple[Facts, ...]:
    """The file's items, in order."""
    return tuple(workspace.files[viewpoint].facts.values())


@of_viewpoint
def first_tree(workspace: Workspace, viewpoint: str) -> Facts | None:
    """The file's first tree: an edit of another one does not change it, as it changes `trees`."""
    return next((facts for facts in workspace.files[viewpoint].facts.values() if isinstance(facts.item, Tree)), None)


@of_viewpoint
def trees(workspace: Workspace, viewpoint: str) -> tuple[Facts, ...]:
    """The file's trees, in order."""
    return tuple([facts for facts in workspace.files[viewpoint].facts.values() if isinstance(facts.item, Tree)])


@of_viewpoint
def first_palette(workspace: Workspace, viewpoint: str) -> Facts | None:
    """The first TreeNodesModel of the file."""
    return next((facts for facts in workspace.files[viewpoint].facts.values() if is_palette(facts.item)), None)


def is_palette(item: Item) -> bool:
    """Whether an item is a TreeNodesModel, also one with attributes, which the language has no words for."""
    return isinstance(item, Models) or (
        isinstance(item, Verbatim) and item.text is not None and _PALETTE(item.text.text) is not None
    )


@of_viewpoint
def is_tree_of_mission(workspace: Workspace, viewpoint: str, name: str) -> bool:
    """Whether a file that is linked with this one by includes, in either direction, has a tree of the name."""
    return workspace.factory is None and any(
        (Kind.TREE, name) in workspace.files[path].defined_names for path in workspace.linked(viewpoint)
    )


@of_viewpoint
def taken_names(workspace: Workspace, viewpoint: str, but: str, version: str) -> dict[str, str]:
    """The names that a tree of the mission cannot have in XML for a version, because other trees or nodes have them,
    with what has each."""
    taken = dict.fromkeys(BUILTINS, "a built-in node")
    trees: dict[str, str] = {}
    for path in sorted(workspace.linked(viewpoint)):
        for kind, name in sorted(workspace.files[path].defined_names, key=lambda defined: defined[1]):
            if kind is Kind.TREE and name != but:
                is_refused = model_name_problem(name, version) is not None
                trees[legal_name(name) if is_refused else name] = f"the tree `{name}`"
            elif kind is Kind.MODEL:
                taken[name] = f"the node `{name}`"
    return taken | trees


@of_viewpoint
def is_node_name(workspace: Workspace, viewpoint: str, name: str) -> bool:
    """Whether a path can name a node by this name."""
    return any(name in workspace.files[path].names_used("node_names") for path in workspace.scope(viewpoint).paths)


@of_viewpoint
def is_asked_for(workspace: Workspace, viewpoint: str, name: str) -> bool:
    """Whether a condition, a bound or an argument in the file names it."""
    return name in workspace.files[viewpoint].names_used("asked_for")


@of_viewpoint
def is_asked_for_by_scenarios(workspace: Workspace, viewpoint: str, name: str) -> bool:
    """Whether a file of scenarios that includes this one names it."""
    return any(
        name in file.names_used("asked_for") and viewpoint in workspace.closure(path)
        for path, file in workspace.files.items()
        if file.has_only_scenarios
    )


@of_viewpoint
def asked_for_in_vain(workspace: Workspace, viewpoint: str) -> frozenset[str]:
    """The names in the file's conditions, bounds and arguments that are neither signals nor contexts."""
    find = workspace.scope(viewpoint).find
    names = workspace.files[viewpoint].names_used("asked_for")
    return frozenset([name for name in names if not (find(Kind.SIGNAL, name) or find(Kind.CONTEXT, name))])


@of_viewpoint
def own_trees(workspace: Workspace, viewpoint: str) -> tuple[str, ...]:
    """The names of the file's trees, in order."""
    return workspace.files[viewpoint].names.by_kind[Kind.TREE]


@of_viewpoint
def has_apply(workspace: Workspace, viewpoint: str) -> bool:
    """Whether the file attaches requirements to nodes from outside."""
    return bool(workspace.files[viewpoint].of_type(Apply))


@of_viewpoint
def has_root_of_tree(workspace: Workspace, viewpoint: str) -> bool:
    """Whether the file names the main tree, even if that does not exist."""
    facts = workspace.files[viewpoint].facts.values()
    return any(Kind.TREE in of_item.used for of_item in facts if isinstance(of_item.item, Root))


@of_viewpoint
def root(workspace: Workspace, viewpoint: str) -> int | None:
    """Where a name may be inserted after the word Root, if there is one: an offset in the file."""
    file = workspace.files[viewpoint]
    return next((file.start_of(item) + item.start + len("Root") for item in file.of_type(Root)), None)


@of_viewpoint
def has_pointers(workspace: Workspace, viewpoint: str) -> bool:
    """Whether any entry of a blackboard may be named in the file."""
    return "{" in workspace.files[viewpoint].text


@of_viewpoint
def main_tree(workspace: Workspace, viewpoint: str) -> tuple[str, bool] | None:
    """The name of the tree that runs when the engine loads the file, and whether it must be this file's own."""
    main = workspace.main_tree(viewpoint)
    if main is None:
        return None
    name = Kind.TREE, main.symbol.name
    return main.symbol.name, main.path == viewpoint and len(workspace.files[viewpoint].names.definitions[name]) == 1


@of_viewpoint
def main_trees(workspace: Workspace, viewpoint: str) -> tuple[str, ...]:
    """The names of all trees that a program may create of what it registers; empty if unknown."""
    if workspace.factory is not None:
        return workspace.factory.main
    main = workspace.main_tree(viewpoint)
    return (main.symbol.name,) if main is not None else ()


@of_viewpoint
def is_first_registered(workspace: Workspace, viewpoint: str) -> bool:
    """Whether this file is the first one in scope that has trees."""
    paths = workspace.scope(viewpoint).paths
    return viewpoint == next((path for path in paths if workspace.files[path].of_type(Tree)), "")


@of_viewpoint
def used(workspace: Workspace, viewpoint: str, kind: Kind) -> frozenset[str]:
    """The names of a kind that the file refers to."""
    return workspace.files[viewpoint].names_used(kind)


@of_viewpoint
def first_user(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> Facts | None:
    """The first of the file's items that refers to a name."""
    return workspace.files[viewpoint].first_users(kind).get(name)


@of_viewpoint
def names_unknown_requirements(workspace: Workspace, viewpoint: str) -> bool:
    """Whether the file refers to a requirement that is defined nowhere."""
    used = workspace.files[viewpoint].names_used(Kind.REQUIREMENT)
    return not used.issubset(workspace.scope(viewpoint).names(Kind.REQUIREMENT))


@of_viewpoint
def custom_node(workspace: Workspace, viewpoint: str, name: str) -> tuple[str, tuple[LikelyPort, ...], int]:
    """The category and the ports that the uses of a custom node suggest, and their number."""
    from btq_lang.workspace.custom_nodes import custom_node as found_in_uses  # few nodes are unknown or lack a value

    custom = found_in_uses(workspace, viewpoint, name)
    return custom.category, custom.ports, custom.uses


@of_viewpoint
def most_have_models(workspace: Workspace, viewpoint: str) -> bool:
    """Whether few of the custom nodes that a file knows or uses have no model: a third at most."""
    declared = workspace.scope(viewpoint).names(Kind.MODEL)
    unknown = workspace.files[viewpoint].names_used(Kind.MODEL).difference(declared)
    return len(declared) >= 2 and 2 * sum(lookup(name) is None for name in unknown) <= len(declared)


@of_viewpoint
def is_crowded(workspace: Workspace, viewpoint: str, kind: Kind) -> bool:
    """Whether so many of the names of a kind are unknown that suggestions are of no use."""
    declared = workspace.scope(viewpoint).names(kind)
    unknown = workspace.files[viewpoint].names_used(kind).difference(declared)
    if kind is Kind.MODEL:
        unknown = unknown.difference(BUILTINS)
    return len(unknown) * (len(declared) + len(BUILTINS)) > _MOST_COMPARED


@of_viewpoint
def is_read(workspace: Workspace, viewpoint: str) -> bool:
    """Whether the whole file could be read."""
    return all(problem.effective_severity is not Severity.ERROR for problem in workspace.files[viewpoint].problems)


@of_viewpoint
def has_torn_tree(workspace: Workspace, viewpoint: str) -> bool:
    """Whether the name of one of the file's trees may be on a line that could not be read."""
    return bool(workspace.files[viewpoint].problems) and any(
        problem.span.start <= entry.item.end
        for entry in workspace.files[viewpoint].parsed.entries
        if entry.diagnostics and isinstance(entry.item, Tree)
        for problem in entry.diagnostics
    )


@of_viewpoint
def is_xml(workspace: Workspace, viewpoint: str) -> bool:
    """Whether the file is XML that the engine loads as it is, without a build."""
    return workspace.files[viewpoint].is_xml


@of_viewpoint
def syntax_errors(workspace: Workspace, viewpoint: str) -> tuple[tuple[Place, str], ...]:
    """The errors that keep the file from being read."""
    entries = workspace.files[viewpoint].parsed.entries
    return tuple(
        [
            (Place(problem.span, viewpoint, entry.item), problem.message)
            for entry in entries
            for problem in entry.diagnostics
            if problem.effective_severity is Severity.ERROR
        ]
    )


@of_viewpoint
def head(workspace: Workspace, viewpoint: str) -> tuple[int, str]:
    """Where a line may be inserted into the head of the file, after its includes, and its indentation: an offset in the
    file."""
    file = workspace.files[viewpoint]
    for last in file.includes[-1:]:
        start = file.start_of(last)
        if offset := file.text.find("\n", start + last.end) + 1:
            return offset, file.text[start : start + last.start]
    return (1 if file.text.startswith("\ufeff") else 0), ""


# ---- the project ----


@of_viewpoint
def included(workspace: Workspace, viewpoint: str, include: Facts) -> str | None:
    """The file that an include refers to, if it is there."""
    return workspace.included_by(viewpoint, include.item) if isinstance(include.item, Include) else None


@of_name
def elsewhere(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> tuple[str, ...]:
    """The files that define a name, whether they are in scope or not."""
    return workspace.files_defining(kind, name)


@of_viewpoint
def other_files(workspace: Workspace, viewpoint: str) -> tuple[str, ...]:
    """The project's other files, as an include in this one names them."""
    folder = posixpath.dirname(viewpoint) or "."
    return tuple(posixpath.relpath(other, folder) for other in workspace.files if other != viewpoint)


# How many names one file's misspelt ones are compared with: 30 ms of work, a second where all look alike (rq_0001 …).
_MOST_COMPARED = 20_000


def _is_of_node(item: object) -> bool:
    return isinstance(item, Model) and item.category.raw != "SubTree"


def _declaration(workspace: Workspace, definition: Definition) -> Declaration:
    return Declaration(
        definition.path, workspace.files[definition.path].facts[id(definition.entry.item)], definition.symbol
    )


def _distribution(workspace: Workspace, viewpoint: str) -> str | None:
    return distribution_among(workspace.scope(viewpoint).node_paths)


distribution = of_viewpoint(_distribution)


_PALETTE = re.compile(r"\s*<\s*TreeNodesModel\b").match
