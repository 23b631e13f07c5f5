"""A check reports of `on violation` what a build does: each clause that is not enforced, and no other."""

from __future__ import annotations

from pathlib import Path

import pytest
from check_asserts import findings, problems
from hypothesis import given
from mission_strategies import missions

from btq_lang.btcpp.enforcement import clause_enforcements
from btq_lang.checks import check
from btq_lang.requirements.resolve import requirements
from btq_lang.workspace.workspace import Workspace

RULE = "not-enforced"
GOLDEN = sorted((Path(__file__).parents[1] / "btcpp" / "golden").glob("*.btq"))
# Other rules that report why the engine does not enforce a claim.
OTHERWISE = ("limit-on-synchronous-node", "limit-too-small", "uses-of-gauge")


def told(clauses: str, signals: str = "", tree: str = "->\n    Action A\n    Condition C") -> list[str]:
    lines = "".join(f"    {line}\n" for line in tree.split("\n"))
    claims = "".join(f"    {clause}\n" for clause in clauses.split("|"))
    found = findings(f"QualityReq q\n{claims}{signals}Root Main\nBehaviorTree Main\n{lines}", RULE)
    return [each.partition("» ")[2] for each in found]


@pytest.mark.parametrize(
    ("clauses", "why"),
    [
        ("A takes at least 5 s", "the engine can stop a node, but cannot make it do more"),
        ("A runs at least 1 per 5 s", "BehaviorTree.CPP has no node that makes another one start in time"),
        ("A keeps p95(n) <= 3", "a script cannot read the samples of `p95(n)`"),
        ("A keeps n <= 3 or node C", "a script cannot check whether a node runs"),
        ("A keeps bare <= 3", "`bare` has no blackboard entry"),
        (
            "A takes at most 5 s|while n > 3",
            "whether `while n > 3` holds during a whole activation is known only at its end",
        ),
        ("A follows C halts", "the engine runs no script at this event"),
        ("A takes at most 5 s|in at least 98 % of runs", "a probability is evaluated in the logs of many runs"),
        ("A takes at most 5 s|verified by test", "verified by test"),
        ("C takes at most 5 s|verified by review", "verified by review"),  # no limit-on-synchronous-node
        ("A takes at most 0.5 ms|over last 5 runs", "a window is evaluated in the logs of many runs"),
        (
            "from A fails to C succeeds takes at most 5 s",
            "it limits the time between nodes, and no node encloses that time",
        ),
        ("sum of A, C takes at most 5 s", "it limits the time between nodes, and no node encloses that time"),
        (
            "from mission starts to C succeeds takes at most 5 s",
            "it limits the time between nodes, and no node encloses that time",
        ),
    ],
)
def test_why_a_claim_is_not_enforced(clauses: str, why: str) -> None:
    signals = "signal n : 1 from {n} initially 0\nsignal bare : 1 initially 0\n"
    for action in ("halt", "fail"):
        assert told(f"{clauses}|on violation {action}", signals) == [
            f"the engine cannot enforce `on violation {action}`: {why}"
        ]
    assert told(clauses, signals) == []
    assert told(f"{clauses}|on violation warn", signals) == []


@pytest.mark.parametrize(
    "clauses",
    [
        "A takes at most 5 s",
        "A takes between 1 s and 5 s",
        "A keeps n <= 3",
        "A keeps n <= 3|while n > 2",
        "A needs n <= 3|when n > 2",
        "A tries at most 3 per Main",
        "C follows A succeeds",
        "from A starts to C succeeds takes at most 5 s",
        "mission takes at most 5 s",
        "C takes at most 5 s",  # limit-on-synchronous-node
        "A takes at most 0 s",  # limit-too-small
        "A uses at most 3 of n",  # uses-of-gauge
    ],
)
def test_what_is_enforced_or_told_otherwise(clauses: str) -> None:
    signals = "signal n : 1 from {n} gauge initially 0\n"
    assert told(f"{clauses}|on violation halt", signals) == []


def test_what_to_do_about_a_claim_that_is_not_enforced() -> None:
    text = "QualityReq q\n    A takes at least 5 s\n    on violation halt\nBehaviorTree Main\n    Action A\n"
    (found,) = problems(text, RULE)
    assert found.notes == (
        "nothing stops the robot, and `btq verify` can only check it in the logs afterwards; "
        "remove `on violation`, or write `on violation warn`",
    )


def test_a_classic_constraint_is_hard_without_being_asked() -> None:
    text = 'Root Main\nBehaviorTree Main\n    Action A (satisfies QualityReq ID = "q" description = "SuccessIf {}")\n'
    assert findings(text.format("takes at most 5 s"), RULE) == []
    assert [each.partition("» ")[2] for each in findings(text.format("takes at least 5 s"), RULE)] == [
        "the engine cannot enforce this: the engine can stop a node, but cannot make it do more"
    ]


def test_nodes_that_nothing_can_stand_around() -> None:
    tree = '->\n    Action A (_skipIf = "@x" _onSuccess = "@y := 1")\n    Condition C'
    assert told("A takes at most 5 s|on violation fail", tree=tree) == [
        "the engine cannot enforce `on violation fail`: `A` may be skipped and has `_onSuccess`, so with a "
        "guard around it the tree would behave differently"
    ]
    # To halt the mission, its root gets a wrapper.
    tree = "RunOnce\n    ->\n        Action A\n        Condition C"
    assert told("A takes at most 5 s|on violation fail", tree=tree) == []
    assert told("A takes at most 5 s|on violation halt", tree=tree) == [
        "the engine cannot enforce `on violation halt`: a node below `RunOnce` may skip it, and with a guard around it "
        "the tree would behave differently"
    ]


def test_where_nobody_knows_the_mission_that_is_told() -> None:
    text = "QualityReq q\n    A takes at most 5 s\n    on violation halt\n"
    text += "BehaviorTree T\n    Action A\nBehaviorTree U\n    Action B\n"
    assert findings(text, RULE) == []
    assert len(findings(text, "unknown-main-tree")) == 1


def files(rules: str, main: str, skills: str = "") -> dict[str, str]:
    skills += "BehaviorTree Home\n    Action A{}\n".format(" satisfies q" if "# here" in main else "")
    include = 'include "rules.btq"\n'
    return {
        "main.btq": f'{include}include "skills.btq"\nRoot Main\n{main}BehaviorTree Main\n    SubTree Home\n',
        "rules.btq": f"QualityReq q\n    {rules}\n    on violation halt\n",
        "skills.btq": f"{include}{skills}",
    }


@pytest.mark.parametrize("main", ["apply q to A\n", "apply q to every A\n", "# here\n", "# here\napply q to every A\n"])
def test_nodes_of_included_files(main: str) -> None:
    workspace = Workspace.of(files("takes at most 5 s", main))
    found = {path: [each for each in check(workspace, path) if each.rule == RULE] for path in workspace.files}
    is_here = "# here" in main
    what = "the engine cannot enforce `on violation halt`"
    why = f"{what}: `A` is in an included file, which other missions may include; "
    assert [each.message for each in found.pop("main.btq")] == ([] if is_here else [f"{why}--bundle enforces it"])
    assert list(found.values()) == [[], []]
    ways = [each.way for clauses in clause_enforcements(workspace, "main.btq") for each in clauses]
    assert ways == ["enforced" if is_here else "monitored"]


def test_a_node_of_this_file_that_another_one_attaches_it_to() -> None:
    texts = files("takes at least 5 s", "") | {
        "skills.btq": 'include "rules.btq"\napply q to every B\nAction B\n',
        "main.btq": 'include "rules.btq"\ninclude "skills.btq"\nRoot Main\nBehaviorTree Main\n    B\n',
    }
    main = texts.pop("main.btq")
    others = {path.removesuffix(".btq"): text for path, text in texts.items()}
    found = findings(main, RULE, project=None, **others)
    why = "the engine can stop a node, but cannot make it do more"
    assert found == [f"5 warning «B» the engine cannot enforce `on violation halt`: {why}"]


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_a_check_says_what_a_build_does(path: Path) -> None:
    texts = {each.name: each.read_text(encoding="utf-8") for each in GOLDEN}
    assert_same(Workspace.of(texts), path.name)


@given(missions())
def test_a_check_says_what_a_build_does_with_any_mission(text: str) -> None:
    assert_same(Workspace.of({"main.btq": text}), "main.btq")


def assert_same(workspace: Workspace, path: str) -> None:
    """Each clause that a bundle should enforce and does not is reported, and no other."""
    found = check(workspace, path)
    reasons = {each.message.partition(": ")[2] for each in found if each.rule == RULE and each.severity is None}
    known = requirements(workspace, path)
    missing = {
        each.why
        for applied, clauses in zip(known.applied, clause_enforcements(workspace, path, bundled=True), strict=True)
        for each in clauses
        if each.asked and each.way != "enforced" and (each.place.path == path or applied.place.path == path)
    }
    unsaid = {each for each in missing - reasons if "the main tree is unknown" not in each}
    assert not unsaid or any(each.rule in OTHERWISE for each in found)
    assert reasons <= missing | {"verified by review", "verified by test", "verified by analysis"}


def test_what_people_verify_leads_to_monitor() -> None:
    text = "QualityReq q\n    A takes at most 5 s on violation fail verified by {}\nBehaviorTree Main\n    Action A\n"
    (found,) = problems(text.format('test "TC-2", review'), RULE)
    instead = 'verified by monitor, test "TC-2", review'
    assert found.notes == (
        f"neither the engine nor `btq verify` checks it; to have both check it, too, write `{instead}`",
    )
    assert problems(text.format(instead.removeprefix("verified by ")), RULE) == []
