"""Reading the paths of clauses: the one node that each of them names.

One invariant: a path that names none, or several, is None and one problem, told where it stands.  A file whose nodes
may be elsewhere (a library, an include that was not found) is not told of a path that names none.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix
from btq_lang.requirements.memory import Asker
from btq_lang.syntax.tree import Apply, Entry, Item, Path, Tree, Word, is_name, quote
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near

if TYPE_CHECKING:
    from btq_lang.diagnostics.rules import Severity
    from btq_lang.requirements.memory import Question
    from btq_lang.requirements.model import Condition, Parameter, Requirement, Signal, SourceNode, Target
    from btq_lang.requirements.nodes import Nodes
    from btq_lang.util.text import Span
    from btq_lang.workspace.workspace import Scope, Workspace


class Problem(Record):
    """Something wrong with a requirement, and the item that the places of the diagnostic count from."""

    path: str
    item: Item
    diagnostic: Diagnostic


class PathReader(Asker):
    """Reads paths of one scope; `begin` says where the next ones stand.  Whatever it looks up elsewhere it notes.

    Attributes:
        requirements, signals, contexts: by name; a context that could not be read is None.
        parameters: of the requirement at hand.
        problems: found since that was emptied, each once.
        noted: what was looked up since that was emptied.
    """

    def __init__(self, workspace: Workspace, path: str, scope: Scope, nodes: Nodes) -> None:
        self.workspace = workspace
        self.nodes = nodes
        self.requirements: dict[str, Requirement] = {}
        self.signals: dict[str, Signal] = {}
        self.contexts: dict[str, Condition | None] = {}
        self.parameters: dict[str, Parameter] = {}
        self.problems: dict[tuple[str, Span, str], Problem] = {}
        self.noted: dict[Question, object] = {}
        self.news: dict[object, frozenset[object]] = {}
        main = workspace.main_tree(path)
        mission = nodes.within(main.entry.item).root if main is not None and isinstance(main.entry.item, Tree) else None
        # A library's nodes may be in the files that include it, and a robot's in XML that nobody has read.
        knows_all_nodes = (
            nodes.are_known
            and scope.complete
            and path not in workspace.included_files
            and not any(workspace.files[each].problems for each in scope.paths)
        )
        # None of these knows the reader: one that knows what knows it would stay, with all that it has read, until
        # Python looks for garbage, and an editor makes one at every key.
        requirements, signals, contexts = self.requirements, self.signals, self.contexts
        is_crowded = _crowding(workspace, scope, nodes)
        self._answers: dict[str, Callable[[Any], object]] = {
            "find": nodes.find,
            "every": nodes.every,
            "any": lambda name: bool(nodes.every(name)),
            "tagged": nodes.tagged,
            "under": lambda about: nodes.under(nodes.every(about[0]), about[1]),
            "nodes": lambda _: nodes.names,
            "has name": nodes.has_name,
            "is crowded": lambda _: is_crowded(),
            "kinds": lambda _: nodes.kinds,
            "tags": lambda _: nodes.tags,
            "mission": lambda _: mission,
            "knows all nodes": lambda _: knows_all_nodes,
            "knows all names": lambda _: scope.complete,
            "requirement": requirements.get,
            "signal": signals.get,
            "signals": lambda _: tuple(signals),
            "context": lambda name: contexts.get(name, _NOTHING),
            "contexts": lambda _: tuple(contexts),
        }

    # ---- what is looked up ----

    def answer(self, question: Question) -> object:
        """What is found now."""
        what, about = question
        return self._answers[what](about)

    def ask(self, what: str, about: Hashable = None) -> Any:
        """What is found, which is noted."""
        answer = self.noted[what, about] = self._answers[what](about)
        return answer

    def find(self, names: tuple[str, ...]) -> tuple[Target, ...]:
        """As `Nodes.find`."""
        found: tuple[Target, ...] = self.ask("find", names)
        return found

    def every(self, name: str) -> tuple[SourceNode, ...]:
        """As `Nodes.every`."""
        found: tuple[SourceNode, ...] = self.ask("every", name)
        return found

    def requirement(self, name: str) -> Requirement | None:
        """The requirement of a name, with its parameters in it."""
        found: Requirement | None = self.ask("requirement", name)
        return found

    def signal(self, name: str) -> Signal | None:
        """The signal of a name."""
        found: Signal | None = self.ask("signal", name)
        return found

    def is_context(self, name: str) -> bool:
        """Whether there is a context of a name, understood or not."""
        return self.ask("context", name) is not _NOTHING

    def names(self, *kinds: str) -> Iterator[str]:
        """The names of these kinds: parameters, signals, contexts, nodes."""
        for kind in kinds:
            yield from self.parameters if kind == "parameters" else self.ask(kind)

    def near(self, word: str, *kinds: str) -> tuple[str, ...]:
        """The names of these kinds that look like one that is unknown; none where so many are unknown that nobody reads
        what each of them may mean."""
        return near(word, self.names(*kinds)) if not self.ask("is crowded") else ()

    @property
    def mission(self) -> SourceNode | None:
        """The main tree's root; None where nobody can say which tree runs."""
        found: SourceNode | None = self.ask("mission")
        return found

    @property
    def knows_all_nodes(self) -> bool:
        """Whether a node that is not among these is nowhere."""
        found: bool = self.ask("knows all nodes")
        return found

    # ---- where it reads ----

    def begin(
        self,
        path: str,
        entry: Entry,
        parameters: dict[str, Parameter] | None = None,
        source: tuple[str, Span] | None = None,
    ) -> None:
        """What follows stands there.

        Args:
            source: the text that it was parsed from, where that is no text of the file, and the place that stands for
                all of it.
        """
        self.path = path
        self.entry = entry
        self.parameters = parameters or {}
        self._source = source

    def complain(
        self,
        rule: str,
        span: Span,
        message: str,
        *,
        notes: tuple[str, ...] = (),
        fixes: tuple[Fix, ...] = (),
        related: tuple[Related, ...] = (),
        severity: Severity | None = None,
    ) -> None:
        diagnostic = Diagnostic(rule, span, message, related, notes, fixes, severity=severity)
        self.note(Problem(self.path, self.entry.item, diagnostic))

    def note(self, problem: Problem) -> None:
        """Add a problem, unless it is known."""
        found = problem.diagnostic
        self.problems.setdefault((found.rule, found.span, found.message), problem)

    def place(self, span: Span) -> Place:
        return Place(span if self._source is None else self._source[1], self.path, self.entry.item)

    def text(self, start: int, end: int) -> str:
        """What is written there, blanks folded."""
        if self._source is not None:
            return " ".join(self._source[0][start:end].split())
        base = self.entry.start
        return " ".join(self.workspace.files[self.path].text[base + start : base + end].split())

    # ---- paths ----

    def target(self, path: Path) -> Target | None:
        """The one node that a path names."""
        names = tuple(name.text for name in path.names)
        found = self.find(names)
        if len(found) == 1:
            return found[0]
        shown = "/".join(name.raw for name in path.names)
        if found:
            self.ambiguous(path.span, shown, found)
        elif self.knows_all_nodes:
            likely = self._meant(path)
            fixes = tuple(
                replace_fix(f"Replace `{word.text}` with `{name}`", word.span, _written(name)) for word, name in likely
            )
            message = f"{self._missing(names, shown)}{did_you_mean(name for _, name in likely)}"
            notes = (_ONE_DEMAND,) if path.names[0].raw == "and" else ()
            self.complain("unmatched-path", path.span, message, notes=notes, fixes=fixes)
        return None

    def none_of(self, name: Word) -> None:
        """Complain of `every X` where nothing is an X."""
        if not self.knows_all_nodes:
            return
        notes: tuple[str, ...] = ()
        if self.find((name.text,)):
            notes = (f"`{name.text}` is the name of one node, not of a kind: write it without `every`",)
        self._no_match(name, f"no node matches `every {name.raw}`", "kinds", notes)

    def no_tag(self, tag: Word) -> None:
        """Complain of `tagged x` where nothing has that tag."""
        if self.knows_all_nodes:
            self._no_match(tag, f"no node has the tag `{tag.text}`", "tags")

    def _no_match(self, word: Word, message: str, kind: str, notes: tuple[str, ...] = ()) -> None:
        likely = self.near(word.text, kind)
        fixes = tuple(replace_fix(f"Replace `{word.text}` with `{name}`", word.span, _written(name)) for name in likely)
        self.complain("unmatched-path", word.span, f"{message}{did_you_mean(likely)}", notes=notes, fixes=fixes)

    def ambiguous(self, span: Span, shown: str, found: tuple[Target, ...]) -> None:
        """Complain of a path that names several nodes."""
        related = tuple(Related(target.node.place, f"in the tree `{target.node.tree}`") for target in found[:_SHOWN])
        some = found[:_LOOKED_AT]
        paths = dict.fromkeys(path for target in some if (path := self._path_to(target)) is not None)
        self.complain(
            "ambiguous-path",
            span,
            f"ambiguous path `{shown}`: {len(found)} nodes match",
            related=related,
            notes=(
                "a path must match one node; write `every` for all of them, in a clause or in `apply … to every …`",
            ),
            fixes=tuple(replace_fix(f"Write `{path}`", span, path) for path in list(paths)[:_SHOWN]),
        )

    def _missing(self, names: tuple[str, ...], shown: str) -> str:
        if len(names) > 1 and self.find(names[-1:]):
            return f"no node `{names[-1]}` below `{'/'.join(names[:-1])}`"
        return f"unknown node `{shown}`" if len(names) == 1 else f"no node matches `{shown}`"

    def _meant(self, path: Path) -> list[tuple[Word, str]]:
        """Words of a path that names no node, each with a near name that makes it match one."""
        found = []
        for index, word in enumerate(path.names):
            for name in self.near(word.text, "nodes") if not self.ask("has name", word.text) else ():
                names = [other.text for other in path.names]
                names[index] = name
                if len(self.find(tuple(names))) == 1:
                    found.append((word, name))
        return found

    def _path_to(self, target: Target) -> str | None:
        """The shortest path that names that node alone."""
        node = target.node
        heads = [word.text for word in (node.node.name, node.node.id) if word is not None]
        above = [node.parent.node.name.text] if node.parent is not None and node.parent.node.name is not None else []
        above += [node.tree] if node.tree is not None else []
        choices = [*([head] for head in heads), *([name, head] for head in heads for name in above)]
        for names in choices:
            found = self.find(tuple(names))
            if len(found) == 1 and found[0].node is node:
                return "/".join(map(_written, names))
        return None


def _crowding(workspace: Workspace, scope: Scope, nodes: Nodes) -> Callable[[], bool]:
    """`_is_crowded`, worked out once; not made in the reader, for compiled the two would make a ring."""
    return cache(lambda: _is_crowded(workspace, scope, nodes))


def _is_crowded(workspace: Workspace, scope: Scope, nodes: Nodes) -> bool:
    """Whether clauses name so much that nobody knows, and there is so much that it may mean, that to compare all of it
    would take seconds."""
    known = {*scope.names(Kind.SIGNAL), *scope.names(Kind.CONTEXT)}
    known |= {*nodes.names, *nodes.tags}
    asked = {name for path in scope.paths for name in (*workspace.files[path].asked_for, *_selecting(workspace, path))}
    return len(asked - known) * len(known) > _MOST_COMPARED


def _selecting(workspace: Workspace, path: str) -> Iterator[str]:
    """The names by which `apply` says what it applies to."""
    for apply in workspace.files[path].of_type(Apply):
        for selector in (*apply.targets, *apply.exceptions):
            words = selector.path.names if selector.path is not None else ()
            yield from [word.text for word in (selector.every, selector.tag, *words) if word is not None]


def _written(name: str) -> str:
    return name if is_name(name) else quote(name)


_ONE_DEMAND: Final = "a clause states one demand; write `succeeds within 30 s`, or `succeeds` on a line of its own"
_SHOWN: Final = 5  # places and fixes of one diagnostic
_LOOKED_AT: Final = 50  # nodes that a path may mean, for paths that mean one of them alone
_MOST_COMPARED: Final = 200_000  # pairs of names: some tenths of a second
_NOTHING: Final = object()
