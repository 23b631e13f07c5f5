"""What is packed of files that nobody works in, says what it said (btq_lang/packed.py)."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.file import File
from btq_lang.name_kinds import Kind
from btq_lang.packed import PackedNames, packed_names, packed_text, unpacked_text

TEXT = """include "skills.btq"
BehaviorTree Main
    ->
        Pick (from = shelf)
        SubTree Carry
signal battery
"""
# Any character, and the halves of pairs that JSON may bring; the sign between packed names more often than by chance.
STRINGS = st.text(st.one_of(st.characters(), st.characters(categories=["Cs"]), st.just("\0")))
NAMES = st.frozensets(st.tuples(st.sampled_from(list(Kind)), STRINGS))


@given(STRINGS)
def test_a_text(text: str) -> None:
    assert unpacked_text(packed_text(text)) == text


@given(NAMES, NAMES)
def test_a_set_of_names(names: frozenset[tuple[Kind, str]], others: frozenset[tuple[Kind, str]]) -> None:
    packed = packed_names(names)
    assert (packed, len(packed), sorted(map(repr, packed))) == (names, len(names), sorted(map(repr, names)))
    assert packed_names(packed) is packed
    if isinstance(packed, PackedNames):
        assert {(kind, name) for kind in Kind for name in packed.of(kind)} == names
    assert [name in packed for name in names | others] == [name in names for name in names | others]
    for mixed in (packed & others, others & packed, packed ^ others, others ^ packed, packed | others, packed - others):
        assert type(mixed) is frozenset
    assert (packed & others, others & packed) == (names & others, names & others)
    assert (packed ^ others, others ^ packed) == (names ^ others, names ^ others)
    assert packed ^ packed_names(others) == names ^ others


def test_part_of_a_name_is_none() -> None:
    packed = packed_names(frozenset([(Kind.TREE, "Carry"), (Kind.SIGNAL, "battery")]))
    assert [(Kind.TREE, name) in packed for name in ("Carry", "arry", "Car", "", "battery")] == [True] + 4 * [False]


def test_a_file() -> None:
    file, same = File("main.btq", TEXT), File("main.btq", TEXT)
    assert not file.is_unpacked  # nobody has asked for anything
    same.pack()
    assert file.parsed.entries
    assert file.is_unpacked
    file.pack()
    for packed in (file, same):
        assert not packed.is_unpacked
        assert "text" not in vars(packed)
        assert packed.included_paths == (("skills.btq", False),)
        assert packed.names_of(Kind.TREE) == ("Main",)
        assert packed.defines(Kind.TREE, "Main")
        assert not packed.defines(Kind.TREE, "Carry")
        assert (Kind.TREE, "Carry") in packed.used_names
        assert not packed.is_unpacked
        assert packed.text == TEXT
        assert packed.is_unpacked
        assert packed == File("main.btq", TEXT)
        packed.pack()
        assert not packed.is_unpacked


@pytest.mark.parametrize("text", ["", "signal battery\n"])
def test_a_packed_file_is_edited_as_one_that_is_not(text: str) -> None:
    file = File("main.btq", TEXT)
    file.pack()
    after = file.edited(text)
    assert (after.text, after.parsed.entries) == (text, File("main.btq", text).parsed.entries)
    assert after.names_of(Kind.SIGNAL) == File("main.btq", text).names_of(Kind.SIGNAL)
