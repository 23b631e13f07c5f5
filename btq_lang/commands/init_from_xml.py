"""`btq init --from-xml`: a project file with the existing XML files that are registered together.

One invariant: only the project file is written, and with `--convert` the .btq files that an import makes.
"""

from __future__ import annotations

import json
import os
import posixpath
import shlex
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import cache, partial
from importlib.util import find_spec

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import ENGINES, PACKAGED
from btq_lang.catalog.versions import VERSION_3, VERSIONS, is_before_4
from btq_lang.checks import check_each
from btq_lang.checks.engines import declared_engines
from btq_lang.commands.init_lines import (
    OF_NAV2,
    NodesLines,
    Trouble,
    free_name,
    navigator_tables,
    nodes_for,
    nodes_lines,
)
from btq_lang.commands.packages import Packages, packages_of
from btq_lang.projects.files import Files
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.projects.tree_servers import TreeServer
from btq_lang.projects.xml_below import XmlBelow
from btq_lang.syntax.tree import Tree
from btq_lang.util.record import Record, replace
from btq_lang.util.text import counted
from btq_lang.workspace.file import GROOT_SUFFIX
from btq_lang.workspace.loader import absolute, matching, shown, write_whole
from btq_lang.workspace.workspace import Workspace

_HEAD = "# What holds for all missions of this project\n"
_ENGINES = f"engine = {json.dumps(VERSIONS)}  # the versions of BehaviorTree.CPP that must load them\n"
_WIDTH = 120
_MANY_MORE = 10
_EXCLUDED = """\
exclude = {}  # converted; delete the line when `btq build` writes these files
"""


def init_from_xml(top: str, converts: bool, messages: CommandOutput) -> int:
    """Write the project file of a folder, unless there is one; returns the exit code.

    Args:
        top: the folder as the command line names it.
        converts: write .btq files beside the XML, too.

    Raises:
        Refused: there is a project file, or no XML; the file cannot be written.
    """
    folder = absolute(top)
    target = f"{folder}/btq.toml"
    if os.path.lexists(target):
        raise Refused(f"{shown(target)} is there already; nothing was written")
    workspace = _xml_below(folder)
    if not workspace.files:
        raise Refused(f"no BehaviorTree.CPP XML below {top}; nothing was written")
    packages = packages_of(folder)
    factories = [*_factories(workspace, packages, folder, messages)]
    if converts and (code := _convert(workspace, target, packages, messages)):
        return code
    engine = _engine_line(workspace, packages) if packages.product or not converts else _ENGINES
    ending = ".btq" if converts else ".xml"
    rest = _excluded_line(workspace, folder) if converts else ""
    rest += "".join(f"\n{factory.written(ending)}" for factory in factories)

    problems_with = cache(partial(_problems_with, folder))

    def trouble(project: str, before: str) -> Trouble:
        """The problems that one project file has and another has not."""
        unreadable, unknown = problems_with(project)
        unreadable_before, unknown_before = problems_with(before)
        return Trouble(
            tuple([why for why in unreadable if why not in unreadable_before]),
            tuple([what for place, what in unknown.items() if place not in unknown_before]),
        )

    def with_engine(nodes: str) -> str:
        """A distribution of Nav2 has a version of its own."""
        return nodes if _names_distribution(nodes) else engine + nodes

    named = nodes_for(workspace, packages, lambda nodes: trouble(with_engine(nodes) + rest, engine + rest))
    nodes = nodes_lines(named)
    text = with_engine(nodes) + rest
    unknown = len(trouble(text, engine + rest).unknown)
    navigators = navigator_tables(
        packages,
        [factory.name for factory in factories],
        [f"{pattern}{ending}" for pattern in _named_by_programs(workspace, packages, folder)],
        lambda distribution: _names_distribution(nodes) or _fits(distribution, named, packages.engines),
        lambda tables: trouble(text + tables, text),
    )
    text += navigators
    try:
        write_whole(target, f"{_HEAD}{text}")
    except OSError as error:
        raise Refused(f"{shown(target)}: {error.strerror}") from error
    count = text.count("\n[[factory]]")
    how_many = f"{count or 'no'} factor{'y' if count == 1 else 'ies'}"
    in_trees = f" With its nodes btq finds {counted(unknown, 'problem')} in the trees." if unknown else ""
    messages.result(f"Wrote {shown(target)} with {how_many}.{in_trees} Next: btq check {shlex.quote(top)}")
    return 0


def _convert(workspace: Workspace, target: str, packages: Packages, messages: CommandOutput) -> int:
    """Write .btq files beside the XML; returns the exit code."""
    from btq_lang.projects.import_files import ImportOptions, import_files

    files = [shown(path) for path in workspace.files if not path.endswith(GROOT_SUFFIX)]
    engine = packages.product or packages.engines
    overlay = {target: f"engine = {json.dumps(engine)}\n"} if engine else {}
    result = import_files(ImportOptions(files), overlay)
    messages.extend(result.messages)
    return result.code


def _excluded_line(workspace: Workspace, folder: str) -> str:
    """The line that leaves out converted XML."""
    trees, models = _by_kind(workspace)
    excluded = [f"/{pattern}.xml" for pattern in patterns(folder, trees, models)]
    return _EXCLUDED.format(json.dumps(excluded, ensure_ascii=False)) if excluded else ""


def _names_distribution(nodes: str) -> bool:
    """Whether the lines for nodes name those of a distribution of Nav2."""
    return any(f'"{name}"' in nodes for name in PACKAGED)


def _fits(distribution: str | None, named: tuple[NodesLines, ...], engines: tuple[str, ...]) -> bool:
    """Whether a distribution is that of the engine, and no trees use nodes of another one."""
    if distribution is None or any(OF_NAV2 in lines.patterns for lines in named):
        return False
    return not engines or is_before_4(ENGINES[distribution]) == is_before_4(engines[-1])


class _Together(Record):
    """Files that need each other, as a factory.

    Attributes:
        load: patterns without the suffix of the files.
        main: the trees that no other tree runs.
        nodes: the files of models, as patterns with their suffixes.
    """

    name: str
    load: tuple[str, ...]
    main: tuple[str, ...]
    nodes: tuple[str, ...]

    def written(self, ending: str) -> str:
        """The table in the project file; `ending`: the suffix of the files."""
        values = {
            "name": self.name,
            "load": [f"{pattern}{ending}" for pattern in self.load],
            "main": self.main[0] if len(self.main) == 1 else list(self.main),
            "nodes": list(self.nodes),
        }
        return "[[factory]]\n" + "".join(_line(key, value) for key, value in values.items() if value)


def _line(key: str, value: Sequence[str]) -> str:
    """A key of the project file; a list that is too long for a line has an item on each."""
    line = f"{key} = {json.dumps(value, ensure_ascii=False)}\n"
    return line if len(line) <= _WIDTH else f"{key} = {json.dumps(value, ensure_ascii=False, indent=4)}\n"


def _xml_below(folder: str) -> Workspace:
    """The XML files of the engine below a folder, each with all of them as its pool."""
    groups, _ = Files().groups([folder], with_xml=True)
    files = {
        path: group.workspace.files[path]
        for group in groups
        for path in group.given
        if group.workspace.files[path].is_foreign
    }
    project = groups[0].workspace.project if groups else Workspace.of({}).project
    return Workspace(files, replace(project, pools=(folder,)))


def _factories(workspace: Workspace, packages: Packages, folder: str, messages: CommandOutput) -> Iterator[_Together]:
    """The files that belong together; if two files define the same tree, they do not."""
    trees_in, _ = _by_kind(workspace)
    names: set[str] = set()
    groups = _connected(workspace, packages.programs.servers)
    grouped = {path for paths in groups for path in paths}
    for paths in groups:
        trees = [name for path in paths for name in workspace.files[path].names_of(Kind.TREE)]
        if len(set(trees)) < len(trees):
            twice = next(name for name in sorted(trees) if trees.count(name) > 1)
            files = ", ".join(shown(path) for path in paths)
            messages.remark(f"not a factory, because several define the tree `{twice}`: {files}")
            continue
        if outside := _outside(workspace, paths, frozenset(trees)):
            runner, tree, elsewhere = outside
            why = f"{shown(runner)} runs the tree `{tree}`, which {' and '.join(map(shown, elsewhere))} define"
            messages.remark(f"not a factory, because {why}: {', '.join(map(shown, paths))}")
            continue
        paths += _beside(workspace, paths, [path for path in trees_in if path not in grouped])
        trees = [name for path in paths for name in workspace.files[path].names_of(Kind.TREE)]
        name = posixpath.basename(posixpath.commonpath([posixpath.dirname(path) for path in paths])) or "robot"
        name = free_name(name, names)
        names.add(name)
        items = [facts for path in paths for facts in workspace.files[path].facts.values()]
        called = {other for facts in items if isinstance(facts.item, Tree) for other in facts.runs}
        targets = [target for target in packages.programs.targets if target in trees]
        main = dict.fromkeys((*targets, *sorted(tree for tree in trees if tree not in called)))
        others = [path for path in trees_in if path not in paths]
        nodes = _nodes_of(workspace, packages, folder, paths)
        if nodes is None:
            messages.remark(f"the factory `{name}` has no `nodes`, because all models are of other packages")
        yield _Together(name, tuple(patterns(folder, paths, others)), tuple(main), nodes or ())


def _nodes_of(workspace: Workspace, packages: Packages, folder: str, paths: Sequence[str]) -> tuple[str, ...] | None:
    """The models in the packages of some files and outside of packages, or else the C++ of the packages whose libraries
    a server loads for these files; None if all models are of other packages."""
    trees_in, models = _by_kind(workspace)
    homes = {_package_of(path, folder) for path in paths}
    own = [path for path in models if "" in homes or _package_of(path, folder) in ("", *homes)]
    if not own and models:
        loaded = [
            posixpath.relpath(package, folder)
            for server in packages.programs.servers
            if any(posixpath.dirname(path) in server.folders for path in paths)
            for package in server.packages
        ]
        is_read = find_spec("tree_sitter_cpp") is not None
        return (packages.sources_in(loaded) if is_read else ()) or None
    of_groot = (posixpath.relpath(path, folder) for path in own if path.endswith(GROOT_SUFFIX))
    xml = [path for path in own if not path.endswith(GROOT_SUFFIX)]
    others = [path for path in (*trees_in, *models) if path not in own]
    return (*(f"{pattern}.xml" for pattern in patterns(folder, xml, others)), *of_groot)


def _package_of(path: str, top: str) -> str:
    """The folder of the package that a file below a folder is in; empty if it is in none."""
    around = (place for place in _folders(path, top) if os.path.isfile(f"{place}/package.xml"))
    return max(around, key=len, default="")


def _outside(
    workspace: Workspace, paths: Sequence[str], trees: frozenset[str]
) -> tuple[str, str, tuple[str, ...]] | None:
    """A file of a group that runs a tree which no file of the group defines; that tree; and the other files that define
    it, any of which the program may load."""
    for path in paths:
        for name in sorted(workspace.files[path].names_used(Kind.TREE) - trees):
            definitions = workspace.pooled(path, Kind.TREE, name)
            if len(definitions) > 1:
                return path, name, tuple(sorted(definition.path for definition in definitions))
    return None


def _beside(workspace: Workspace, paths: list[str], lone: list[str]) -> list[str]:
    """Files that need no other, in a folder with many more of a factory: its program loads the whole folder."""
    members, others = (Counter(map(posixpath.dirname, each)) for each in (paths, lone))
    names = {name for path in paths for name in workspace.files[path].names_of(Kind.TREE)}
    beside: list[str] = []
    for path in lone:
        own = workspace.files[path].names_of(Kind.TREE)
        folder = posixpath.dirname(path)
        if others[folder] * _MANY_MORE <= members[folder] and names.isdisjoint(own):
            names.update(own)
            beside.append(path)
    return beside


def _engine_line(workspace: Workspace, packages: Packages) -> str:
    """The line that names the versions of the engine: those that packages depend on, or else version 3 if some files
    are written for it, and none for version 4."""
    if packages.product:
        return f"engine = {json.dumps(packages.product)}  # the packages depend on {packages.depends_on}\n"
    if packages.engines:
        why, is_old = f"the packages depend on {packages.depends_on}", is_before_4(packages.engines[-1])
    else:
        engines = {workspace.store.ask(declared_engines, path) for path in workspace.files}
        why, is_old = "the XML is written for version 3 of BehaviorTree.CPP", engines - {()} == {(VERSION_3,)}
    return f"engine = {json.dumps(VERSION_3)}  # {why}\n" if is_old else _ENGINES


def _named_by_programs(workspace: Workspace, packages: Packages, folder: str) -> Iterator[str]:
    """Patterns for the files with trees that Python or launch files name."""
    trees, _ = _by_kind(workspace)
    named = [path for path in trees if posixpath.basename(path) in packages.named]
    yield from patterns(folder, named, [path for path in trees if path not in named])


def _problems_with(folder: str, project: str) -> tuple[tuple[str, ...], dict[tuple[str, int], str]]:
    """If this is the project file: why some files cannot be read, and the unknown nodes and ports, by place."""
    files = Files()
    files.overlay[f"{folder}/btq.toml"] = project
    groups, problems = files.groups([folder], with_xml=True, for_checks=True)
    unknown = {
        (path, diagnostic.span.start): f"with it btq finds in {shown(path)}: {diagnostic.message}"
        for group in groups
        for path, diagnostics in zip(group.given, check_each(group.workspace, group.given), strict=True)
        for diagnostic in diagnostics
        if diagnostic.rule in ("unknown-node", "unknown-port")
    }
    return tuple([problem.message for problem in problems]), unknown


def _by_kind(workspace: Workspace) -> tuple[list[str], list[str]]:
    """The files with trees, and those without, which have only models."""
    trees = [path for path, file in workspace.files.items() if file.of_type(Tree)]
    return trees, [path for path in workspace.files if path not in trees]


def _connected(workspace: Workspace, servers: Iterable[TreeServer]) -> list[list[str]]:
    """The files with trees that need each other beyond what they include, or are in a project of Groot2, or in folders
    that one server registers, in groups."""
    group = {path: {path} for path in workspace.files}
    needing = {path for path in workspace.files if path.endswith(GROOT_SUFFIX)}

    def join(one: str, other: str) -> None:
        if group[one] is not group[other]:
            group[one] |= group[other]
            for path in group[other]:
                group[path] = group[one]

    for path, file in workspace.files.items():
        for included in workspace.closure(path):
            join(path, included)
        scope = workspace.scope(path)
        for name in file.names_used(Kind.TREE):
            definitions = () if scope.defines(Kind.TREE, name) else workspace.pooled(path, Kind.TREE, name)
            if len(definitions) == 1:
                join(path, definitions[0].path)
                needing.add(path)
    for server in servers:
        registered = [path for path in workspace.files if posixpath.dirname(path) in server.folders]
        needing.update(registered)
        for path in registered[1:]:
            join(registered[0], path)
    groups = {id(members): members for members in group.values()}
    needed = [sorted(members) for members in groups.values() if not needing.isdisjoint(members)]
    with_trees = [[path for path in members if workspace.files[path].of_type(Tree)] for members in needed]
    return [members for members in with_trees if len(members) > 1]


def patterns(folder: str, paths: Collection[str], others: Collection[str]) -> Iterator[str]:
    """Patterns for some XML files, relative to a folder and without suffix.

    A folder that has several of the files, and no other XML of the engine, is one pattern; with the folders below it,
    if that is true of them too.
    """
    xml = XmlBelow()
    taken: set[str] = set()

    @cache
    def matches_no_other(pattern: str) -> bool:
        unasked = {*matching(folder, f"{pattern}.xml")}.difference(paths)
        return unasked.isdisjoint(others) and not any(map(xml.is_mission, unasked))

    for path in paths:
        if path in taken:
            continue
        for place in _folders(path, folder):
            start = "" if place == folder else f"{posixpath.relpath(place, folder)}/"
            below = {path_below for path_below in paths if path_below.startswith(f"{place}/")}
            directly_in = {path_below for path_below in below if posixpath.dirname(path_below) == place}
            if start and directly_in and len(directly_in) < len(below) and matches_no_other(f"{start}**/*"):
                taken |= below
                yield f"{start}**/*"
                break
            if path in directly_in and len(directly_in) > 1 and matches_no_other(f"{start}*"):
                taken |= directly_in
                yield f"{start}*"
                break
        else:
            yield posixpath.relpath(path, folder).removesuffix(".xml")


def _folders(path: str, top: str) -> Iterator[str]:
    """The folders that a file is in, from the top."""
    names = posixpath.dirname(posixpath.relpath(path, top)).split("/")
    yield top
    for number in range(1, len(names) + 1) if names != [""] else ():
        yield posixpath.join(top, *names[:number])
