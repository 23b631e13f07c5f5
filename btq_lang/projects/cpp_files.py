"""The C++ sources of a project as files: the text of each has the models of the nodes that it registers.

One invariant: a source is parsed once, and again only if its text changes; where a model and a port are in the C++, the
places of the file say.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from btq_lang.catalog.nav2 import DISTRIBUTIONS, ENGINES, FILES, PACKAGED, PACKAGES
from btq_lang.catalog.versions import is_before_4
from btq_lang.cpp.findings import findings, nothing_registered
from btq_lang.cpp.grammar import GrammarMissing
from btq_lang.cpp.macros import Macro, Macros, macros_in
from btq_lang.cpp.model import CppNode, CppNodes
from btq_lang.cpp.nodes import nodes_of
from btq_lang.cpp.source import CppSource
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.parser import parse
from btq_lang.projects.factory_files import cpp_in_folder
from btq_lang.projects.node_writers import models_in_btq
from btq_lang.syntax.tree import models_in
from btq_lang.util.record import Record, replace
from btq_lang.util.source_map import OriginMap
from btq_lang.util.text import LineIndex, Placed, Span
from btq_lang.workspace.config import Project
from btq_lang.workspace.factories import Factory
from btq_lang.workspace.file import CPP_SUFFIXES, File, Origin
from btq_lang.workspace.loader import FoundProject, LoadProblem, excluder, matching, read, shown
from btq_lang.workspace.queries import Store, input_of
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.util.source_map import Piece

_OF_FIELD = re.compile(r".*::_\w+_type").fullmatch
MISSING = "C++ is read with tree-sitter; install it with pip install 'btq-lang[cpp]'"


class ProjectSources(Record):
    """A project with the nodes of its C++ sources.

    Attributes:
        project: its `node_files` with the C++ sources of the whole project.
        files: all of them, by path.
        problems: what keeps nodes from being known, at the place in the project file.
    """

    project: Project
    files: dict[str, File]
    problems: tuple[LoadProblem, ...] = ()

    def declared_in(self, factory: Factory) -> Factory:
        """A factory whose `node_files` have its own C++ sources, too."""
        own = tuple(path for path in factory.cpp_files if path in self.files)
        factory = replace(factory, node_files=(*factory.node_files, *own)) if own else factory
        if not factory.nav2:
            return factory
        from btq_lang.nav2.libraries import unloaded_sources  # few projects are for Nav2

        return replace(factory, unloaded=unloaded_sources(self.files, factory.libraries))


class CppFiles:
    """Reads C++ sources, and remembers them until they change."""

    def __init__(self) -> None:
        self._store: Store[dict[str, str]] = Store({})  # the texts, by path
        self._files: dict[str, File] = {}

    def read(self, home: FoundProject, factories: tuple[Factory, ...]) -> ProjectSources:
        """Read the sources that a project and its factories name."""
        project, problems = home.project, []
        own: dict[str, None] = {}
        for pattern in project.cpp:
            matched = cpp_in_folder(pattern, project.root, matching)
            own.update(dict.fromkeys(matched))
            if not matched:
                problems.append(_problem(home, pattern, f"no C++ file matches `{pattern}`"))
        paths = dict.fromkeys((*own, *(path for factory in factories for path in factory.cpp_files)))
        is_excluded = excluder(project)
        texts = {path: text for path in paths if not is_excluded(path) and (text := read(path)[0]) is not None}
        try:
            nodes, files = self.files(texts, project.root, distributions_of(project))
        except GrammarMissing:
            nodes, files = None, {}
            problems.append(_problem(home, project.cpp_patterns[0], MISSING))
        if nodes is not None and texts and not nodes.nodes and not any(gap.hides_node for gap in nodes.unseen):
            message = nothing_registered({shown(path): text for path, text in texts.items()})
            problems.append(_problem(home, project.cpp_patterns[0], message))
        project = replace(
            project,
            node_files=(*project.node_files, *(path for path in own if path in files)),
            hides_nodes=nodes is None or any(gap.hides_node for gap in nodes.unseen),
        )
        return ProjectSources(project, files, tuple(problems))

    def files(
        self, texts: Mapping[str, str], root: str = ".", distributions: tuple[str, ...] = DISTRIBUTIONS
    ) -> tuple[CppNodes, dict[str, File]]:
        """The nodes of some sources, and a file for each source.

        Args:
            texts: by path.
            root: the folder from which messages name files.
            distributions: those of Nav2 whose base classes may be meant.

        Raises:
            GrammarMissing: tree-sitter is not installed.
        """
        state = self._store.state
        changed = [path for path, text in texts.items() if state.get(path) != text]
        self._store.advance({**state, **texts}, changed)
        macros = Macros(macro for path in texts for macro in self._store.ask(_macros, path))
        nodes = self._store.ask(
            _nodes, distributions, *((path, macros.needed_by(text)) for path, text in texts.items())
        )
        wrong, home = findings(nodes, texts), f"{root.rstrip('/')}/"
        of_path: dict[str, dict[str, CppNode]] = {path: {} for path in texts}
        for node in nodes.nodes:
            of_path[node.place.path][node.name] = node
        for path, text in texts.items():
            named = (
                (diagnostic, diagnostic.message.replace(home, "")) for diagnostic in wrong.get(path, ())
            )  # as people see files
            diagnostics = tuple(replace(diagnostic, message=message) for diagnostic, message in named)
            file = self._files.get(path)
            before = (file.source, file.cpp_nodes, file.source_diagnostics) if file is not None else None
            if before != (text, of_path[path], diagnostics):
                self._files[path] = cpp_file(path, text, of_path[path], diagnostics, file)
        return nodes, {path: self._files[path] for path in texts}


def distributions_of(project: Project) -> tuple[str, ...]:
    """The distributions of Nav2 that a project may be for: those whose nodes it names, else those with its engine."""
    of_factories = (PACKAGED.get(name, "") for factory in project.factories for name in factory.nodes)
    paths = {*project.node_files, *of_factories}
    if named := tuple(distribution for distribution in DISTRIBUTIONS if FILES[distribution] in paths):
        return named
    is_old = is_before_4(project.target)
    return tuple(
        distribution
        for distribution in DISTRIBUTIONS
        if not project.pinned or is_before_4(ENGINES[distribution]) == is_old
    )


def with_code_of_nav2(workspace: Workspace, cpp: CppFiles) -> Workspace:
    """A workspace with the C++ of Nav2's own nodes too, if a checkout is among the packages around its project."""
    root = workspace.project.root
    patterns = [f"package://{package}/**/*{suffix}" for package in PACKAGES for suffix in CPP_SUFFIXES]
    paths = [path for pattern in patterns for path in cpp_in_folder(pattern, root, matching)]
    texts = {path: text for path in paths if (text := read(path)[0]) is not None}
    try:
        _, files = cpp.files(texts, root)
    except GrammarMissing:
        return workspace
    project = replace(workspace.project, node_files=(*workspace.project.node_files, *files))
    return Workspace({**workspace.files, **files}, project, workspace.factory)


def cpp_file(
    path: str,
    text: str,
    nodes: Mapping[str, CppNode],
    diagnostics: tuple[Diagnostic, ...],
    before: File | None = None,
) -> File:
    """A C++ source with the models of the nodes that it registers; it shares with the file before an edit what is the
    same."""
    models = models_in_btq(map(_certain, nodes.values()), f"the nodes that {path} registers") if nodes else ""
    places = OriginMap((), (), lambda *_: tuple(_pieces(models, path, text, nodes)))
    # Not complete: most of what is in the C++ is not in the models, and neither can be edited by the other.
    origin = Origin(text, places, diagnostics, is_complete=False, defines=frozenset(nodes), nodes=nodes)
    return File(path, models, origin) if before is None else before.edited(models, origin)


def _nodes(
    store: Store[dict[str, str]], distributions: tuple[str, ...], *files: tuple[str, tuple[Macro, ...]]
) -> CppNodes:
    return nodes_of((store.ask(_source, path, macros) for path, macros in files), distributions)


def _source(store: Store[dict[str, str]], path: str, macros: tuple[Macro, ...]) -> CppSource:
    return CppSource(path, store.ask(_text, path), macros)


def _macros(store: Store[dict[str, str]], path: str) -> tuple[Macro, ...]:
    return macros_in(path, store.ask(_text, path))


@input_of(lambda path: path)
def _text(texts: dict[str, str], path: str) -> str:
    return texts[path]


def _certain(node: CppNode) -> CppNode:
    """A node with an empty default for each input that it may do without, and without types that only
    other files say: `_error_code_type` is what ROS calls the type of a message's field, whatever it is."""
    needed = {name for name, without in node.without if without == "fails"}
    needed.update(port.name for port in node.ports if port.direction == "output" or port.default is not None)
    ports = tuple(
        replace(
            port,
            default=port.default if port.name in needed else "",
            type="" if _OF_FIELD(port.type) else port.type,
        )
        for port in node.ports
    )
    return replace(node, ports=ports)


def _pieces(models: str, path: str, text: str, nodes: Mapping[str, CppNode]) -> Iterator[Piece]:
    """Where the names in the models are in the C++: a node at its class or, if that is in another file, where it is
    registered; a port of another file likewise."""
    lines = LineIndex(text)
    for entry in parse(models).entries if models else ():
        for model in models_in(entry.item):
            if model.name is None:
                continue
            node = nodes[model.name.text]
            home = (node.class_place if node.class_place.path == path else node.place).span_in(lines)
            yield (*_span(entry.start, model.name), *home)
            places = {port.name: port.place for port in node.ports if port.place.path == path}
            for port in model.ports:
                if port.id is not None:
                    place = places.get(port.id.text)
                    yield (*_span(entry.start, port.id), *(home if place is None else place.span_in(lines)))
    yield len(models), len(models) + len(text), 0, len(text)


def _span(start: int, part: Placed) -> Span:
    return Span(part.start, part.end).shifted(start)


def _problem(home: FoundProject, pattern: str, message: str) -> LoadProblem:
    """A problem of a pattern in the project file."""
    path = home.path or ""
    text = read(path)[0] or ""
    return LoadProblem(path, message, LineIndex(text).position(max(text.find(pattern) - 1, 0)))
