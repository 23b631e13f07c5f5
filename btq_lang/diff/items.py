"""What changed beside the trees: requirements, signals, contexts, qualities, models, includes.

One invariant: things are matched by name; those with equal contents and another name were renamed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Sequence
from typing import Final

from btq_lang.diff.changes import Change, Detail, details
from btq_lang.diff.contents import MAIN, MISSION, AspectValue, Item, TreePart
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted

# The things that can be renamed: others refer to them by name.
_RENAMED: Final = ("requirement", "signal", "context", "quality", "node model")


def renamed_items(old: Iterable[Item], new: Iterable[Item]) -> dict[tuple[str, str], str]:
    """The new names of things whose contents are equal, by thing and old name."""
    before, after = _by_name(old), _by_name(new)
    removed = _by_content(item for key, item in before.items() if key not in after)
    added = _by_content(item for key, item in after.items() if key not in before)
    return {
        (items[0].thing, items[0].name): added[content][0].name
        for content, items in removed.items()
        if len(items) == 1 == len(added.get(content, ()))
    }


def item_changes(
    old: Sequence[Item], new: Sequence[Item], renamed: dict[tuple[str, str], str], nodes: tuple[Iterable[TreePart], ...]
) -> Iterator[Change]:
    """The changes of things, in the order of the new mission, then those that were removed.

    Args:
        nodes: of the old and of the new mission, for the requirements attached to them.
    """
    before, after = _by_name(old), _by_name(new)
    _leave_out_built(before, after)
    names = {(thing, new_name): old_name for (thing, old_name), new_name in renamed.items()}
    attached = [Counter(name for part in parts for name in dict.fromkeys(part.requirements)) for parts in nodes]
    for key, item in after.items():
        thing, name = item.thing, item.name
        earlier = names.get((thing, name))
        previous = before.get((thing, earlier) if earlier is not None else key)
        if previous is None:
            yield Change("added", thing, name, None, item.place, tuple(_contents(item, added=True)))
            continue
        if earlier is not None:
            yield Change("renamed", thing, name, previous.place, item.place, earlier=earlier)
        values = previous.values
        if thing == MISSION and MAIN in values:
            main = renamed.get(("tree", str(values[MAIN].key)), values[MAIN].key)
            values = {**values, MAIN: AspectValue(main, values[MAIN].text)}
        differences = [*details(values, item.values)]
        if thing == "requirement":
            counts = attached[0][previous.name], attached[1][name]
            if (counts[0] == 0) != (counts[1] == 0):
                differences.append(Detail("attached to", _nodes(counts[0]), _nodes(counts[1])))
        if differences:
            yield Change("changed", thing, name, previous.place, item.place, tuple(differences))
    for key, item in before.items():
        if key not in after and (item.thing, item.name) not in renamed:
            yield Change("removed", item.thing, item.name, item.place, None, tuple(_contents(item, added=False)))


def _leave_out_built(before: dict[tuple[str, object], Item], after: dict[tuple[str, object], Item]) -> None:
    """Leave out an include of a mission and that of its XML: a build writes one for the other."""
    for stem in (_path, _name):  # in the same folder first: several folders may have files of one name
        added: dict[tuple[str, bool], list[tuple[str, object]]] = {}
        for key, item in after.items():
            if item.thing == "include" and key not in before:
                added.setdefault((stem(item), item.name.endswith(".xml")), []).append(key)
        removed = [key for key, item in before.items() if item.thing == "include" and key not in after]
        for key in removed:
            others = added.get((stem(before[key]), not before[key].name.endswith(".xml")))
            if others:
                del before[key], after[others.pop(0)]


def _path(item: Item) -> str:
    return item.name.rpartition(".")[0]


def _name(item: Item) -> str:
    return _path(item).rpartition("/")[2]


def _contents(item: Item, added: bool) -> Iterator[Detail]:
    """The contents of something that was removed or added."""
    for aspect, value in item.values.items():
        if value.text and aspect:
            yield Detail(aspect, None, value.text) if added else Detail(aspect, value.text, None)


def _by_name(items: Iterable[Item]) -> dict[tuple[str, object], Item]:
    by_name: dict[tuple[str, object], Item] = {}
    for item in items:
        # The name of an `apply` is its text, however it is spelt.
        name = item.values[""].key if item.thing == "apply" else item.name
        by_name.setdefault((item.thing, name), item)
    return by_name


def _by_content(items: Iterable[Item]) -> dict[Hashable, list[Item]]:
    return grouped(
        ((item.thing, frozenset((aspect, value.key) for aspect, value in item.values.items())), item)
        for item in items
        if item.thing in _RENAMED and item.values
    )


def _nodes(number: int) -> str:
    return counted(number, "node") if number else "no node"
