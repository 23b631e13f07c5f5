"""The workspace: scopes, definitions, references, main trees, and edits that share what did not change."""

from __future__ import annotations

import pytest

from btq_lang.catalog.name_kinds import Kind
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace

FILES = {
    "/p/requirements.btq": 'QualityReq fast : time-behaviour "In time"\n    takes at most 30 s\nsignal battery : %\n',
    "/p/skills.btq": "Action MoveBase\n    input station : string\nquality gentleness : safety\n",
    "/p/main.btq": (
        'include "requirements.btq"\ninclude "lib/skills.btq"\n'
        "BehaviorTree Main\n    ->\n        MoveBase satisfies fast\n        SubTree Pick\n"
        "BehaviorTree Pick\n    MoveBase (station = x)\n        satisfices gentleness\n"
    ),
}


def workspace(**project: object) -> Workspace:
    files = {path.replace("/p/skills", "/p/lib/skills"): text for path, text in FILES.items()}
    return Workspace.of(files, Project(**project))  # type: ignore[arg-type]


def found(workspace: Workspace, path: str, kind: Kind, name: str) -> str | None:
    definition = workspace.scope(path).find(kind, name)
    if definition is None:
        return None
    text = workspace.files[definition.path].text
    return f"{definition.path}:{text[definition.span.start : definition.span.end]}"


def test_a_name_is_found_in_the_file_and_in_what_it_includes() -> None:
    files = workspace()
    assert files.scope("/p/main.btq").paths == ("/p/requirements.btq", "/p/lib/skills.btq", "/p/main.btq")
    assert found(files, "/p/main.btq", Kind.REQUIREMENT, "fast") == "/p/requirements.btq:fast"
    assert found(files, "/p/main.btq", Kind.MODEL, "MoveBase") == "/p/lib/skills.btq:MoveBase"
    assert found(files, "/p/main.btq", Kind.QUALITY, "gentleness") == "/p/lib/skills.btq:gentleness"
    assert found(files, "/p/main.btq", Kind.SIGNAL, "battery") == "/p/requirements.btq:battery"
    assert found(files, "/p/lib/skills.btq", Kind.REQUIREMENT, "fast") is None
    assert [definition.path for definition in files.defined_anywhere(Kind.REQUIREMENT, "fast")] == [
        "/p/requirements.btq"
    ]


def test_an_include_is_looked_for_beside_the_file_and_then_in_the_include_paths() -> None:
    files = Workspace.of({"/p/a/x.btq": 'include "y.btq"', "/p/shared/y.btq": "", "/p/z.btq": ""})
    assert files.included("/p/a/x.btq", "y.btq") is None
    assert files.included("/p/a/x.btq", "../z.btq") == "/p/z.btq"
    found = files.with_project(Project(include_paths=("/p/shared",)))
    assert found.included("/p/a/x.btq", "y.btq") == "/p/shared/y.btq"
    assert found.included_files == {"/p/shared/y.btq"}


def test_includes_in_a_circle_end() -> None:
    files = Workspace.of({"/a": 'include "b"', "/b": 'include "c"', "/c": 'include "a"'})
    assert files.closure("/a") == ("/c", "/b", "/a")
    assert files.closure("/b") == ("/a", "/c", "/b")


def test_uses_are_in_the_order_of_the_text() -> None:
    file = workspace().files["/p/main.btq"]
    models = [use.span.shifted(entry.start) for entry, use in file.uses if use.name == "MoveBase"]
    assert [span.start for span in models] == [
        file.text.index("MoveBase satisfies"),
        file.text.index("MoveBase (station"),
    ]


def test_repeated_classic_requirements_are_one_and_the_first_place_defines() -> None:
    text = (
        "BehaviorTree T\n    ->\n"
        '        A (satisfies QualityReq ID = "rq" description = "a  b")\n'
        '        B (satisfies QualityReq ID = "rq" description = "a b")\n'
        "        C satisfies rq\n"
        '        D (satisfies QualityReq ID = "rq")\n'
    )
    files = Workspace.of({"/f": text})
    first, second = files.scope("/f").all(Kind.REQUIREMENT, "rq")
    assert first.span.start == text.index('"rq"')
    assert [entry.start + use.span.start for entry, use in files.files["/f"].uses if use.name == "rq"] == [
        text.index("rq\n"),
        text.index('"rq")\n', text.index("D (")),
    ]
    assert second.span.start == text.index('"rq"', first.span.end)


@pytest.mark.parametrize(
    ("text", "main"),
    [
        ("BehaviorTree A\n    X\n", "A"),
        ("BehaviorTree A\n    SubTree B\nBehaviorTree B\n    X\n", "A"),
        ("BehaviorTree B\n    X\nBehaviorTree A\n    SubTree B\n", "A"),
        ("Root B\nBehaviorTree A\n    SubTree B\nBehaviorTree B\n    X\n", "B"),
        ("Root (main_tree_to_execute = B)\nBehaviorTree A\n    X\nBehaviorTree B\n    X\n", "B"),
        ("Root C\nBehaviorTree A\n    X\n", None),
        ("BehaviorTree A\n    X\nBehaviorTree B\n    X\n", None),
        ("BehaviorTree A\n    SubTree A\nBehaviorTree B\n    SubTree A\n", "B"),
        ("", None),
    ],
)
def test_the_main_tree(text: str, main: str | None) -> None:
    definition = Workspace.of({"/f": text}).main_tree("/f")
    assert (definition.symbol.name if definition else None) == main


def test_an_edit_of_one_file_parses_one_file() -> None:
    before = workspace()
    parsed = {path: file.parsed for path, file in before.files.items()}
    after = before.with_file("/p/requirements.btq", "QualityReq slow\n")
    assert {path for path in parsed if after.files[path].parsed is parsed[path]} == {
        "/p/main.btq",
        "/p/lib/skills.btq",
    }
    assert found(after, "/p/main.btq", Kind.REQUIREMENT, "fast") is None
    assert found(before, "/p/main.btq", Kind.REQUIREMENT, "fast") == "/p/requirements.btq:fast"
    assert after.with_file("/p/requirements.btq", FILES["/p/requirements.btq"]) == before
    without = Workspace({path: file for path, file in before.files.items() if path != "/p/main.btq"}, before.project)
    assert without.with_file("/p/main.btq", FILES["/p/main.btq"]) == before


def test_who_says_a_name_is_looked_for_no_further_than_asked() -> None:
    file = Workspace.of({"main.btq": "BehaviorTree A\n    Dock\n\nBehaviorTree B\n    Dock\n"}).files["main.btq"]
    entry, mention = next(file.mentioned("Dock"))
    assert (entry.start, mention.name) == (0, "Dock")
    assert ["mentions" in facts.__dict__ for facts in file.facts.values()] == [True, False]


@pytest.mark.parametrize(
    "text", ["# a\rx\n\nBehaviorTree A\n    X\n", "QualityReq a  QualityReq b\r\n\r\nRoot A\r\n  Root B"]
)
def test_where_items_begin_is_known_after_any_edit(text: str) -> None:
    before = File("a.btq", text)
    assert len(before.item_places) == len(before.parsed.entries)
    for start in range(len(text)):
        for gone, come in ((0, " "), (1, ""), (1, "\n"), (1, "x"), (0, "\r"), (2, ""), (0, "\nRoot C\n")):
            edited = f"{text[:start]}{come}{text[start + gone :]}"
            after, new = before.edited(edited), File("a.btq", edited)
            for one, other in zip(after.parsed.entries, new.parsed.entries, strict=True):
                assert after.item_places[id(one.item)] == new.item_places[id(other.item)], (start, gone, come)


def test_a_file_whose_tree_is_let_go_keeps_text_and_names() -> None:
    text = FILES["/p/main.btq"]
    file, never_parsed = File("/p/main.btq", text), File("/p/main.btq", text)
    assert file.parsed.entries
    for each in (file, never_parsed):
        each.let_go()
        assert (each.is_parsed, each.text) == (False, text)
        assert each.included_paths == (("requirements.btq", False), ("lib/skills.btq", False))
        assert sorted(each.names_of(Kind.TREE)) == ["Main", "Pick"]
        assert [each.defines(Kind.TREE, name) for name in ("Pick", "Pic")] == [True, False]
        assert {(Kind.MODEL, "MoveBase"), (Kind.REQUIREMENT, "fast"), (Kind.QUALITY, "gentleness")} <= each.used_names
        assert not each.is_parsed
        assert each == File("/p/main.btq", text)


@pytest.mark.parametrize("text", ["", "signal battery\n"])
def test_a_file_whose_tree_is_let_go_is_edited_as_any_other(text: str) -> None:
    file = File("main.btq", FILES["/p/main.btq"])
    file.let_go()
    after, new = file.edited(text), File("main.btq", text)
    assert (after.text, after.parsed.entries, after.names_of(Kind.SIGNAL)) == (
        text,
        new.parsed.entries,
        new.names_of(Kind.SIGNAL),
    )
