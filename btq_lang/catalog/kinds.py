"""What the catalog says of a node kind and of a port: the records and the categories.

One invariant: a record describes BehaviorTree.CPP's newest version; what older ones do otherwise is said beside it
(`since`, `type_before`).  It knows no particular node: those are rows of `engine_nodes`.
"""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

from btq_lang.util.record import Record

# The engine's five categories, as the word in a file and the tag of the explicit XML form have them.
Category: TypeAlias = "Literal['Action', 'Condition', 'Control', 'Decorator', 'SubTree']"
CATEGORIES: Final[tuple[Category, ...]] = ("Action", "Condition", "Control", "Decorator", "SubTree")

# Where a port's value flows, as a model's Port says it.
Direction: TypeAlias = "Literal['input', 'output', 'inout']"

# When a node returns RUNNING.  synchronous: never, it completes within the tick that started it.  asynchronous: by
# itself, if only between two children that complete at once; a Timeout around it can halt it.  as-children: exactly
# when a child of it does.
Execution: TypeAlias = "Literal['synchronous', 'asynchronous', 'as-children']"

# What the text of a port is: a value, a script, or the name of a blackboard entry, written without braces.
Content: TypeAlias = "Literal['value', 'script', 'key']"

# The literals of a port that says what its node returns: with IDLE the engine ends with an error.
RESULT: Final = "BT::NodeStatus except IDLE"


class PortKind(Record):
    """A port of a built-in.

    Attributes:
        type: the C++ type as the engine prints it.
        default: the value of an absent port; None: there is none.
        required: the engine complains where it is absent, at load or when the node is ticked.
        unit: the unit of a number in it, where one is known.
        doc: one line.
        literal: the type that a literal is read as, where that is not `type`.
        type_before: a version and the type that every earlier one prints.
    """

    name: str
    direction: Direction
    type: str
    doc: str
    default: str | None = None
    required: bool = False
    unit: str | None = None
    content: Content = "value"
    literal: str | None = None
    type_before: tuple[str, str] | None = None


class NodeKind(Record):
    """A built-in node of the engine.

    Attributes:
        tag: its XML tag, which is also its name in a file.
        children: how many it takes, at least and at most; None: any number.
        doc: one line.
        semantics: what it does, in a paragraph.
        symbols: its spellings that are no words, the canonical one first.
        aliases: other words for it.
        reactive: at every tick it begins with its first child again, and halts a running one that it does not reach:
            two asynchronous children restart each other.
        late_count: a wrong number of children passes the engine's load and throws when the node is ticked.
        since, until: the first and the last version that has it; None: the newest does.
    """

    tag: str
    category: Category
    children: tuple[int, int | None]
    doc: str
    semantics: str
    ports: tuple[PortKind, ...] = ()
    symbols: tuple[str, ...] = ()
    aliases: tuple[str, ...] = ()
    execution: Execution = "as-children"
    reactive: bool = False
    late_count: bool = False
    since: str = "4.6"
    until: str | None = None

    def port(self, name: str) -> PortKind | None:
        """Its port of that name."""
        for port in self.ports:
            if port.name == name:
                return port
        return None
