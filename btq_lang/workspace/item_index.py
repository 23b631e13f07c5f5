"""Facts that follow from single items, and indexes of a file's items by name.

One invariant: facts depend on their item alone, so they stay valid as long as it exists, wherever it moves; names and
tallies are updated at an edit from the items that it removed and added.  Neither files nor the meaning of names are
known here.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from itertools import chain
from typing import Literal, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.syntax.tree import Item, Model, Scenario, Signal, Tree
from btq_lang.workspace.references import Mention, kinds, mentions, summarize
from btq_lang.workspace.symbols import Summary, Symbol, asked_for, claiming

Name: TypeAlias = tuple[Kind, str]
# The names of a kind that an item refers to, or the property of its facts with other names.
NameSort: TypeAlias = Kind | Literal["asked_for", "claiming", "node_names", "runs"]


class Facts:
    """The facts of an item: they follow from it alone, are computed on demand, and are valid as long as it exists."""

    def __init__(self, item: Item) -> None:
        self.item = item

    @cached_property
    def summary(self) -> Summary:
        return summarize(self.item)

    @cached_property
    def asked_for(self) -> frozenset[str]:
        return asked_for(self.item)

    @cached_property
    def claiming(self) -> frozenset[str]:
        """The requirements that it defines whose claims may name their own subjects."""
        return claiming(self.summary)

    @cached_property
    def mentions(self) -> tuple[Mention, ...]:
        """Every word of it that names something."""
        return mentions(self.item)

    @cached_property
    def kinds(self) -> frozenset[tuple[str, bool]]:
        """The kinds of its nodes, and whether they are quoted."""
        nodes = self.item.walk() if isinstance(self.item, Tree) else ()
        return frozenset([(word.text, word.quoted) for node in nodes for word in kinds(node)])

    @cached_property
    def used(self) -> Mapping[Kind, frozenset[str]]:
        """The names that it refers to, by their kind."""
        names_by_kind: dict[Kind, set[str]] = {}
        for use in self.summary.uses:
            names_by_kind.setdefault(use.kind, set()).add(use.name)
        return {kind: frozenset(names) for kind, names in names_by_kind.items()}

    def names_used(self, sort: NameSort) -> frozenset[str]:
        """The names of a kind that it refers to, or the value of the property with this name."""
        names: frozenset[str] = self.used.get(sort, frozenset()) if isinstance(sort, Kind) else getattr(self, sort)
        return names

    @cached_property
    def node_names(self) -> frozenset[str]:
        """Every name by which a path can name a node in it: its own, and those of kinds and instances."""
        if not isinstance(self.item, Tree):
            return frozenset()
        words = [self.item.name, *(word for node in self.item.walk() for word in (node.id, node.name))]
        return frozenset([word.text for word in words if word is not None])

    @cached_property
    def runs(self) -> frozenset[str]:
        """The trees that it refers to, except itself; a scenario runs one as a program does."""
        if isinstance(self.item, Scenario):
            return frozenset()
        used = self.used.get(Kind.TREE, frozenset())
        name = self.item.name.text if isinstance(self.item, Tree) and self.item.name is not None else ""
        return used - {name} if used else used


class NameCounts:
    """For each of some names, the number of a file's items that have it."""

    def __init__(self, sort: NameSort, counts: dict[str, int]) -> None:
        self._sort = sort
        self._counts = counts

    @classmethod
    def of(cls, items: Iterable[Facts], sort: NameSort) -> NameCounts:
        """A tally of the names of a kind that items use, or of another set of names in their facts."""
        names = [each.names_used(sort) for each in items if type(each.item) not in _USING_NOTHING]
        counts: dict[str, int] = {}
        for name in chain.from_iterable(names):
            counts[name] = counts.get(name, 0) + 1
        return cls(sort, counts)

    def edited(self, removed: Iterable[Facts], come: Iterable[Facts]) -> NameCounts:
        """The tally after an edit that replaced some items; the same object if it is equal."""
        changes: dict[str, int] = {}
        for facts, change in (*((each, 1) for each in come), *((each, -1) for each in removed)):
            for name in facts.names_used(self._sort):
                changes[name] = changes.get(name, 0) + change
        if not any(changes.values()):
            return self
        counts = dict(self._counts)
        for name, change in changes.items():
            counts[name] = counts.get(name, 0) + change
            if not counts[name]:
                del counts[name]
        return NameCounts(self._sort, counts)

    @cached_property
    def names(self) -> frozenset[str]:
        return frozenset(self._counts)


_USING_NOTHING = (Model, Signal)  # most other items are of these types


class Names:
    """The names that a file defines, each with the items and symbols that define it, in the order of the text."""

    def __init__(self, definitions: dict[Name, list[tuple[Item, Symbol]]]) -> None:
        self.definitions = definitions

    @classmethod
    def of(cls, facts: Iterable[Facts]) -> Names:
        definitions: dict[Name, list[tuple[Item, Symbol]]] = {}
        for item_facts in facts:
            for symbol in item_facts.summary.symbols:
                definitions.setdefault((symbol.kind, symbol.name), []).append((item_facts.item, symbol))
        return cls(definitions)

    def edited(self, gone: Iterable[Facts], come: Iterable[Facts]) -> Names | None:
        """The names after an edit that replaced some items; None if they must be recomputed: a name has several
        definitions, or the position of the new ones is unclear, for instance because they are in several places."""
        before = [(symbol.kind, symbol.name) for each in gone for symbol in each.summary.symbols]
        now = [((symbol.kind, symbol.name), [(each.item, symbol)]) for each in come for symbol in each.summary.symbols]
        added = dict(now)
        if any(len(self.definitions[name]) > 1 for name in before) or len(added) < len(now):
            return None
        if before == [*added]:
            after = Names({**self.definitions, **added})
            after.__dict__.update({name: value for name, value in self.__dict__.items() if name != "definitions"})
            return after
        defined, names = [*self.definitions.items()], [*self.definitions]
        index = names.index(before[0]) if before else 0
        if (
            not before
            or names[index : index + len(before)] != before
            or added.keys() - before & self.definitions.keys()
        ):
            return None
        after = Names(dict([*defined[:index], *now, *defined[index + len(before) :]]))
        if "by_kind" in self.__dict__:
            after.by_kind = self.by_kind | after._by_kind({kind for kind, _ in (*before, *added)})
        return after

    @cached_property
    def all(self) -> frozenset[Name]:
        return frozenset(self.definitions)

    @cached_property
    def by_kind(self) -> dict[Kind, tuple[str, ...]]:
        return self._by_kind(Kind)

    def _by_kind(self, kinds: Iterable[Kind]) -> dict[Kind, tuple[str, ...]]:
        return {kind: tuple([name for own_kind, name in self.definitions if own_kind is kind]) for kind in kinds}

    @cached_property
    def repeated(self) -> frozenset[Name]:
        """The names with several definitions."""
        return frozenset([name for name, definers in self.definitions.items() if len(definers) > 1])
