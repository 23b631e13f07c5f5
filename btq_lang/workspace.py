"""The workspace: many files as one immutable value, and who means what across them.

One invariant: a workspace is a function of its texts and its project; one reached by edits equals one built afresh,
and shares with the one before it all files that did not change.  It knows no disk: the loader brings the texts,
included ones too.

Names are looked up in a file's scope: the file and what it includes.  The project's other files are known as well, but
only to say where a name could have come from.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from itertools import chain

from btq_lang.diagnostics import Diagnostic, Place
from btq_lang.parser import Parsed, parse, reparse
from btq_lang.project import Project, include_candidates
from btq_lang.record import Record
from btq_lang.symbols import Kind, Summary, Symbol, Use, asked_for, summarize
from btq_lang.syntax import Entry, Include, Item, Model, Root, Signal, Tree, Word
from btq_lang.text import LineIndex, Span, changed

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import TypeAlias

    from btq_lang.mentions import Mention, What
    from btq_lang.places import Places

Name: TypeAlias = tuple[Kind, str]


class Definition(Record):
    """A symbol and where it stands."""

    path: str
    entry: Entry
    symbol: Symbol

    @property
    def span(self) -> Span:
        """The name, counted from the start of the file."""
        return self.symbol.span.shifted(self.entry.start)


class Reference(Record):
    """A use and where it stands."""

    path: str
    entry: Entry
    use: Use

    @property
    def span(self) -> Span:
        """The name, counted from the start of the file."""
        return self.use.span.shifted(self.entry.start)


class Origin(Record):
    """What a file stands for that is written in another language.

    Attributes:
        text: as it stands on the disk.
        places: what in the file's text was made of what in this one.
        diagnostics: what is wrong with it in its own language; spans count from its start.
        is_complete: all of it could be read, so a name that is not in the file's text is not in this one.
    """

    text: str
    places: Places
    diagnostics: tuple[Diagnostic, ...]
    is_complete: bool


class Facts:
    """What an item says by itself: found out when first asked for, and true for as long as the item stays.

    Attributes:
        colours: what colours its words: of the features, who know what else it depends on.
    """

    def __init__(self, item: Item) -> None:
        self.item = item
        self.colours: object = None

    @cached_property
    def summary(self) -> Summary:
        return summarize(self.item)

    @cached_property
    def asked_for(self) -> frozenset[str]:
        return asked_for(self.item)

    @cached_property
    def mentions(self) -> tuple[Mention, ...]:
        """Every word of it that names something."""
        from btq_lang.mentions import mentions  # only editors ask

        return mentions(self.item)

    @cached_property
    def named(self) -> Mapping[What, tuple[Mention, ...]]:
        """What it names, by what that is: of mentions that say the same the first one."""
        found: dict[What, dict[tuple[str, bool, bool], Mention]] = {}
        for one in self.mentions:
            found.setdefault(one.what, {}).setdefault((one.name, one.word.quoted, one.defines), one)
        return {what: tuple(names.values()) for what, names in found.items()}

    @cached_property
    def kinds(self) -> frozenset[tuple[str, bool]]:
        """What its nodes are, and whether that is quoted."""
        from btq_lang.mentions import What  # as above

        found = self.named.get(What.NODE, ())
        return frozenset([(one.name, one.word.quoted) for one in found if not one.defines])

    @cached_property
    def mentioned(self) -> Mapping[str, list[Mention]]:
        """Its mentions by what they say."""
        found: dict[str, list[Mention]] = {}
        for one in self.mentions:
            found.setdefault(one.name, []).append(one)
        return found

    @cached_property
    def used(self) -> Mapping[Kind, frozenset[str]]:
        """The names that it refers to, by their kind."""
        found: dict[Kind, set[str]] = {}
        for use in self.summary.uses:
            found.setdefault(use.kind, set()).add(use.name)
        return {kind: frozenset(names) for kind, names in found.items()}

    def said(self, of: Kind | str) -> frozenset[str]:
        """The names of a kind that it refers to, or what else is said here of it by this name."""
        names: frozenset[str] = self.used.get(of, frozenset()) if isinstance(of, Kind) else getattr(self, of)
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
        """The trees that it refers to; of a tree, the other ones."""
        used = self.used.get(Kind.TREE, frozenset())
        name = self.item.name.text if isinstance(self.item, Tree) and self.item.name is not None else ""
        return used - {name} if used else used


class Tally:
    """How many items of a file say each of some names."""

    def __init__(self, of: Kind | str, counts: dict[str, int]) -> None:
        self._of = of
        self._counts = counts

    @classmethod
    def of(cls, items: Iterable[Facts], of: Kind | str) -> Tally:
        """A tally of the names of a kind that items use, or of another set of names that their facts have."""
        said = [each.said(of) for each in items if type(each.item) not in _SAYING_NOTHING]
        return cls(of, dict(Counter(chain.from_iterable(said))))

    def edited(self, gone: Iterable[Facts], come: Iterable[Facts]) -> Tally:
        """The tally after an edit that has put other items in the place of some; the same one if they say the same."""
        changes = Counter(chain.from_iterable([each.said(self._of) for each in come]))
        changes.subtract(chain.from_iterable([each.said(self._of) for each in gone]))
        if not any(changes.values()):
            return self
        counts = dict(self._counts)
        for name, change in changes.items():
            counts[name] = counts.get(name, 0) + change
            if not counts[name]:
                del counts[name]
        return Tally(self._of, counts)

    @cached_property
    def names(self) -> frozenset[str]:
        return frozenset(self._counts)


_SAYING_NOTHING = (Model, Signal)  # of others; most items are such


class Names:
    """The names that a file defines, each with the items and symbols that define it, in the order of the text."""

    def __init__(self, found: dict[Name, list[tuple[Item, Symbol]]]) -> None:
        self.found = found

    @classmethod
    def of(cls, facts: Iterable[Facts]) -> Names:
        found: dict[Name, list[tuple[Item, Symbol]]] = {}
        for each in facts:
            for symbol in each.summary.symbols:
                found.setdefault((symbol.kind, symbol.name), []).append((each.item, symbol))
        return cls(found)

    def edited(self, gone: Iterable[Facts], come: Iterable[Facts]) -> Names | None:
        """The names after an edit that has put other items in the place of some; None where that says too little: the
        names or their order are others, or a name has several definitions."""
        before = [(symbol.kind, symbol.name) for each in gone for symbol in each.summary.symbols]
        now = [(each.item, symbol) for each in come for symbol in each.summary.symbols]
        if before != [(symbol.kind, symbol.name) for _, symbol in now]:
            return None
        if any(len(self.found[key]) > 1 for key in before):
            return None
        if not now:
            return self
        after = Names({**self.found, **{(one[1].kind, one[1].name): [one] for one in now}})
        after.__dict__.update({each: self.__dict__[each] for each in ("all", "by_kind") if each in self.__dict__})
        return after

    @cached_property
    def all(self) -> frozenset[Name]:
        return frozenset(self.found)

    @cached_property
    def by_kind(self) -> dict[Kind, tuple[str, ...]]:
        names: dict[Kind, list[str]] = {kind: [] for kind in Kind}
        for kind, name in self.found:
            names[kind].append(name)
        return {kind: tuple(each) for kind, each in names.items()}

    @cached_property
    def repeated(self) -> frozenset[Name]:
        """Those with several definitions."""
        return frozenset([name for name, found in self.found.items() if len(found) > 1])


class File:
    """One file: its text, and what was made of it so far.  Two files with one path and text are equal.

    Attributes:
        text: in this language, whatever the file on the disk is written in.
        origin: that file, where it is written in another one.
        known_errors: what was last found wrong with it for those that include it, behind the project, the files and
            the names of trees that this rests on.
    """

    known_errors: tuple[Project, tuple[File, ...], frozenset[str], tuple[tuple[Place, str], ...]] | None = None

    def __init__(self, path: str, text: str, origin: Origin | None = None) -> None:
        self.path = path
        self.text = text
        self.origin = origin

    def edited(self, text: str) -> File:
        """The file after an edit, which shares what the edit does not touch."""
        after = File(self.path, text)
        if self.origin is None and "parsed" in self.__dict__ and is_btq(self.path):
            change = changed(self.text, text)
            after.parsed = reparse(self.parsed, text, change)
            known = self.facts
            items = [entry.item for entry in after.parsed.entries]
            facts = after.facts = {id(item): known.get(id(item)) or Facts(item) for item in items}
            gone = [each for item, each in known.items() if item not in facts]
            come = [each for item, each in facts.items() if item not in known]
            after._tallies = {of: tally.edited(gone, come) for of, tally in self._tallies.items()}
            if "names" in self.__dict__:
                names = self.names.edited(gone, come)
                if names is not None:
                    after.names = names
            if "lines" in self.__dict__:
                after.lines = self.lines.edited(text, change)
        return after

    @property
    def has_tree(self) -> bool:
        """Whether it was parsed, and is held so."""
        return "parsed" in self.__dict__

    def forget_tree(self) -> None:
        """Let go of what was made of the text, but for the names in it: it is made again for whoever asks."""
        names = {known: getattr(self, known) for known in _NAMES}
        names.update({known: self.__dict__[known] for known in _RARE_NAMES if known in self.__dict__})
        self.__dict__.clear()
        self.__dict__.update(names)

    @cached_property
    def parsed(self) -> Parsed:
        return parse(self.text if self.origin or is_btq(self.path) else "")

    @property
    def source(self) -> str:
        """The text as it stands on the disk: the one that people see."""
        return self.origin.text if self.origin else self.text

    @property
    def is_understood(self) -> bool:
        """Whether a name that is not in this file's tree is not in the file."""
        return self.origin.is_complete if self.origin else is_btq(self.path)

    @cached_property
    def facts(self) -> dict[int, Facts]:
        """What is known of each item, by its id."""
        return {id(entry.item): Facts(entry.item) for entry in self.parsed.entries}

    @cached_property
    def summaries(self) -> tuple[Summary, ...]:
        """One for each entry."""
        facts = self.facts
        return tuple([facts[id(entry.item)].summary for entry in self.parsed.entries])

    @cached_property
    def lines(self) -> LineIndex:
        return LineIndex(self.text)

    @cached_property
    def defined(self) -> tuple[Definition, ...]:
        """What the file itself defines, in the order of its text."""
        return tuple(
            Definition(self.path, entry, symbol)
            for entry, summary in zip(self.parsed.entries, self.summaries, strict=True)
            for symbol in summary.symbols
        )

    def first_users(self, kind: Kind) -> Mapping[str, Facts]:
        """The names of a kind that the file refers to, each with the first item that does."""
        if kind not in self._first_users:
            found = self._first_users[kind] = {}
            for each in reversed(self.facts.values()):
                if names := each.used.get(kind):
                    found.update(dict.fromkeys(names, each))
        return self._first_users[kind]

    @cached_property
    def _first_users(self) -> dict[Kind, dict[str, Facts]]:
        return {}

    @property
    def node_names(self) -> frozenset[str]:
        """Every name by which a path can name a node in the file."""
        return self._said("node_names")

    @property
    def asked_for(self) -> frozenset[str]:
        """The names in the file's conditions, bounds and arguments."""
        return self._said("asked_for")

    @property
    def runs(self) -> frozenset[str]:
        """The trees that the file's items refer to, of trees the other ones."""
        return self._said("runs")

    def used(self, kind: Kind) -> frozenset[str]:
        """The names of a kind that the file refers to."""
        return self._said(kind)

    def _said(self, of: Kind | str) -> frozenset[str]:
        if of not in self._tallies:
            self._tallies[of] = Tally.of(self.facts.values(), of)
        return self._tallies[of].names

    @cached_property
    def _tallies(self) -> dict[Kind | str, Tally]:
        return {}

    @cached_property
    def names(self) -> Names:
        """The names that the file itself defines."""
        return Names.of(self.facts.values())

    def definitions(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        """What a name means by this file alone, in the order of its text."""
        found = self.names.found.get((kind, name), ())
        return tuple([Definition(self.path, self._entries[id(item)], symbol) for item, symbol in found])

    def defines(self, kind: Kind, name: str) -> bool:
        """Whether the file defines a name; not parsed where its text says that it cannot."""
        return (name in self.text or not _ESCAPED.isdisjoint(name)) and (kind, name) in self.defined_names

    @cached_property
    def problems(self) -> tuple[Diagnostic, ...]:
        """What is wrong with its syntax; spans count from the items."""
        found: tuple[Diagnostic, ...] = ()
        for entry in self.parsed.entries:
            if entry.diagnostics:
                found += entry.diagnostics
        return found

    @cached_property
    def is_swallowed(self) -> bool:
        """Whether a forgotten quote may have made text of what declares names."""
        return any(problem.rule in _SWALLOWING for problem in self.problems)

    def mentions_of(self, entry: Entry) -> tuple[Mention, ...]:
        """Every word of one of the file's entries that names something."""
        return self.facts[id(entry.item)].mentions

    def mentioned(self, name: str) -> list[tuple[Entry, Mention]]:
        """The words that say a name and name something, in the order of the text."""
        facts = self.facts
        return [(entry, one) for entry in self.parsed.entries for one in facts[id(entry.item)].mentioned.get(name, ())]

    @property
    def mentioned_names(self) -> Iterable[str]:
        """All that words say which name something."""
        return dict.fromkeys(chain.from_iterable(each.mentioned for each in self.facts.values()))

    @cached_property
    def kinds(self) -> frozenset[tuple[str, bool]]:
        """What its nodes are, and whether that is quoted."""
        return frozenset().union(*[each.kinds for each in self.facts.values()])

    def named(self, entry: Entry) -> Mapping[What, tuple[Mention, ...]]:
        """What one of the file's entries names: of mentions that say the same the first one."""
        return self.facts[id(entry.item)].named

    @cached_property
    def source_lines(self) -> LineIndex:
        return LineIndex(self.source) if self.origin else self.lines

    def start_of(self, item: object) -> int:
        """Where one of the file's items begins.

        Raises:
            KeyError: the item is none of this file's.
        """
        return self._entries[id(item)].start

    def entry_of(self, item: Item) -> Entry:
        """The entry of one of the file's items."""
        return self._entries[id(item)]

    def summary_of(self, entry: Entry) -> Summary:
        """The summary of one of the file's entries."""
        return self.facts[id(entry.item)].summary

    @cached_property
    def _entries(self) -> dict[int, Entry]:
        return {id(entry.item): entry for entry in self.parsed.entries}

    @cached_property
    def includes(self) -> tuple[Include, ...]:
        if "include" not in self.text:  # most files have none, and need not be parsed to know what another one means
            return ()
        return tuple(entry.item for entry in self.parsed.entries if isinstance(entry.item, Include))

    @cached_property
    def included_paths(self) -> tuple[tuple[str, bool], ...]:
        """What its includes name, and whether a ROS package is to have it."""
        return tuple(
            (include.path.text, _is_of_package(include)) for include in self.includes if include.path is not None
        )

    @cached_property
    def defined_names(self) -> frozenset[Name]:
        return self.names.all

    @cached_property
    def used_names(self) -> frozenset[Name]:
        return frozenset((use.kind, use.name) for summary in self.summaries for use in summary.uses)

    def __reduce__(self) -> tuple[type[File], tuple[str, str, Origin | None]]:
        return File, (self.path, self.text, self.origin)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, File) and (self.path, self.text, self.source) == (
            other.path,
            other.text,
            other.source,
        )

    def __hash__(self) -> int:
        return hash((self.path, self.text))

    def __repr__(self) -> str:
        return f"File({self.path!r}, {len(self.text)} characters)"


_ESCAPED = frozenset("\"'\\\r\n\t")  # a name with one of these may be written otherwise than it is
_NAMES = ("path", "text", "origin", "included_paths", "defined_names", "used_names")  # they hold nothing of the tree
_RARE_NAMES = ("kinds",)  # likewise, and seldom asked for


class Scope:
    """The names that a file can use: its own and those of the files it includes, directly or not.

    Attributes:
        paths: those files, included ones before the file that includes them.
    """

    def __init__(self, paths: tuple[str, ...], workspace: Workspace) -> None:
        self.paths = paths
        self._files = [workspace.files[path] for path in paths]
        self._complete = all(
            (target := workspace.included_by(file.path, include)) is not None and workspace.files[target].is_understood
            for file in self._files
            for include in file.includes
        ) and not any(file.is_swallowed for file in self._files)
        self._found: dict[Name, tuple[Definition, ...]] = {}
        self._names: dict[Kind, tuple[str, ...]] = {}
        self._repeated: frozenset[Name] | None = None

    @property
    def complete(self) -> bool:
        """All includes were found and understood, and no string may have swallowed the rest of a file, so a name that
        is not here is nowhere."""
        return self._complete

    def defines(self, kind: Kind, name: str) -> bool:
        """Whether a name means something."""
        key = kind, name
        return bool([file for file in self._files if key in file.names.found])

    def find(self, kind: Kind, name: str) -> Definition | None:
        """The definition that a name means: the first one."""
        found = self._found.get((kind, name))
        if found is None:
            found = self._look_up(kind, name)
        return found[0] if found else None

    def all(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        """Every definition of a name, the one that counts first."""
        found = self._found.get((kind, name))
        return self._look_up(kind, name) if found is None else found

    def is_repeated(self, kind: Kind, name: str) -> bool:
        """Whether a name has several definitions: hardly any has, so who looks at all of them asks this first."""
        if self._repeated is None:
            self._repeated = _repeated([file.names for file in self._files])
        return (kind, name) in self._repeated

    def names(self, kind: Kind) -> tuple[str, ...]:
        """All names of a kind, in the order of their definitions."""
        names = self._names.get(kind)
        if names is None:
            known = [file.names.by_kind[kind] for file in self._files]
            names = self._names[kind] = known[0] if len(known) == 1 else tuple(dict.fromkeys(chain(*known)))
        return names

    def _look_up(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        key = kind, name
        found: tuple[Definition, ...] = ()
        for file in self._files:
            if key in file.names.found:
                found += file.definitions(kind, name)
        self._found[key] = found
        return found


def _repeated(files: list[Names]) -> frozenset[Name]:
    """The names with several definitions, in one of these files or in two of them."""
    seen: set[Name] = set()
    found: set[Name] = set()
    for names in files:
        found |= names.repeated
        found |= seen & names.all
        seen |= names.all
    return frozenset(found)


_SWALLOWING = frozenset(("unclosed-string", "string-over-items"))


class Workspace:
    """All files at one moment.

    Attributes:
        files: by path; paths are absolute or all relative to one folder, with `/`.
        project: what holds for all of them.
    """

    def __init__(self, files: Mapping[str, File], project: Project) -> None:
        self.files = files
        self.project = project
        self._scopes: dict[str, Scope] = {}
        self._everywhere: dict[Name, tuple[Definition, ...]] = {}
        self._closures: dict[str, tuple[str, ...]] = {}
        self._main_trees: dict[str, Definition | None] = {}
        self._referred: dict[str, dict[Span, tuple[Reference, ...]]] = {}

    @classmethod
    def of(cls, texts: Mapping[str, str], project: Project | None = None) -> Workspace:
        """A workspace of these texts, by path."""
        return cls({path: File(path, text) for path, text in texts.items()}, project or Project())

    def with_file(self, path: str, text: str) -> Workspace:
        """The workspace after an edit: `path` says `text`; every other file is shared."""
        before = self.files.get(path)
        file = before.edited(text) if before else File(path, text)
        after = Workspace({**self.files, path: file}, self.project)
        if before is not None and before.included_paths == file.included_paths:
            after._take_over(self, path)
        return after

    def forget_trees(self, paths: Iterable[str]) -> None:
        """Hold nothing of the trees of some files; who holds a definition in one of them must not ask for it again."""
        gone = frozenset(paths)
        for path in gone:
            self.files[path].forget_tree()
        self._scopes = {path: scope for path, scope in self._scopes.items() if gone.isdisjoint(scope.paths)}
        self._everywhere.clear()
        self._main_trees.clear()
        self._referred.clear()
        self._main_trees.clear()

    def _take_over(self, before: Workspace, edited: str) -> None:
        """What is known of which file includes which, and of the names in files that do not see the one edited."""
        for known in ("included_files", "missions", "_users"):
            if known in before.__dict__:
                self.__dict__[known] = before.__dict__[known]
        self._closures = before._closures
        self._scopes = {path: scope for path, scope in before._scopes.items() if edited not in scope.paths}

    def without_file(self, path: str) -> Workspace:
        return Workspace({other: file for other, file in self.files.items() if other != path}, self.project)

    def with_project(self, project: Project) -> Workspace:
        return Workspace(self.files, project)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Workspace) and (self.files, self.project) == (other.files, other.project)

    def __hash__(self) -> int:
        return hash(tuple(self.files))

    @cached_property
    def origins(self) -> Mapping[str, Origin]:
        """What the files that are written in another language stand for, by path."""
        return {path: file.origin for path, file in self.files.items() if file.origin is not None}

    # ---- includes and scopes ----

    def included(self, path: str, include: str) -> str | None:
        """The file that an `include` in `path` brings, if it is there."""
        for candidate in include_candidates(self.project, path, include):
            if candidate in self.files:
                return candidate
        return None

    def included_by(self, path: str, include: Include) -> str | None:
        """As `included`; what a ROS package holds is known to none but the robot."""
        return None if include.path is None else self._target(path, include.path.text, _is_of_package(include))

    def _target(self, path: str, include: str, is_of_package: bool) -> str | None:
        return None if is_of_package else self.included(path, include)

    def closure(self, path: str) -> tuple[str, ...]:
        """A file and all that it includes, included ones first; a file that includes itself is in it once."""
        known = self._closures.get(path)
        if known is None:
            known = self._closures[path] = self._closure(path)
        return known

    def _closure(self, path: str) -> tuple[str, ...]:
        seen: set[str] = set()
        order: list[str] = []
        stack: list[tuple[str, Iterator[str]]] = []

        def enter(file: str) -> None:
            seen.add(file)
            stack.append((file, self._targets(file)))

        enter(path)
        while stack:
            file, targets = stack[-1]
            target = next((target for target in targets if target not in seen), None)
            if target is not None:
                enter(target)
            else:
                order.append(file)
                stack.pop()
        return tuple(order)

    def _targets(self, path: str) -> Iterator[str]:
        for named in self.files[path].included_paths:
            target = self._target(path, *named)
            if target is not None:
                yield target

    def scope(self, path: str) -> Scope:
        """The names that a file can use."""
        if path not in self._scopes:
            self._scopes[path] = Scope(self.closure(path), self)
        return self._scopes[path]

    @cached_property
    def included_files(self) -> frozenset[str]:
        """The files that another file includes."""
        return frozenset(target for path in self.files for target in self._targets(path) if target != path)

    @cached_property
    def missions(self) -> Mapping[str, str]:
        """For each file a name for all that it is linked with by includes, either way, over however many files."""
        found = {path: path for path in self.files}

        def first(path: str) -> str:
            while found[path] != path:
                path = found[path]
            return path

        for path in self.files:
            for target in self._targets(path):
                one, other = sorted((first(path), first(target)))
                found[other] = one
        return {path: first(path) for path in self.files}

    def linked(self, path: str) -> list[str]:
        """A file, those that see it, and those that it sees, over however many files."""
        mission = self.missions[path]
        return [other for other, of in self.missions.items() if of == mission]

    # ---- definitions and references ----

    def defined_in(self, path: str) -> tuple[Definition, ...]:
        """What a file itself defines, in the order of its text."""
        return self.files[path].defined

    def defined_anywhere(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        """Every definition of a name in the project, to say where it could have come from."""
        key = kind, name
        if key not in self._everywhere:
            self._everywhere[key] = tuple(
                definition
                for file in self.files.values()
                if file.defines(kind, name)
                for definition in file.definitions(kind, name)
            )
        return self._everywhere[key]

    def uses_in(self, path: str) -> Iterator[Reference]:
        """What a file itself refers to, in the order of its text."""
        file = self.files[path]
        for entry, summary in zip(file.parsed.entries, file.summaries, strict=True):
            for use in summary.uses:
                yield Reference(path, entry, use)

    def references(self, definition: Definition) -> tuple[Reference, ...]:
        """Every use, in every file, of the name that `definition` defines."""
        return self._references_to(definition.path).get(definition.span, ())

    def _references_to(self, path: str) -> dict[Span, tuple[Reference, ...]]:
        """The uses of what a file defines, by the place of the definition."""
        if path not in self._referred:
            found: dict[Span, list[Reference]] = {}
            for user in self._users[path]:
                scope = self.scope(user)
                for reference in self.uses_in(user):
                    definition = scope.find(reference.use.kind, reference.use.name)
                    if definition is not None and definition.path == path:
                        found.setdefault(definition.span, []).append(reference)
            self._referred[path] = {span: tuple(references) for span, references in found.items()}
        return self._referred[path]

    @cached_property
    def _users(self) -> dict[str, list[str]]:
        """For each file, those that can use what it defines: itself, and all that include it."""
        users: dict[str, list[str]] = {path: [] for path in self.files}
        for path in self.files:
            for used in self.closure(path):
                users[used].append(path)
        return users

    # ---- missions ----

    def main_tree(self, path: str) -> Definition | None:
        """The tree that runs when the engine loads the file: the one its `Root` names, its only tree, or the only one
        of its trees that no other of its trees refers to."""
        if path not in self._main_trees:
            self._main_trees[path] = self._main_tree(path)
        return self._main_trees[path]

    def _main_tree(self, path: str) -> Definition | None:
        file = self.files[path]
        for entry in file.parsed.entries:
            if isinstance(entry.item, Root):
                named = entry.item.name or _attribute(entry.item, "main_tree_to_execute")
                if named is not None:
                    return self.scope(path).find(Kind.TREE, named.text)
        trees = file.names.by_kind[Kind.TREE]
        if len(trees) > 1 or any(len(file.names.found[Kind.TREE, name]) > 1 for name in trees):
            trees = tuple([name for name in trees if name not in file.runs])
        found = file.definitions(Kind.TREE, trees[0]) if len(trees) == 1 else ()
        return found[0] if len(found) == 1 else None


def is_btq(path: str) -> bool:
    """Whether a file is written in this language; an XML file may be included too."""
    return not path.endswith(".xml")


def _is_of_package(include: Include) -> bool:
    return any(pair.key.text == "ros_pkg" for pair in include.attributes)


def _attribute(root: Root, key: str) -> Word | None:
    return next((pair.value for pair in root.attributes if pair.key.text == key), None)
