"""`@record`: a frozen, slotted class from its annotations, as `dataclass(frozen=True, slots=True)` makes it.

Why not dataclasses: importing them and making our classes with them costs 50 ms at every start of `btq check`, more
than the whole check; this costs 3 ms, for `__init__` is written only when a class is first used.  Type checkers treat
both alike (PEP 681).  Deliberately left out: inheritance of fields, keyword-only fields, default factories, ordering.
"""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:

    def dataclass_transform(**_: object) -> Any:
        return lambda function: function


T = TypeVar("T")


@dataclass_transform(frozen_default=True, eq_default=True)
def record(cls: type[T]) -> type[T]:
    """Make a class a record: slots, an `__init__` in field order, equality by type and fields, hash, repr, no setting.

    Raises:
        TypeError: a field without a default follows one with a default.
    """
    fields = tuple(cls.__annotations__) if "__annotations__" in dir(cls) else ()
    namespace = {name: value for name, value in cls.__dict__.items() if name not in ("__dict__", "__weakref__")}
    defaults = {name: namespace.pop(name) for name in fields if name in namespace}
    if tuple(defaults) != fields[len(fields) - len(defaults) :]:
        raise TypeError(f"{cls.__name__}: a field without a default follows one with a default")
    namespace |= {
        "__slots__": fields,
        "__match_args__": fields,
        "__eq__": _equal,
        "__hash__": _hash,
        "__repr__": _repr,
        "__setattr__": _refuse,
        "__delattr__": _refuse,
        "__reduce__": _reduce,
        "_values": property(attrgetter(*fields) if len(fields) > 1 else lambda self: _few(self, fields)),
    }
    made: Any = type(cls.__name__, cls.__bases__, namespace)

    def write_init(self: Any, *args: object, **kwargs: object) -> None:
        made.__init__ = _make_init(made, fields, defaults)
        made.__init__(self, *args, **kwargs)

    made.__init__ = write_init
    return made  # type: ignore[no-any-return]  # made anew with slots, so only its name ties it to T


def replace(instance: T, **changes: object) -> T:
    """A copy of a record with some fields changed."""
    fields: tuple[str, ...] = type(instance).__slots__  # type: ignore[attr-defined]  # every record has them
    values = dict(zip(fields, instance._values, strict=True)) | changes  # type: ignore[attr-defined]  # as above
    return type(instance)(**values)


def _make_init(made: type, fields: tuple[str, ...], defaults: dict[str, object]) -> Any:
    """Write `__init__`; it stores through the slots' own descriptors, which the refusing `__setattr__` does not see."""
    scope: dict[str, Any] = {f"_default_{name}": value for name, value in defaults.items()}
    scope |= {f"_set_{name}": made.__dict__[name].__set__ for name in fields}
    parameters = [f"{name}=_default_{name}" if name in defaults else name for name in fields]
    body = "\n".join(f" _set_{name}(self, {name})" for name in fields) or " pass"
    exec(f"def __init__({', '.join(['self', *parameters])}):\n{body}", scope)
    return scope["__init__"]


def _few(self: Any, fields: tuple[str, ...]) -> tuple[object, ...]:
    return tuple(getattr(self, name) for name in fields)


def _equal(self: Any, other: Any) -> Any:
    if type(other) is not type(self):
        return NotImplemented
    return self._values == other._values


def _hash(self: Any) -> int:
    return hash((type(self), self._values))


def _repr(self: Any) -> str:
    return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)!r}' for name in self.__slots__)})"


def _refuse(self: Any, name: str, *_: object) -> None:
    raise AttributeError(f"{type(self).__name__} is frozen: cannot change {name!r}")


def _reduce(self: Any) -> tuple[object, ...]:
    return type(self), self._values
