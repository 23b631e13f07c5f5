"""`class Point(Record):` is a frozen, slotted class from its annotations, as `dataclass(frozen=True, slots=True)` is.

Why not dataclasses: importing them and making our classes with them costs 50 ms at every start of `btq check`, more
than the whole check.  A record is made once, with its slots, where a decorator would make a second class of the first;
and classes of as many fields share the code of one `__init__`.  Type checkers treat both alike (PEP 681).  Deliberately
left out: inheritance, keyword-only fields, default factories, ordering.
"""

from __future__ import annotations

from btq_lang.record_inits import INITS

TYPE_CHECKING = False  # type checkers read it as True; importing `typing` for it takes 5 ms
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any, TypeVar

    from typing_extensions import dataclass_transform

    T = TypeVar("T")


class _Making(type):
    """What Python asks to make a class with `Record` behind its name; what is made is a class like any other, as with
    `typing.NamedTuple`."""

    def __new__(cls, name: str, bases: tuple[type, ...], namespace: dict[str, Any]) -> Any:
        """A class with slots, an `__init__` in field order, equality by type and fields, hash, repr, no setting.

        Raises:
            TypeError: a field without a default follows one with a default.
        """
        fields = namespace["__slots__"] = namespace["__match_args__"] = tuple(namespace.get("__annotations__", ()))
        defaults: tuple[object, ...] = ()
        for field in fields:
            if field in namespace:
                defaults += (namespace.pop(field),)
            elif defaults:
                raise TypeError(f"{name}: a field without a default follows one with a default")
        if defaults:
            namespace["_defaults"] = defaults
        return type(name, (_Record,), namespace)


if TYPE_CHECKING:

    @dataclass_transform(frozen_default=True, eq_default=True)
    class Record(metaclass=_Making):
        """What is written behind the name of a class that is to be a record."""
else:
    Record = type.__new__(_Making, "Record", (), {})


def replace(instance: T, **changes: object) -> T:
    """A copy of a record with some fields changed."""
    values = [changes.pop(name) if name in changes else getattr(instance, name) for name in fields_of(instance)]
    return type(instance)(*values, **changes)  # what is left over is no field: a TypeError


def fields_of(part: object) -> tuple[str, ...]:
    """The names of the fields of a record, or of a class that says them as records do, in order."""
    fields: tuple[str, ...] = type(part).__match_args__  # type: ignore[attr-defined]  # what has none is no record
    return fields


class _Record:
    """What all records do alike; a base, for a class made of fewer names is made faster.

    Attributes:
        _defaults: those of the last fields.
    """

    __slots__ = ()
    _defaults: tuple[object, ...] = ()

    def __init__(self, *values: object, **named: object) -> None:
        """That of the first instance, which makes the one of its class: of most classes a run has no instances."""
        made: Any = type(self)
        made.__init__ = _init(made)
        made.__init__(self, *values, **named)

    @property
    def _values(self) -> tuple[object, ...]:
        """Those of its fields, in order; the first instance that is asked makes what its class does so with."""
        from operator import attrgetter  # most checks compare no records

        made: Any = type(self)
        fields = fields_of(self)
        made._values = property(attrgetter(*fields) if len(fields) > 1 else lambda self: _few(self, fields))
        return self._values

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._values == other._values

    def __hash__(self) -> int:
        return hash((type(self), self._values))

    def __repr__(self) -> str:
        fields: tuple[str, ...] = self.__slots__
        return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)!r}' for name in fields)})"

    def __setattr__(self, name: str, _: object) -> None:
        raise AttributeError(f"{type(self).__name__} is frozen: cannot change {name!r}")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__} is frozen: cannot change {name!r}")

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), self._values


def _init(made: Any) -> Callable[..., None]:
    """`__init__` with the fields as parameters: the code of all classes with as many, given these names.

    It stores through the slots' own descriptors, which the refusing `__setattr__` does not see.
    """
    fields = made.__match_args__
    init: Any = _with_setters(len(fields))(*[made.__dict__[name].__set__ for name in fields])
    init.__code__ = init.__code__.replace(co_varnames=("self", *fields))
    init.__defaults__ = made._defaults
    init.__name__, init.__qualname__ = "__init__", f"{made.__name__}.__init__"
    return init  # type: ignore[no-any-return]  # its parameters are known here alone


def _with_setters(count: int) -> Callable[..., Any]:
    """What makes an `__init__` of so many fields, given their setters in order."""
    if count not in INITS:
        setters = [f"set{number}" for number in range(count)]
        parameters = ", ".join(["self", *(f"value{number}" for number in range(count))])
        body = "; ".join(f"{setter}(self, value{number})" for number, setter in enumerate(setters)) or "pass"
        scope: dict[str, Any] = {}
        exec(f"def outer({', '.join(setters)}):\n def __init__({parameters}): {body}\n return __init__", scope)
        INITS[count] = scope["outer"]
    return INITS[count]


def _few(self: Any, fields: tuple[str, ...]) -> tuple[object, ...]:
    return tuple(getattr(self, name) for name in fields)
