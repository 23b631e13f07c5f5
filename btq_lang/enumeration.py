"""`class Kind(Enum):` is an enumeration as `enum` makes them.

Why not `enum`: importing it and making our enumerations with it takes a twentieth of a small check.  Type checkers
take it for the standard library's.  Deliberately left out: aliases, flags, `auto`, members that are numbers or texts.
"""

from __future__ import annotations

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from enum import Enum as Enum
else:

    class _Enumeration(type):
        """An enumeration, which is asked for its members: in order by `iter`, by value as it is called."""

        def __new__(cls, name, bases, namespace):
            values = {each: value for each, value in namespace.items() if bases and not each.startswith("_")}
            made = super().__new__(cls, name, bases, {**namespace, "_members": {}})
            for each, value in values.items():
                member = object.__new__(made)
                member.name, member.value = each, value
                made._members[value] = member
                type.__setattr__(made, each, member)
            return made

        def __iter__(cls):
            return iter(cls._members.values())

        def __len__(cls):
            return len(cls._members)

        def __call__(cls, value):
            if value not in cls._members:
                raise ValueError(f"{value!r} is not a valid {cls.__name__}")
            return cls._members[value]

    class Enum(metaclass=_Enumeration):
        def __repr__(self):
            return f"<{self}: {self.value!r}>"

        def __str__(self):
            return f"{type(self).__name__}.{self.name}"

        def __reduce__(self):
            return type(self), (self.value,)
