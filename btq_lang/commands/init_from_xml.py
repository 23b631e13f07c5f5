"""`btq init --from-xml`: a project file that says which of the XML files that are there are registered together.

One invariant: only the project file is written, and with `--convert` the .btq files that an import makes.
"""

from __future__ import annotations

import json
import os
import posixpath
import shlex
import sys
from argparse import Namespace
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from functools import cache

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import ENGINES, PACKAGED
from btq_lang.catalog.versions import VERSION_3, VERSIONS, is_before_4
from btq_lang.checks import check_each
from btq_lang.checks.engines import declared_engines
from btq_lang.commands.init_navigators import free_name, navigator_tables
from btq_lang.commands.init_nodes import OF_NAV2, NodesLines, nodes_for, nodes_lines
from btq_lang.commands.output import show
from btq_lang.commands.packages import Packages, packages_of
from btq_lang.projects.files import Files
from btq_lang.projects.options import Refused
from btq_lang.projects.xml_below import XmlBelow
from btq_lang.syntax.tree import Tree
from btq_lang.util.record import Record, replace
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


def run(options: Namespace) -> int:
    """Write the project file, unless there is one."""
    folder = absolute(options.folder)
    target = f"{folder}/btq.toml"
    if os.path.lexists(target):
        raise Refused(f"{shown(target)} is there already; nothing was written")
    workspace = _xml_below(folder)
    if not workspace.files:
        raise Refused(f"no BehaviorTree.CPP XML below {options.folder}; nothing was written")
    factories = [*_factories(workspace, folder)]
    packages = packages_of(folder)
    excluded: list[str] = []
    if options.convert:
        from btq_lang.projects.import_files import ImportOptions, import_files

        files = [shown(path) for path in workspace.files if not path.endswith(GROOT_SUFFIX)]
        overlay = {target: f"engine = {json.dumps(packages.engines)}\n"} if packages.engines else {}
        imported = import_files(ImportOptions(files), overlay)
        show(imported.messages)
        if imported.code:
            return imported.code
        trees, models = _by_kind(workspace)
        excluded = [f"/{each}.xml" for each in patterns(folder, trees, models)]
    engine = _engine_line(workspace, packages) if not options.convert else _ENGINES
    ending = ".btq" if options.convert else ".xml"
    rest = _EXCLUDED.format(json.dumps(excluded, ensure_ascii=False)) if excluded else ""
    rest += "".join(f"\n{each.written(ending)}" for each in factories)

    def trouble(project: str, before: str) -> str:
        """What is unknown with one project file and not with another."""
        known = _unknown_in(folder, before)
        return next((what for place, what in _unknown_in(folder, project).items() if place not in known), "")

    def with_engine(nodes: str) -> str:
        """A distribution of Nav2 has a version of its own."""
        return nodes if _names_distribution(nodes) else engine + nodes

    named = nodes_for(workspace, packages, lambda nodes: trouble(with_engine(nodes) + rest, engine + rest))
    nodes = nodes_lines(named)
    text = with_engine(nodes) + rest
    navigators = navigator_tables(
        packages,
        [each.name for each in factories],
        [f"{each}{ending}" for each in _named_by_programs(workspace, packages, folder)],
        lambda distribution: _names_distribution(nodes) or _fits(distribution, named, packages.engines),
        lambda tables: trouble(text + tables, text),
    )
    try:
        write_whole(target, f"{_HEAD}{text}{navigators}")
    except OSError as error:
        raise Refused(f"{shown(target)}: {error.strerror}") from error
    count = f"{text}{navigators}".count("\n[[factory]]")
    how_many = f"{count or 'no'} factor{'y' if count == 1 else 'ies'}"
    print(f"Wrote {shown(target)} with {how_many}. Next: btq check {shlex.quote(options.folder)}")
    return 0


def _names_distribution(nodes: str) -> bool:
    """Whether the lines for nodes name those of a distribution of Nav2."""
    return any(f'"{name}"' in nodes for name in PACKAGED)


def _fits(distribution: str | None, named: tuple[NodesLines, ...], engines: tuple[str, ...]) -> bool:
    """Whether a distribution is that of the engine, and no trees use nodes of another one."""
    if distribution is None or any(OF_NAV2 in each.patterns for each in named):
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
    """The XML files of the engine below a folder, each of which has all as its pool."""
    groups, _ = Files().groups([folder], with_xml=True)
    files = {
        path: group.workspace.files[path]
        for group in groups
        for path in group.given
        if group.workspace.files[path].is_foreign
    }
    project = groups[0].workspace.project if groups else Workspace.of({}).project
    return Workspace(files, replace(project, pools=(folder,)))


def _factories(workspace: Workspace, folder: str) -> Iterator[_Together]:
    """What belongs together; files of which two define one tree do not, whatever refers to them."""
    trees_in, models = _by_kind(workspace)
    of_groot = (posixpath.relpath(path, folder) for path in models if path.endswith(GROOT_SUFFIX))
    xml = [path for path in models if not path.endswith(GROOT_SUFFIX)]
    nodes = (*(f"{each}.xml" for each in patterns(folder, xml, trees_in)), *of_groot)
    names: set[str] = set()
    groups = _connected(workspace)
    grouped = {path for paths in groups for path in paths}
    for paths in groups:
        trees = [name for path in paths for name in workspace.files[path].names_of(Kind.TREE)]
        if len(set(trees)) < len(trees):
            twice = next(name for name in sorted(trees) if trees.count(name) > 1)
            files = ", ".join(shown(path) for path in paths)
            print(f"not a factory, because several define the tree `{twice}`: {files}", file=sys.stderr)
            continue
        paths += _beside(workspace, paths, [path for path in trees_in if path not in grouped])
        trees = [name for path in paths for name in workspace.files[path].names_of(Kind.TREE)]
        name = posixpath.basename(posixpath.commonpath([posixpath.dirname(path) for path in paths])) or "robot"
        name = free_name(name, names)
        names.add(name)
        items = [facts for path in paths for facts in workspace.files[path].facts.values()]
        called = {other for facts in items if isinstance(facts.item, Tree) for other in facts.runs}
        main = tuple(sorted(each for each in trees if each not in called))
        others = [path for path in trees_in if path not in paths]
        yield _Together(name, tuple(patterns(folder, paths, others)), main, nodes)


def _beside(workspace: Workspace, paths: list[str], lone: list[str]) -> list[str]:
    """Files that need no other, in a folder with many more of a factory: its program loads the whole folder."""
    members, others = (Counter(map(posixpath.dirname, each)) for each in (paths, lone))
    names = {name for path in paths for name in workspace.files[path].names_of(Kind.TREE)}
    found: list[str] = []
    for path in lone:
        own = workspace.files[path].names_of(Kind.TREE)
        folder = posixpath.dirname(path)
        if others[folder] * _MANY_MORE <= members[folder] and names.isdisjoint(own):
            names.update(own)
            found.append(path)
    return found


def _engine_line(workspace: Workspace, packages: Packages) -> str:
    """The line that names the versions of the engine: those that packages depend on, or else version 3 if some files
    are written for it, and none for version 4."""
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


def _unknown_in(folder: str, project: str) -> dict[tuple[str, int], str]:
    """What nodes and ports a check does not know, or what it cannot read, if this is the project file, by place."""
    files = Files()
    files.overlay[f"{folder}/btq.toml"] = project
    groups, problems = files.groups([folder], with_xml=True, for_checks=True)
    return {
        (path, each.span.start): f"with it btq finds in {shown(path)}: {each.message}"
        for group in groups
        for path, found in zip(group.given, check_each(group.workspace, group.given), strict=True)
        for each in found
        if each.rule in ("unknown-node", "unknown-port")
    } | {(problem.message, 0): problem.message for problem in problems}


def _by_kind(workspace: Workspace) -> tuple[list[str], list[str]]:
    """The files with trees, and those without, which have only models."""
    trees = [path for path, file in workspace.files.items() if file.of_type(Tree)]
    return trees, [path for path in workspace.files if path not in trees]


def _connected(workspace: Workspace) -> list[list[str]]:
    """The files with trees that need each other beyond what they include, or are in a project of Groot2, in groups."""
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
            found = () if scope.defines(Kind.TREE, name) else workspace.pooled(path, Kind.TREE, name)
            if len(found) == 1:
                join(path, found[0].path)
                needing.add(path)
    groups = {id(each): each for each in group.values()}
    needed = [sorted(each) for each in groups.values() if not needing.isdisjoint(each)]
    with_trees = [[path for path in each if workspace.files[path].of_type(Tree)] for each in needed]
    return [each for each in with_trees if len(each) > 1]


def patterns(folder: str, paths: Collection[str], others: Collection[str]) -> Iterator[str]:
    """Patterns for some XML files, relative to a folder and without suffix.

    A folder that has several of the files, and no other XML of the engine, is one pattern; with the folders below it,
    if that is true of them too.
    """
    known = XmlBelow()
    taken: set[str] = set()

    @cache
    def matches_no_other(pattern: str) -> bool:
        found = {*matching(folder, f"{pattern}.xml")}.difference(paths)
        return found.isdisjoint(others) and not any(map(known.is_mission, found))

    for path in paths:
        if path in taken:
            continue
        for place in _folders(path, folder):
            start = "" if place == folder else f"{posixpath.relpath(place, folder)}/"
            below = {each for each in paths if each.startswith(f"{place}/")}
            here = {each for each in below if posixpath.dirname(each) == place}
            if start and here and len(here) < len(below) and matches_no_other(f"{start}**/*"):
                taken |= below
                yield f"{start}**/*"
                break
            if path in here and len(here) > 1 and matches_no_other(f"{start}*"):
                taken |= here
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
