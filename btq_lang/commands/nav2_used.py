"""Which distribution of Nav2 XML is written for, as far as the nodes in it, their ports and the version of the format
tell."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nav2 import DISTRIBUTIONS, ports_of
from btq_lang.commands.explain_nav2 import models_of
from btq_lang.workspace.workspace import Workspace

_OF_VERSION_3 = ("humble", "iron")  # their Nav2 has version 3 of the engine, and so trees without BTCPP_format


def nav2_line(workspace: Workspace, holds: Callable[[str], bool]) -> str:
    """The line of a project file that names Nav2's nodes, a comment if it is unknown which; empty if XML uses none.

    Args:
        holds: whether such a line may be written, as far as its effect on the project is concerned.
    """
    used = _used(workspace)
    if not any(used.values()):
        return ""  # a `Wait` alone may be anybody's
    fitting = [each for each in _of_format(workspace, used) if _has(each, used)]
    if len(fitting) == 1:
        line = f'nodes = ["nav2-{fitting[0]}"]  # the only distribution of Nav2 with the nodes and ports of the trees\n'
        if holds(line):
            return line
        fitting.clear()
    fit = f"they fit {', '.join(fitting)}" if fitting else "no distribution has all of these nodes and ports"
    return f'# nodes = ["nav2-DISTRIBUTION"]  # the trees use nodes of Nav2; name yours: {fit}\n'


def _of_format(workspace: Workspace, used: Mapping[str, set[str]]) -> Iterator[str]:
    """The distributions whose engine reads the format of the files that use some nodes."""
    formats = {
        "BTCPP_format" in file.source for file in workspace.files.values() if not file.used(Kind.MODEL).isdisjoint(used)
    }
    for each in DISTRIBUTIONS:
        if formats <= {each not in _OF_VERSION_3}:
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
