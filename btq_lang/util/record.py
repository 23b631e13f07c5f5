"""`class Point(Record):` makes an immutable class with slots from its annotations, like a frozen, slotted dataclass.

Why not dataclasses, measured: 200 of their decorators cost 100 ms at each start of `btq check`, and constructing a
frozen one takes 359 ns under mypyc instead of 22.  Here one function is generated, `__init__`, and only when a class
gets its first instance.  Type checkers treat both alike (PEP 681); that fields with defaults come last, they alone see.
"""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeVar

T = TypeVar("T")


class _Frozen:
    """The behavior of records: equal by class and fields; setting or deleting a field raises an AttributeError."""

    __slots__ = ()
    _key: attrgetter[Any]  # the class and the fields, for equality and hash

    def __init__(self, *values: object, **named: object) -> None:
        cls: Any = type(self)
        scope = {f"set_{field}": cls.__dict__[field].__set__ for field in fields_of(self)}
        body = "; ".join(f"set_{field}(self, {field})" for field in fields_of(self)) or "pass"
        exec(f"def __init__({', '.join(('self', *fields_of(self)))}): {body}", scope)
        cls.__init__ = scope["__init__"]
        cls.__init__.__defaults__ = cls._defaults
        cls.__init__(self, *values, **named)

    def __eq__(self, other: object) -> bool:
        return self._key(self) == self._key(other) if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key(self))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{each}={getattr(self, each)!r}' for each in fields_of(self))})"

    def __setattr__(self, name: str, *_: object) -> None:
        raise AttributeError(f"{type(self).__name__} is frozen: cannot change {name!r}")

    __delattr__ = __setattr__

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), tuple([getattr(self, field) for field in fields_of(self)])


class _Maker(type):
    """Makes the classes without being their type: `isinstance` takes five times as long where that is not `type`."""

    def __new__(cls, name: str, bases: tuple[Any, ...], namespace: dict[str, Any]) -> Any:
        fields = (*bases[0]._fields, *namespace.get("__annotations__", ()))
        defaults = {field: namespace.pop(field) for field in fields if field in namespace}
        record: Any = type(name, (_Frozen,), {**namespace, "__slots__": fields, "__match_args__": fields})
        record._key, record._defaults = attrgetter("__class__", *fields), tuple(defaults.values())
        return record


if TYPE_CHECKING:
    from typing_extensions import dataclass_transform

    @dataclass_transform(frozen_default=True, eq_default=True)
    class Record(_Frozen, metaclass=_Maker): ...

    class Part(Record):
        """A record that begins with its place in a text."""

        start: int
        end: int
else:  # only the bases in a class statement: no record is an instance
    Record = type.__new__(_Maker, "Record", (), {"_fields": ()})
    Part = type.__new__(_Maker, "Part", (), {"_fields": ("start", "end")})


def replace(instance: T, **changes: Any) -> T:
    """A copy of a record with some fields changed; an unknown name raises a TypeError."""
    return type(instance)(**as_dict(instance) | changes)


def as_dict(part: object) -> dict[str, Any]:
    """The values of the fields of a record, or of another class with `__match_args__`, in order, by name."""
    return {field: getattr(part, field) for field in fields_of(part)}


def fields_of(part: object) -> tuple[str, ...]:
    """The names of these fields, in order."""
    return type(part).__match_args__  # type: ignore[attr-defined, no-any-return]  # `part` may be of any class
