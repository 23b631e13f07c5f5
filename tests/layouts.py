"""What the tests of the formatter compare, and how they make layouts that nobody would write.

`said` and `places` are written from language.md alone and share no code with the formatter: what a file says, and the
element that each of its comments belongs to.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterator, Sequence
from itertools import islice

from btq_lang.diagnostics.rules import Severity
from btq_lang.lexer import tokens
from btq_lang.parser import Parsed, parse
from btq_lang.syntax.tokens import BLANK, CLOSE, COMMENT, DEDENT, ERROR, INDENT, NEWLINE, OPEN, QUANTITY, Token
from btq_lang.syntax.tree import Requirement, Word, shape
from btq_lang.util.record import fields_of

# ---- what a file says -----------------------------------------------------------------------------------------------


def has_errors(text: str) -> bool:
    return any(problem.effective_severity is Severity.ERROR for problem in parse(text).diagnostics)


def said(text: str) -> object:
    """The tree of a file without offsets, and without the order of clauses."""
    return [(_unordered(shape(entry.item)), entry.in_root) for entry in parse(text).entries]


def _unordered(part: object) -> object:
    if not isinstance(part, tuple):
        return part
    fields = [_unordered(field) for field in part]
    if fields[:1] == ["Requirement"]:
        fields[-1] = sorted(map(repr, fields[-1]))  # type: ignore[call-overload]  # its clauses
    return tuple(fields)


def words(text: str) -> list[str]:
    """The words and signs of a file as they are written; quantities without blanks, line ends as one character."""
    found = [token for token in tokens(text) if token.kind not in (BLANK, COMMENT, NEWLINE, INDENT, DEDENT)]
    return ["".join(token.text.split()) if token.kind == QUANTITY else _line_ends(token.text) for token in found]


def _line_ends(text: str) -> str:
    return re.sub(r"\r\n?", "\n", text)


# ---- where comments belong ------------------------------------------------------------------------------------------


class _Line:
    """A line of code: its blanks, its level, and the number of the element that it is, or is a clause of."""

    def __init__(self, blanks: str, level: int, element: int, is_clause: bool) -> None:
        self.blanks = blanks
        self.level = level
        self.element = element
        self.is_clause = is_clause


def places(text: str) -> list[tuple[str, tuple[object, ...]]]:
    """Every comment with the place that language.md §6 gives it.

    A place is one of `("child of", element, "before", element)`, where the second is the element of the line below or
    "the end"; `("behind", element, words before it)`; `("in brackets of", element, words before it)`; `("in front of",
    element)`.  Elements are numbers of lines, those of clauses not counted: a clause counts as its requirement, since
    clauses may be sorted, and then the words before a comment are not counted either.
    """
    parsed = parse(text)
    clause_starts = {start for starts in _requirements(parsed) for start in starts[1:]}
    requirement_starts = {starts[0] for starts in _requirements(parsed)}
    found: list[tuple[str, tuple[object, ...]]] = []
    lines: list[_Line] = []
    waiting: list[tuple[str, str]] = []  # comments on lines of their own, and the blanks before them
    level = count = depth = 0
    has_clauses = False  # the line at hand begins a requirement with clauses, which may be moved
    here: list[tuple[Token, int, int]] = []  # comments of the line at hand, with the words and the brackets before them
    for index, token in enumerate(parsed.tokens):
        if token.kind in (INDENT, DEDENT):
            level += 1 if token.kind == INDENT else -1
        elif token.kind == COMMENT:
            if count or _code_follows(parsed.tokens, index):
                here.append((token, count, depth))
            else:
                waiting.append((_line_ends(token.text).rstrip(" \t"), _blanks_before(text, token.start)))
        elif token.kind == NEWLINE:
            line = lines[-1]
            counted = not (line.is_clause or has_clauses)
            for comment, before, brackets in here:
                place = "in brackets of" if brackets else "behind" if before else "in front of"
                found.append((_shown(comment), (place, line.element, before if counted else None)))
            here, count, depth, has_clauses = [], 0, 0, False
        elif token.kind != BLANK:
            if not count:
                start = here[0][0].start if here else token.start
                is_clause = token.start in clause_starts
                element = lines[-1].element if is_clause else (lines[-1].element + 1 if lines else 0)
                line = _Line(_blanks_before(text, start), level, element, is_clause)
                found += [(comment, _owner(blanks, lines, line)) for comment, blanks in waiting]
                waiting = []
                lines.append(line)
            has_clauses = has_clauses or token.start in requirement_starts
            count += 1
            depth += (token.kind == OPEN) - (token.kind == CLOSE)
    found += [(comment, _owner(blanks, lines, _Line("", 0, -1, False))) for comment, blanks in waiting]
    return found


def _owner(blanks: str, above: list[_Line], below: _Line) -> tuple[object, ...]:
    """The line above that stands further left; the parent of the line below, if that is further in."""
    before = "the end" if below.element < 0 else None if below.is_clause else below.element
    level = 0
    owner: object = None
    for line in reversed(above):
        if len(line.blanks) < len(blanks):
            owner, level = line.element, line.level + 1
            before = None if line.is_clause else before
            break
    if level < below.level:
        owner = next(line.element for line in reversed(above) if line.level < below.level)
    return "child of", owner, "before", before


def _shown(comment: Token) -> str:
    return _line_ends(comment.text).rstrip(" \t")


def _blanks_before(text: str, start: int) -> str:
    before = re.split(r"\r\n|\n|\r", text[:start])[-1].lstrip("\ufeff")
    return before[: len(before) - len(before.lstrip(" \t"))]


def _code_follows(found: Sequence[Token], index: int) -> bool:
    """Whether code stands behind a comment on the same line, other comments between them or not."""
    for token in islice(found, index + 1, None):
        if token.kind == BLANK and ("\n" in token.text or "\r" in token.text):
            return False
        if token.kind not in (BLANK, COMMENT, INDENT, DEDENT):
            return token.kind != NEWLINE
    return False


def _requirements(parsed: Parsed) -> Iterator[list[int]]:
    """Where each requirement that has clauses begins, and where they do."""
    for entry in parsed.entries:
        parts: list[object] = [entry.item]
        while parts:
            part = parts.pop()
            if isinstance(part, tuple):
                parts += part
            elif not isinstance(part, Word | str | int | None):
                if isinstance(part, Requirement) and part.clauses:
                    yield [entry.start + found.start for found in (part, *part.clauses)]
                parts += [getattr(part, name) for name in fields_of(part)]


# ---- other layouts --------------------------------------------------------------------------------------------------


def relaid(text: str, seed: int) -> str:
    """The words of a file in another layout, with comments anywhere: most often a file without errors, not always.

    Blocks are indented by any number of blanks or tabs, one of the two in a file; words have any gaps between them,
    line ends in brackets and comments among them; a gap that is none is sometimes made one, and the other way round.
    """
    draw = random.Random(seed)
    unit = draw.choice(" \t")
    line_end = draw.choice(["\n", "\n", "\n", "\r\n", "\r"])
    wild = draw.choice([0.02, 0.1, 0.3])
    indents = [""]
    brackets = 0
    out: list[str] = []
    before: Token | None = None  # on the same line
    for token in tokens(text):
        if token.kind == INDENT:
            indents.append(indents[-1] + unit * draw.randint(1, 9))
        elif token.kind == DEDENT:
            indents.pop()
        elif token.kind == NEWLINE:
            behind = [" ", "\t", " # t", "  // t ", " /* t */", f" /* t{line_end} */ // t"]
            out.append((draw.choice(behind) if draw.random() < wild else "") + line_end)
            before = None
        elif token.kind not in (BLANK, COMMENT, ERROR):
            if before is None:
                out += _between_lines(draw, wild, unit, line_end, len(indents[-1]) + 3)
                out.append(indents[-1] + ("/* b */ " if draw.random() < wild / 4 else ""))
            else:
                inner = line_end + indents[-1] + unit * draw.randrange(9) if brackets else ""
                out.append(_gap(draw, wild, text, before, token, inner))
            out.append(token.text)
            brackets += (token.kind == OPEN) - (token.kind == CLOSE)
            before = token
    out += _between_lines(draw, wild, unit, line_end, 3)
    made = "".join(out)
    return made.rstrip("\r\n") if draw.random() < 0.1 else made


def _between_lines(draw: random.Random, wild: float, unit: str, line_end: str, columns: int) -> Iterator[str]:
    """Blank lines and comment lines."""
    remarks = ["# c", "// c", "/* c */", f"/* a{line_end}  b */", "#", "# d  ", "/* e */ # f", "", "  "]
    while draw.random() < wild:
        yield unit * draw.randrange(columns) + draw.choice(remarks) + line_end


def _gap(draw: random.Random, wild: float, text: str, before: Token, token: Token, inner: str) -> str:
    """What stands between two words; `inner` begins a line, where that is possible."""
    was = text[before.end : token.start]
    chance = draw.random()
    if was == "" and chance > wild / 4:
        return ""
    if inner and chance < wild:
        remarks = ["", "", " # c", " /* c */", " /**/", inner, f"{inner}# d", f"{inner}/* e{inner}f */"]
        return draw.choice(remarks) + inner
    if chance < wild * 1.2 and not (_is_letter(before.text[-1:]) and _is_letter(token.text[:1])):
        return ""
    if chance < wild * 2:
        return draw.choice(["  ", "\t", "    ", " /* c */ ", " /* two */ /**/ "])
    return " " if "\n" in was else was


def _is_letter(character: str) -> bool:
    return character.isalnum() or character == "_"
