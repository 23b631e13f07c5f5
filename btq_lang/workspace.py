"""The workspace: many files as one immutable value, and who means what across them.

One invariant: a workspace is a function of its texts and its project; one reached by edits equals one built afresh,
and shares with the one before it all files that did not change.  It knows no disk: the loader brings the texts,
included ones too.

Names are looked up in a file's scope: the file and what it includes.  The project's other files are known as well, but
only to say where a name could have come from.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property

from btq_lang.diagnostics import Diagnostic
from btq_lang.parser import Parsed, parse, reparse
from btq_lang.project import Project, include_candidates
from btq_lang.record import record
from btq_lang.symbols import Kind, Summary, Symbol, Use, summarize
from btq_lang.syntax import Entry, Include, Item, Root, Tree, Word
from btq_lang.text import LineIndex, Span

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from btq_lang.mentions import Mention
    from btq_lang.places import Places


@record
class Definition:
    """A symbol and where it stands."""

    path: str
    entry: Entry
    symbol: Symbol

    @property
    def span(self) -> Span:
        """The name, counted from the start of the file."""
        return self.symbol.span.shifted(self.entry.start)


@record
class Reference:
    """A use and where it stands."""

    path: str
    entry: Entry
    use: Use

    @property
    def span(self) -> Span:
        """The name, counted from the start of the file."""
        return self.use.span.shifted(self.entry.start)


@record
class Origin:
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
    """What an item says by itself: found out when first asked for, and true for as long as the item stays."""

    def __init__(self, item: Item) -> None:
        self.item = item

    @cached_property
    def summary(self) -> Summary:
        return summarize(self.item)

    @cached_property
    def mentions(self) -> tuple[Mention, ...]:
        """Every word of it that names something."""
        from btq_lang.mentions import mentions  # only editors ask

        return mentions(self.item)


class File:
    """One file: its text, and what was made of it so far.  Two files with one path and text are equal.

    Attributes:
        text: in this language, whatever the file on the disk is written in.
        origin: that file, where it is written in another one.
    """

    def __init__(self, path: str, text: str, origin: Origin | None = None) -> None:
        self.path = path
        self.text = text
        self.origin = origin

    def edited(self, text: str) -> File:
        """The file after an edit, which shares what the edit does not touch."""
        after = File(self.path, text)
        if self.origin is None and "parsed" in self.__dict__ and is_btq(self.path):
            after.parsed = reparse(self.parsed, text)
            known = self.facts
            items = (entry.item for entry in after.parsed.entries)
            after.facts = {id(item): known.get(id(item)) or Facts(item) for item in items}
            if "lines" in self.__dict__:
                after.lines = self.lines.edited(text)
        return after

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

    def mentions_of(self, entry: Entry) -> tuple[Mention, ...]:
        """Every word of one of the file's entries that names something."""
        return self.facts[id(entry.item)].mentions

    @cached_property
    def mentioned(self) -> dict[str, list[tuple[Entry, Mention]]]:
        """The words that name something, by what they say."""
        found: dict[str, list[tuple[Entry, Mention]]] = {}
        for entry in self.parsed.entries:
            for mention in self.mentions_of(entry):
                found.setdefault(mention.name, []).append((entry, mention))
        return found

    @cached_property
    def source_lines(self) -> LineIndex:
        return LineIndex(self.source) if self.origin else self.lines

    def start_of(self, item: object) -> int:
        """Where one of the file's items begins.

        Raises:
            KeyError: the item is none of this file's.
        """
        return self._starts[id(item)]

    def summary_of(self, entry: Entry) -> Summary:
        """The summary of one of the file's entries."""
        return self.facts[id(entry.item)].summary

    @cached_property
    def _starts(self) -> dict[int, int]:
        return {id(entry.item): entry.start for entry in self.parsed.entries}

    @cached_property
    def includes(self) -> tuple[Include, ...]:
        if "include" not in self.text:  # most files have none, and need not be parsed to know what another one means
            return ()
        return tuple(entry.item for entry in self.parsed.entries if isinstance(entry.item, Include))

    @property
    def included_paths(self) -> tuple[tuple[str, bool], ...]:
        """What its includes name, and whether a ROS package is to have it."""
        return tuple(
            (include.path.text, _is_of_package(include)) for include in self.includes if include.path is not None
        )

    @cached_property
    def defined_names(self) -> frozenset[tuple[Kind, str]]:
        return frozenset((symbol.kind, symbol.name) for summary in self.summaries for symbol in summary.symbols)

    @cached_property
    def used_names(self) -> frozenset[tuple[Kind, str]]:
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


class Scope:
    """The names that a file can use: its own and those of the files it includes, directly or not.

    Attributes:
        paths: those files, included ones before the file that includes them.
    """

    def __init__(self, paths: tuple[str, ...], workspace: Workspace) -> None:
        self.paths = paths
        self._complete = all(
            (target := workspace.included_by(path, include)) is not None and workspace.files[target].is_understood
            for path in paths
            for include in workspace.files[path].includes
        ) and not any(map(_is_swallowed, (workspace.files[path] for path in paths)))
        self._found: dict[tuple[Kind, str], list[Definition]] = {}
        self._names: dict[Kind, list[str]] = {kind: [] for kind in Kind}
        for path in paths:
            for definition in workspace.defined_in(path):
                symbol = definition.symbol
                same = self._found.setdefault((symbol.kind, symbol.name), [])
                if not same:
                    self._names[symbol.kind].append(symbol.name)
                same.append(definition)

    @property
    def complete(self) -> bool:
        """All includes were found and understood, and no string may have swallowed the rest of a file, so a name that
        is not here is nowhere."""
        return self._complete

    def find(self, kind: Kind, name: str) -> Definition | None:
        """The definition that a name means: the first one."""
        found = self._found.get((kind, name))
        return found[0] if found else None

    def all(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        """Every definition of a name, the one that counts first."""
        return tuple(self._found.get((kind, name), ()))

    def names(self, kind: Kind) -> tuple[str, ...]:
        """All names of a kind, in the order of their definitions."""
        return tuple(self._names[kind])


def _is_swallowed(file: File) -> bool:
    """Whether a forgotten quote may have made text of what declares names."""
    return any(problem.rule in _SWALLOWING for entry in file.parsed.entries for problem in entry.diagnostics)


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
        self._everywhere: dict[tuple[Kind, str], tuple[Definition, ...]] = {}
        self._closures: dict[str, tuple[str, ...]] = {}
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
        if include.path is None or _is_of_package(include):
            return None
        return self.included(path, include.path.text)

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
        for include in self.files[path].includes:
            target = self.included_by(path, include)
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
                if key in file.defined_names
                for definition in file.defined
                if (definition.symbol.kind, definition.symbol.name) == key
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
        file = self.files[path]
        for entry in file.parsed.entries:
            if isinstance(entry.item, Root):
                named = entry.item.name or _attribute(entry.item, "main_tree_to_execute")
                if named is not None:
                    return self.scope(path).find(Kind.TREE, named.text)
        trees = [definition for definition in self.defined_in(path) if definition.symbol.kind is Kind.TREE]
        if len(trees) > 1:
            used = {
                use.name
                for entry, summary in zip(file.parsed.entries, file.summaries, strict=True)
                for use in summary.uses
                if use.kind is Kind.TREE and not _is_tree_called(entry, use.name)
            }
            trees = [tree for tree in trees if tree.symbol.name not in used]
        return trees[0] if len(trees) == 1 else None


def is_btq(path: str) -> bool:
    """Whether a file is written in this language; an XML file may be included too."""
    return not path.endswith(".xml")


def _is_of_package(include: Include) -> bool:
    return any(pair.key.text == "ros_pkg" for pair in include.attributes)


def _attribute(root: Root, key: str) -> Word | None:
    return next((pair.value for pair in root.attributes if pair.key.text == key), None)


def _is_tree_called(entry: Entry, name: str) -> bool:
    return isinstance(entry.item, Tree) and entry.item.name is not None and entry.item.name.text == name
