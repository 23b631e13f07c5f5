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
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cache
from importlib.util import find_spec

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nav2 import DISTRIBUTIONS, ENGINES, ports_of
from btq_lang.catalog.versions import VERSION_3, VERSIONS, is_before_4
from btq_lang.checks import check_each
from btq_lang.checks.engines import declared_engines
from btq_lang.commands.explain_nav2 import models_of
from btq_lang.commands.output import show
from btq_lang.commands.packages import Packages, packages_of
from btq_lang.projects.files import Files
from btq_lang.projects.options import Refused
from btq_lang.projects.xml_below import XmlBelow
from btq_lang.syntax.tree import Tree
from btq_lang.util.record import Record, replace
from btq_lang.workspace.engine_version import written_for
from btq_lang.workspace.file import GROOT_SUFFIX
from btq_lang.workspace.loader import absolute, matching, shown, write_whole
from btq_lang.workspace.workspace import Workspace

_HEAD = "# What holds for all missions of this project\n"
_ENGINES = f"engine = {json.dumps(VERSIONS)}  # the versions of BehaviorTree.CPP that must load them\n"
_SOURCES = "# nodes = {}  # C++ that registers nodes: `btq nodes` shows what is seen of them\n"
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

    def holds(line: str) -> bool:
        return _unknown_in(folder, line + rest) <= _unknown_in(folder, engine + rest)

    nodes = nav2_line(workspace, packages, holds)
    if nodes.startswith("nodes"):
        engine = ""  # a distribution has a version of its own
    nodes, sources = _with_sources(nodes, packages.sources, holds)
    try:
        write_whole(target, f"{_HEAD}{engine}{nodes}{sources}{rest}{''.join(_parameters(packages.parameters))}")
    except OSError as error:
        raise Refused(f"{shown(target)}: {error.strerror}") from error
    count = f"{len(factories) or 'no'} factor{'y' if len(factories) == 1 else 'ies'}"
    print(f"Wrote {shown(target)} with {count}. Next: btq check {shlex.quote(options.folder)}")
    return 0


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
        if group.workspace.files[path].origin is not None
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
        name = next(each for each in (name, *(f"{name}{number}" for number in range(2, 10_000))) if each not in names)
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


def _parameters(paths: Iterable[str]) -> Iterator[str]:
    """Factories that the project file may have, as comments."""
    for path in paths:
        yield f'\n# [[factory]]  # what bt_navigator loads\n# name = "navigator"\n# nav2 = {json.dumps(path)}\n'


def _unknown_in(folder: str, project: str) -> set[tuple[str, int]]:
    """Where a check finds nodes and ports that are not known, or cannot read something, if this is the project file."""
    files = Files()
    files.overlay[f"{folder}/btq.toml"] = project
    groups, problems = files.groups([folder], with_xml=True, for_checks=True)
    return {
        (path, each.span.start)
        for group in groups
        for path, found in zip(group.given, check_each(group.workspace, group.given), strict=True)
        for each in found
        if each.rule in ("unknown-node", "unknown-port")
    } | {(problem.message, 0) for problem in problems}


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
        for name in file.said(Kind.TREE):
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


def _with_sources(nodes: str, sources: tuple[str, ...], holds: Callable[[str], bool]) -> tuple[str, str]:
    """The line that names nodes, with C++ sources in it, and a comment that proposes these if they are not: without the
    grammar of C++, or if with them more in the trees is unknown."""
    written = json.dumps(sources)
    if not sources:
        return nodes, ""
    both = f"{nodes}nodes = {written}  # C++ that registers nodes\n"
    if nodes.startswith("nodes"):
        both = nodes.replace("]", f", {written[1:]}", 1)
    if find_spec("tree_sitter_cpp") is not None and holds(both):
        return both, ""
    return nodes, _SOURCES.format(written)


def nav2_line(workspace: Workspace, packages: Packages, holds: Callable[[str], bool]) -> str:
    """The line of a project file that names Nav2's nodes, a comment if it is unknown which; empty if XML uses none.

    Args:
        packages: what they say of the engine, and which parameter files they have.
        holds: whether a line may be written, as far as its effect on the project is concerned.
    """
    used = _used(workspace)
    if not any(used.values()):
        return ""  # a `Wait` alone may be anybody's
    fitting = [each for each in _of_engine(workspace, packages.engines, used) if _has(each, used)]
    named = [each for each in fitting if each in packages.distributions]
    if len(fitting) == 1 or len(named) == 1:
        why = "the only distribution of Nav2 with the nodes and ports of the trees"
        if len(fitting) > 1:
            fitting, why = named, "the distribution of Nav2 for which the parameters of bt_navigator are"
        line = f'nodes = ["nav2-{fitting[0]}"]  # {why}\n'
        if holds(line):
            return line
        fitting.clear()
    fit = f"they fit {', '.join(fitting)}" if fitting else "no distribution has all of these nodes and ports"
    return f'# nodes = ["nav2-DISTRIBUTION"]  # the trees use nodes of Nav2; name yours: {fit}\n'


def _of_engine(workspace: Workspace, engines: tuple[str, ...], used: Mapping[str, set[str]]) -> Iterator[str]:
    """The distributions with the engine that the files are for which use some nodes; Nav2's own trees declare a format
    from version 4 on."""
    project = replace(workspace.project, engines=engines or VERSIONS, names_all=engines == VERSIONS)
    users = [file for file in workspace.files.values() if not file.said(Kind.MODEL).isdisjoint(used)]
    signs = [file.origin.signs for file in users if file.origin is not None]
    wanted = {is_before_4((written_for(project, None, each) or (VERSION_3,))[-1]) for each in signs}
    for each in DISTRIBUTIONS:
        if wanted <= {is_before_4(ENGINES[each])}:
            yield each


def _used(workspace: Workspace) -> Mapping[str, set[str]]:
    """The nodes of Nav2 in XML, each with the ports that have values; one that has other ports is the project's own."""
    used: dict[str, set[str]] = {}
    for file in workspace.files.values():
        for facts in file.facts.values():
            for use in facts.summary.uses:
                if use.kind is Kind.MODEL and use.node is not None and ports_of(use.name) is not None:
                    given = (pair.key.text for pair in use.node.attributes)
                    used.setdefault(use.name, set()).update(filter(is_port_name, given))
    return {name: ports for name, ports in used.items() if ports <= (ports_of(name) or set())}


def _has(distribution: str, used: Mapping[str, set[str]]) -> bool:
    models = models_of(distribution)
    return all(
        name in models and ports <= {port.id.text for port in models[name].ports if port.id is not None}
        for name, ports in used.items()
    )
