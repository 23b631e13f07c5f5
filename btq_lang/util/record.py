"""`class Point(Record):` makes an immutable class with slots from its annotations, like a frozen, slotted dataclass.

Why not dataclasses, measured: 200 of their decorators cost 100 ms at each start of `btq check`, and constructing a
frozen one takes 359 ns under mypyc instead of 22.  Here one function is generated, `__init__`, and only when a class
gets its first instance: a run instantiates few of the classes.  Type checkers treat both alike (PEP 681).  Left out:
inheritance, keyword-only fields, default factories, ordering.
"""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:

    def dataclass_transform(**_):
        return lambda made: made


T = TypeVar("T")


class _Frozen:
    """What records do: equal by class and fields; setting or deleting a field raises an AttributeError."""

    __slots__ = ()
    _key: attrgetter[Any]  # the class and the fields, for equality and hash
    _defaults: tuple[object, ...]  # of the last fields

    def __init__(self, *values: object, **named: object) -> None:
        made: Any = type(self)
        scope = {f"set_{field}": made.__dict__[field].__set__ for field in fields_of(self)}
        body = "; ".join(f"set_{field}(self, {field})" for field in fields_of(self)) or "pass"
        exec(f"def __init__({', '.join(('self', *fields_of(self)))}): {body}", scope)
        made.__init__ = scope["__init__"]
        made.__init__.__defaults__ = made._defaults
        made.__init__(self, *values, **named)

    def __eq__(self, other: object) -> bool:
        key = type(self)._key
        return key(self) == key(other) if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(type(self)._key(self))

    def __repr__(self) -> str:
        values = [f"{field}={getattr(self, field)!r}" for field in fields_of(self)]
        return f"{type(self).__name__}({', '.join(values)})"

    def __setattr__(self, name: str, *_: object) -> None:
        raise AttributeError(f"{type(self).__name__} is frozen: cannot change {name!r}")

    __delattr__ = __setattr__

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), tuple([getattr(self, field) for field in fields_of(self)])


@dataclass_transform(frozen_default=True, eq_default=True)
class _RecordType(type):
    """Makes the classes without being their type: with a type other than `type`, `isinstance` takes five times as
    long.
    """

    def __new__(cls, name: str, bases: tuple[type, ...], namespace: dict[str, Any]) -> Any:
        if bases == (_Frozen,):
            return super().__new__(cls, name, bases, namespace)  # Record itself
        fields = tuple(namespace.get("__annotations__", ()))
        defaults = {field: namespace.pop(field) for field in fields if field in namespace}
        if tuple(defaults) != fields[len(fields) - len(defaults) :]:
            raise TypeError(f"{name}: a field without a default follows one with a default")
        made: Any = type(name, (_Frozen,), {**namespace, "__slots__": fields, "__match_args__": fields})
        made._key, made._defaults = attrgetter("__class__", *fields), tuple(defaults.values())
        return made


class Record(_Frozen, metaclass=_RecordType):
    """The base of records, for the statement of a class only: no record is an instance of it."""


def replace(instance: T, **changes: Any) -> T:
    """A copy of a record with some fields changed; an unknown name raises a TypeError."""
    return type(instance)(**{field: getattr(instance, field) for field in fields_of(instance)} | changes)


def fields_of(part: object) -> tuple[str, ...]:
    """The names of the fields, in order, of a record or of another class with `__match_args__`."""
    fields: tuple[str, ...] = type(part).__match_args__  # type: ignore[attr-defined]  # records have it
    return fields
