"""Entries of the blackboard: their values, types and numbers of writes, and how subtrees remap them.

A value is a float, an int, a str, or a bool, which the engine keeps as an int.  Source: facts about BehaviorTree.CPP
4.6 to 4.10, seen in runs of the engine.
"""

from __future__ import annotations

import re
from typing import Final, TypeAlias

from btq_lang.simulator.errors import EngineError, NotModelled


class Unknown:
    """A value that nothing determines: it can be written and passed on.

    Whatever else is done with it raises NotModelled, but for a comparison where a subclass has an answer.
    """

    __slots__ = ()

    def compared(self, operator: str, other: Value) -> bool:
        """Whether a comparison with it on the left holds."""
        raise self.needed("compared")

    def combined(self, operator: str, other: Value, is_left: bool) -> Value:
        """What an operator makes of it and another value; `is_left`: it is the left operand."""
        raise self.needed("calculated with")

    def __bool__(self) -> bool:
        return self.compared("!=", 0)

    def __float__(self) -> float:
        raise self.needed("read as a number")

    def __int__(self) -> int:
        raise self.needed("read as a number")

    def __str__(self) -> str:
        raise self.needed("read as a text")

    def needed(self, what: str) -> NotModelled:
        """The exception for something that cannot be done without its value."""
        return ValueNeeded(what, self)


class ValueNeeded(NotModelled):
    """Something cannot be done without the value of an entry, which is unknown.

    Attributes:
        value: the unknown value.
    """

    def __init__(self, what: str, value: Unknown) -> None:
        super().__init__(f"an entry whose value is unknown is {what}")
        self.value: Final = value


class Unsaid(Unknown):
    """What a skill has written, where nothing says what that is.

    Attributes:
        writer: the path of the skill.
        key: of the entry, as the skill names it.
        given: what a scenario gives to say it: `Dock succeeds and writes place = …`; empty: the value of the entry.
    """

    __slots__ = ("given", "key", "writer")

    def __init__(self, writer: str, key: str, given: str = "") -> None:
        self.writer: Final = writer
        self.key: Final = key
        self.given: Final = given

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Unsaid) and (other.writer, other.key) == (self.writer, self.key)

    def __hash__(self) -> int:
        return hash((self.writer, self.key))

    @property
    def fact(self) -> str:
        """Why it is unknown."""
        return f"nothing says what {self.writer} writes into {{{self.key}}}"

    def why(self, name: str = "") -> str:
        """Why it is unknown, and what a scenario gives to say it; `name`: of the signal that reads it."""
        given = self.given or f"{name or f'{{{self.key}}}'} = …"
        return f"{self.fact}; write `given {given}`"


Value: TypeAlias = float | int | str | Unknown

UNTYPED: Final = ""
STRING: Final = "std::string"
DOUBLE: Final = "double"
INT64: Final = "long"
BOOL: Final = "bool"
_FLOATING: Final = ("double", "float")


class BoardEntry:
    """An entry.

    Attributes:
        value: None: it exists, but nothing has been written.
        type: a type of C++; empty: that of the first value is still to be fixed.
        number: how often it was written.
    """

    __slots__ = ("number", "type", "value")

    def __init__(self, type_: str = UNTYPED, value: Value | None = None, number: int = 0) -> None:
        self.type = type_
        self.value = value
        self.number = number


class Board:
    """The blackboard of a tree, or of a SubTree inside one.

    Attributes:
        entries: those of its own.
        remapped: keys that are other ones in the parent.
        is_autoremapped: all other keys are those of the parent, except private ones, which begin with `_`.
        is_old: it is that of version 3: no key is private or of the root, and an entry made without a type has none.
    """

    __slots__ = ("entries", "is_autoremapped", "is_old", "parent", "remapped", "root")

    def __init__(self, parent: Board | None = None, is_autoremapped: bool = False, is_old: bool = False) -> None:
        self.entries: Final[dict[str, BoardEntry]] = {}
        self.remapped: Final[dict[str, str]] = {}
        self.parent: Final = parent
        self.root: Final[Board] = parent.root if parent is not None else self
        self.is_autoremapped: Final = is_autoremapped
        self.is_old: Final[bool] = parent.is_old if parent is not None else is_old

    def entry(self, key: str) -> BoardEntry | None:
        """The entry of a key, wherever the key leads; None if there is none."""
        board, name = self.home(key)
        return board.entries.get(name)

    def home(self, key: str) -> tuple[Board, str]:
        """The blackboard that has the entry of a key, or would get it, and the entry's name there."""
        board = self
        while True:
            if key.startswith("@") and not self.is_old:
                board, key = board.root, key[1:]
            if key in board.entries or board.parent is None:
                return board, key
            if key in board.remapped:
                key = board.remapped[key]
            elif not board.is_autoremapped or (key.startswith("_") and not self.is_old):
                return board, key
            board = board.parent

    def create(self, key: str, type_: str = UNTYPED) -> BoardEntry:
        """The entry of a key, which is made if there is none.

        Raises:
            EngineError: it has another type.
        """
        board, name = self.home(key)
        entry = board.entries.get(name)
        if entry is None:
            entry = board.entries[name] = BoardEntry(type_)
        elif entry.type and type_ and entry.type != type_:
            raise EngineError(
                f"Blackboard entry [{name}]: once declared, the type of a port shall not change. "
                f"Previously declared type [{entry.type}], current type [{type_}]"
            )
        return entry

    def write(self, key: str, value: Value, type_: str) -> None:
        """Write a value of a type, as a leaf of the program does.

        Raises:
            EngineError: the entry has a type to which the value is not converted.
        """
        if key.startswith("@"):
            self.root.write(key[1:], value, type_)
            return
        entry = self.entries.get(key)
        if entry is None:
            entry = self.create(key, UNTYPED if type_ == STRING else type_)
            entry.value = value
        elif not entry.type:
            entry.type, entry.value = UNTYPED if self.is_old else type_, value
        else:
            entry.value = _into(entry, key, value, type_)
        entry.number += 1

    def give(self, key: str, value: Value, type_: str) -> None:
        """Write a value that is given: for an entry of any type but numbers and texts it is one of that type.

        Raises:
            EngineError: `write` does.
        """
        entry = self.entry(key)
        is_opaque = entry is not None and entry.type not in (UNTYPED, STRING, *_FLOATING, *LIMITS)
        self.write(key, value, entry.type if entry is not None and is_opaque else type_)

    def replace(self, key: str, value: Value, type_: str) -> None:
        """Write a value of any type, which it keeps, as SetBlackboard does.

        Raises:
            EngineError: the entry has another type.
        """
        if key.startswith("@"):
            self.root.replace(key[1:], value, type_)
            return
        entry = self.entries.get(key) or self.create(key, type_)
        if entry.type and type_ and entry.type != type_:
            raise EngineError(
                f"Blackboard::set({key}): once declared, the type of a port shall not change. "
                f"Previously declared type [{entry.type}], current type [BT::Any]"
            )
        entry.value = value
        entry.number += 1

    def memory(self, counts_writes: bool) -> tuple[object, ...]:
        """Its own entries, as a value; `counts_writes`: with the numbers of writes."""
        return tuple(
            [
                (key, entry.type, entry.value, entry.number if counts_writes else 0)
                for key, entry in self.entries.items()
            ]
        )

    def define(self, key: str, value: Value, type_: str) -> None:
        """Give this blackboard an entry of its own, whatever its parent has."""
        self.entries[key] = BoardEntry(type_, value, 1)

    def unset(self, key: str) -> None:
        """Remove an entry of its own; one that is elsewhere stays."""
        self.entries.pop(key, None)


def _into(entry: BoardEntry, key: str, value: Value, type_: str) -> Value:
    """What a typed entry holds after a value of a type is written to it."""
    if entry.type == type_ or isinstance(value, Unknown):
        return value
    if isinstance(value, str):
        return parsed(value, entry.type)
    if fits(value, entry.type):
        return copied(value, entry.value)
    raise EngineError(
        f"Blackboard::set({key}): once declared, the type of a port shall not change. "
        f"Previously declared type [{entry.type}], current type [{type_}]"
    )


def copied(value: Value, old: Value | None) -> Value:
    """A value in the form of the one that it replaces: a number stays whole or real.

    Raises:
        EngineError: it cannot be converted without a loss, or one is a text and the other a number.
    """
    if old is None or isinstance(value, Unknown) or isinstance(old, Unknown):
        return value
    if isinstance(value, str) and isinstance(old, str):
        return value
    if isinstance(value, str) or isinstance(old, str):
        raise EngineError("Any::copyInto fails")
    if isinstance(old, float):
        return float(value)
    return whole(value)


def type_of(value: Value | None) -> str:
    """The type that a value has in an entry without one."""
    if value is None or isinstance(value, Unknown):
        return UNTYPED
    return STRING if isinstance(value, str) else DOUBLE if isinstance(value, float) else INT64


def whole(value: Value) -> int:
    """A number without a fraction.

    Raises:
        EngineError: it has one.
    """
    if isinstance(value, float):
        if not value.is_integer():
            raise EngineError("Invalid floating point to integer conversion")
        return int(value)
    return int(value)


def fits(value: float, type_: str) -> bool:
    """Whether a number can be kept in a type of C++ without a loss."""
    if type_ in _FLOATING:
        return True
    limits = LIMITS.get(type_)
    return limits is not None and float(value).is_integer() and limits[0] <= value <= limits[1]


def parsed(text: str, type_: str) -> Value:
    """A text as a value of a type of C++, as `convertFromString` reads it: of a number, what follows it is ignored.

    Raises:
        EngineError: the text cannot be read as such a value.
    """
    if type_ in (STRING, UNTYPED):
        return text
    try:
        if type_ in _FLOATING:
            return float(_REAL.findall(text)[0])
        if type_ == BOOL:
            return _TRUTH[text]
        if type_ in LIMITS:
            return int(_WHOLE.findall(text)[0])
    except (IndexError, KeyError):
        raise EngineError(f"Can't convert string [{text}] to {type_}") from None
    raise EngineError(f"You (maybe indirectly) called BT::convertFromString() for type [{type_}]")


_WHOLE: Final = re.compile(r"\A-?\d+")
_REAL: Final = re.compile(r"\A[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|inf|nan)")
_TRUTH: Final = {"1": 1, "true": 1, "TRUE": 1, "True": 1, "0": 0, "false": 0, "FALSE": 0, "False": 0}
LIMITS: Final = {
    BOOL: (0, 1),
    **{
        f"{'u' if low == 0 else ''}int{bits}_t": (low and -(1 << bits - 1), (1 << bits - (low != 0)) - 1)
        for bits in (8, 16, 32, 64)
        for low in (0, -1)
    },
    "int": (-(1 << 31), (1 << 31) - 1),
    "unsigned int": (0, (1 << 32) - 1),
    INT64: (-(1 << 63), (1 << 63) - 1),
    "unsigned long": (0, (1 << 64) - 1),
}
