"""The lines of a first project file that name nodes: those of Nav2 by distribution, and C++ that registers others.

One invariant: at most one line has the key, and what is not written says why.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
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


def nodes_for(workspace: Workspace, packages: Packages, trouble: Callable[[str], str]) -> tuple[NodesLines, ...]:
    """What a project file may name.

    Args:
        packages: what they say of the engine, and which sources and parameter files they have.
        trouble: what is unknown only with a line in the project file; empty if nothing is.
    """
    of_nav2 = _of_nav2(workspace, packages)
    is_read = find_spec("tree_sitter_cpp") is not None
    sources = NodesLines(packages.sources, "C++ that registers nodes", "" if is_read else _WITHOUT_GRAMMAR)
    named = () if of_nav2 is None else (of_nav2,)
    both = (*named, sources) if sources.patterns else named
    if not trouble(nodes_lines(both)):
        return both
    if of_nav2 is not None and not of_nav2.obstacle and (unfit := trouble(nodes_lines(named))):
        named = (_open(f"{of_nav2.patterns[0]} does not fit, {unfit}"),)
    obstacle = sources.obstacle or trouble(nodes_lines((*named, sources)))
    if obstacle and not sources.obstacle and named and named[0].obstacle:
        obstacle = "name the distribution first"
    return (*named, replace(sources, obstacle=obstacle)) if sources.patterns else named


def nodes_lines(named: tuple[NodesLines, ...]) -> str:
    """The lines of the project file."""
    written = [each for each in named if not each.obstacle]
    left_out = [each for each in named if each.obstacle]
    if written:
        others = "".join(f"# {_listed(each)} may be added: {_reason(each)}\n" for each in left_out)
        return f"nodes = [{_listed(*written)}]  # {written[0].why}\n{others}"
    if len(left_out) == 1:
        return f"# nodes = [{_listed(*left_out)}]  # {_reason(left_out[0])}\n"
    reasons = "".join(f"#     {_reason(each)}\n" for each in left_out)
    return f"# nodes = [{_listed(*left_out)}]\n{reasons}" if left_out else ""


def _listed(*named: NodesLines) -> str:
    return ", ".join(json.dumps(pattern, ensure_ascii=False) for each in named for pattern in each.patterns)


def _reason(left_out: NodesLines) -> str:
    return f"{left_out.why}; {left_out.obstacle}"


def _of_nav2(workspace: Workspace, packages: Packages) -> NodesLines | None:
    """Nav2's nodes, if XML uses any."""
    used = {name: ports for name, ports in _used(workspace).items() if name not in packages.registered}
    if not any(used.values()):
        return None  # a `Wait` alone may be anybody's
    fitting = [each for each in _of_engine(workspace, packages.engines, used) if _has(each, used)]
    named = [each for each in fitting if each in packages.parameters.values()]
    if len(fitting) == 1 or len(named) == 1:
        why = "the only distribution of Nav2 with the nodes and ports of the trees"
        if len(fitting) > 1:
            fitting, why = named, "the distribution of Nav2 for which the parameters of bt_navigator are"
        return NodesLines((f"nav2-{fitting[0]}",), why)
    return _open(f"they fit {', '.join(fitting)}" if fitting else "no distribution has all of these nodes and ports")


def _open(which: str) -> NodesLines:
    """Nav2's nodes, of a distribution that a person must name."""
    return NodesLines((OF_NAV2,), "the trees use nodes of Nav2", f"name yours: {which}")


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
