"""missing-include, cyclic-include: what their pages do not show."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, split_files, workspace_of
from kept_checks import Kept

from btq_lang.checks import CHECKS, check
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.projects.opening import open_workspace
from btq_lang.syntax.tree import Tree
from btq_lang.util.text import Span
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace


def test_includes_that_are_found() -> None:
    assert_clean('//- a/main.btq\ninclude "b.btq"\ninclude "../c.btq"\n//- a/b.btq\n//- c.btq\n')
    assert_clean('//- main.btq\ninclude "b.btq"\n//- shared/b.btq\n', Project(include_paths=("shared",)))
    assert_clean('include "nav.xml" (ros_pkg = "nav2")\n')  # the files of a ROS package are unknown here


def test_what_may_be_meant() -> None:
    elsewhere = '//- missions/main.btq\ninclude "skills.btq"\n//- shared/skills.btq\n'
    assert_problems(
        elsewhere, 'missions/main.btq:1:9 error missing-include «"skills.btq"» cannot find the file `skills.btq`'
    )
    assert_fix(elsewhere, "Replace it with `../shared/skills.btq`", elsewhere.replace('"skills', '"../shared/skills'))
    misspelt = '//- main.btq\ninclude "skils.btq"\n//- skills.btq\n'
    assert_fix(misspelt, "Replace it with `skills.btq`", misspelt.replace("skils", "skills"))


def test_three_files_of_its_name_may_be_meant() -> None:
    folders = "".join(f"//- {folder}/skills.btq\n" for folder in "abcd")
    workspace = workspace_of(split_files(f'//- main.btq\ninclude "skills.btq"\n{folders}'))
    (found,) = check(workspace, "main.btq")
    assert [fix.title for fix in found.fixes] == [f"Replace it with `{folder}/skills.btq`" for folder in "abc"]


def test_an_empty_path() -> None:
    assert_problems('include ""\n', '1:9 error missing-include «""» missing file name after `include`')


def test_circles() -> None:
    assert_problems('include "main.btq"\n', '1:9 error cyclic-include «"main.btq"» this file includes itself')
    assert_problems(
        '//- a.btq\ninclude "b.btq"\n//- b.btq\ninclude "c.btq"\n//- c.btq\ninclude "b.btq"\n',
        'b.btq:1:9 error cyclic-include «"c.btq"» this file includes `c.btq`, which includes this file again',
        'c.btq:1:9 error cyclic-include «"b.btq"» this file includes `b.btq`, which includes this file again',
    )


def test_in_a_circle_everything_is_known() -> None:
    assert_problems(
        """
        //- a.btq
        include "b.btq"
        BehaviorTree A
            SubTree B
        //- b.btq
        include "a.btq"
        BehaviorTree B
            X
        """,
        'a.btq:1:9 error cyclic-include «"b.btq"» this file includes `b.btq`, which includes this file again',
        'b.btq:1:9 error cyclic-include «"a.btq"» this file includes `a.btq`, which includes this file again',
    )


def test_a_quality_that_a_missing_file_may_declare_is_not_called_unknown() -> None:
    missing = '1:9 error missing-include «"own.btq"» cannot find the file `own.btq`'
    text = 'include "own.btq"\nBehaviorTree Main\n    Action X satisfices {}\n'
    assert_problems(text.replace("{}", "hygiene"), missing)
    assert_problems(
        text.replace("{}", "relability"),
        missing,
        "3:25 warning unknown-quality «relability» unknown quality `relability`; "
        "did you mean `reliability` or `maintainability.reusability`?",
    )


def test_a_file_that_cannot_be_read_is_told_where_it_is_included() -> None:
    skills = "//- skills.btq\nAction Go\n    input goal string\nAction Dock\n    input \n    input id string\n"
    message = "has 2 errors: expected `:` and the port's type, found `string`"
    workspace = workspace_of(
        split_files(f'//- main.btq\ninclude "more.btq"\n//- more.btq\ninclude "skills.btq"\n{skills}')
    )
    for path, which in (("main.btq", "`skills.btq`, which that file includes,"), ("more.btq", "`skills.btq`")):
        (found,) = check(workspace, path)
        assert (found.rule, found.effective_severity) == ("include-with-errors", Severity.ERROR)
        assert found.message.startswith(f"{which} {message}")
        ((place, told),) = [(related.place, related.message) for related in found.related]
        assert (place.path, place.span.start, told) == ("skills.btq", 25, "first error")


def test_what_a_check_of_the_included_file_finds_is_told_there_alone() -> None:
    text = (
        '//- main.btq\ninclude "other.btq"\n//- other.btq\nBehaviorTree A\n    Repeat (num_cycles = "x")\n        B\n'
    )
    workspace = workspace_of(split_files(text))
    assert check(workspace, "main.btq") == ()
    assert [each.rule for each in check(workspace, "other.btq")] == ["invalid-literal"]


def test_included_xml_that_cannot_be_read() -> None:
    (found,) = _of_xml(nav="<root>\n")
    ((place, told),) = [(related.place, related.message) for related in found.related]
    assert found.rule == "include-with-errors"
    assert (place.path, place.span, told) == ("nav.xml", Span(0, 6), "here")


_TREE = '<root BTCPP_format="4">{include}\n  <BehaviorTree ID="Nav">{node}</BehaviorTree>\n</root>\n'
_GOOD = _TREE.format(include="", node="<AlwaysSuccess/>")


def _of_xml(main: str = "main.btq", **xml: str) -> tuple[Diagnostic, ...]:
    """The diagnostics of a mission that includes `nav.xml`."""
    texts = {f"{name}.xml": text for name, text in xml.items()}
    texts["main.btq"] = 'include "nav.xml"\nRoot Main\nBehaviorTree Main\n    SubTree Nav\n'
    return check(workspace_of(texts), main)


@pytest.mark.parametrize(
    ("text", "at", "message"),
    [
        (
            _TREE.format(include="", node="<Sequence/>"),
            "Sequence",
            "`Sequence` requires 1 or more children, found none",
        ),
        (
            _TREE.format(include="", node='<SubTree ID="Gone"/>'),
            "Gone",
            "unknown tree `Gone`; neither this file nor its includes define it",
        ),
        (
            _TREE.format(include='<include path="gone.xml"/>', node="<A/>"),
            "gone.xml",
            "cannot find the file `gone.xml`",
        ),
        (_GOOD.replace('"Nav"', '"Na v"'), "Na v", "the engine refuses the tree ID `Na v`: it contains a space"),
    ],
)
def test_what_the_engine_would_refuse_in_included_xml_is_told_where_it_is_included(
    text: str, at: str, message: str
) -> None:
    found = next(each for each in _of_xml(nav=text) if each.rule == "include-with-errors")
    assert found.message == f"`nav.xml` has 1 error: {message}"
    assert found.notes == ("`btq build` refuses every file that includes it",)
    ((place, told),) = [(related.place, related.message) for related in found.related]
    assert (place.path, told) == ("nav.xml", "here")
    assert text[place.span.start : place.span.end].strip('"') == at


def test_of_several_errors_in_included_xml_the_first_is_told_and_how_to_see_the_others() -> None:
    (found,) = _of_xml(nav=_TREE.format(include="", node='<Sequence><Fallback/><Delay delay_msec="x"/></Sequence>'))
    assert found.message.startswith("`nav.xml` has 3 errors: `Fallback` requires 1 or more children")
    assert [related.message for related in found.related] == ["first error"]
    assert found.notes == (
        "`btq build` refuses every file that includes it",
        "run `btq check nav.xml` to see all of them",
    )


def test_warnings_in_included_xml_are_told_there_alone() -> None:
    text = _TREE.format(include="", node="<Fallback><AlwaysSuccess/><AlwaysFailure/></Fallback>")
    assert _of_xml(nav=text) == ()
    assert [each.rule for each in _of_xml(main="nav.xml", nav=text)] == ["unreachable-child"]


def test_xml_that_xml_includes_counts() -> None:
    nav = _TREE.format(include='<include path="more.xml"/>', node="<AlwaysSuccess/>")
    more = _TREE.format(include="", node="<Sequence/>").replace("Nav", "More")
    for path, which in (("main.btq", "`more.xml`, which that file includes,"), ("nav.xml", "`more.xml`")):
        (found,) = _of_xml(main=path, nav=nav, more=more)
        assert found.message == f"{which} has 1 error: `Sequence` requires 1 or more children, found none"


def test_xml_that_includes_itself_in_a_circle() -> None:
    nav = _TREE.format(include='<include path="more.xml"/>', node="<AlwaysSuccess/>")
    more = _TREE.format(include='<include path="nav.xml"/>', node="<AlwaysSuccess/>").replace("Nav", "More")
    (found,) = _of_xml(nav=nav, more=more)
    assert found.message == "`nav.xml` has 1 error: this file includes `more.xml`, which includes this file again"


def test_the_trees_of_included_xml_may_run_those_of_the_files_that_include_it() -> None:
    """The engine reads all files before it makes a tree."""
    nav = _TREE.format(include="", node='<SubTree ID="More"/>')
    files = {"main.btq": 'include "nav.xml"\nRoot Main\nBehaviorTree Main\n    SubTree Nav\n', "nav.xml": nav}
    beside = {**files, "main.btq": f'include "more.xml"\n{files["main.btq"]}', "more.xml": _GOOD.replace("Nav", "More")}
    above = {**files, "main.btq": f"{files['main.btq']}BehaviorTree More\n    AlwaysSuccess\n"}
    for complete in (beside, above):
        workspace = workspace_of(complete)
        assert [check(workspace, path) for path in complete] == [()] * len(complete)
    workspace = workspace_of(above)
    without = workspace.with_file("main.btq", files["main.btq"])
    assert [each.rule for each in check(without, "main.btq")] == ["include-with-errors"]


def test_a_circle_through_included_xml_is_told_where_it_is_included() -> None:
    (found,) = _of_xml(nav=_TREE.format(include="", node='<SubTree ID="Main"/>'))
    assert found.rule == "recursive-tree"
    assert found.message == "the tree `Main` contains itself: `Main` → `Nav` → `Main`"


def test_included_xml_is_looked_at_again_when_it_or_what_it_includes_or_the_project_is_another(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[str] = []

    def noting(view: View) -> Iterator[Diagnostic]:
        asked.append(view.path)
        yield from ()

    monkeypatch.setitem(CHECKS, Tree, (*CHECKS[Tree], noting))
    nav = _TREE.format(include='<include path="more.xml"/>', node='<SubTree ID="More"/>')
    good, bad = _GOOD.replace("Nav", "More"), _GOOD.replace("Nav", "Other")
    workspace = workspace_of({"main.btq": 'include "nav.xml"\n', "nav.xml": nav, "more.xml": good})
    kept = Kept()
    assert kept.check(workspace, "main.btq").diagnostics == ()
    assert sorted(asked) == ["more.xml", "nav.xml"]
    edited = workspace.with_file("main.btq", 'include "nav.xml"\n\n')
    assert kept.check(edited, "main.btq").diagnostics == ()
    assert len(asked) == 2
    other = Workspace({**edited.files, "more.xml": workspace_of({"more.xml": bad}).files["more.xml"]}, edited.project)
    assert [each.rule for each in kept.check(other, "main.btq").diagnostics] == ["include-with-errors"]
    ignoring = other.with_project(Project(ignore=("unknown-tree",)))
    assert kept.check(ignoring, "main.btq").diagnostics == ()


def test_an_include_path_that_is_no_folder_is_shown_where_something_is_missing(tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    (tmp_path / "btq.toml").write_text('include-paths = ["shared", "lib"]\n')
    (tmp_path / "main.btq").write_text('include "skills.btq"\n')
    workspace = open_workspace(str(tmp_path))
    (path,) = workspace.files
    (found,) = check(workspace, path)
    assert found.notes == ("searched `.`, `shared`, `lib` (no folder); add folders with `include-paths` in btq.toml",)
