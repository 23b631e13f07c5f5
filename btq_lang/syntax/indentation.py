"""Indentation: the open blocks around a line, and the level of lines whose indentation fits none of them.

One invariant: each line has a level, whatever its blanks; one that fits no block is reported once, and its block has
that column from then on.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.util.text import Span, counted


class Indentation:
    """A line of a text, and the blocks around it.

    Attributes:
        position: where the next token is read.
        level: how many blocks are open around the line.
        line_start: where the line begins, its blanks included.
        blanks: the blanks it begins with.
        columns: the blanks of each open block.
        adopted: other blanks were accepted as those of an open block.
        problems: diagnostics so far.
    """

    def __init__(self, text: str) -> None:
        self.text: Final = text
        self.size: Final = len(text)
        self.position = 1 if text.startswith("\ufeff") else 0
        self.level = 0
        self.line_start = self.position
        self.blanks = ""
        self.columns: list[str] = [""]
        self.adopted = False
        self.problems: list[Diagnostic] = []
        self._aliases: list[tuple[str, ...]] = [()]  # other blanks accepted for the same block, each reported once
        self._root_level = -1  # the level of an open Root block's items
        self._cut_until = -1  # the end of the last line that ended its brackets early

    def _indent(self, blanks: str) -> None:
        """Open a block, close blocks, or adopt a column that no open block has."""
        columns, aliases = self.columns, self._aliases
        level = len(columns) - 1
        if not self.adopted and len(blanks) > len(columns[level]):
            level = -1  # as below: no column is longer
        while level >= 0 and blanks != columns[level] and blanks not in aliases[level]:
            level -= 1
        if level < 0:
            if extends(blanks, columns[-1], aliases[-1]):
                columns.append(blanks)
                aliases.append(())
                self.level = len(columns) - 1
                return
            level = self._adopting_level(blanks)
            self.adopted = True
            if self._cut_until < 0 or self.text[self._cut_until : self.line_start].strip():
                self._report_indentation(blanks, columns[level])  # else it is the rest of the brackets
            if level == 0:
                aliases[0] = (*aliases[0], blanks)[-_ALIASES:]
            else:
                aliases[level] = (*aliases[level], columns[level])[-_ALIASES:]
                columns[level] = blanks
        while len(columns) > level + 1:
            columns.pop()
            aliases.pop()
        if self.adopted and level <= max(self._root_level, 0) and not any(aliases):
            self.adopted = False  # the blocks concerned are closed
        self.level = level
        if level < self._root_level:
            self._root_level = -1

    def _adopting_level(self, blanks: str) -> int:
        """The level of a line whose indentation fits no block: an item's is that of the items, any other's that of the
        nearer of the two blocks around it; in a file of blanks, each tab counts as a level.
        """
        columns = self.columns
        items = max(0, min(self._root_level, len(columns) - 1))  # a Root may have no block
        if TOP_LINE.match(self.text, self.position):
            return items
        if not blanks.strip("\t") and not "".join(columns).strip(" "):
            return min(len(blanks), len(columns) - 1)
        level = len(columns) - 1
        while not extends(blanks, columns[level - 1], self._aliases[level - 1]):
            level -= 1
        is_nearer = len(blanks) - len(columns[level - 1]) < len(columns[level]) - len(blanks)
        return level - 1 if is_nearer and level - 1 > items else level

    def _report_indentation(self, blanks: str, expected: str) -> None:
        if expected.startswith(blanks) or blanks.startswith(expected):
            message = f"an indentation of {_shown(blanks)} matches no open block"
        else:
            message = f"tabs and spaces are mixed: {_shown(blanks)} cannot be compared with {_shown(expected)}"
        note = f"btq reads the line as if indented by {_shown(expected)}"
        span = Span(self.line_start, self.line_start + len(blanks))
        fix = replace_fix(f"Indent it by {_shown(expected)}", span, expected)
        self.problems.append(Diagnostic("inconsistent-indentation", span, message, notes=(note,), fixes=(fix,)))


def extends(blanks: str, outer: str, aliases: tuple[str, ...]) -> bool:
    """Whether a line with these blanks is in the block of a line with the outer ones or an alias of them."""
    if len(blanks) > len(outer) and blanks.startswith(outer):
        return True
    return any(len(blanks) > len(column) and blanks.startswith(column) for column in aliases)


def _shown(blanks: str) -> str:
    if not blanks:
        return "nothing"
    tabs = blanks.count("\t")
    return " and ".join(
        counted(number, word) for number, word in ((tabs, "tab"), (len(blanks) - tabs, "space")) if number
    )


# The words that begin an item, and what must follow for a line to end a forgotten bracket (docs/language.md, Brackets).
TOP_LINE: Final = re.compile(
    r"""(?x)
        BehaviorTree [ \t]+ ID [ \t]* = (?!=)
        | (?:BehaviorTree|Root|TreeNodesModel) (?: [ \t]+ (?= \# | //? ) | [ \t]* (?= [\r\n(] | \Z ) )
        | (?:BehaviorTree|Root|TreeNodesModel|include|signal|context|apply|quality|qualities|QualityReq|hazard)
          (?: [ \t]+ (?= (?P<name> [^\W\d] (?:\w|-(?=\w))* [?!]? ) ) (?P=name)
            | [ \t]* (?: "(?:[^"\\\r\n]|\\[^\r\n])*" | '(?:[^'\\\r\n]|\\[^\r\n])*' ) )
          (?! [ \t]* = )
        | scenario [ \t]* (?: "(?:[^"\\\r\n]|\\[^\r\n])*" | '(?:[^'\\\r\n]|\\[^\r\n])*' ) (?! [ \t]* = )
        | given [ \t]* (?: \{ | [ \t] [^\W\d] (?:\w|-(?=\w))* [?!]? [ \t]* = (?!=)
          | [ \t] (?: every [ \t]+ )? [^\W\d] (?: [\w/] | -(?=\w) )* [?!]?
            (?: [ \t]* \( | [ \t]+ (?:succeeds|fails|skips|does|answers|takes|after) \b ) )
    """
)
_ALIASES: Final = 16  # columns accepted for one block; more would only cost time
