"""One file as a value: its text, and cached results about it.

One invariant: a file is a function of its path and texts; one reached by an edit equals a new one, and shares with its
predecessor all that the edit does not touch.  It knows the paths of its includes, but not their contents.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

from btq_lang.catalog.name_kinds import Kind
from btq_lang.diagnostics.model import Diagnostic, Place
from btq_lang.grammar.item_words import may_include
from btq_lang.parser import Parsed, parse, reparse
from btq_lang.syntax.tree import Entry, Include, Item, Scenario, Tree
from btq_lang.util.record import Record
from btq_lang.util.text import LineIndex, Placed, Span, changed
from btq_lang.workspace.item_index import Facts, Name, NameCounts, Names, NameSort
from btq_lang.workspace.symbols import Symbol, Use

if TYPE_CHECKING:
    from btq_lang.cpp.model import CppNode
    from btq_lang.util.source_map import OriginMap
    from btq_lang.workspace.references import Mention

    Kept = TypeVar("Kept", bound=Item)

SUFFIXES = (".btq", ".qualitybtcpp")  # of files in this language; the second is that of the classic form
CPP_SUFFIXES = (".cpp", ".hpp", ".h", ".cc", ".hh", ".cxx", ".hxx", ".ipp", ".tpp")
GROOT_SUFFIX = ".btproj"  # of a project of Groot2: includes and models
XML_SUFFIXES = (".xml", GROOT_SUFFIX)
YAML_SUFFIXES = (".yaml", ".yml")  # of parameters
SIDE_SUFFIX = ".qreq.json"  # of what a build writes beside XML


class File:
    """One file: its text, and cached results about it.  Files with equal path and text are equal.

    Attributes:
        text: in this language, whatever the language of the file on the disk.
        origin: that file, if it is in another language; outside of the workspace it is asked through the properties
            below (`is_foreign`, `source`, `on_disk`, …).
        last_read: the last file that could be read, if an edit since then has made this one unreadable: it has no text.
    """

    last_read: File | None = None

    def __init__(self, path: str, text: str, origin: Origin | None = None) -> None:
        self.path = path
        self.text = text
        self.origin = origin
        self._of_type: dict[type, tuple[Any, ...]] = {}
        self._first_users: dict[Kind, dict[str, Facts]] = {}
        self._tallies: dict[NameSort, NameCounts] = {}

    def edited(self, text: str, origin: Origin | None = None) -> File:
        """The file after an edit, which shares what the edit does not touch.

        Args:
            origin: the file in another language after the edit; `text` is its translation.
        """
        if text and self.last_read is not None:
            return self.last_read.edited(text, origin)
        after = File(self.path, text, origin)
        if origin is not None and not text:
            after.last_read = self.last_read or self
        if "parsed" in self.__dict__ and self._is_read and after._is_read:
            change = changed(self.text, text)
            after.parsed = _sharing(self.parsed, reparse(self.parsed, text, change), change)
            facts_before = self.facts
            items = [entry.item for entry in after.parsed.entries]
            facts_after = after.facts = {id(item): facts_before.get(id(item)) or Facts(item) for item in items}
            removed = [item_facts for item, item_facts in facts_before.items() if item not in facts_after]
            come = [item_facts for item, item_facts in facts_after.items() if item not in facts_before]
            after._tallies = {sort: tally.edited(removed, come) for sort, tally in self._tallies.items()}
            touched = {type(item_facts.item) for item_facts in (*removed, *come)}
            after._of_type = {kind: items for kind, items in self._of_type.items() if kind not in touched}
            if "includes" in self.__dict__ and Include not in touched:
                after.includes = self.includes
            if change is not None and not self.__dict__.get("has_directives", True):
                longest = max(map(len, _DIRECTIVES))
                end = change.end + len(text) - len(self.text) + longest
                edited = text[max(change.start - longest, 0) : end]
                after.has_directives = any(word in edited for word in _DIRECTIVES)
            if "names" in self.__dict__:
                names = self.names.edited(removed, come)
                if names is not None:
                    after.names = names
            if "lines" in self.__dict__:
                after.lines = self.lines.edited(text, change)
            if "item_places" in self.__dict__ and change is not None:
                replacing = text[change.start : change.end + len(text) - len(self.text)]
                is_in_line = _LINE_ENDS.isdisjoint((*self.text[change.start : change.end], *replacing))
                if is_in_line and after.lines.line_count == self.lines.line_count:  # no \r has been joined to a \n
                    places = after.item_places = self.item_places.copy()
                    for item_facts in removed:
                        del places[id(item_facts.item)]
                    places.update(
                        (id(item_facts.item), after.lines.place(after.start_of(item_facts.item))) for item_facts in come
                    )
                    places.update(after._places_on_line(change.start))
        return after

    @property
    def is_parsed(self) -> bool:
        """Whether its tree is in memory."""
        return "parsed" in self.__dict__

    def let_go(self) -> None:
        """Release all but the text and its names; the rest is recomputed on demand."""
        kept = {attribute: getattr(self, attribute) for attribute in _KEPT}
        kept.update({attribute: self.__dict__[attribute] for attribute in _KEPT_IF_ASKED if attribute in self.__dict__})
        self.__dict__ = {**File(self.path, self.text, self.origin).__dict__, **kept}

    @cached_property
    def parsed(self) -> Parsed:
        return parse(self.text if self._is_read else "")

    @property
    def _is_read(self) -> bool:
        """Whether its text is in this language."""
        return self.origin is not None or self.is_btq

    @property
    def is_btq(self) -> bool:
        """Whether it is written in this language; an XML file may be included too."""
        return self.origin is None and not is_xml(self.path, self.text)

    @property
    def is_foreign(self) -> bool:
        """Whether it is written in another language, XML or C++; the text is its translation."""
        return self.origin is not None

    @property
    def is_xml(self) -> bool:
        """Whether it is XML that the engine loads as it is, without a build."""
        return self.origin is not None and self.origin.nodes is None

    @property
    def source(self) -> str:
        """The text on the disk, which users see."""
        return self.origin.text if self.origin else self.text

    @property
    def source_diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of the language that it is written in; spans count from its start on the disk."""
        return self.parsed.diagnostics if self.origin is None else self.origin.diagnostics

    @property
    def places(self) -> OriginMap | None:
        """Maps the text to the file on the disk; None if they are the same."""
        return None if self.origin is None else self.origin.places

    def on_disk(self, span: Span) -> Span:
        """The span on the disk for one of the text."""
        return span if self.origin is None else self.origin.places.origin(span)

    def from_disk(self, offset: int, exact: bool = True) -> int | None:
        """The offset in the text for one on the disk; None: the text has no such place.

        Args:
            exact: only in parts that are the same in both texts; of others the offset is their start.
        """
        return offset if self.origin is None else self.origin.places.made(offset, exact)

    def after_models(self, span: Span) -> Span:
        """For C++, the span after the end of the text that is `span` on the disk: there the text is the C++ itself."""
        return span.shifted(len(self.text))

    @property
    def is_cpp(self) -> bool:
        """Whether it is C++; the text has the models of the nodes that it registers."""
        return self.origin is not None and self.origin.nodes is not None

    @property
    def cpp_nodes(self) -> Mapping[str, CppNode]:
        """The nodes that it registers, by ID; none unless it is C++."""
        return (self.origin.nodes if self.origin is not None else None) or {}

    @property
    def signs(self) -> Signs | None:
        """The signs of its version of the engine; None unless it is XML."""
        return None if self.origin is None else self.origin.signs

    @property
    def is_understood(self) -> bool:
        """Whether all of it could be read: a name that is not in its tree is then not in the file."""
        return self.origin.is_complete if self.origin else self.is_btq

    @cached_property
    def facts(self) -> dict[int, Facts]:
        """The facts of each item, by its id."""
        return {id(entry.item): Facts(entry.item) for entry in self.parsed.entries}

    @cached_property
    def lines(self) -> LineIndex:
        return LineIndex(self.text)

    @cached_property
    def has_directives(self) -> bool:
        """Whether a comment in it may silence rules, or be meant as an include."""
        return any(word in self.text for word in _DIRECTIVES)

    @cached_property
    def defined(self) -> tuple[Definition, ...]:
        """The definitions in the file itself, in the order of its text."""
        return tuple(
            Definition(self.path, entry, symbol)
            for entry in self.parsed.entries
            for symbol in self.facts[id(entry.item)].summary.symbols
        )

    @property
    def uses(self) -> Iterator[tuple[Entry, Use]]:
        """The uses in the file, each with its entry, in the order of its text."""
        return ((entry, use) for entry in self.parsed.entries for use in self.facts[id(entry.item)].summary.uses)

    def of_type(self, kind: type[Kept]) -> tuple[Kept, ...]:
        """The file's items of a type, in the order of the text."""
        if kind not in self._of_type:
            self._of_type[kind] = tuple([entry.item for entry in self.parsed.entries if type(entry.item) is kind])
        return self._of_type[kind]

    def first_users(self, kind: Kind) -> Mapping[str, Facts]:
        """The names of a kind that the file refers to, each with the first item that does."""
        if kind not in self._first_users:
            users = self._first_users[kind] = {}
            for facts in self.facts.values():
                for name in facts.used.get(kind, ()):
                    users.setdefault(name, facts)
        return self._first_users[kind]

    def names_used(self, sort: NameSort) -> frozenset[str]:
        """The names of a kind that the file's items refer to, or those that their facts have of another sort."""
        if sort not in self._tallies:
            self._tallies[sort] = NameCounts.of(self.facts.values(), sort)
        return self._tallies[sort].names

    @cached_property
    def names(self) -> Names:
        """The names that the file itself defines."""
        return Names.of(self.facts.values())

    def definitions(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        """The definitions of a name in this file, in the order of its text."""
        definers = self.names.definitions.get((kind, name), ())
        return tuple([Definition(self.path, self._entries[id(item)], symbol) for item, symbol in definers])

    def defines(self, kind: Kind, name: str) -> bool:
        """Whether the file defines a name; not parsed if the text rules it out."""
        may = "defined_names" in self.__dict__ or name in self.text or not _ESCAPED.isdisjoint(name)
        return may and (kind, name) in self.defined_names

    @cached_property
    def problems(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of its syntax; spans count from the items."""
        return tuple([each for entry in self.parsed.entries for each in entry.diagnostics])

    @cached_property
    def is_swallowed(self) -> bool:
        """Whether a forgotten quote may have turned declarations into text."""
        return any(problem.rule in _SWALLOWING for problem in self.problems)

    def mentions_of(self, entry: Entry) -> tuple[Mention, ...]:
        """Every word of an entry that names something."""
        return self.facts[id(entry.item)].mentions

    def mentioned(self, name: str) -> Iterator[tuple[Entry, Mention]]:
        """The references with a name, in the order of the text, found lazily."""
        return (
            (entry, mention)
            for entry in self._entries_with(name)
            for mention in self.mentions_of(entry)
            if mention.name == name
        )

    def _entries_with(self, name: str) -> Sequence[Entry]:
        """The entries that may contain a name: those with its exact text, or all if it may be written otherwise."""
        entries = self.parsed.entries
        if not name or not _NOT_AS_IT_IS.isdisjoint(name):
            return entries
        candidates: list[Entry] = []
        offset = self.text.find(name)
        while offset >= 0:
            index = bisect_right(entries, offset, key=_start_of)
            candidates += entries[index - 1 : index]
            offset = self.text.find(name, entries[index].start) if index < len(entries) else -1
        return candidates

    @cached_property
    def kinds(self) -> frozenset[tuple[str, bool]]:
        """The kinds of its nodes, and whether they are quoted."""
        return frozenset().union(*[each.kinds for each in self.facts.values()])

    @cached_property
    def source_lines(self) -> LineIndex:
        return LineIndex(self.source) if self.origin else self.lines

    @cached_property
    def item_places(self) -> dict[int, tuple[int, str]]:
        """The start of each item, by its `id`: its line, and the text before it on that line."""
        place = self.lines.place
        return {id(entry.item): place(entry.start) for entry in self.parsed.entries}

    def _places_on_line(self, offset: int) -> dict[int, tuple[int, str]]:
        """As `item_places`, for the items that begin in the line of an offset."""
        place, entries = self.lines.place, self.parsed.entries
        line, before = place(offset)
        places: dict[int, tuple[int, str]] = {}
        for index in range(bisect_left(entries, offset - len(before), key=_start_of), len(entries)):
            begins = place(entries[index].start)
            if begins[0] != line:
                break
            places[id(entries[index].item)] = begins
        return places

    def start_of(self, item: object) -> int:
        """The start of one of the file's items.

        Raises:
            KeyError: the item does not belong to this file.
        """
        return self._entries[id(item)].start

    def span_of(self, place: Place) -> Span:
        """The span of a place in this file, counted from its start."""
        return place.span if place.anchor is None else place.span.shifted(self.start_of(place.anchor))

    def entry_of(self, item: Item) -> Entry:
        """The entry of one of the file's items."""
        return self._entries[id(item)]

    def on_one_line(self, entry: Entry, part: Placed) -> str:
        """A part of an item as it is written, on one line."""
        return " ".join(self.text[entry.start + part.start : entry.start + part.end].split())

    def text_of(self, item: Item) -> str:
        """The text of one of the file's items, up to the next one."""
        entries, start = self.parsed.entries, self.start_of(item)
        after = bisect_right(entries, start, key=_start_of)
        return self.text[start : entries[after].start if after < len(entries) else len(self.text)]

    @cached_property
    def _entries(self) -> dict[int, Entry]:
        return {id(entry.item): entry for entry in self.parsed.entries}

    @cached_property
    def includes(self) -> tuple[Include, ...]:
        if not may_include(self.text):
            return ()
        return self.of_type(Include)

    @cached_property
    def included_paths(self) -> tuple[tuple[str, bool], ...]:
        """The paths of its includes, and whether a ROS package has them."""
        return tuple(
            (include.path.text, is_of_package(include)) for include in self.includes if include.path is not None
        )

    @cached_property
    def has_only_scenarios(self) -> bool:
        """Whether it has scenarios and no tree: `btq test` runs it, and no program loads it."""
        return "scenario" in self.text and bool(self.of_type(Scenario)) and not self.of_type(Tree)

    @property
    def inclusion(self) -> tuple[object, ...]:
        """What determines which files it includes as a mission does."""
        return self.included_paths, self.has_only_scenarios

    @cached_property
    def defined_names(self) -> frozenset[Name]:
        return self.names.all

    def names_of(self, kind: Kind) -> tuple[str, ...]:
        """The names of a kind that the file defines, in any order."""
        return tuple([name for own_kind, name in self.defined_names if own_kind is kind])

    @cached_property
    def used_names(self) -> frozenset[Name]:
        return frozenset((use.kind, use.name) for _, use in self.uses)

    def __reduce__(self) -> tuple[type[File], tuple[str, str, Origin | None]]:
        return File, (self.path, self.text, self.origin)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, File) and (self.path, self.text, self.source) == (other.path, other.text, other.source)

    def __hash__(self) -> int:
        return hash((self.path, self.text))

    def __repr__(self) -> str:
        return f"File({self.path!r}, {len(self.text)} characters)"


def _sharing(before: Parsed, now: Parsed, change: Span | None) -> Parsed:
    """The new tree, but with the old object for the item before the change if it was reparsed with an equal result: a
    change in the first line of an item may touch the one before it.  All text up to the next item must be equal too,
    which it is not if a following item has become a comment."""
    old, new = before.entries, now.entries
    index = bisect_right(old, change.start, key=_start_of) - 2 if change is not None else -1
    is_first_one = (
        0 <= index < len(new) - 1 and new[index] is not old[index] and (index == 0 or new[index - 1] is old[index - 1])
    )
    if not is_first_one or new[index + 1].start != old[index + 1].start or new[index] != old[index]:
        return now  # and changed ones stay consecutive
    return Parsed(now.text, now.maps, (*new[:index], old[index], *new[index + 1 :]), now.starts)


def _start_of(entry: Entry) -> int:
    return entry.start


_ESCAPED = frozenset("\"'\\\r\n\t")  # a name with one of these may be written with escapes
_NOT_AS_IT_IS = _ESCAPED | {"."}  # between the names of a quality there may be blanks
# Kept when the tree is released: what refers to no part of it.
_KEPT = ("included_paths", "has_only_scenarios", "defined_names", "used_names")
_KEPT_IF_ASKED = ("kinds",)  # seldom
_DIRECTIVES = ("btq:", "#include", "#import")
_LINE_ENDS = frozenset("\r\n")
_SWALLOWING = frozenset(("unclosed-string", "string-over-items"))


class Definition(Record):
    """A symbol and its file."""

    path: str
    entry: Entry
    symbol: Symbol

    @property
    def span(self) -> Span:
        """The name, counted from the start of the file."""
        return self.symbol.span.shifted(self.entry.start)

    @property
    def whole(self) -> Span:
        """All of what is defined, likewise."""
        return Span(self.symbol.target.start, self.symbol.target.end).shifted(self.entry.start)


class Signs(Record):
    """Signs in XML of the version that it is written for.

    Attributes:
        format: its BTCPP_format; empty if it has none.
        is_new: whether it has a construct that version 4 alone reads.
        old: the constructs, as they are spelt, that version 4 does not read as version 3 does; empty if `is_new`.
        is_refused: whether version 4 refuses one of these.
    """

    format: str = ""
    is_new: bool = False
    old: tuple[str, ...] = ()
    is_refused: bool = False


class Origin(Record):
    """The file in another language from which a file was translated.

    Attributes:
        text: on the disk.
        places: maps the file's text to this one.
        diagnostics: what is wrong with it in its own language; spans count from its start.
        is_complete: whether all of it could be read, so that a name that is not in the file's text is not in this one.
        defines: the names of its trees and models.
        nodes: by ID, those that it registers, if it is C++; its diagnostics are then all there are.
        signs: of its version of the engine, if it is XML.
    """

    text: str
    places: OriginMap
    diagnostics: tuple[Diagnostic, ...]
    is_complete: bool
    defines: frozenset[str] = frozenset()
    nodes: Mapping[str, CppNode] | None = None
    signs: Signs | None = None


def is_xml(path: str, text: str) -> bool:
    """Whether a file is XML: it is called .xml, or begins with `<` under an unknown suffix; some projects call trees
    for Groot .tree or .bt."""
    return not path.endswith(SUFFIXES) and (path.endswith(".xml") or text.lstrip().startswith("<"))


def is_of_package(include: Include) -> bool:
    return any(pair.key.text == "ros_pkg" for pair in include.attributes)
