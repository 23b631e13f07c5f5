import pickle

import pytest

from btq_lang.util.record import Part, Record, fields_of, replace


class Point(Record):
    x: int
    y: int = 0

    @property
    def sum(self) -> int:
        return self.x + self.y


class Only(Record):
    value: object


class Nothing(Record):
    pass


def test_fields_defaults_and_methods() -> None:
    assert (Point(1).x, Point(1).y, Point(1, y=4).sum) == (1, 0, 5)
    with pytest.raises(TypeError):
        Point()  # type: ignore[call-arg]


def test_equality_is_by_type_and_fields() -> None:
    assert Point(1, 2) == Point(1, 2) != Point(2, 1)
    assert Only((1,)) != Point(1)
    assert {Point(1), Point(1, 0), Only(None)} == {Only(None), Point(1)}
    assert Nothing() == Nothing() != Only(())


def test_frozen() -> None:
    with pytest.raises(AttributeError, match="Point is frozen: cannot change 'x'"):
        Point(1).x = 2  # type: ignore[misc]
    with pytest.raises(AttributeError):
        Point(1).z = 2


def test_replace_repr_match_pickle() -> None:
    assert replace(Point(1, 2), y=3) == Point(1, 3)
    assert repr(Point(1, 2)) == "Point(x=1, y=2)"
    assert pickle.loads(pickle.dumps(Point(1, 2))) == Point(1, 2)
    match Point(1, 2):
        case Point(x, 2):
            assert x == 1


def test_a_part_begins_with_its_place() -> None:
    class Word(Part):
        """A word."""

        text: str = ""

    class Gap(Part):
        """Blanks."""

    assert Word(1, 3, "ab") == Word(start=1, end=3, text="ab") != Word(1, 3)
    assert (fields_of(Word(1, 3)), fields_of(Gap(3, 4))) == (("start", "end", "text"), ("start", "end"))
    assert repr(replace(Gap(3, 4), end=5)) == "Gap(start=3, end=5)"
