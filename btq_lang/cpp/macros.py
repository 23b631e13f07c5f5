"""The macros by which sources register nodes and provide ports, expanded as the preprocessor does.

One invariant: an expansion is on the line where the macro is used, so lines stay as they are, and `Expanded.original`
says for any column which one it was.  Only macros that may register a node or provide a port are expanded; of those
that several `#if` branches define, the first one that may is taken.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from typing import Final, TypeAlias

from btq_lang.cpp.model import SourcePosition
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record

Point: TypeAlias = tuple[int, int]  # row and column, from 0, columns in bytes


class Macro(Record):
    """A macro.

    Attributes:
        parameters: None if it is used without brackets.
        rows: from where to where it is defined, until the end of the file if nothing undefines it.
    """

    path: str
    name: str
    parameters: tuple[str, ...] | None
    body: str
    rows: range


class Failed(Record):
    """A macro that is used and cannot be expanded."""

    message: str
    place: SourcePosition


class Registering(Record):
    """A call that looks like a macro which registers its arguments, but whose definition is unknown."""

    name: str
    arguments: tuple[str, ...]
    place: SourcePosition


def macros_in(path: str, text: str) -> tuple[Macro, ...]:
    """The macros that a file defines."""
    macros: list[Macro] = []
    for match in _DIRECTIVE.finditer(text) if "#" in text else ():
        row = text.count("\n", 0, match.end())
        if match["undefined"]:
            ended = [macro for macro in macros if macro.name == match["undefined"] and macro.rows.stop == _END]
            for macro in ended:
                macros[macros.index(macro)] = Macro(
                    path, macro.name, macro.parameters, macro.body, range(macro.rows[0], row)
                )
        elif match["name"]:
            listed = match["parameters"]
            parameters = None if listed is None else tuple(filter(None, map(str.strip, _plain(listed).split(","))))
            body = _plain(match["body"])
            macros.append(Macro(path, match["name"], parameters, body, range(row, _END)))
    return tuple(macros)


def uncalled(texts: Mapping[str, str]) -> Iterator[Macro]:
    """The macros of some files, texts by path, that register what they are given and that none of them calls."""
    code = [_WITHOUT_DEFINITIONS.sub("", text) for text in texts.values()]
    for path, text in texts.items():
        for macro in macros_in(path, text):
            is_called = any(re.search(rf"\b{macro.name}\b", each) for each in code)
            if macro.parameters and _REGISTERS(macro.body) and not is_called:
                yield macro


class Macros:
    """All macros of some files."""

    def __init__(self, macros: Iterable[Macro]) -> None:
        self._by_name: Final = grouped((macro.name, macro) for macro in macros)
        words = {macro: frozenset(_WORD(macro.body)) for every in self._by_name.values() for macro in every}
        expanded = {macro.name for macro in words if _is_wanted(macro)}
        while more := {macro.name for macro, names in words.items() if macro.name not in expanded and names & expanded}:
            expanded |= more
        self._wanted: Final = frozenset(expanded)

    def needed_by(self, text: str) -> tuple[Macro, ...]:
        """The macros that are to be expanded in a text, and those that they use."""
        names = {name for name in self._wanted if name in text}
        waiting = [*names]
        for name in waiting:
            for macro in self._by_name.get(name, ()):
                inside = {*_WORD(macro.body)} & self._by_name.keys() - names
                names |= inside
                waiting += inside
        return tuple(macro for name in sorted(names) for macro in self._by_name[name])


class Expanded:
    """A text with its macros expanded.

    Attributes:
        text: with the same lines.
        failed: what could not be expanded.
        registering: what may register a node.
    """

    def __init__(self, path: str, text: str, macros: tuple[Macro, ...]) -> None:
        self.failed: Final[list[Failed]] = []
        self.registering: Final[list[Registering]] = []
        # By row: begin and end of each expansion in the text, and of what it replaces, which may end in a later row.
        self._replaced: Final[dict[int, list[tuple[int, int, int, Point]]]] = {}
        self._path: Final = path
        self._original: Final = text
        self._macros: Final = grouped((each.name, each) for each in macros)
        text = _WITH_BRACKETS.sub(_blank, text)  # the grammar cannot read all that a definition may have
        may_register = _MAY_REGISTER_SOMEWHERE.search(text.replace(_OF_ENGINE, "")) is not None
        self.text: Final = self._expanded(text) if macros or may_register else text

    def original(self, row: int, column: int, at_end: bool = False) -> Point:
        """The point of the text on the disk for one of this text; at_end: it ends something."""
        shift = 0
        for begin, end, start, stop in self._replaced.get(row, ()):
            if column < begin or (at_end and column == begin):
                break
            if column < end or (at_end and column == end):
                return stop if at_end else (row, start)
            shift = stop[1] - end
        return row, column + shift

    def _expanded(self, text: str) -> str:
        pieces: list[str] = []
        copied, row, line_start = 0, 0, 0  # offsets in the text
        for match in _TOKEN_OF_FILE.finditer(text):
            if match.start() < copied or match["name"] is None:
                continue
            name = match["name"]
            is_macro = name in self._macros
            if not is_macro and (name == _OF_ENGINE or _MAY_REGISTER.match(text, match.start()) is None):
                continue
            row += text.count("\n", line_start, match.start())
            line_start = text.rfind("\n", 0, match.start()) + 1
            passed, end = _arguments(text, match.end())
            if not is_macro:
                if passed:
                    self.registering.append(Registering(name, tuple(passed), self._place(match.start(), end)))
                continue
            macro = self._macro_named(name, row, match.start(), end)
            if macro is None or (macro.parameters is not None and passed is None):
                continue
            end = end if macro.parameters is not None else match.end()
            expansion = self._call(macro, passed or [], frozenset(), self._place(match.start(), end))
            if expansion is None:
                continue
            pieces.append(text[copied : match.start()])
            begin = _bytes("".join(pieces).rpartition("\n")[2])
            replaced = text[match.start() : end]
            stop = self._point(end)
            of_row = begin, begin + _bytes(expansion), self._point(match.start())[1], stop
            self._replaced.setdefault(row, []).append(of_row)
            pieces.append(expansion)
            if "\n" in replaced:
                pieces.append("\n" * replaced.count("\n") + " " * stop[1])
            copied = end
        return "".join((*pieces, text[copied:]))

    def _macro_named(self, name: str, row: int, start: int, end: int) -> Macro | None:
        """The macro that a name means in a row; reported if it may be any of several."""
        every = self._macros[name]
        choice = [macro for macro in every if macro.path == self._path and row in macro.rows]
        if not choice:
            others = [macro for macro in every if macro.path != self._path and macro.rows.stop == _END]
            included = [macro for macro in others if macro.path.rpartition("/")[2] in self._original]
            choice = included or [macro for macro in others if not macro.path.endswith(_OF_ONE_FILE)]
        choice = [macro for macro in choice if MATTERS(macro.body)] or choice
        first = {macro.path: macro for macro in reversed(choice)}
        if len({(macro.parameters, macro.body) for macro in first.values()}) > 1:
            places = ", ".join(sorted(f"{macro.path}:{macro.rows[0] + 1}" for macro in first.values()))
            message = f"`{name}` may be any of several macros: {places}; include the file that defines it"
            self._fail(message, self._place(start, end), *choice)
            return None
        return choice[0] if choice else None

    def _call(self, macro: Macro, passed: list[str], within: frozenset[str], place: SourcePosition) -> str | None:
        """The expansion of a macro; None if it fails; within: the macros that are being expanded."""
        parameters = macro.parameters or ()
        is_variadic = parameters[-1:] != () and parameters[-1].endswith("...")
        if macro.parameters is not None:
            passed = [] if not parameters and passed == [""] else passed
            least = len(parameters) - is_variadic
            if len(passed) < least or (len(passed) > least and not is_variadic):
                message = f"`{macro.name}` takes {least} arguments, and is given {len(passed)}; it cannot be expanded"
                self._fail(message, place, macro)
                return None
        values = dict(zip(parameters, passed, strict=False))
        if is_variadic:
            others = ", ".join(passed[len(parameters) - 1 :])
            values[parameters[-1].removesuffix("...").strip() or "__VA_ARGS__"] = others
        inside = _VISIBILITY.sub("", "".join(self._substituted(macro.body, values, within, place)))
        return self._rescanned(inside, within | {macro.name}, place)

    def _substituted(
        self, body: str, values: Mapping[str, str], within: frozenset[str], place: SourcePosition
    ) -> Iterator[str]:
        """The pieces of a body with its parameters replaced."""
        tokens = ["", *(match[0] for match in _TOKEN.finditer(_HASHES.sub(lambda sign: sign[0].strip(), body))), "", ""]
        index = 1
        while index < len(tokens) - 2:
            before, token, after, next_but_one = tokens[index - 1 : index + 3]
            if token == "#" and after in values:
                yield _quoted(values[after])
                index += 1
            elif (token, after) == (",", "##") and not values.get(next_but_one, "?"):
                index += 2  # `, ##__VA_ARGS__` without arguments
            elif token in values:
                is_pasted = "##" in (before, after)
                yield values[token] if is_pasted else self._rescanned(values[token], within, place)
            elif token != "##":
                yield token
            index += 1

    def _rescanned(self, text: str, within: frozenset[str], place: SourcePosition) -> str:
        """A text in which macros are expanded, except those that are being so."""
        pieces: list[str] = []
        copied = 0
        for match in _TOKEN.finditer(text):
            name = match["name"]
            if match.start() < copied or name is None or name in within or name not in self._macros:
                continue
            passed, end = _arguments(text, match.end())
            macro = self._macro_named(name, place.line - 1, match.start(), match.end())
            if macro is None or (macro.parameters is not None and passed is None):
                continue
            expansion = self._call(macro, passed or [], within, place)
            if expansion is not None:
                pieces += (text[copied : match.start()], expansion)
                copied = end if macro.parameters is not None else match.end()
        return "".join((*pieces, text[copied:]))

    def _fail(self, message: str, place: SourcePosition, *macros: Macro) -> None:
        """Report what cannot be expanded, if that may hide a node or a port."""
        if any(MATTERS(each.body) for each in macros):
            self.failed.append(Failed(message, place))

    def _point(self, offset: int) -> Point:
        start = self._original.rfind("\n", 0, offset) + 1
        return self._original.count("\n", 0, offset), _bytes(self._original[start:offset])

    def _place(self, start: int, end: int) -> SourcePosition:
        (row, column), (end_row, end_column) = self._point(start), self._point(end)
        return SourcePosition(self._path, row + 1, column + 1, end_row + 1, end_column + 1)


def _is_wanted(macro: Macro) -> bool:
    """Whether a macro matters by itself, or through its arguments: `#define NODES(X) X(Dock) X(Move)`."""
    if _IS_KNOWN(macro.name):
        return False
    names = "|".join(map(re.escape, filter(str.isidentifier, macro.parameters or ())))
    calls_one = names and re.search(rf"\b(?:{names})\s*\(", macro.body)
    return MATTERS(macro.body) is not None or bool(calls_one)


def _arguments(text: str, offset: int) -> tuple[list[str] | None, int]:
    """The arguments in the brackets at an offset, and the end of these; None if there are none."""
    passed: list[str] = []
    depth, begin = 0, offset
    for match in _TOKEN.finditer(text, offset):
        sign = match[0]
        if depth == 0 and sign != "(":
            if sign.isspace():
                continue
            break
        if sign in ("(", "[", "{"):
            depth += 1
            begin = match.end() if depth == 1 else begin
        elif sign in (")", "]", "}"):
            depth -= 1
        if (sign == "," and depth == 1) or depth == 0:
            passed.append(_plain(text[begin : match.start()]))
            begin = match.end()
        if depth == 0:
            return passed, match.end()
    return None, offset


def _plain(text: str) -> str:
    """A piece of code on one line, without comments."""
    return " ".join(_COMMENT.sub(_without_comment, _SPLICED.sub(" ", text)).split())


def _without_comment(match: re.Match[str]) -> str:
    return " " if match[0].startswith("/") else match[0]


def _blank(match: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", match[0])


def _bytes(text: str) -> int:
    return len(text.encode("utf-8", "replace"))


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


_END: Final = sys.maxsize  # of a file
_STRING: Final = r'R"(?P<mark>[^()\s"]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"'
_TOKENS: Final = (
    rf"//[^\n]*|/\*.*?\*/|{_STRING}|'(?:\\.|[^'\\\n])+'"
    r"|(?P<name>[A-Za-z_]\w*)|\d[\w'.]*|\#\#|\n|[^\S\n]+|."
)
_TOKEN: Final = re.compile(_TOKENS, re.DOTALL)
_TOKEN_OF_FILE: Final = re.compile(rf"^[ \t]*\#(?:\\\r?\n|[^\n])*|{_TOKENS}", re.DOTALL | re.MULTILINE)
_COMMENT: Final = re.compile(rf"//[^\n]*|/\*.*?\*/|{_STRING}", re.DOTALL)
_DIRECTIVE: Final = re.compile(
    r"^[ \t]*#[ \t]*(?:undef[ \t]+(?P<undefined>\w+)"
    r"|define[ \t]+(?P<name>\w+)(?:\((?P<parameters>[^)]*)\))?(?P<body>(?:\\\r?\n|[^\n])*))",
    re.MULTILINE,
)
_WITH_BRACKETS: Final = re.compile(r"^[ \t]*#[ \t]*define[ \t]+\w+\((?:\\\r?\n|[^\n])*", re.MULTILINE)
_WITHOUT_DEFINITIONS: Final = re.compile(r"^[ \t]*#[ \t]*(?:define|undef|ifn?def)\b(?:\\\r?\n|[^\n])*", re.MULTILINE)
_REGISTERS: Final = re.compile(r"[rR]egister[A-Z]\w*\s*[<(]").search
_SPLICED: Final = re.compile(r"\\\r?\n")
_HASHES: Final = re.compile(r"\s*##\s*|#\s+")
_WORD: Final = re.compile(r"[A-Za-z_]\w*").findall
# What registers a node or provides, reads or writes a port, or begins a class with a base class.
MATTERS: Final = re.compile(
    r"providedPorts|Port\s*[<(]|[rR]egister[A-Z]\w*\s*[<(]|getInput|setOutput|\b(?:class|struct)\s[^;{]*[^:]:[^:]"
).search
_MAY_REGISTER: Final = re.compile(r"(?:[A-Z0-9_]*(?:REGISTER|EXPORT|PLUGIN)[A-Z0-9_]*|\w*[rR]egister\w*)(?=\s*\()")
_MAY_REGISTER_SOMEWHERE: Final = re.compile(r"(?:REGISTER|EXPORT|PLUGIN|[rR]egister)\w*\s*\(")
_OF_ONE_FILE: Final = (".cpp", ".cc", ".cxx")  # others do not see what these define
_VISIBILITY: Final = re.compile(r"\b[A-Z0-9_]+_(?:EXPORTS?|PUBLIC|API|VISIBLE)\b(?!\s*\()")  # before a type
# What is understood as it is written: the head of a function, and a read with something to take instead.
_IS_KNOWN: Final = re.compile(r"BT_REGISTER_NODES|get\w*Or[A-Z]\w*").fullmatch
_OF_ENGINE: Final = "BT_REGISTER_NODES"
