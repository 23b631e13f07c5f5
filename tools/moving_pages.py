"""The pages of the documentation site about moving on from one version of the engine, or distribution of Nav2, to the
next.

One invariant: all that they say is in the tables by which `btq check --target` finds it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from btq_lang.catalog.engine_changes import ENGINE_CHANGES
from btq_lang.catalog.nav2 import DISTRIBUTIONS, ENGINES
from btq_lang.catalog.nav2.changes import CHANGES, INSTEAD, RENAMED, RENAMED_PORTS
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, OLD_PORTS
from btq_lang.catalog.versions import ANY, VERSION_3, VERSIONS, BehaviorChange, at_least
from btq_lang.catalog.versions import CHANGES as VERSION_CHANGES
from btq_lang.checks.target_changes import is_between
from btq_lang.commands.explain_nav2 import models_of


def moving_pages() -> dict[str, str]:
    """A page for each step, and their index, by the path below the site's root."""
    of_engine, of_nav2 = list(pairwise((VERSION_3, *VERSIONS))), list(pairwise(DISTRIBUTIONS))
    links = [f"* [{old.title()} to {new.title()}]({old}-{new}.md)" for old, new in (*of_engine, *of_nav2)]
    engine, nav2 = links[: len(of_engine)], links[len(of_engine) :]
    index = ["# Moving on", "", _HOW, "", "## Versions of the engine", "", *engine, ""]
    index += ["## Distributions of Nav2", "", *nav2, ""]
    return (
        {"moving/index.md": "\n".join(index)}
        | {f"moving/{old}-{new}.md": "\n".join(_page_of_engine(old, new)) for old, new in of_engine}
        | {f"moving/{old}-{new}.md": "\n".join(_page(old, new)) for old, new in of_nav2}
    )


_HOW = (
    "With `engine` or `nodes` in btq.toml as the trees are today, `btq check --target 4.10` or `--target nav2-lyrical` "
    "finds in them what these pages say, for all steps on the way."
)


def _page_of_engine(old: str, new: str) -> Iterator[str]:
    """A line such as 4.8 is its last release, but the first one of the page may be any of its releases."""
    rows = [row for row in VERSION_CHANGES if is_between(row.since, "", "", old, new)]
    changes = [row for row in ENGINE_CHANGES if is_between(row.since, row.until, row.after, old, new)]
    gone = [f"`{known.word}`: {known.why}" for known in KNOWN_WORDS.values() if known.until == old]
    ports = [f"`{node}` has no port `{port}`: write `{now}`" for (node, port), now in OLD_PORTS.items() if gone]
    nodes = [f"`{kind.tag}`" for kind in BUILTINS.values() if is_between(kind.since, "", "", old, new)]
    does = [_since(row.since, _said(row)) for row in changes]

    def of(effect: str) -> list[str]:
        return [_since(row.since, row.what) for row in rows if row.effect == effect]

    yield f"# {old} to {new}\n"
    yield from _section("Refused", (*gone, *ports, *of("refused")))
    yield from _section("Means something else", dict.fromkeys((*of("differs"), *does)))
    yield from _section("New", (*nodes, *of("new")))


def _since(version: str, what: str) -> str:
    return f"{what} (from {version} on)"


def _page(old: str, new: str) -> Iterator[str]:
    before, after = _nodes(old), _nodes(new)
    changes = [change for change in CHANGES if change.since == new]
    yield f"# {old.title()} to {new.title()}\n"
    if at_least(ENGINES[new], ENGINES[old]) and ENGINES[old] != ENGINES[new]:
        yield f"BehaviorTree.CPP {ENGINES[new]} takes the place of {ENGINES[old]}: [its changes](index.md).\n"
    yield from _section("Refused", (*_gone(before, after, new), *map(_said, (each for each in changes if each.breaks))))
    yield from _section("Means something else", map(_said, (each for each in changes if not each.breaks)))
    yield from _section("New", _added(before, after))


def _section(title: str, lines: Iterable[str]) -> Iterator[str]:
    found = [*lines]
    if found:
        yield f"## {title}\n"
        yield from (f"* {line}" for line in found)
        yield ""


def _gone(before: dict[str, set[str]], after: dict[str, set[str]], new: str) -> Iterator[str]:
    for node, ports in before.items():
        name = node if node in after else RENAMED.get((new, node))
        if name != node:
            instead = name or INSTEAD.get((new, node))
            yield f"`{node}` is not there" + (f": write {f'`{name}`' if name else instead}" if instead else "")
        for port in sorted(ports - after[name]) if name else ():
            called = RENAMED_PORTS.get((new, node, port))
            yield f"`{node}` has no port `{port}`" + (f": write `{called}`" if called else "")


def _said(change: BehaviorChange) -> str:
    nodes = "any node" if change.nodes == (ANY,) else ", ".join(f"`{node}`" for node in change.nodes)
    keeps = f"`{change.port} = {change.keeps}` keeps the old meaning" if change.keeps else ""
    return "; ".join(filter(None, (f"{nodes}: {change.what}", change.instead, keeps)))


def _added(before: dict[str, set[str]], after: dict[str, set[str]]) -> Iterator[str]:
    for node, ports in after.items():
        new = sorted(ports - before[node]) if node in before else []
        if node not in before:
            yield f"`{node}`"
        elif new:
            yield f"`{node}`: " + ", ".join(f"`{port}`" for port in new)


def _nodes(distribution: str) -> dict[str, set[str]]:
    """The ports of each node of a distribution."""
    models = models_of(distribution).items()
    return {name: {port.name.text for port in model.ports if port.name} for name, model in models}
