"""The parts of a first project file that name nodes and what loads them: the nodes of Nav2 by distribution, C++ that
registers others, and factories for the parameter files of Nav2.

One invariant: what cannot be read, or needs a distribution that is not known, is a comment that says why.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Container, Iterator, Mapping, Sequence
from importlib.util import find_spec

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nav2 import DISTRIBUTIONS, ENGINES, ports_of
from btq_lang.catalog.versions import VERSION_3, VERSIONS, is_before_4
from btq_lang.commands.explain_nav2 import models_of
from btq_lang.commands.packages import Packages
from btq_lang.util.record import Record, replace
from btq_lang.workspace.engine_version import written_for
from btq_lang.workspace.workspace import Workspace

_WITHOUT_GRAMMAR = "btq reads it with pip install 'btq-lang[cpp]'"
OF_NAV2 = "nav2-DISTRIBUTION"  # which one is unknown


class NodesLines(Record):
    """Patterns for the key `nodes`.

    Attributes:
        why: what they name, for a comment.
        obstacle: why they are not written; empty if they are.
    """

    patterns: tuple[str, ...]
    why: str
    obstacle: str = ""


class Trouble(Record):
    """The problems that only some lines in a project file cause.

    Attributes:
        unreadable: why something that they name cannot be read.
        unknown: the nodes and ports that are unknown with them.
    """

    unreadable: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()

    @property
    def first(self) -> str:
        """The first one; empty if there are none."""
        return next(iter(self.unreadable + self.unknown), "")


def nodes_for(workspace: Workspace, packages: Packages, trouble: Callable[[str], Trouble]) -> tuple[NodesLines, ...]:
    """The patterns that a project file may name.

    Args:
        packages: their engine, their sources and their parameter files.
        trouble: the problems that only a line in the project file causes.
    """
    of_nav2 = _of_nav2(workspace, packages)
    is_read = find_spec("tree_sitter_cpp") is not None
    sources = NodesLines(packages.sources, "C++ that registers nodes", "" if is_read else _WITHOUT_GRAMMAR)
    named = () if of_nav2 is None else (of_nav2,)
    both = (*named, sources) if sources.patterns else named
    if not trouble(nodes_lines(both)).first:
        return both
    if of_nav2 is not None and not of_nav2.obstacle and (unfit := trouble(nodes_lines(named)).first):
        named = (_of_unknown_distribution(f"{of_nav2.patterns[0]} does not fit, {unfit}"),)
    with_sources = trouble(nodes_lines((*named, sources)))
    obstacle = sources.obstacle or next(iter(with_sources.unreadable), "")
    if with_sources.first and not sources.obstacle and named and named[0].obstacle:
        obstacle = "name the distribution first"
    return (*named, replace(sources, obstacle=obstacle)) if sources.patterns else named


def nodes_lines(named: tuple[NodesLines, ...]) -> str:
    """The lines of the project file."""
    written = [lines for lines in named if not lines.obstacle]
    left_out = [lines for lines in named if lines.obstacle]
    if written:
        others = "".join(f"# {_as_list(lines)} may be added: {_reason(lines)}\n" for lines in left_out)
        return f"nodes = [{_as_list(*written)}]  # {written[0].why}\n{others}"
    if len(left_out) == 1:
        return f"# nodes = [{_as_list(*left_out)}]  # {_reason(left_out[0])}\n"
    reasons = "".join(f"#     {_reason(lines)}\n" for lines in left_out)
    return f"# nodes = [{_as_list(*left_out)}]\n{reasons}" if left_out else ""


def _as_list(*named: NodesLines) -> str:
    return ", ".join(json.dumps(pattern, ensure_ascii=False) for lines in named for pattern in lines.patterns)


def _reason(left_out: NodesLines) -> str:
    return f"{left_out.why}; {left_out.obstacle}"


def _of_nav2(workspace: Workspace, packages: Packages) -> NodesLines | None:
    """Nav2's nodes, if XML uses any."""
    used = {name: ports for name, ports in _used_nodes(workspace).items() if name not in packages.registered}
    if not any(used.values()):
        return None  # a `Wait` alone may be any project's
    fitting = [
        distribution for distribution in _of_engine(workspace, packages.engines, used) if _has_nodes(distribution, used)
    ]
    named = [distribution for distribution in fitting if distribution in packages.parameters.values()]
    if len(fitting) == 1 or len(named) == 1:
        why = "the only distribution of Nav2 with the nodes and ports of the trees"
        if len(fitting) > 1:
            fitting, why = named, "the distribution of Nav2 for which the parameters of bt_navigator are"
        return NodesLines((f"nav2-{fitting[0]}",), why)
    return _of_unknown_distribution(
        f"they fit {', '.join(fitting)}" if fitting else "no distribution has all of these nodes and ports"
    )


def _of_unknown_distribution(which: str) -> NodesLines:
    """Nav2's nodes, of a distribution that a person must name."""
    return NodesLines((OF_NAV2,), "the trees use nodes of Nav2", f"name yours: {which}")


def _of_engine(workspace: Workspace, engines: tuple[str, ...], used: Mapping[str, set[str]]) -> Iterator[str]:
    """The distributions with an engine that the files with some nodes are for; Nav2's own trees declare a format from
    version 4 on."""
    project = replace(workspace.project, engines=engines or VERSIONS, names_all=engines == VERSIONS)
    users = [file for file in workspace.files.values() if not file.names_used(Kind.MODEL).isdisjoint(used)]
    signs = [file.signs for file in users if file.is_foreign]
    ages = {is_before_4((written_for(project, None, file_signs) or (VERSION_3,))[-1]) for file_signs in signs}
    for distribution in DISTRIBUTIONS:
        if ages <= {is_before_4(ENGINES[distribution])}:
            yield distribution


def _used_nodes(workspace: Workspace) -> Mapping[str, set[str]]:
    """The nodes of Nav2 in XML, each with the ports that have values; one that has other ports is the project's own."""
    used: dict[str, set[str]] = {}
    for file in workspace.files.values():
        for facts in file.facts.values():
            for use in facts.summary.uses:
                if use.kind is Kind.MODEL and use.node is not None and ports_of(use.name) is not None:
                    ports = (pair.key.text for pair in use.node.attributes)
                    used.setdefault(use.name, set()).update(filter(is_port_name, ports))
    return {name: ports for name, ports in used.items() if ports <= (ports_of(name) or set())}


def _has_nodes(distribution: str, used: Mapping[str, set[str]]) -> bool:
    models = models_of(distribution)
    return all(
        name in models and ports <= {port.id.text for port in models[name].ports if port.id is not None}
        for name, ports in used.items()
    )


def navigator_tables(
    packages: Packages,
    taken: Collection[str],
    goals: Sequence[str],
    fits: Callable[[str | None], bool],
    trouble: Callable[[str], Trouble],
) -> str:
    """The tables, one for each parameter file.

    Args:
        taken: the names of other factories.
        goals: patterns of trees that programs name, which may be for goals.
        fits: whether the distribution that a file is for is known and that of the project.
        trouble: the problems that only some tables in the project file cause.
    """
    written = comments = ""
    names: list[str] = []
    for path, distribution in packages.parameters.items():
        names.append(free_name("navigator", (*taken, *names)))
        table = f"name = {json.dumps(names[-1])}\nnav2 = {json.dumps(path, ensure_ascii=False)}\n"
        heading = "[[factory]]  # what bt_navigator loads"
        load = f"# load = {json.dumps(goals, ensure_ascii=False)}  # {_FOR_GOALS}\n" if goals else ""
        obstacle = "" if fits(distribution) else "name its distribution in `nodes` first"
        obstacle = obstacle or trouble(f"{written}\n{heading}\n{table}").first
        if obstacle:
            comments += f"\n# {heading}; {obstacle}\n" + "".join(f"# {line}\n" for line in table.splitlines()) + load
        else:
            written += f"\n{heading}\n{table}{load}"
    return written + comments


def free_name(name: str, taken: Container[str]) -> str:
    """A name for a factory that no other has."""
    return next(free for free in (name, *(f"{name}{number}" for number in range(2, 10_000))) if free not in taken)


_FOR_GOALS = "Python or a launch file names them: keep what is for goals"
