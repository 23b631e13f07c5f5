"""The nodes that C++ sources register, as plain records."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.util.record import Record
from btq_lang.util.text import LineIndex, Position, Span

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Category, Direction


class SourcePosition(Record):
    """A place in a file; lines and columns count from 1, columns in bytes of UTF-8."""

    path: str
    line: int
    column: int
    end_line: int
    end_column: int

    def span_in(self, lines: LineIndex) -> Span:
        """The place in the text of its file."""
        start = lines.offset(Position(self.line - 1, self.column - 1), "utf-8")
        return Span(start, lines.offset(Position(self.end_line - 1, self.end_column - 1), "utf-8"))

    def __str__(self) -> str:
        return f"{self.path}:{self.line}:{self.column}"


class CppPort(Record):
    """A port that a class provides.

    Attributes:
        type: as it is written; empty if it takes anything.
        default: the value that the engine takes if none is given; None: none.  Empty if it is an expression.
        written: the default as it is written.
        text: its description.
    """

    name: str
    direction: Direction
    type: str
    default: str | None
    written: str
    text: str
    place: SourcePosition


class PortUse(Record):
    """A place where the code of a node reads or writes a port.

    Attributes:
        without: what happens if the port is not given: "fails", "goes on" with something else, "ignores" that (a
            variable stays as it is), or empty if that cannot be seen.
        falls_back: whether a function reads it that knows what to take instead, such as an entry of that name.
    """

    port: str
    writes: bool
    without: str
    place: SourcePosition
    falls_back: bool = False


class CppNode(Record):
    """A node that the sources register.

    Attributes:
        name: its ID.
        class_name: empty for a function.
        place: of the registration.
        class_place: of the name of the class, else of the registration.
        ports: in order.
        complete: whether these are all of its ports.
        unread: ports that its code never names.
        undeclared: reads and writes of ports that it does not provide.
        without: what its code does if it gets no value of an input, as where an entry has none: see `PortUse.without`.
        at_once: whether it is seen to end within the tick that starts it.
        keeps_result: whether it is seen to start only after a reset: until then it has the result that it has.
        nav2_base: the class of nav2_behavior_tree from which its class derives; empty if from none.
    """

    name: str
    category: Category
    class_name: str
    place: SourcePosition
    class_place: SourcePosition
    ports: tuple[CppPort, ...]
    complete: bool = True
    unread: tuple[CppPort, ...] = ()
    undeclared: tuple[PortUse, ...] = ()
    without: tuple[tuple[str, str], ...] = ()
    at_once: bool = False
    keeps_result: bool = False
    nav2_base: str = ""

    def goes_on_without(self, port: CppPort) -> bool:
        """Whether the code is seen to go on if an input is not given."""
        return port.default is None and dict(self.without).get(port.name) == "goes on"


class Unseen(Record):
    """A part of the sources that cannot be read; hides_node: whether it may register a node."""

    message: str
    place: SourcePosition
    hides_node: bool = False


class CppNodes(Record):
    """All nodes of some sources, sorted by name, and what is not seen in them."""

    nodes: tuple[CppNode, ...]
    unseen: tuple[Unseen, ...]
