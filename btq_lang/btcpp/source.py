"""The file that is being exported: what all parts of an export look up, and where they record remarks.

One invariant: remarks are only added, and there is one for a message and a place.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, partial
from typing import Final

from btq_lang.btcpp.constants import types_below
from btq_lang.btcpp.document import Content, Raw, XmlComment, escape
from btq_lang.btcpp.spelling import FORBIDDEN, as_comment, spelt
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_xml_name, legal_name, model_name_problem
from btq_lang.syntax.tree import Entry, Verbatim, Word
from btq_lang.util.record import Record
from btq_lang.util.text import Placed, Span
from btq_lang.workspace.comments import NO_COMMENTS, Comments, comments
from btq_lang.workspace.comments import Comment as SourceComment
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Scope, Workspace


class Remark(Record):
    """A remark of an export, and the place it is about, counted from the start of the file."""

    path: str
    span: Span
    message: str


class ExportSource:
    """One file while it is exported.

    Attributes:
        target: the version of the engine.
        verbatim: whether to write exactly what is in the file, and nothing else.
        is_bundled: whether XML that the file includes is written too, instead of staying as it is.
        comments: of the file, by the element that they belong to.
    """

    def __init__(self, workspace: Workspace, path: str, target: str, verbatim: bool, is_bundled: bool) -> None:
        self.workspace: Final = workspace
        self.path: Final = path
        self.target: Final = target
        self.verbatim: Final = verbatim
        self.is_bundled: Final = is_bundled
        self.file: Final[File] = workspace.files[path]
        self.scope: Final[Scope] = workspace.scope(path)
        self.comments: Final[Mapping[int, Comments]] = comments(self.file.parsed)
        self.repairs: Final[dict[Remark, None]] = {}
        self.problems: Final[dict[Remark, None]] = {}
        self.tree_id: Final = cache(self._tree_id)
        # The types as which a port of a tree is read.
        self.types_below: Final = cache(partial(types_below, self.scope, self.target))
        self._changed_comments: list[SourceComment] = []

    def repair(self, entry: Entry, part: Placed, message: str) -> None:
        """Record a change that was made because the engine would refuse the file otherwise."""
        self.repairs[Remark(self.path, Span(part.start, part.end).shifted(entry.start), message)] = None

    def problem(self, entry: Entry, part: Placed, message: str) -> None:
        """Record what cannot be written."""
        self.problems[Remark(self.path, Span(part.start, part.end).shifted(entry.start), message)] = None

    def _tree_id(self, name: str) -> str:
        """The ID under which a tree is written, in every file and wherever it is named."""
        refused = not self.verbatim and model_name_problem(name, self.target) is not None
        return legal_name(name) if refused and not self._stays(name) else name

    def _stays(self, tree: str) -> bool:
        """Whether a tree is in XML that is not written, so that its name cannot change."""
        definition = None if self.is_bundled else self.scope.find(Kind.TREE, tree)
        return definition is not None and definition.path != self.path and definition.path in self.workspace.foreign

    def spelt_tree(self, name: Word) -> str:
        """A tree's name as the value of an attribute."""
        tree_id = self.tree_id(name.text)
        return spelt(name) if tree_id == name.text else escape(tree_id)

    def around(self, entry: Entry, part: Placed) -> Comments:
        """The comments of an element."""
        return self.comments.get(entry.start + part.start, NO_COMMENTS)

    def respelt(self, entry: Entry, part: Placed, original: str, written: str) -> None:
        """Record that a constant of a subtree's port is spelt as another type."""
        why = "4.9.1 and later would read it as another type than the node below expects"
        self.repair(entry, part, f"`{original}` is written as `{written}`: {why}")

    def raw(self, entry: Entry, verbatim: Verbatim) -> Raw:
        """An element that the file spells out."""
        text = verbatim.text.text.strip() if verbatim.text is not None else ""
        if problem := fragment_problem(text):
            self.problem(entry, verbatim, problem)
        return Raw(text)

    def put(self, contents: list[Content], element: Content, around: Comments) -> None:
        """Add an element with the comments before and after it."""
        contents += self.written(around.before)
        contents += self.written(around.within)
        contents.append(element)
        contents += self.written(around.after, beside=True)

    def written(self, remarks: tuple[SourceComment, ...], beside: bool = False) -> list[XmlComment]:
        """Comments as XML has them."""
        xml_comments = []
        for remark in remarks:
            text = as_comment(remark.text)
            if "--" in remark.text:
                self._changed_comments.append(remark)
            if not remark.is_block and text[:1] in _BLANKS:
                text += " "
            xml_comments.append(XmlComment(text, beside))
        return xml_comments

    def finish(self) -> None:
        """Record what concerns the file as a whole."""
        if self._changed_comments:
            first = self._changed_comments[0]
            number = len(self._changed_comments)
            where = "a comment" if number == 1 else f"{number} comments"
            message = f"`--` in {where} is written `- -`: XML does not allow it there"
            span = Span(first.start, first.start + len(first.raw))
            self.repairs[Remark(self.path, span, message)] = None
        for match in FORBIDDEN.finditer(self.file.text):
            message = f"XML does not allow the character U+{ord(match[0]):04X}"
            self.problems[Remark(self.path, Span(match.start(), match.end()), message)] = None


def fragment_problem(text: str) -> str | None:
    """What is wrong with a text that should be one element; None if it is one.  Prefixes need no declaration."""
    if text[:1] != "<" or not is_xml_name(text[1:2]):
        return "`xml` takes one element; its text must begin with `<`"
    from btq_lang.btcpp.reader import read  # few files have such elements

    problems = read(text, with_prefixes=False).problems
    return f"not a well-formed element: {problems[0].message}" if problems else None


_BLANKS: Final = (" ", "\t")
