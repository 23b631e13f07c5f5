"""Code actions: fixes, silencing, fix-all, and refactorings."""

from __future__ import annotations

from pathlib import Path

import pytest
from feature_asserts import (
    check_action,
    check_actions,
    check_all_actions,
    check_no_action,
    check_preferred,
    check_silences,
)
from rule_pages import blocks

from btq_lang.diagnostics.rules import Severity
from btq_lang.ide.actions import code_actions
from btq_lang.projects.opening import open_workspace
from btq_lang.util.text import Span

FOLDER = Path(__file__).resolve().parents[2] / "examples"
EXAMPLES = sorted(path for path in FOLDER.rglob("*") if path.suffix in (".btq", ".qualitybtcpp"))


def test_fixes_of_diagnostics() -> None:
    check_action(
        "BehaviorTree Main\n    Sequ$0nce\n        Pick\n        Place\n",
        "Replace `Sequnce` with `Sequence`",
        "BehaviorTree Main\n    Sequence\n        Pick\n        Place\n",
    )


def test_silencing() -> None:
    check_action(
        "BehaviorTree Main\n    Sequn$0ce\n        Pick\n",
        "Silence `unknown-node` on this line",
        "BehaviorTree Main\n    Sequnce  # btq: ignore[unknown-node]\n        Pick\n",
    )
    check_no_action("BehaviorTree Main\n    Sequn$0ce  # why\n        Pick\n", "Silence")
    check_no_action("BehaviorTree Main\n    Pick $0)\n", "Silence `syntax-error`")


@pytest.mark.parametrize("text", [text for _, language, text in blocks() if language == "btq"])
def test_silencing_is_offered_where_it_works(text: str) -> None:
    check_silences(text)


@pytest.mark.parametrize("line", ["Pick (a = 3 se$0k)", "Pick W#$02", 'Pick (a = "$0x)', "Pick (a = 1$0"])
def test_no_mistake_in_the_syntax_is_silenced(line: str) -> None:
    check_no_action(f"BehaviorTree Main\n    {line}\n", "Silence")


def test_a_text_that_is_not_closed_takes_no_comment() -> None:
    check_no_action('BehaviorTree Main\n    AlwaysSuccess (_sk"ip = "mo$0de = 3")\n', "Silence")


def test_all_safe_fixes_at_once() -> None:
    check_actions("$0BehaviorTree Main\n    Pick satisfices usability\n", only=("source.fixAll",))
    check_action(
        "$0BehaviorTree Main\n    Pick satisfices speed, energy\n",
        "Apply 2 safe fixes",
        "BehaviorTree Main\n    Pick satisfices performance-efficiency.time-behaviour, "
        "performance-efficiency.resource-utilization\n",
    )


def test_safe_fixes_that_touch_each_other_are_all_applied() -> None:
    check_action(
        '$0QualityReq rq "Soon"\n    takes at most 3 s\nBehaviorTree Main\n    Pick satisfies rq, rq, rq, rq\n',
        "Apply 3 safe fixes",
        'QualityReq rq "Soon"\n    takes at most 3 s\nBehaviorTree Main\n    Pick satisfies rq\n',
    )
    check_action(
        "$0BehaviorTree Main\n    Timeout (msec == 3)\n        Pick satisfices speed, speed\n",
        "Apply 4 safe fixes",
        "BehaviorTree Main\n    Timeout (msec = 3)\n        Pick satisfices performance-efficiency.time-behaviour\n",
    )


def test_only_what_is_asked_for() -> None:
    text = "BehaviorTree Main\n    ->\n        SubTree Do$0ck\nBehaviorTree Dock\n    Pick\n"
    check_actions(text, "Inline the tree `Dock`", only=("refactor.inline",))
    check_actions(text, only=("source",))
    check_actions(text, only=("quickfix",))


@pytest.mark.parametrize(
    ("text", "title"),
    [
        ("BehaviorTree Main\n    Sequ$0nce\n        Pick\n", "Replace `Sequnce` with `Sequence`"),
        ("BehaviorTree Main\n    Timeout (msec = 30$0sek)\n        Pick\n", "Replace `sek` with `s`"),
        (
            "BehaviorTree Main\n    Retry (num_at$0empts = 3)\n        Pick\n",
            "Replace `num_atempts` with `num_attempts`",
        ),
        ("BehaviorTree Main\n    SubTree Do$0k\nBehaviorTree Dock\n    Pick\n", "Replace `Dok` with `Dock`"),
        ("BehaviorTre$0 Main\n    Pick\n", "Replace `BehaviorTre` with `BehaviorTree`"),
        (
            'BehaviorTree Main\n    SubTree "my do$0k"\nBehaviorTree "my dock"\n    Pick\n',
            "Replace `my dok` with `my dock`",
        ),
        (
            'QualityReq rq "Soon"\n    tak$0s at most 30 s\nBehaviorTree Main\n    Pick satisfies rq\n',
            "Replace `taks` with `takes`",
        ),
    ],
)
def test_the_only_near_name_of_a_misspelt_word_is_preferred(text: str, title: str) -> None:
    check_preferred(text, title)


@pytest.mark.parametrize(
    "text",
    [
        "BehaviorTree Main\n    Pick satisfices relib$0ility\n",  # reliability or legibility
        "//- main.btq\nBehaviorTree Main\n    SubTree Do$0ck\n//- dock.btq\nBehaviorTree Dock\n    Pick\n"
        "//- dok.btq\nBehaviorTree Dok\n    Pick\n",  # an include, or another tree
        "BehaviorTree Main\n    Parallel (failure_count = $03)\n        Pick\n",  # what replaces it is not its name
        "Root Main\nBehaviorTree Main\n    Pick\nBehaviorTree Do$0ck\n    Pick\n",  # used some day, or removed
    ],
)
def test_where_there_is_a_choice_nothing_is_preferred(text: str) -> None:
    check_preferred(text)


def test_a_safe_fix_is_preferred() -> None:
    check_preferred(
        "BehaviorTree Main\n    Pick satisfices spe$0ed\n", "Replace it with `performance-efficiency.time-behaviour`"
    )


KINDS = (
    '//- main.btq\ninclude "lib.btq"\ninclude "lib.btq"\nRoot Main\n'
    "BehaviorTree Main\n    ->\n        Sequ$0nce satisfices speed\n"
    "            SubTree Lib\n//- lib.btq\nBehaviorTree Lib\n    Pick\n"
)
FIX_ALL = "Apply 1 safe fix"
ORGANIZE = "Remove 1 duplicate or unused include"


@pytest.mark.parametrize(
    ("only", "titles"),
    [
        (("source.fixAll",), (FIX_ALL,)),
        (("source.fixAll.btq",), (FIX_ALL,)),
        (("source.fixAll.eslint",), ()),
        (("source.fixAl",), ()),
        (("source.organizeImports",), (ORGANIZE,)),
        (("source.organizeImports.btq",), (ORGANIZE,)),
        (("source",), (FIX_ALL, ORGANIZE)),
        (("source.organizeImports", "source.fixAll"), (FIX_ALL, ORGANIZE)),
        (("quickfix",), ("Replace `Sequnce` with `Sequence`", "Silence `unknown-node` on this line")),
        (("quickfix.btq",), ()),
        (("refactor.inline",), ()),
        (("refactor.rewriter",), ()),
        (("notebook",), ()),
    ],
)
def test_a_kind_that_is_asked_for_gives_all_below_it(only: tuple[str, ...], titles: tuple[str, ...]) -> None:
    check_actions(KINDS, *titles, only=only)


def test_the_empty_kind_gives_everything() -> None:
    check_action(KINDS, ORGANIZE, KINDS.replace("$0", "").replace('include "lib.btq"\n', "", 1))
    check_actions(
        "BehaviorTree Main\n    Sequ$0nce\n",
        "Replace `Sequnce` with `Sequence`",
        "Silence `unknown-node` on this line",
        *(f"Wrap in {what}" for what in ("Retry", "Timeout", "Inverter", "ForceSuccess", "a Sequence", "a Fallback")),
        only=("",),
    )


USED = "Root Main\nBehaviorTree Main\n    Pick\n"


@pytest.mark.parametrize(
    ("text", "title", "after"),
    [
        (
            f"signal batt$0ery : % from {{b}}  # of the robot\n\n{USED}",
            "Remove the unused signal `battery`",
            USED,
        ),
        (
            f"# what it measures\nsignal batt$0ery : % from {{b}}\n{USED}",
            "Remove the unused signal `battery`",
            f"# what it measures\n{USED}",
        ),
        (
            f"signal b : % from {{b}}\ncontext low : b < 3 %\ncontext nev$0er : low\n{USED}",
            "Remove the unused context `never`",
            f"signal b : % from {{b}}\ncontext low : b < 3 %\n{USED}",
        ),
        (
            f'{USED}\nQualityReq r$0q "Soon"\n    # soon\n    takes at most 3 s\n    on violation fail\n# end\n',
            "Remove the unused requirement `rq`",
            f"{USED}\n# end\n",
        ),
        (
            f"{USED}\n# docks\nBehaviorTree Do$0ck\n    ->\n        Pick  # first\n    # that is all\n\n# next\n"
            "Action Pick\n",
            "Remove the unused tree `Dock`",
            f"{USED}\n# docks\n\n# next\nAction Pick\n",
        ),
        (
            f'{USED}\n\nBehaviorTree "Do$0ck"\n    Pick',
            "Remove the unused tree `Dock`",
            USED[:-1],
        ),
        (f"{USED}\n\nBehaviorTree Do$0ck\n    Pick\n\n", "Remove the unused tree `Dock`", USED),
        (
            f"{USED}BehaviorTree Dock\n    SubTree Home\nBehaviorTree Ho$0me\n    Pick\n",
            "Remove the unreachable tree `Home`",
            f"{USED}BehaviorTree Dock\n    SubTree Home\n",
        ),
        (
            "Root Main\n    BehaviorTree Dock$0\n        Pick\n\n    BehaviorTree Main\n        Pick\n",
            "Remove the unused tree `Dock`",
            "Root Main\n\n    BehaviorTree Main\n        Pick\n",
        ),
        (
            "/* why */ signal batt$0ery : % from {b}\n" + USED,
            "Remove the unused signal `battery`",
            "/* why */ \n" + USED,
        ),
    ],
)
def test_what_is_unused_is_removed(text: str, title: str, after: str) -> None:
    check_action(text, title, after)


LIBRARIES = (
    "//- dock.btq\nBehaviorTree Dock\n    Pick\n"
    "//- home.btq\nsignal away : m from {away}\n\nBehaviorTree Home\n    Pick\n"
)


def test_includes_that_bring_nothing_are_removed() -> None:
    """The order of the others stays, and so do comments."""
    mission = "\nRoot Main\nBehaviorTree Main\n    SubTree Dock\n"
    check_action(
        f'//- main.btq\n$0# parts\ninclude "home.btq"  # unused\ninclude "dock.btq"\n\ninclude "home.btq"\n\n'
        f'include "dock.btq"\n{mission}{LIBRARIES}',
        "Remove 3 duplicate or unused includes",
        f'//- main.btq\n# parts\n# unused\ninclude "dock.btq"\n{mission}{LIBRARIES}',
    )
    check_action(
        f'//- main.btq\ninclude "ho$0me.btq"\ninclude "dock.btq"\n{mission}{LIBRARIES}',
        "Remove the unused include `home.btq`",
        f'//- main.btq\ninclude "dock.btq"\n{mission}{LIBRARIES}',
    )
    check_action(
        f'//- main.btq\ninclude "dock.btq"\ninclude "do$0ck.btq"\n{mission}{LIBRARIES}',
        "Remove the duplicate include `dock.btq`",
        f'//- main.btq\ninclude "dock.btq"\n{mission}{LIBRARIES}',
    )


def test_an_include_of_the_same_file_in_other_words_is_a_duplicate() -> None:
    check_action(
        '//- main.btq\n$0include "dock.btq"\ninclude "./dock.btq"\nBehaviorTree Main\n    SubTree Dock\n'
        "//- dock.btq\nBehaviorTree Dock\n    Pick\n",
        ORGANIZE,
        '//- main.btq\ninclude "dock.btq"\nBehaviorTree Main\n    SubTree Dock\n'
        "//- dock.btq\nBehaviorTree Dock\n    Pick\n",
    )


@pytest.mark.parametrize(
    ("mission", "library"),
    [
        ("BehaviorTree Main\n    SubTree Dock\n", "BehaviorTree Dock\n    Pick\n"),
        ("Root Dock\nBehaviorTree Main\n    Pick\n", "BehaviorTree Dock\n    Pick\n"),
        ("BehaviorTree Main\n    Pick (at = 3)\n", "Action Pick\n    input at : int\n"),
        ('BehaviorTree Main\n    ScriptAction (name = "Pick")\n', "Action Pick\n    input at : int\n"),
        ("BehaviorTree Main\n    Pick satisfies rq\n", 'QualityReq rq "Soon"\n    takes at most 3 s\n'),
        ("BehaviorTree Main\n    Pick\n", 'QualityReq rq "Soon"\n    takes at most 3 s\n'),  # the overview lists it
        ("BehaviorTree Main\n    Pick satisfices safety.gentleness\n", 'quality gentleness : safety "soft"\n'),
        ("BehaviorTree Main\n    Pick\n", "qualities iso25010-2011\n"),
        (
            'QualityReq rq "Soon"\n    keeps b > 3 %\nBehaviorTree Main\n    Pick satisfies rq\n',
            "signal b : % from {b}\n",
        ),
        (
            'QualityReq rq "Soon"\n    takes at most 3 s\n    while low\nBehaviorTree Main\n    Pick satisfies rq\n',
            "signal b : % from {b}\ncontext low : b < 3 %\n",
        ),
        ('QualityReq rq "Soon"\n    takes at most 3 s\nBehaviorTree Main\n    Pick\n', "apply rq to Pick\n"),
        (
            'QualityReq rq "Soon"\n    every Go takes at most 3 s\nBehaviorTree Main\n    Go\n',
            "BehaviorTree Dock\n    Go\n",
        ),
        ("BehaviorTree Main\n    Pick (\n", "BehaviorTree Dock\n    Pick\n"),  # its user may be what is not readable
        ("BehaviorTree Main\n    Pick\n", "BehaviorTree Dock\n    Pick (\n"),
        ("BehaviorTree A\n    Pick\nBehaviorTree B\n    Pick\n", "BehaviorTree Dock\n    Pick\n"),  # no main tree
        ('include "nowhere.btq"\nBehaviorTree Main\n    Pick\n', "BehaviorTree Dock\n    Pick\n"),
        ('BehaviorTree Main\n    Pick\n//- all.btq\ninclude "main.btq"\n', "BehaviorTree Dock\n    Pick\n"),
    ],
)
def test_includes_that_are_used_or_may_be_stay(mission: str, library: str) -> None:
    text = f'//- main.btq\n$0include "lib.btq"\n{mission}//- lib.btq\n{library}'
    check_actions(text, only=("source.organizeImports",))
    check_no_action(text, "Remove the unused include")


def test_an_include_stays_where_its_repetition_may_count() -> None:
    """The engine runs the last of two trees with one ID that it reads."""
    check_actions(
        '//- main.btq\n$0include "a.btq"\ninclude "b.btq"\ninclude "a.btq"\nBehaviorTree Main\n    SubTree Dock\n'
        "//- a.btq\nBehaviorTree Dock\n    Pick\n//- b.btq\nBehaviorTree Dock\n    Place\n",
        only=("source.organizeImports",),
    )


def test_an_include_with_a_syntax_error_stays() -> None:
    check_actions(
        '//- main.btq\n$0include "lib.btq"\ninclude "lib.btq" again\nBehaviorTree Main\n    SubTree Lib\n'
        "//- lib.btq\nBehaviorTree Lib\n    Pick\n",
        only=("source.organizeImports",),
    )


def test_includes_are_not_sorted() -> None:
    check_actions(
        '//- main.btq\n$0include "b.btq"\ninclude "a.btq"\n'
        "BehaviorTree Main\n    ->\n        SubTree A\n        SubTree B\n"
        "//- a.btq\nBehaviorTree A\n    Pick\n//- b.btq\nBehaviorTree B\n    Pick\n",
        only=("source.organizeImports",),
    )


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_all_includes_of_the_examples_are_needed(example: Path) -> None:
    workspace = open_workspace(str(example.parent))
    assert code_actions(workspace, str(example), Span(0, 0), ("source.organizeImports",)) == ()


def test_extract() -> None:
    check_action(
        """
        Action Look
            output pose : string
        BehaviorTree Main
            ->
                Retry Search$0 (num_attempts = 3)  # often
                    # first look, then go
                    ->
                        Look (pose = {there})
                        Go (to = {there} from = {home} why = "because
        it is there")
                Done
        BehaviorTree Other
            Pick
        """,
        "Extract into the tree `Search`",
        """
        Action Look
            output pose : string
        BehaviorTree Main
            ->
                SubTree Search (there = {=} home = {=})
                Done

        BehaviorTree Search
            inout there
            inout home
            Retry Search (num_attempts = 3)  # often
                # first look, then go
                ->
                    Look (pose = {there})
                    Go (to = {there} from = {home} why = "because
        it is there")
        BehaviorTree Other
            Pick
        """,
    )


def test_extract_of_what_a_script_reads_and_writes() -> None:
    check_action(
        """
        BehaviorTree Main
            ->
                -> Count$0
                    Script (code = "tries += 1; last := now; seen = 1")
                Done
        """,
        "Extract into the tree `Count`",
        """
        BehaviorTree Main
            ->
                SubTree Count (tries = {=} last = {=} now = {=} seen = {=})
                Done

        BehaviorTree Count
            inout tries
            output last
            input now
            output seen
            -> Count
                Script (code = "tries += 1; last := now; seen = 1")
        """,
    )


def test_extract_gives_a_free_name() -> None:
    check_action(
        "BehaviorTree Main\n    ->\n        Pi$0ck\nBehaviorTree Extracted\n    Place\n",
        "Extract into the tree `Extracted2`",
        "BehaviorTree Main\n    ->\n        SubTree Extracted2\n\nBehaviorTree Extracted2\n    Pick\n"
        "BehaviorTree Extracted\n    Place\n",
    )


@pytest.mark.parametrize(("distribution", "name"), [("nav2-humble", "Extracted"), ("nav2-jazzy", "Extracted2")])
def test_extract_gives_a_name_that_is_free_in_the_version_of_the_file(
    tmp_path: Path, distribution: str, name: str
) -> None:
    """A build for version 4 writes `Extracted?` as `Extracted`."""
    text = 'BehaviorTree Main\n    ->\n        Pick\nBehaviorTree "Extracted?"\n    Place\n'
    path, at = str(tmp_path / "main.btq"), text.index("Pick")
    (tmp_path / "btq.toml").write_text(f'nodes = ["{distribution}"]\n')
    (tmp_path / "main.btq").write_text(text)
    actions = code_actions(open_workspace(path), path, Span(at, at), ("refactor.extract",))
    assert [action.title for action in actions] == [f"Extract into the tree `{name}`"]


@pytest.mark.parametrize(
    ("node", "name"),
    [
        ('$0ScriptAction (name = "Drive")', "Extracted"),  # which becomes the node Drive
        ("-> $0Ready?", "Ready"),
        ("-> $0Root", "Root_"),
        ("-> $0Drive", "Drive2"),
        ("-> $0Pick", "Pick2"),
        ("-> $0Look_there", "Look_there2"),
        ("-> $0Home", "Home2"),
        ("-> $0Sequence", "Sequence2"),
        ('-> $0"tags"', "tags2"),
    ],
)
def test_extract_gives_a_name_that_no_check_complains_of(node: str, name: str) -> None:
    """Nor in a file that includes this one, which has nodes, a skill in the classic form and a tree."""
    including = (
        '//- mission.btq\ninclude "main.btq"\nRoot Home\nBehaviorTree Home\n    ->\n        Pick\n'
        '        ScriptAction (name = "Drive")\n        ScriptAction (name = "Look there")\n        SubTree Main\n'
    )
    check_actions(
        f"//- main.btq\nBehaviorTree Main\n    ->\n        {node}\n            Wait\n{including}",
        f"Extract into the tree `{name}`",
        only=("refactor.extract",),
    )


def test_extractions_in_examples() -> None:
    problems = (Severity.ERROR, Severity.WARNING)
    found = {example.name: check_all_actions(example, "Extract", *problems) for example in EXAMPLES}
    named = [title.split("`")[1] for title in found["inspector.qualitybtcpp"]]
    assert named == ["Extracted", "Pumps", *["Extracted"] * 7]


def test_a_time_that_is_enforced_is_not_parted() -> None:
    """A build puts it around the Sequence that begins and ends with its nodes; what is monitored may be parted."""
    extract = ("Extract into the tree `Extracted`",)
    for action, first in (("fail", ()), ("halt", ()), ("log", extract), ("fail\n    verified by test", extract)):
        text = (
            "Root Main\n"
            'QualityReq r "x"\n    from Pick starts to Place succeeds takes at most 9 s\n'
            f"    on violation {action}\n"
            "BehaviorTree Main\n    ->\n        Wait\n        -> All\n"
            "            Pick\n            Move\n            Place\n"
        )
        check_actions(text.replace("  Pick", "  Pi$0ck"), *first, only=("refactor.extract",))
        check_actions(text.replace("  Place", "  Pl$0ace"), *first, only=("refactor.extract",))
        check_actions(
            text.replace("  Move", "  Mo$0ve"), "Extract into the tree `Extracted`", only=("refactor.extract",)
        )
        check_actions(text.replace("-> All", "-> A$0ll"), "Extract into the tree `All`", only=("refactor.extract",))


def test_what_cannot_be_extracted() -> None:
    check_no_action("BehaviorTree Main\n    Pi$0ck\n", "Extract")
    check_no_action("BehaviorTree Main\n    ->\n        SubTree Do$0ck\n", "Extract")
    check_no_action("BehaviorTree Main\n    ->\n        Pick$0 (_autoremap = true a = {b})\n", "Extract")


@pytest.mark.parametrize(
    ("call", "body", "inlined"),
    [
        ("SubTree Do$0ck", "Pick", "Pick"),
        ("SubTree Do$0ck (to = {goal})", "Pick (from = {to})", "Pick (from = {goal})"),
        ("SubTree Do$0ck (to = {=})", "Pick (from = {to})", "Pick (from = {to})"),
        ('SubTree Do$0ck (to = "a b")', "Pick (from = {to})", 'Pick (from = "a b")'),
        ("SubTree Do$0ck (to = {goal})", "Pick (to = {=})", "Pick (to = {goal})"),
        (
            "SubTree Do$0ck (to = {goal})",
            '->\n        Script (code = "to := to + 1")  # up\n        Pick (from = {mine})',
            '->\n            Script (code = "goal := goal + 1")  # up\n            Pick (from = {mine})',
        ),
    ],
)
def test_inline(call: str, body: str, inlined: str) -> None:
    trees = "BehaviorTree Main\n    ->\n        {}\n        Place\nBehaviorTree Dock\n    input to\n    {}\n"
    check_action(trees.format(call, body), "Inline the tree `Dock`", trees.format(inlined, body))


@pytest.mark.parametrize(
    "text",
    [
        "BehaviorTree Main\n    SubTree Do$0ck satisfies rq\nBehaviorTree Dock\n    Pick\n",
        "BehaviorTree Main\n    SubTree Do$0ck (_skipIf = x)\nBehaviorTree Dock\n    Pick\n",
        "BehaviorTree Main\n    SubTree Do$0ck\nBehaviorTree Dock\n    satisfies rq\n    Pick\n",
        "BehaviorTree Main\n    SubTree Do$0ck (to = 3)\nBehaviorTree Dock\n    Script (code = 'a := to')\n",
        "BehaviorTree A\n    ->\n        B (c = {d})\n        SubTree Do$0ck\nBehaviorTree Dock\n    Pick (e = {d})\n",
        "BehaviorTree Main\n    SubTree Nowh$0ere\n",
        "BehaviorTree Main\n    SubTree Ma$0in\n",
    ],
)
def test_what_cannot_be_put_in(text: str) -> None:
    check_no_action(text, "Inline")


def test_wrap_and_unwrap() -> None:
    bare = "BehaviorTree Main\n    ->\n        {}Pick (\n            a = 1\n        )\n        Place\n"
    wrapped = (
        "BehaviorTree Main\n    ->\n        {}Retry (num_attempts = 3)\n            Pick (\n                a = 1\n"
        "            )\n        Place\n"
    )
    check_action(bare.format("$0"), "Wrap in Retry", wrapped.format(""))
    check_action(wrapped.format("$0"), "Unwrap: remove `Retry`", bare.format(""))


def test_what_is_not_unwrapped() -> None:
    check_no_action("BehaviorTree Main\n    $0->\n        Pick\n        Place\n", "Unwrap")
    check_no_action("BehaviorTree Main\n    $0Inverter satisfies rq\n        Pick\n", "Unwrap")
    check_no_action("BehaviorTree Main\n    $0Inverter  # why\n        Pick\n", "Unwrap")
    check_no_action("BehaviorTree Main\n    /* why */ $0Inverter\n        Pick\n", "Unwrap")
    check_no_action("BehaviorTree Main\n    $0Inverter\n        /* x */ Pick\n", "Unwrap")
    check_no_action("BehaviorTree Main\n    $0Inverter\n        /* why */Pick\n", "Unwrap")


def test_a_node_after_a_comment_is_not_wrapped() -> None:
    check_no_action("BehaviorTree Main\n    /* why */ $0Pick\n", "Wrap")
    check_no_action("BehaviorTree Main\n    /* why\n    */ $0Pick\n", "Wrap")


def test_lift_a_requirement() -> None:
    check_action(
        """
        BehaviorTree Main
            Pick
                satisfies QualityReq r$0q1 : safety "Slow"
                    takes at most 30 s
                    on violation fail
        """,
        "Move `rq1` to the top level of the file",
        """
        QualityReq rq1 : safety "Slow"
            takes at most 30 s
            on violation fail

        BehaviorTree Main
            Pick
                satisfies rq1
        """,
    )


def test_lift_a_classic_requirement() -> None:
    check_action(
        """
        BehaviorTree ID = Main
            Pick (
            satisfices Quality = performance
            (QualityReq ID = "rq1"
            description = "It shall take$0
                           at most 30 sec")
            )
        """,
        "Move `rq1` to the top level of the file",
        """
        QualityReq rq1 : performance "It shall take at most 30 sec"

        BehaviorTree ID = Main
            Pick (
            satisfices Quality = performance
            satisfies rq1
            )
        """,
    )


@pytest.mark.parametrize(("item", "step"), [("    ", "    "), ("\t", "\t"), ("", "\t")])
def test_lift_to_where_the_tree_stands(item: str, step: str) -> None:
    """In a Root block all items are indented; the clauses are so in the characters of the file."""
    node = item + step + step
    tree = f"{item}BehaviorTree Main\n{item}{step}->\n{node}Wave satisfies {{}}\n{node}SubTree Other\n"
    after = f"{item}BehaviorTree Other\n{item}{step}Wave\n"
    check_action(
        "Root Main\n" + tree.format('QualityReq r$0 : safety "x" takes at most 3 s') + after,
        "Move `r` to the top level of the file",
        f'Root Main\n{item}QualityReq r : safety "x"\n{item}{step}takes at most 3 s\n\n{tree.format("r")}{after}',
    )


def test_lifts_in_examples() -> None:
    lifted = [title for example in EXAMPLES for title in check_all_actions(example, "Move `rq", Severity.ERROR)]
    assert lifted == [f"Move `rq{number}` to the top level of the file" for number in (1, 2, 3)]


def test_what_is_not_lifted() -> None:
    """A quality that encloses one of two definitions: as an item it would say more than the other one."""
    wave = 'Wave (satisfices Quality = safety (QualityReq ID = "{}" description = "d"))'
    check_no_action(f"BehaviorTree Main\n    ->\n        {wave.format('r$0')}\n        {wave.format('r')}\n", "Lift")


def test_the_short_form_of_a_node() -> None:
    check_action(
        'BehaviorTree ID = Main\n    -> $0(name = "BatteryCheck")\n        SubTree (ID = Dock, to = x)\n',
        "Write the node in the short form",
        "BehaviorTree ID = Main\n    -> BatteryCheck\n        SubTree (ID = Dock, to = x)\n",
    )


@pytest.mark.parametrize("word", ["Script", "ScriptAction"])
def test_the_short_form_of_a_placeholder(word: str) -> None:
    text = f'BehaviorTree Main\n    $0{word} (name = "Move")\n'
    check_action(text, "Write the node in the short form", "BehaviorTree Main\n    Move\n")


def test_the_short_form_of_a_file() -> None:
    check_action(
        """
        BehaviorTree ID = Main
            -> $0(name = "BatteryCheck")
                SubTree (ID = Dock, to = x)
                ScriptAction (name = "MoveBase" satisfices Quality = performance)
                Pick (name = "two words" a = 1)
        """,
        "Write the file in the short form",
        """
        BehaviorTree Main
            -> BatteryCheck
                SubTree Dock (to = x)
                MoveBase (satisfices performance)
                Pick "two words" (a = 1)
        """,
    )


def test_what_is_short_already() -> None:
    check_no_action("BehaviorTree Main\n    $0-> First\n        SubTree Dock (to = x)\n", "Write the")
