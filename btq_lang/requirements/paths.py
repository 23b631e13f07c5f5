"""Reading the paths of clauses: the one node that each of them names.

One invariant: a path that names no node, or several nodes, resolves to None and adds exactly one problem, at the path.
In a file whose nodes may be elsewhere (a library, an include that was not found) a path without a node is not a
problem.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix, write_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.grammar.clause_slips import OF_MISSION
from btq_lang.grammar.items import SELECTORS
from btq_lang.requirements import nodes
from btq_lang.requirements.model import NodeTarget, ResolvedParameter
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.syntax.tree import Path, Word, written
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


class Problem(Record):
    """Something wrong with a requirement.

    Attributes:
        place: where to report the diagnostic; the spans in the diagnostic are relative to the same item.
    """

    place: Place
    diagnostic: Diagnostic


class PathReader:
    """Reads the paths in an item.

    Attributes:
        path, facts: the item.
        parameters: of the requirement that is read.
        source: None while the text of the file is read; otherwise the text that is read instead, and the span in the
            item at which all of it is reported.
    """

    def __init__(
        self, store: Store[Workspace], viewpoint: str, path: str, facts: Facts, signals: Collection[str] | None = None
    ) -> None:
        """signals: the only ones that may be named, without contexts; None: all signals and contexts."""
        self.store: Final = store
        self.viewpoint: Final = viewpoint
        self.path: Final = path
        self.parameters: dict[str, ResolvedParameter] = {}
        self.source: tuple[str, Span] | None = None
        self.facts: Final = facts
        self._signals: Final = signals
        self._problems: dict[tuple[str, Span, str], Problem] = {}

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The problems that were found, each once."""
        return tuple(self._problems.values())

    # ---- look-ups ----

    def find(self, names: tuple[str, ...]) -> tuple[NodeTarget, ...]:
        """The nodes that a path means."""
        return self.store.ask(nodes.find, self.viewpoint, names)

    def names(self, kind: str) -> tuple[str, ...]:
        """The names of a kind: parameters, signals, contexts, nodes, kinds, tags."""
        if kind == "parameters":
            return tuple(self.parameters)
        if kind in _DECLARED and self._signals is not None:
            return tuple(self._signals) if kind == "signals" else ()
        if kind in _DECLARED:
            return self.store.ask(inputs.names, self.viewpoint, _DECLARED[kind])
        if kind == "nodes":
            return self.store.ask(nodes.node_names, self.viewpoint)
        return tuple(self.store.ask(nodes.kinds if kind == "kinds" else nodes.tags, self.viewpoint))

    def near(self, word: str, *kinds: str) -> tuple[str, ...]:
        """Similar names of these kinds for an unknown one; empty if there are so many that comparing them would take
        seconds.
        """
        if self.store.ask(_too_many_to_compare, self.viewpoint):
            return ()
        return near(word, [name for kind in kinds for name in self.names(kind)])

    @property
    def mission(self) -> ResolvedNode | None:
        """The main tree's root; None if it is unknown which tree runs."""
        return self.store.ask(nodes.mission, self.viewpoint)

    @property
    def knows_all_nodes(self) -> bool:
        """Whether a node that is not in scope does not exist."""
        return self.store.ask(nodes.knows_all_nodes, self.viewpoint)

    # ---- reports ----

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
        """Add a problem, once."""
        diagnostic = Diagnostic(rule, span, message, related, notes, fixes, severity=severity)
        self._problems.setdefault((rule, span, message), Problem(Place(span, self.path, self.facts.item), diagnostic))

    def place(self, span: Span) -> Place:
        """A place in the item."""
        return Place(span if self.source is None else self.source[1], self.path, self.facts.item)

    def text(self, start: int, end: int) -> str:
        """The text of a span, blanks folded."""
        text = self.store.ask(inputs.text, self.path, self.facts) if self.source is None else self.source[0]
        return " ".join(text[start:end].split())

    # ---- paths ----

    def target(
        self, path: Path, notes: tuple[str, ...] = (), *, asked: tuple[Span, str] | None = None
    ) -> NodeTarget | None:
        """The one node that a path names.

        Args:
            notes: for a path that names none.
            asked: the condition or event that is about that node, if one is, and its form: `node {}`, `{} fails`.
        """
        names = tuple(name.text for name in path.names)
        targets = self.find(names)
        if len(targets) > 1 and names[-1] in self.store.ask(inputs.names, self.viewpoint, Kind.TREE):
            # A node `Water` beside the tree `Water` lacks its `SubTree`, which is reported there.
            targets = tuple([target for target in targets if not _lacks_word(target.node, names[-1])]) or targets
        if len(targets) == 1:
            return targets[0]
        shown = "/".join(name.raw for name in path.names)
        if targets:
            self.report_ambiguous(path.span, shown, targets, asked)
        elif self.knows_all_nodes:
            likely = self._respellings(path)
            fixes = tuple(
                replace_fix(f"Replace `{word.text}` with `{name}`", word.span, written(name)) for word, name in likely
            )
            message = f"{self._missing(names, shown)}{did_you_mean(name for _, name in likely)}"
            notes = (_ONE_VERB,) if path.names[0].raw == "and" else notes
            notes = notes or ((OF_MISSION,) if shown == "mission" else ())
            notes = (SELECTORS,) if shown in ("all", "everything", "everywhere") else notes
            self.complain("unmatched-path", path.span, message, notes=notes, fixes=fixes)
        return None

    def report_unknown_kind(self, name: Word) -> None:
        """Report `every X` where no node matches X."""
        if not self.knows_all_nodes:
            return
        notes: tuple[str, ...] = ()
        if self.find((name.text,)):
            notes = (f"`{name.text}` is the name of one node, not of a kind: write it without `every`",)
        elif name.raw in ("node", "nodes") or name.raw in CATEGORIES:
            notes = (SELECTORS,)
        self._report_no_match(name, f"no node matches `every {name.raw}`", "kinds", notes)

    def report_unknown_tag(self, tag: Word) -> None:
        """Report `tagged x` without a node that has that tag."""
        if self.knows_all_nodes:
            self._report_no_match(tag, f"no node has the tag `{tag.text}`", "tags")

    def _report_no_match(self, word: Word, message: str, kind: str, notes: tuple[str, ...] = ()) -> None:
        likely = self.near(word.text, kind)
        fixes = tuple(replace_fix(f"Replace `{word.text}` with `{name}`", word.span, written(name)) for name in likely)
        self.complain("unmatched-path", word.span, f"{message}{did_you_mean(likely)}", notes=notes, fixes=fixes)

    def report_ambiguous(
        self, span: Span, shown: str, targets: tuple[NodeTarget, ...], asked: tuple[Span, str] | None = None
    ) -> None:
        """Report a path that names several nodes; `asked`: as of `target`."""
        related = tuple(
            Related(target.node.place, f"in the tree `{target.node.tree}`") for target in targets[:_MAX_SHOWN]
        )
        examined = targets[:_MAX_EXAMINED]
        paths = list(dict.fromkeys(path for target in examined if (path := self._path_to(target)) is not None))
        message = f"ambiguous path `{shown}`: {len(targets)} nodes match"
        notes: tuple[str, ...] = (
            "a path must match one node; write `every` for all of them, in a clause or in `apply … to every …`",
        )
        fixes = tuple(write_fix(path, span) for path in paths[:_MAX_SHOWN])
        if asked is not None:
            whole, form = asked
            is_each = len(paths) == len(targets) <= _MAX_JOINED
            several = " or ".join(map(form.format, paths if is_each else ("X", "Y")))
            is_event = form.startswith("{}")
            notes = (f"for any of them, {'an event' if is_event else 'a condition'} names each: `{several}`",)
            fixes = (write_fix(several if is_event else f"({several})", whole), *fixes) if is_each else fixes
        if len(paths) < len(examined):
            kinds = [node.id.text for target in examined if (node := target.node.node).name is None and node.id]
            names = "" if not kinds else f": `{written(kinds[0])} X`, `{written(kinds[0])} Y`"
            notes += (f"nodes that no path tells apart need names{names}",)
        self.complain("ambiguous-path", span, message, related=related, notes=notes, fixes=fixes)

    def _missing(self, names: tuple[str, ...], shown: str) -> str:
        if len(names) > 1 and self.find(names[-1:]):
            return f"no node `{names[-1]}` below `{'/'.join(names[:-1])}`"
        return f"unknown node `{shown}`" if len(names) == 1 else f"no node matches `{shown}`"

    def _respellings(self, path: Path) -> list[tuple[Word, str]]:
        """Corrections of a path that matches no node: pairs of a word and the similar name with which the path would
        match exactly one node.
        """
        respellings = []
        for index, word in enumerate(path.names):
            if self.store.ask(nodes.has_name, self.viewpoint, word.text):
                continue
            for name in self.near(word.text, "nodes"):
                names = [other.text for other in path.names]
                names[index] = name
                if len(self.find(tuple(names))) == 1:
                    respellings.append((word, name))
        return respellings

    def _path_to(self, target: NodeTarget) -> str | None:
        """The shortest path that names that node alone."""
        node = target.node
        heads = [word.text for word in (node.node.name, node.node.id) if word is not None]
        above = [node.parent.node.name.text] if node.parent is not None and node.parent.node.name is not None else []
        above += [node.tree] if node.tree is not None else []
        choices = [*([head] for head in heads), *([name, head] for head in heads for name in above)]
        for names in choices:
            targets = self.find(tuple(names))
            if len(targets) == 1 and targets[0].node is node:
                return "/".join(map(written, names))
        return None


def _lacks_word(node: ResolvedNode, tree: str) -> bool:
    """Whether a node that nothing declares has the name of a tree as its kind, without `SubTree`."""
    is_declared = node.kind is not None or node.of_model is not None or node.node.category is not None
    kind = node.node.kind
    return not (is_declared or node.is_subtree or node.is_placeholder) and kind is not None and kind.text == tree


def _too_many_to_compare(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether clauses use so many unknown names, and there are so many known ones, that comparing all of them would
    take seconds."""
    names = {*store.ask(inputs.names, viewpoint, Kind.SIGNAL), *store.ask(inputs.names, viewpoint, Kind.CONTEXT)}
    names |= {*store.ask(nodes.node_names, viewpoint), *store.ask(nodes.tags, viewpoint)}
    return len(store.ask(inputs.asked_for, viewpoint) - names) * len(names) > _MAX_COMPARISONS


_DECLARED: Final = {"signals": Kind.SIGNAL, "contexts": Kind.CONTEXT}
_ONE_VERB: Final = "a clause has one verb: write `succeeds within 30 s`, or put `succeeds` on a line of its own"
_MAX_SHOWN: Final = 5  # places and fixes of one diagnostic
_MAX_JOINED: Final = 10  # paths in one fix
_MAX_EXAMINED: Final = 50  # matching nodes for which an unambiguous path is sought
_MAX_COMPARISONS: Final = 200_000  # pairs of names; takes a few tenths of a second
