"""The diagnostics of a parameter file and of the files that bt_navigator loads by it.

One invariant: without a distribution there is no diagnostic that depends on one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.btcpp.recognition import listed_trees
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2.navigator import OWN_PACKAGE
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.nav2.libraries import NAMES, Libraries, own_libraries
from btq_lang.nav2.loaded import Load, SkippedFile, file_with
from btq_lang.nav2.names import OwnCode, parameter_findings, unknown_parameters
from btq_lang.nav2.parameters import Parameters
from btq_lang.syntax.tree import Tree
from btq_lang.util.record import Record, replace
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span
from btq_lang.workspace.workspace import Workspace


class NavigatorTree(Record):
    """A tree that bt_navigator creates, with the files that it registers for it."""

    load: Load
    workspace: Workspace


def findings(
    parameters: Parameters, distribution: str, trees: Iterable[NavigatorTree]
) -> Iterator[tuple[str | None, Diagnostic]]:
    """All diagnostics, each with its file; None is the parameter file."""
    trees = tuple(trees)
    libraries = Libraries(parameters, distribution, own_libraries(tree.workspace for tree in trees))
    results: list[tuple[str | None, Diagnostic]] = []
    of_names = unknown_parameters(parameters, distribution, _own_code(parameters, libraries, trees))
    results += ((None, diagnostic) for diagnostic in (*parameter_findings(parameters, distribution), *of_names))
    results += ((None, diagnostic) for diagnostic in libraries.findings())
    for tree in trees:
        results += ((None, diagnostic) for diagnostic in _unloaded(tree, parameters, libraries))
    for load, diagnostic in _of_loads(parameters, distribution, trees):
        results += [(goal.path, replace(diagnostic, span=goal.span)) for goal in load.goals] or [(None, diagnostic)]
    yield from dict.fromkeys(results)


def _own_code(parameters: Parameters, libraries: Libraries, trees: Iterable[NavigatorTree]) -> OwnCode:
    files = {path: file.source for tree in trees for path, file in tree.workspace.files.items() if file.is_cpp}
    has_navigator = any(not plugin.text.startswith(OWN_PACKAGE) for _, plugin in parameters.plugins)
    return OwnCode(tuple(files.values()), has_navigator or not libraries.are_of_nav2)


def wrong_goals(
    parameters: Parameters, distribution: str, trees: Iterable[NavigatorTree]
) -> Iterator[tuple[str, Diagnostic]]:
    """The diagnostics of the trees that goals name, each with that name; without related places, as their files need
    not be loaded."""
    for load, diagnostic in _of_loads(parameters, distribution, trees):
        tree_name = load.main or (load.tree.named if load.tree is not None else None)
        if load.goals and tree_name is not None:
            yield tree_name.text, replace(diagnostic, related=())


def _of_loads(
    parameters: Parameters, distribution: str, trees: Iterable[NavigatorTree]
) -> Iterator[tuple[Load, Diagnostic]]:
    """What is wrong with the trees that bt_navigator creates and with the files that it registers for them."""
    reported_paths: set[str | None] = set()
    for tree in trees:
        of_load = [*_places(tree), *_folders(tree.load, parameters, reported_paths)]
        of_load += _without_main(tree, parameters) if distribution != "lyrical" else ()
        yield from ((tree.load, diagnostic) for diagnostic in of_load)


# ---- trees and folders ----


def _places(navigator_tree: NavigatorTree) -> Iterator[Diagnostic]:
    """Files, folders and trees that parameters or goals name and that do not exist."""
    load = navigator_tree.load
    for place in (load.tree, *(load.folders if not load.goals else ())):
        if place is None or not place.problem or place.named is None:
            continue
        is_folder = place is not load.tree
        what = "folder" if is_folder else "tree"
        message = f"cannot find the {what} `{place.named.text}`: {place.problem}"
        notes = ("a launch file may put another value here",) if not load.goals else ()
        if not place.named.text:
            holder = "item" if is_folder else "parameter"
            message, notes = f"this {holder} is empty and names no {what}; a launch file may set it", ()
        if place.severity is Severity.ERROR and not load.goals:
            refused = "bt_navigator refuses to start"
            notes = ("without this folder bt_navigator loads no tree at all",) if is_folder else (refused,)
        yield Diagnostic("missing-nav2-tree", place.named.span, message, notes=notes, severity=place.severity)
    if load.main is not None and load.is_whole and not _defines(navigator_tree.workspace, load.main.text):
        if any(load.main.text in skipped.ids for skipped in load.skipped):
            return  # which is reported
        more = did_you_mean(near(load.main.text, _tree_names(navigator_tree.workspace), 1))
        related: tuple[Related, ...] = ()
        outside = file_with(load.main.text, navigator_tree.workspace.project.root)
        if outside is not None:
            more = f"; `{_name(outside)}` has one, but is in none of them"
            related = (Related(outside, "this file"),)
        message = f"no file in the search directories has a tree `{load.main.text}`{more}"
        notes = ("a file is named by a path that ends in `.xml`",)
        yield Diagnostic("missing-nav2-tree", load.main.span, message, related, notes)


def _without_main(navigator_tree: NavigatorTree, parameters: Parameters) -> Iterator[Diagnostic]:
    """A file that has several trees, with its includes, and names no main one.  Lyrical creates a tree by its ID."""
    load, workspace = navigator_tree.load, navigator_tree.workspace
    top = workspace.files.get((load.tree.path if load.tree is not None else None) or "")
    listed = listed_trees(top.source) if top is not None else None
    if top is None or listed is None or listed[1] is not None:
        return
    trees = {
        tree.name.text: Place(file.on_disk(tree.name.span.shifted(file.start_of(tree))), file.path)
        for file in (workspace.files[path] for path in workspace.registered)
        for tree in file.of_type(Tree)
        if tree.name is not None
    }
    if len(trees) > 1:
        place = Place(Span(0, 0), top.path)
        message = f"bt_navigator refuses `{_name(place)}`: nothing says which of {len(trees)} trees is the main one"
        related = (Related([*trees.values()][1], "second tree"),)
        notes = ("write `main_tree_to_execute`",)
        yield Diagnostic("refused-tree-file", _span(place, load, parameters), message, related, notes)


def _folders(load: Load, parameters: Parameters, reported_paths: set[str | None]) -> Iterator[Diagnostic]:
    """The files that bt_navigator skips or refuses, except those already reported, to which these are added."""
    for place in load.refused:
        if place.path not in reported_paths:
            name = _name(place)
            which = "nothing says which of its trees is the main one"
            message = f"`{name}` keeps bt_navigator from loading any tree: {which}"
            notes = ("write `main_tree_to_execute`, or one tree into each file",)
            span = _span(place, load, parameters)
            yield Diagnostic("refused-tree-file", span, message, (Related(place, "second tree"),), notes)
    for skipped in load.skipped:
        if skipped.place.path not in reported_paths:
            yield _skipped(skipped, load, parameters)
    reported_paths.update(place.path for place in (*load.refused, *(skipped.place for skipped in load.skipped)))


def _skipped(skipped: SkippedFile, load: Load, parameters: Parameters) -> Diagnostic:
    name, other = _name(skipped.place), _name(skipped.other)
    if name == other:  # in two folders
        name, other = (_name(place, 2) for place in (skipped.place, skipped.other))
    related: tuple[Related, ...] = (Related(skipped.place, "this file"),)
    message = f"bt_navigator skips `{name}`, which has no tree with an ID"
    notes: tuple[str, ...] = ()
    if skipped.other is not None:
        message = f"bt_navigator skips `{name}` or `{other}`: both have a tree `{skipped.id}`"
        notes = ("folders are read in no defined order, and a file is skipped as a whole",)
        if load.tree is not None and skipped.other.path == load.tree.path:
            message = f"bt_navigator skips `{name}`: `{other}` has a tree `{skipped.id}` too"
            notes = ("a file is skipped as a whole",)
        related = (*related, Related(skipped.other, "other file"))
    severity = None if skipped.loses else Severity.HINT
    span = _span(skipped.place, load, parameters)
    return Diagnostic("skipped-tree-file", span, message, related, notes, severity=severity)


def _span(file: Place, load: Load, parameters: Parameters) -> Span:
    """The span in the parameters that names a file or a folder around it."""
    path = file.path or ""
    for place in (load.tree, *load.folders):
        if place is None or place.path is None or place.named is None:
            continue
        if path == place.path or path.startswith(f"{place.path}/"):
            return place.named.span
    return parameters.place or Span(0, 0)


def _name(place: Place | None, parts: int = 1) -> str:
    """The name of a file, or the end of its path with some folders."""
    return "/".join(((place.path if place is not None else None) or "").split("/")[-parts:])


# ---- nodes ----


def _unloaded(navigator_tree: NavigatorTree, parameters: Parameters, libraries: Libraries) -> Iterator[Diagnostic]:
    """Nodes that nothing registers."""
    span = parameters.key(NAMES) or parameters.place or Span(0, 0)
    refused = ("while such a file is in a search directory, bt_navigator loads no tree at all",)
    notes = refused if navigator_tree.load.folders else ()  # as Lyrical does
    for name, place in _strangers(navigator_tree.workspace).items():
        if name in libraries.nodes:
            continue
        related = (Related(place, "used here"),)
        library = libraries.library_of(name)
        if library is not None:
            message = f"bt_navigator does not load the library of `{name}`: add `{library}`"
            yield Diagnostic("unloaded-node", span, message, related, notes)
        elif libraries.are_all_known:
            message = f"no library that bt_navigator loads has a node `{name}`"
            yield Diagnostic("unloaded-node", span, message, related, (f"name its library in `{NAMES}`", *notes))


def _strangers(workspace: Workspace) -> dict[str, Place]:
    """The nodes in registered files that are not the engine's, each with the place where it is first used."""
    first_uses: dict[str, Place] = {}
    for path in workspace.registered:
        file = workspace.files[path]
        names = {
            name
            for name in file.names_used(Kind.MODEL)
            if name not in BUILTINS and name not in KNOWN_WORDS and not _defines(workspace, name)
        }
        for entry, use in file.uses if names else ():
            if use.kind is Kind.MODEL and use.name in names:
                first_uses.setdefault(use.name, Place(file.on_disk(use.span.shifted(entry.start)), path))
    return first_uses


def _defines(workspace: Workspace, tree: str) -> bool:
    return any(workspace.files[path].defines(Kind.TREE, tree) for path in workspace.registered)


def _tree_names(workspace: Workspace) -> list[str]:
    return [name for path in workspace.registered for name in workspace.files[path].names_of(Kind.TREE)]
