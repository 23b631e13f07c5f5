"""What Nav2's nodes do where people expect something else, by distribution; each was seen in runs of them."""

from __future__ import annotations

from collections.abc import Mapping

import pytest
from simulated import Skills, ticked

from btq_lang.simulator.errors import NotModelled
from btq_lang.simulator.versions import Dialect

HUMBLE, JAZZY, LYRICAL = Dialect("3.8.7", "humble"), Dialect("4.10", "jazzy"), Dialect("4.10", "lyrical")
NAMES = ("humble", "jazzy", "lyrical")
Entries = Mapping[str, float | str]


def leaves(**successive: str) -> Skills:
    """What each leaf returns at successive starts, a letter each; RUNNING in as many ticks before as a digit says."""
    return {
        name: [[int(letter) if letter.isdigit() else 0, "S" if letter.isdigit() else letter, {}] for letter in letters]
        for name, letters in successive.items()
    }


def writes(*entries: Entries) -> Skills:
    """A leaf `w` that succeeds, and what it writes at successive starts."""
    return {"w": [[0, "S", dict(each)] for each in entries]}


TURNS = "<RoundRobin><AlwaysSuccess/><AlwaysSuccess/></RoundRobin>"
RATE = '<RateController hz="4"><Cond name="c"/></RateController><Act name="a"/>'
SPEED = '<SpeedController min_rate="1" max_rate="5"><Cond name="c"/></SpeedController>'
LONGER = '<PathLongerOnApproach path="{path}"><AlwaysFailure/></PathLongerOnApproach>'
EXPIRING = '<PathExpiringTimer seconds="0.15" path="{path}"/>'
MOVES = writes(*[{"robot_x": 0.4 * step} for step in range(6)])
NEW_GOAL = writes({}, {}, {"goal": 1.0})
NEW_PATHS = writes({}, {}, {"path": "9;5;2;0"}, {}, {"path": "5;2;2;0"}, {"path": "9;5;3;0"})


@pytest.mark.parametrize(
    ("tree", "skills", "entries", "letters"),
    [
        # Without a reset the throttle counts from the success before; with one it holds nothing back.
        (f"<PipelineSequence>{RATE}</PipelineSequence>", leaves(a="9", c="SF"), {}, "RRRFRR"),
        (f"<ReactiveSequence>{RATE}</ReactiveSequence>", leaves(a="9", c="SF"), {}, "RFRFRF"),
        (
            '<PipelineSequence><Sync name="w"/><DistanceController distance="1"><Cond name="c"/></DistanceController>'
            '<Act name="a"/></PipelineSequence>',
            {**leaves(a="9", c="SF"), **MOVES},
            {},
            "RRRFRR",
        ),
        (
            f'<PipelineSequence>{SPEED}<Act name="a"/></PipelineSequence>',
            leaves(a="9", c="SSF"),
            {"robot_speed": 0.5},
            "RRRRFR",
        ),
        (f'<PipelineSequence>{SPEED}<Act name="a"/></PipelineSequence>', leaves(a="9", c="SSF"), {}, "RRRRRR"),
        (
            '<WhileDoElse><TimeExpired seconds="0.25"/><AlwaysSuccess/><Act name="a"/></WhileDoElse>',
            leaves(a="9"),
            {},
            "RRRSRR",
        ),
        ('<Inverter><TimeExpired seconds="0.05"/></Inverter>', {}, {}, "SSSSSS"),
        ('<PathExpiringTimer seconds="0.25" path="{path}"/>', {}, {"path": "5;2;2;0"}, "FFFSFF"),
        (
            '<PipelineSequence><Sync name="w"/><WhileDoElse><GoalUpdated/><AlwaysSuccess/><Act name="a"/></WhileDoElse>'
            "</PipelineSequence>",
            {**leaves(a="9"), **NEW_GOAL},
            {"goal": 0.0},
            "RRSRRR",
        ),
        ('<Sequence><Sync name="w"/><GoalUpdated/></Sequence>', NEW_GOAL, {"goal": 0.0}, "FFFFFF"),
        ('<Sequence><Sync name="w"/><GlobalUpdatedGoal/></Sequence>', NEW_GOAL, {"goal": 0.0}, "SFSFFF"),
        (
            '<PipelineSequence><Sync name="w"/><WhileDoElse><DistanceTraveled distance="1"/><AlwaysSuccess/>'
            '<Act name="a"/></WhileDoElse></PipelineSequence>',
            {**leaves(a="9"), **MOVES},
            {},
            "RRRSRR",
        ),
        (f'<Sequence><Sync name="w"/>{LONGER}</Sequence>', NEW_PATHS, {"path": "5;2;2;0"}, "SSFSSS"),
        (LONGER, {}, {}, "SSSSSS"),
        (f'<Sequence><Sync name="w"/>{EXPIRING}</Sequence>', NEW_PATHS, {"path": "5;2;2;0"}, "FFFFFF"),
        # Two paths without a pose are the same.
        (
            f'<Sequence><Sync name="w"/>{EXPIRING}</Sequence>',
            writes({"path": "0;1;1;0"}),
            {"path": "0;9;9;0"},
            "FFSFSF",
        ),
        # Without a position there is no distance; one that is lost in the tick of the success turns that to a failure.
        (
            '<PipelineSequence><Sync name="w"/><DistanceController><AlwaysSuccess/></DistanceController>'
            '<Act name="a"/></PipelineSequence>',
            {**leaves(a="9"), **writes({}, {"robot_x": "lost"}, {}, {"robot_x": 0.0})},
            {},
            "RFFRRF",
        ),
        ('<DistanceController><Sync name="w"/></DistanceController>', writes({"robot_x": "lost"}), {}, "FFFFFF"),
        # A finished trigger is spent until a parent resets it.
        (
            '<PipelineSequence><SingleTrigger><AlwaysSuccess/></SingleTrigger><Act name="a"/></PipelineSequence>',
            leaves(a="3"),
            {},
            "RFRFRF",
        ),
        ("<SingleTrigger><AlwaysSuccess/></SingleTrigger>", {}, {}, "SSSSSS"),
        # An earlier child that runs again does not keep the later ones from being ticked.
        ('<PipelineSequence><Act name="a"/><Act name="b"/></PipelineSequence>', leaves(a="S9", b="3"), {}, "RRRSRR"),
        ("<InitialPoseReceived/>", {}, {"initial_pose_received": 1.0}, "SSSSSS"),
    ],
)
@pytest.mark.parametrize("dialect", [HUMBLE, JAZZY, LYRICAL], ids=NAMES)
def test_all_distributions(tree: str, skills: Skills, entries: Entries, letters: str, dialect: Dialect) -> None:
    assert ticked(tree, dialect, skills, entries) == letters


@pytest.mark.parametrize(
    ("tree", "skills", "entries", "letters"),
    [
        ('<RateController hz="4"><AlwaysSuccess _skipIf="true"/></RateController>', {}, {}, "KRRKKK"),
        (
            '<RecoveryNode number_of_retries="-1"><Act name="a"/><AlwaysSuccess/></RecoveryNode>',
            {"a": [[1, "F", {}]]},
            {},
            "RRFRRF",
        ),
        ('<RecoveryNode><AlwaysFailure/><AlwaysSuccess _skipIf="true"/></RecoveryNode>', {}, {}, "FFFFFF"),
        ('<RecoveryNode><AlwaysFailure _skipIf="true"/><AlwaysSuccess/></RecoveryNode>', {}, {}, "KKKKKK"),
        (
            "<RecoveryNode><AlwaysFailure/></RecoveryNode>",
            {},
            {},
            " Exception in node 'RecoveryNode::1' [RecoveryNode]: "
            "Recovery Node 'RecoveryNode' must only have 2 children.",
        ),
        (
            '<AreErrorCodesPresent error_code="{error_code}" error_codes_to_check="101;107"/>',
            {},
            {"error_code": 107.0},
            "SSSSSS",
        ),
        ("<InitialPoseReceived/>", {}, {}, "FFFFFF"),
    ],
)
@pytest.mark.parametrize("dialect", [JAZZY, LYRICAL], ids=NAMES[1:])
def test_since_jazzy(tree: str, skills: Skills, entries: Entries, letters: str, dialect: Dialect) -> None:
    assert ticked(tree, dialect, skills, entries) == letters


@pytest.mark.parametrize(
    ("tree", "skills", "letters"),
    [
        # A number without a sign is read from -1: there are more than enough retries.
        (
            '<RecoveryNode number_of_retries="-1"><Act name="a"/><AlwaysSuccess/></RecoveryNode>',
            {"a": [[1, "F", {}]]},
            "RRRRRR",
        ),
        (
            "<RecoveryNode><AlwaysFailure/></RecoveryNode>",
            {},
            " Recovery Node 'RecoveryNode' must only have 2 children.",
        ),
        ("<InitialPoseReceived/>", {}, " Blackboard::get() error. Missing key [initial_pose_received]"),
    ],
)
def test_humble(tree: str, skills: Skills, letters: str) -> None:
    assert ticked(tree, HUMBLE, skills) == letters


@pytest.mark.parametrize(
    ("tree", "jazzy", "lyrical"),
    [
        (TURNS, "SSSSSS", "SFSFSF"),
        ("<RoundRobin><AlwaysSuccess/></RoundRobin>", "SSSSSS", "FFFFFF"),
        ('<RoundRobin><AlwaysFailure/><AlwaysSuccess _skipIf="true"/></RoundRobin>', "FFFFFF", "FFFFFF"),
        ('<RoundRobin><AlwaysSuccess _skipIf="true"/></RoundRobin>', "KKKKKK", "KKKKKK"),
    ],
)
def test_turns(tree: str, jazzy: str, lyrical: str) -> None:
    assert (ticked(tree, JAZZY, {}), ticked(tree, LYRICAL, {})) == (jazzy, lyrical)


@pytest.mark.parametrize(
    ("tree", "skills", "entries", "letters"),
    [
        # A goal at a port is looked up there.
        (
            '<PipelineSequence><Sync name="w"/><GoalUpdatedController goal="{goal}"><Cond name="c"/>'
            '</GoalUpdatedController><Act name="a"/></PipelineSequence>',
            {**leaves(a="9", c="SF"), **NEW_GOAL},
            {"goal": 0.0},
            "RRFRRR",
        ),
        ("<PauseResumeController><AlwaysSuccess/></PauseResumeController>", {}, {}, "SSSSSS"),
        (TURNS.replace("<RoundRobin>", '<RoundRobin wrap_around="true">'), {}, {}, "SSSSSS"),
        (
            '<NonblockingSequence><Act name="a"/><Act name="b"/></NonblockingSequence>',
            leaves(a="1", b="3"),
            {},
            "RRRSRR",
        ),
        (
            '<NonblockingSequence><AlwaysSuccess _skipIf="true"/></NonblockingSequence>',
            {},
            {},
            " Exception in node 'NonblockingSequence::1' [NonblockingSequence]: "
            "Invalid node status. Received status SKIPPEDfrom child AlwaysSuccess",
        ),
        (
            '<PersistentSequence current_child_idx="{i}"><AlwaysSuccess/></PersistentSequence>',
            {},
            {},
            " Exception in node 'PersistentSequence::1' [PersistentSequence]: Missing required input "
            '[current_child_idx] in PersistentSequenceNode. Set via <Script code="current_child_idx := 0" />',
        ),
        (
            '<PersistentSequence current_child_idx="{idx1}"><AlwaysFailure/><Act name="a"/></PersistentSequence>',
            leaves(a="1"),
            {"idx1": 1.0},
            "RSFFFF",
        ),
        (
            '<PersistentSequence current_child_idx="1"><AlwaysFailure/><Act name="a"/></PersistentSequence>',
            leaves(a="1"),
            {},
            "RSRSRS",
        ),
        # A call while it is not ticked acts when it begins again; without a third child it goes on to its pause.
        (
            '<PauseResumeController pause_service_name="p" resume_service_name="r"><Sync name="w"/><Sync name="v"/>'
            "</PauseResumeController>",
            {"w": [[0, "F", {"call": "p"}]], "v": [[0, "S", {}], [0, "S", {"call": "r"}]]},
            {},
            "FRRRRF",
        ),
    ],
)
def test_lyrical(tree: str, skills: Skills, entries: Entries, letters: str) -> None:
    assert ticked(tree, LYRICAL, skills, entries) == letters


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        ("<NonblockingSequence><AlwaysSuccess/></NonblockingSequence>", "what NonblockingSequence does with its"),
        (
            '<RateController hz="{x}"><AlwaysSuccess/></RateController>',
            "the port hz of RateController::1 has no number",
        ),
        (
            '<DistanceController distance="{x}"><AlwaysSuccess/></DistanceController>',
            "the port distance of DistanceController::1 is read when the tree is created, and its entry is empty",
        ),
        (
            '<SpeedController min_rate="0"><AlwaysSuccess/></SpeedController>',
            "SpeedController::1 has a rate that is not",
        ),
        (
            '<SpeedController min_speed="0.5" max_rate="20"><KeepRunningUntilFailure><AlwaysSuccess/>'
            "</KeepRunningUntilFailure></SpeedController>",
            "the two speeds of SpeedController::1 are the same",
        ),
        ('<GoalUpdated goal="1;2;3"/>', "the port goal of GoalUpdated::1 is a literal"),
        ('<PathExpiringTimer path="{path}"/>', "the path of PathExpiringTimer::1 is not written"),
    ],
)
def test_what_is_not_modelled(tree: str, message: str) -> None:
    with pytest.raises(NotModelled, match=f"^{message}"):
        ticked(tree, JAZZY, {}, {"path": "home"})


def test_one_that_does_not_end_within_a_tick() -> None:
    tree = '<RecoveryNode number_of_retries="-1"><AlwaysFailure/><AlwaysSuccess/></RecoveryNode>'
    with pytest.raises(NotModelled, match="RecoveryNode::1 goes on without an end in one tick"):
        ticked(tree, HUMBLE, {})


@pytest.mark.parametrize(
    ("tree", "skills", "entries", "humble", "iron"),
    [
        # Iron begins anew whenever the node does, and takes a path with as many poses for another one.
        (f'<Sequence><Sync name="w"/>{LONGER}</Sequence>', NEW_PATHS, {"path": "5;2;2;0"}, "SSFSSS", "SSSSSS"),
        (
            f'<PipelineSequence><Sync name="w"/>{LONGER}<Act name="a"/></PipelineSequence>',
            {**leaves(a="9"), **writes({}, {"path": "5;9;2;0"})},
            {"path": "5;2;2;0"},
            "RRRRRR",
            "RFRRRR",
        ),
        # It cannot read a list of error codes.
        (
            '<AreErrorCodesPresent error_code="{error_code}" error_codes_to_check="101;107"/>',
            {},
            {"error_code": 107.0},
            None,
            "FFFFFF",
        ),
    ],
)
def test_iron(tree: str, skills: Skills, entries: Entries, humble: str | None, iron: str) -> None:
    assert ticked(tree, Dialect("3.8.7", "iron"), skills, entries) == iron
    assert humble is None or ticked(tree, HUMBLE, skills, entries) == humble
