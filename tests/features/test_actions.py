"""Code actions: fixes, silencing, fix-all, and refactorings."""

from __future__ import annotations

from pathlib import Path

import pytest
from feature_asserts import check_action, check_actions, check_all_actions, check_no_action, check_silences
from test_rules import blocks

from btq_lang.rules import Severity

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


def test_only_what_is_asked_for() -> None:
    text = "BehaviorTree Main\n    ->\n        SubTree Do$0ck\nBehaviorTree Dock\n    Pick\n"
    check_actions(text, "Inline the tree `Dock`", only=("refactor.inline",))
    check_actions(text, only=("source",))
    check_actions(text, only=("quickfix",))


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
    for action, first in (("fail", ()), ("halt", ()), ("log", ("Extract into the tree `Extracted`",))):
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
