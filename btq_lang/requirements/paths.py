"""Reading the paths of clauses: the one node that each of them names.

One invariant: a path that names none, or several, is None and one problem, told where it stands.  A file whose nodes
may be elsewhere (a library, an include that was not found) is not told of a path that names none.
"""

from __future__ import annotations

from collections.abc import Iterable

from btq_lang.diagnostics import Diagnostic, Fix, Place, Related, replace_fix
from btq_lang.near import near
from btq_lang.record import record
from btq_lang.requirements.model import Condition, Parameter, Signal, Target
from btq_lang.requirements.nodes import Nodes, kinds
from btq_lang.rules import Severity
from btq_lang.syntax import Entry, Path, Word, is_name, quote
from btq_lang.text import Span
from btq_lang.workspace import Scope, Workspace

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final


@record
class Problem:
    """Something wrong with a requirement, and the entry that the places of the diagnostic count from."""

    path: str
    entry: Entry
    diagnostic: Diagnostic


class PathReader:
    """Reads paths of one scope; `begin` says where the next ones stand.

    Attributes:
        signals, contexts: by name; a context that could not be read is None.
        parameters: of the requirement at hand.
        mission: the main tree's root; None where nobody can say which tree runs.
        problems: all found so far, each once.
    """

    def __init__(self, workspace: Workspace, path: str, scope: Scope, nodes: Nodes) -> None:
        self.workspace = workspace
        self.scope = scope
        self.nodes = nodes
        self.signals: dict[str, Signal] = {}
        self.contexts: dict[str, Condition | None] = {}
        self.parameters: dict[str, Parameter] = {}
        main = workspace.main_tree(path)
        self.mission = nodes.root_of(main.entry) if main is not None else None
        self.problems: dict[tuple[int, Diagnostic], Problem] = {}
        # A library's nodes may be in the files that include it, and a robot's in XML that nobody has read.
        self.knows_all_nodes = (
            bool(nodes.all)
            and scope.complete
            and path not in workspace.included_files
            and not any(file.parsed.diagnostics for file in map(workspace.files.__getitem__, scope.paths))
        )

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
        self.problems.setdefault((id(self.entry), diagnostic), Problem(self.path, self.entry, diagnostic))

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
        found = self.nodes.find(names)
        if len(found) == 1:
            return found[0]
        shown = "/".join(name.raw for name in path.names)
        if found:
            self.ambiguous(path.span, shown, found)
        elif self.knows_all_nodes:
            self.complain("unmatched-path", path.span, self._missing(names, shown), fixes=self._meant(path))
        return None

    def none_of(self, name: Word) -> None:
        """Complain of `every X` where nothing is an X."""
        if not self.knows_all_nodes:
            return
        known = {name for node in self.nodes.all for name in kinds(node)}
        notes: tuple[str, ...] = ()
        if self.nodes.find((name.text,)):
            notes = (f"`{name.text}` is the name of one node, not of a kind: write it without `every`",)
        fixes = _replaced(name, known)
        self.complain("unmatched-path", name.span, f"no node is a `{name.text}`", notes=notes, fixes=fixes)

    def no_tag(self, tag: Word) -> None:
        """Complain of `tagged x` where nothing has that tag."""
        if self.knows_all_nodes:
            fixes = _replaced(tag, self.nodes.tags())
            self.complain("unmatched-path", tag.span, f"no node has the tag `{tag.text}`", fixes=fixes)

    def ambiguous(self, span: Span, shown: str, found: tuple[Target, ...]) -> None:
        """Complain of a path that names several nodes."""
        related = tuple(Related(target.node.place, f"in the tree `{target.node.tree}`") for target in found[:_SHOWN])
        paths = dict.fromkeys(path for target in found if (path := self._path_to(target)) is not None)
        self.complain(
            "ambiguous-path",
            span,
            f"`{shown}` is the name of {len(found)} nodes",
            related=related,
            notes=("a path names one node; for all of them write `every`, in a claim or in `apply … to every …`",),
            fixes=tuple(replace_fix(f"Write `{path}`", span, path) for path in list(paths)[:_SHOWN]),
        )

    def _missing(self, names: tuple[str, ...], shown: str) -> str:
        if len(names) > 1 and self.nodes.find(names[-1:]):
            return f"no node `{names[-1]}` stands below `{'/'.join(names[:-1])}`"
        return f"nothing is called `{shown}`" if len(names) == 1 else f"no node is named by `{shown}`"

    def _meant(self, path: Path) -> tuple[Fix, ...]:
        known = self.nodes.names()
        fixes = []
        for index, word in enumerate(path.names):
            for name in near(word.text, known) if word.text not in known else ():
                names = [other.text for other in path.names]
                names[index] = name
                if len(self.nodes.find(names)) == 1:
                    fixes.append(replace_fix(f"Replace `{word.text}` by `{name}`", word.span, _written(name)))
        return tuple(fixes)

    def _path_to(self, target: Target) -> str | None:
        """The shortest path that names that node alone."""
        node = target.node
        heads = [word.text for word in (node.node.name, node.node.id) if word is not None]
        above = [node.parent.node.name.text] if node.parent is not None and node.parent.node.name is not None else []
        above += [node.tree] if node.tree is not None else []
        choices = [*([head] for head in heads), *([name, head] for head in heads for name in above)]
        for names in choices:
            found = self.nodes.find(names)
            if len(found) == 1 and found[0].node is node:
                return "/".join(map(_written, names))
        return None


def _replaced(word: Word, known: Iterable[str]) -> tuple[Fix, ...]:
    return tuple(
        replace_fix(f"Replace `{word.text}` by `{other}`", word.span, _written(other))
        for other in near(word.text, known)
    )


def _written(name: str) -> str:
    return name if is_name(name) else quote(name)


_SHOWN: Final = 5  # places and fixes of one diagnostic
