"""What `btq explore` answers."""

from __future__ import annotations

import pytest
from exploring import Exploring

FETCH = """
<Sequence>
  <DetectCup cup="{cup}"/>
  <Grasp cup="{cup}"/>
  <ForceSuccess><PutDown/></ForceSuccess>
</Sequence>"""
MISSION = """
Condition Ready
Action DetectCup
    output cup : int
Action Grasp
    input cup : int
Action Wait

BehaviorTree Fetch
    R->
        Ready
        ->
            ?
                DetectCup (cup = {cup})
                Wait
            ScriptCondition (code = "cup > 3")
            Grasp (cup = {cup})
"""


def test_an_order_of_events_with_its_witness(explore: Exploring) -> None:
    explore.tree(FETCH)
    assert explore.can("Grasp starts before DetectCup succeeds") == (
        1,
        "  can Grasp starts before DetectCup succeeds: no, in all 1 state\n",
    )
    assert explore.can("PutDown fails after Grasp succeeds") == (
        0,
        "  can PutDown fails after Grasp succeeds: yes, in 1 tick\n"
        "    tick 1\n"
        "      DetectCup::2 succeeds  (tree.xml:5)\n"
        "      Grasp::3 succeeds  (tree.xml:6)\n"
        "      PutDown::5 fails  (tree.xml:7)\n",
    )


def test_a_node_that_is_halted_needs_leaves_that_run_on(explore: Exploring) -> None:
    explore.mission(MISSION)
    assert explore.can("Grasp halts") == (
        0,
        "  can Grasp halts: yes, in 2 ticks\n"
        "    tick 1\n"
        "      Ready::2 succeeds  (mission.btq:11)\n"
        "      DetectCup::5 succeeds  (mission.btq:14)\n"
        "      Grasp::8 runs  (mission.btq:17)\n"
        "      {cup} >= 4\n"
        "    tick 2\n"
        "      Ready::2 fails  (mission.btq:11)\n"
        "      Grasp::8 is halted  (mission.btq:17)\n",
    )


def test_entries_that_are_read_unset(explore: Exploring) -> None:
    explore.mission(MISSION.replace('            ScriptCondition (code = "cup > 3")\n', ""))
    assert explore.can("Grasp reads {cup} unset") == (
        0,
        "  can Grasp reads {cup} unset: yes, in 1 tick\n"
        "    tick 1\n"
        "      Ready::2 succeeds  (mission.btq:11)\n"
        "      DetectCup::5 fails  (mission.btq:14)\n"
        "      Wait::6 succeeds  (mission.btq:15)\n",
    )


def test_one_script_over_the_same_entries_has_one_value(explore: Exploring) -> None:
    explore.tree(
        '<Fallback><Sequence><ScriptCondition code="x &gt; 3"/><A/><ScriptCondition name="again" code="x &gt; 3"/>'
        '<ScriptCondition name="other" code="x &lt; 3"/></Sequence><B/></Fallback>'
    )
    assert explore.can("again fails")[0] == 1
    assert explore.can("other succeeds")[0] == 1
    assert explore.can("B starts after when {x} > 3")[0] == 0


def test_entries_in_questions_are_those_of_scenarios(explore: Exploring) -> None:
    explore.tree("<Sequence><A/></Sequence>")
    assert explore.can("{@limit} == 3 and {name} == 'three'") == (
        0,
        "  can {@limit} == 3 and {name} == 'three': yes, in 1 tick\n"
        "    tick 1\n"
        "      {limit} = 3\n"
        "      {name} = 'three'\n",
    )
    code, _, err = explore("--can", "{} == 3 and")
    assert (code, err.splitlines()[0]) == (
        2,
        "btq explore: `{} == 3 and`: expected a condition: a signal, a context, a value, …, found the end of the line; "
        "a question is an event (`Pick starts`), one `before` or `after` another, a condition "
        "(`node Pick and {done} == 1`), `Pick reads {pose} unset` or `mission does not end`",
    )


def test_conditions_of_nodes_that_run_together(explore: Exploring) -> None:
    explore.tree('<ParallelAll><A name="a"/><Sequence><B name="b"/><C name="c"/></Sequence></ParallelAll>')
    assert explore.can("node a and node b")[0] == 0
    assert explore.can("node b and node c")[0] == 1
    assert explore.can("not node a")[0] == 0


def test_missions_that_need_not_end(explore: Exploring) -> None:
    explore.tree("<KeepRunningUntilFailure><A/></KeepRunningUntilFailure>")
    assert (
        explore.can("mission does not end")
        == (
            0,
            "  can mission does not end: yes, in 1 tick\n"
            "    and from here again and again:\n"
            "    tick 1\n"
            "      A::2 succeeds  (tree.xml:3)\n",
        )
        or explore.can("mission does not end")[0] == 0
    )
    explore.tree('<Sequence><A/><Repeat num_cycles="3"><B/></Repeat></Sequence>')
    assert explore.can("mission does not end")[0] == 1
    explore.tree('<Sequence><A/><Repeat num_cycles="-1"><B/></Repeat></Sequence>')
    assert explore.can("mission does not end")[0] == 0


def test_two_actions_that_interrupt_each_other_for_ever(explore: Exploring) -> None:
    explore.tree("<ReactiveSequence><Action ID='A'/><Action ID='B'/></ReactiveSequence>")
    assert explore.can("mission does not end")[0] == 0


def test_codes(explore: Exploring) -> None:
    explore.tree("<Fallback><A/><B/></Fallback>")
    assert explore("--can", "B starts")[0] == 0
    assert explore("--never", "B starts")[0] == 1
    assert explore("--never", "B starts before A starts")[0] == 0
    assert explore("--can", "B starts before A starts")[0] == 1


def test_what_is_not_found_before_the_budget_is_spent(explore: Exploring) -> None:
    explore.tree('<Repeat num_cycles="90"><Sequence><A/><A/></Sequence></Repeat>')
    assert explore.can("mission succeeds", "--states", "10") == (
        1,
        "  can mission succeeds: not found in 10 states\n",
    )
    assert explore("--never", "mission succeeds", "--states", "10")[0] == 0
    assert explore("--never", "mission succeeds", "--states", "10", "--strict")[0] == 1
    assert explore("--never", "mission succeeds")[0] == 1


def test_the_standard_questions(explore: Exploring) -> None:
    explore.mission(
        """
Action Go
    input to : int
Action Look
    output place : int

BehaviorTree Main
    ?
        ->
            Fallback Find
                Look (place = {place})
                AlwaysSuccess
            Go (to = {place})
            AlwaysFailure
            Go Never (to = {place})
        KeepRunningUntilFailure Loop
            AlwaysSuccess
"""
    )
    code, out, _ = explore()
    assert code == 1
    assert out.splitlines()[1:] == [
        "  all 3 states seen",
        "  reads-unset: Go::6 can read {place} before it has a value  (mission.btq:13)",
        "  cannot-end: the mission cannot end",
        "  never-runs: Never never runs  (mission.btq:15); btq check: unreachable-child",
        "  never-ends: Loop never ends  (mission.btq:16)",
    ]


def test_what_a_rule_reports_too_names_it(explore: Exploring) -> None:
    explore.mission(
        """
Action Plan
    output path : Path
Action Follow
    input path : Path
    input speed : double

BehaviorTree Main
    ->
        Follow (path = {path}, speed = {speed})
        Plan (path = {path})
        ?
            Follow (path = {path}, speed = {next_speed})
            Script (code = "next_speed := 1.0")
        AlwaysFailure
        Plan (path = {path})
"""
    )
    (survey,) = [each["survey"] for each in explore.json()["missions"]]
    assert [(each["text"], each["line"], each.get("rule")) for each in survey["findings"] if "uid" in each] == [
        ("Follow::2 can read {path} before it has a value", 10, "unset-entry"),
        ("Follow::5 can read {next_speed} before it has a value", 13, None),
        ("the mission cannot succeed: AlwaysFailure::7 never succeeds", 15, None),
        ("Plan::8 never runs", 16, "unreachable-child"),
    ]


def test_exceptions_of_the_engine(explore: Exploring) -> None:
    explore.tree('<Sequence><A name="a" out="{x}"/><ScriptCondition code="x &gt; 3"/></Sequence>')
    code, out, _ = explore()
    assert code == 1
    assert "throws: the engine can throw: Exception in node 'ScriptCondition::3' [ScriptCondition]" in out


def test_entries_that_cpp_sets_have_a_value_before(explore: Exploring) -> None:
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    scripts = '<Script code="mode = 3"/><ScriptCondition code="speed &gt; 1"/><Script code="speed = 1"/>'
    explore.tree(f"<Sequence>{scripts}</Sequence>")
    assert "doesn't exist, yet" in explore()[1]
    (explore.folder / "btq.toml").write_text('nodes = ["main.cpp"]\n', encoding="utf-8")
    code = (
        'void start(BT::BehaviorTreeFactory& factory, BT::Blackboard& board) { factory.registerSimpleAction("A", a);\n'
        'board.set("mode", 1); board.set("speed", 2.0); }\n'
    )
    (explore.folder / "main.cpp").write_text(code, encoding="utf-8")
    assert explore() == (0, "tree.xml: tree Main, BehaviorTree.CPP 4.10\n  all 1 state seen\n", "")


def test_two_callers_of_a_server(explore: Exploring) -> None:
    (explore.folder / "btq.toml").write_text('nodes = ["nav2-jazzy"]\n')
    explore.tree(
        '<ParallelAll><FollowPath path="{path}"/><Sequence><Wait/><FollowPath name="again" path="{path}"/></Sequence>'
        "</ParallelAll>"
    )
    _, out, _ = explore()
    assert "shared-server: FollowPath::2 and again can call the server `follow_path` at the same time" in out


def test_questions_that_are_none(explore: Exploring) -> None:
    explore.tree("<Fallback><A/><B/></Fallback>")
    for question, message in (
        ("B start", "btq explore: `B start`: "),
        ("", "btq explore: ``: "),
        ("Grap starts", "btq explore: tree.xml: no node of the tree Main is called `Grap`"),
        ("{x", "btq explore: `{x`: "),
        (
            "battery < 3 %",
            "btq explore: tree.xml: the values of signals are not known here; write {battery}",
        ),
    ):
        code, out, err = explore("--can", question)
        assert (code, out) == (2, "")
        assert err.startswith(message)


@pytest.mark.parametrize(
    ("question", "message"),
    [
        ("node Grasp and Ready fails", "(`Ready fails`) {}; {}: `Grasp starts after Ready fails`"),
        ("Ready fails and node Grasp", "(`Ready fails`) {}; {}: `Grasp starts after Ready fails`"),
        ("node Grasp starts", "(`Grasp starts`) {}; {}: `Pick starts after Grasp starts`"),
    ],
)
def test_an_event_in_a_condition(explore: Exploring, question: str, message: str) -> None:
    explore.mission(MISSION)
    expected = message.format("cannot be part of a condition", "ask for it alone, or for what happens after it")
    assert explore("--can", question) == (2, "", f"btq explore: `{question}`: an event {expected}\n")


def test_brackets_around_events(explore: Exploring) -> None:
    explore.mission(MISSION)
    plain = explore.json("--can", "Grasp starts before DetectCup succeeds or Wait succeeds")
    bracketed = explore.json("--can", "(Grasp starts) before (DetectCup succeeds or Wait succeeds)")
    bracketed["missions"][0]["questions"][0]["text"] = plain["missions"][0]["questions"][0]["text"]
    assert bracketed == plain
    for question, problem in (
        ("Grasp starts before (Wait succeeds", "missing `)` for this `(`"),
        ("(Grasp starts before Wait succeeds)", "expected `)`, found `before`"),
        ("Grasp starts before (Wait)", "expected starts, succeeds, fails, finishes or halts, found `)`"),
        ("Grasp starts before (", "missing `)` for this `(`"),
    ):
        assert explore("--can", question)[2].startswith(f"btq explore: `{question}`: {problem}")


def test_a_question_is_asked_of_the_missions_that_have_its_nodes(explore: Exploring) -> None:
    explore.mission(MISSION, "fetch.btq")
    explore.mission("Action Spray\n\nRoot Clean\n\nBehaviorTree Clean\n    Spray\n", "clean.btq")
    both = ("fetch.btq", "clean.btq")
    assert explore.json(*both, "--can", "Spray fails", "--can", "Wait fails", "--can", "mission fails") == {
        **explore.json("fetch.btq", "--can", "Wait fails", "--can", "mission fails"),
        "missions": [
            *explore.json("fetch.btq", "--can", "Wait fails", "--can", "mission fails")["missions"],
            *explore.json("clean.btq", "--can", "Spray fails", "--can", "mission fails")["missions"],
        ],
    }
    code, out, err = explore(*both, "--can", "Spray fails")
    assert (code, out.splitlines()[0], err) == (0, "clean.btq: tree Clean, BehaviorTree.CPP 4.10", "")
    assert explore(*both, "--can", "Spray fails", "--can", "Sing fails")[::2] == (
        2,
        "btq explore: fetch.btq: no node of the tree Fetch is called `Sing`\n"
        "btq explore: clean.btq: no node of the tree Clean is called `Sing`\n",
    )
    assert explore(*both, "--can", "Spray fails before Wait fails")[::2] == (
        2,
        "btq explore: fetch.btq: no node of the tree Fetch is called `Spray`\n"
        "btq explore: clean.btq: no node of the tree Clean is called `Wait`\n",
    )


def test_entries_of_guards_are_shown_where_a_guard_refuses(explore: Exploring) -> None:
    explore.mission(
        """
signal speed : m/s from {base_speed}

Action Drive
Action Look
    input lamp : bool
Condition Read
    output speed : double
    output lamp : bool

QualityReq slow : safety "Slow"
    keeps speed <= 0.8 m/s
    on violation halt

Root Main

BehaviorTree Main
    R->
        Read (speed = {base_speed}, lamp = {lamp})
        ->
            Drive satisfies slow
            ScriptCondition (code = "lamp == false")
            Look (lamp = {lamp})
"""
    )

    def entries(question: str) -> list[str]:
        return [line.strip() for line in explore.can(question)[1].splitlines() if line.startswith("      {")]

    assert entries("Drive fails") == ["{lamp} has a value"]
    assert entries("Look fails") == ["{lamp} = 0"]
    assert entries("{base_speed} < 0.5 and node Drive") == ["{base_speed} < 0.5", "{lamp} has a value"]
    assert entries("Drive halts before Read fails") == [
        "{base_speed} <= 0.8",
        "{lamp} has a value",
        "{slow_stop} = 0.0",
        "{base_speed} > 0.8",
        "{slow_stop} = 1.0",
    ]
    assert explore("--can", "{base_speed} > 0.8 and node Drive")[0] == 0  # before the guard halts it, in the same tick
    assert explore("--can", "Drive succeeds after when {base_speed} > 0.8 and node Drive")[0] == 1
    (question,) = explore.json("--can", "Drive fails")["missions"][0]["questions"]
    assert sorted(question["witness"][0]["entries"]) == ["base_speed", "lamp", "slow_stop"]


def test_the_same_bytes_again(explore: Exploring) -> None:
    explore.mission(MISSION)
    first = explore("--format", "json", "--can", "Grasp halts", "--never", "mission fails")
    assert explore("--format", "json", "--can", "Grasp halts", "--never", "mission fails") == first


def test_nodes_of_nav2_without_its_distribution(explore: Exploring) -> None:
    explore.tree(
        '<RecoveryNode number_of_retries="2"><ComputePathToPose goal="{goal}" path="{path}"/><Wait/></RecoveryNode>'
    )
    code, out, _ = explore("--can", "Wait starts before ComputePathToPose fails", "--can", "Wait starts")
    assert code == 1
    assert out.splitlines()[:4] == [
        'tree.xml: tree Main, BehaviorTree.CPP 4.10, Nav2 Jazzy (assumed; name it: nodes = ["nav2-jazzy"])',
        "  can Wait starts before ComputePathToPose fails: no, in all 1 state",
        "  can Wait starts: yes, in 1 tick",
        "    tick 1",
    ]


def test_entries_that_bt_navigator_sets_have_a_value(explore: Exploring) -> None:
    (explore.folder / "btq.toml").write_text('nodes = ["nav2-jazzy"]\n', encoding="utf-8")
    explore.tree(
        '<Sequence><RemovePassedGoals input_goals="{goals}" output_goals="{goals}" radius="0.7"/>'
        '<FollowPath path="{path}"/><ComputePathToPose goal="{goal}" path="{path}" planner_id="GridBased"/></Sequence>'
    )
    findings = explore.json()["missions"][0]["survey"]["findings"]
    assert [finding["text"] for finding in findings] == ["FollowPath::3 can read {path} before it has a value"]


def test_a_node_that_the_engine_does_not_have_yet_is_refused(explore: Exploring) -> None:
    explore.tree("<TryCatch>\n<Pick/>\n<Home/>\n</TryCatch>")
    assert explore()[0] == 0
    (explore.folder / "btq.toml").write_text('engine = "4.6"\n', encoding="utf-8")
    assert explore() == (
        2,
        "",
        "btq explore: tree.xml: the engine refuses the tree: tree.xml:3: `TryCatch` requires BehaviorTree.CPP 4.9; "
        "4.6 does not have it\n",
    )


def test_a_node_of_the_program_may_have_the_name_of_a_later_one(explore: Exploring) -> None:
    explore.tree("<TryCatch/>")
    model = '<TreeNodesModel><Action ID="TryCatch"/></TreeNodesModel>'
    text = (explore.folder / "tree.xml").read_text(encoding="utf-8").replace("</root>", f"{model}</root>")
    explore.mission(text, "tree.xml")
    (explore.folder / "btq.toml").write_text('engine = "4.6"\n', encoding="utf-8")
    assert explore()[2] == ""


MANY_ATTEMPTS = (
    "<Sequence><ParallelAll>"
    + "".join(f'<RetryUntilSuccessful num_attempts="100"><A name="{name}"/></RetryUntilSuccessful>' for name in "abc")
    + "</ParallelAll><Home/></Sequence>"
)


def test_attempts_are_not_counted_if_that_takes_too_many_states(explore: Exploring) -> None:
    explore.tree(MANY_ATTEMPTS)
    few = ("--states", "500")
    assert explore.can("Home starts before a succeeds", *few) == (
        1,
        "  can Home starts before a succeeds: no, in all 57 states, with any number of attempts\n",
    )
    assert explore.can("ParallelAll fails before a fails or b fails or c fails", *few) == (
        1,
        "  can ParallelAll fails before a fails or b fails or c fails: no, in all 64 states, "
        "with any number of attempts\n",
    )
    code, out, _ = explore(*few)
    assert (code, out.splitlines()[1:]) == (0, ["  all 57 states seen, with any number of attempts"])


def test_what_happens_only_after_many_attempts_is_not_made_up(explore: Exploring) -> None:
    explore.tree(MANY_ATTEMPTS)
    assert explore.can("ParallelAll fails", "--states", "60") == (
        1,
        "  can ParallelAll fails: not found in 60 states\n",
    )
