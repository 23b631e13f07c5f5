"""Hover: what stands under the cursor, explained."""

from __future__ import annotations

import pytest
from feature_asserts import check_hover


def test_a_model_with_its_ports() -> None:
    check_hover(
        """
        Action Pick "Takes a tube"
            input from : string "where the tubes are"
            output weight : double = 0
        BehaviorTree Main
            <hover>Pi$0ck</hover> (from = x)
        """,
        """
        ```btq
        Action Pick
        ```

        Takes a tube

        - `input from : string` (required): where the tubes are
        - `output weight : double = 0`
        """,
    )


def test_a_builtin() -> None:
    check_hover(
        "BehaviorTree Main\n    <hover>Inv$0erter</hover>\n        Pick\n",
        """
        **Inverter** (Decorator) · `Inverter` · children: 1 · since 3.8

        Turns success into failure and failure into success.

        It passes RUNNING and SKIPPED on.
        """,
    )


def test_a_requirement_from_another_file() -> None:
    check_hover(
        """
        //- main.btq
        include "lib.btq"
        BehaviorTree Main
            ->
                Pick Near satisfies <hover>rq$01</hover>
                Place satisfies rq1
        //- lib.btq
        QualityReq rq1 : safety "Keep
                                 calm"
            takes at most
                30 s
            on violation fail
        """.replace("at most\n                30 s", "at most 30 s"),
        """
        **rq1** · safety

        Keep calm

        ```btq
        takes at most 30 s
        on violation fail
        ```

        Enforcement by `btq build`:
        - `takes at most 30 s`: **enforced**

        Attached to:
        - `Pick Near` in `Main` (main.btq)
        - `Place` in `Main` (main.btq)
        """,
    )


def test_a_requirement_in_si_units_and_what_a_build_does_about_it() -> None:
    check_hover(
        """
        signal speed : m/s from {speed} initially 0 m/s
        QualityReq <hover>ca$0lm</hover> : safety "Calm"
            takes at most 2 min
            keeps speed <= 36 kmh
            in at least 95 % of runs
        apply calm to every Pick
        BehaviorTree Main
            Pick
        """,
        """
        **calm** · safety

        Calm

        ```btq
        takes at most 2 min  # 2 min = 120 s
        keeps speed <= 36 kmh  # 36 kmh = 10 m/s
        in at least 95 % of runs  # 95 % = 0.95
        ```

        Enforcement by `btq build`:
        - `takes at most 2 min`: **monitored**
        - `keeps speed <= 36 kmh`: **monitored**

        Attached to:
        - `apply calm to every Pick` (main.btq)
        """,
    )


def test_what_a_build_does_may_differ_from_node_to_node() -> None:
    check_hover(
        """
        Root Main
        QualityReq <hover>so$0on</hover>
            takes at most 2 s
            on violation fail
        BehaviorTree Main
            ->
                Action Go satisfies soon
                Condition At satisfies soon
        """,
        """
        **soon**

        ```btq
        takes at most 2 s
        on violation fail
        ```

        Enforcement by `btq build`:
        - `takes at most 2 s`: **enforced** at `Go`; **not enforced, monitored** at `At`: `At` completes within one tick

        Attached to:
        - `Go` in `Main` (main.btq)
        - `At` in `Main` (main.btq)
        """,
    )


def test_what_a_build_does_about_a_requirement_that_missions_share() -> None:
    check_hover(
        """
        //- lib.btq
        QualityReq <hover>so$0on</hover> "In time"
            takes at most 2 s
            on violation fail
            verified by monitor
        //- one.btq
        include "lib.btq"
        Root One
        BehaviorTree One
            Action Go satisfies soon
        //- two.btq
        include "lib.btq"
        Root Two
        BehaviorTree Two
            Condition At satisfies soon
        //- unconcerned.btq
        BehaviorTree Other
            Go
        """,
        """
        **soon**

        In time

        ```btq
        takes at most 2 s
        on violation fail
        verified by monitor
        ```

        Enforcement by `btq build`:
        - `takes at most 2 s`: **enforced** at `Go`; **not enforced, monitored** at `At`: `At` completes within one tick

        Attached to:
        - `Go` in `One` (one.btq)
        - `At` in `Two` (two.btq)
        """,
    )


def test_a_requirement_that_scenarios_verify() -> None:
    check_hover(
        """
        //- mission.btq
        QualityReq <hover>so$0on</hover>
            takes at most 3 s
            verified by test
        BehaviorTree Main
            Pick satisfies soon
        //- cases.btq
        include "mission.btq"
        scenario "It picks" verifies soon
            expect soon
        scenario "It fails"
            expect soon violated
        """,
        """
        **soon**

        ```btq
        takes at most 3 s
        verified by test
        ```

        Enforcement by `btq build`:
        - `takes at most 3 s`: **by test**

        Attached to:
        - `Pick` in `Main` (mission.btq)

        Verified by:
        - the scenario "It picks" (cases.btq)
        """,
    )


def test_a_requirement_that_people_judge() -> None:
    check_hover(
        """
        BehaviorTree Main
            Pick satisfies <hover>ti$0dy</hover>
        QualityReq tidy "Tidy"
            takes at most 3 s
            verified by review
        """,
        """
        **tidy**

        Tidy

        ```btq
        takes at most 3 s
        verified by review
        ```

        Enforcement by `btq build`:
        - `takes at most 3 s`: **by review**

        Attached to:
        - `Pick` in `Main` (main.btq)
        """,
    )


def test_a_requirement_of_a_classic_file() -> None:
    check_hover(
        """
        Root Main
        BehaviorTree Main
            Action Pick (satisfies QualityReq ID = <hover>"rq$01"</hover> description = "SuccessIf takes at most 1 min")
        """,
        """
        **rq1**

        SuccessIf takes at most 1 min

        Enforcement by `btq build`:
        - `takes at most 1 min`: **enforced**

        Attached to:
        - `Pick` in `Main` (main.btq)
        """,
    )


def test_a_requirement_that_holds_for_nothing() -> None:
    check_hover(
        'QualityReq <hover>r$0q</hover> "Soon"\n    takes at most 1 s\n',
        "**rq**\n\nSoon\n\n```btq\ntakes at most 1 s\n```",
    )


def test_a_quality() -> None:
    check_hover(
        "BehaviorTree Main\n    Pick satisfices <hover>time-$0behavior</hover>\n",
        """
        **performance-efficiency.time-behaviour** · Time behaviour

        Response time and throughput meet the requirement.

        _ISO/IEC 25010:2023_

        Siblings: `resource-utilization`, `capacity`
        """,
    )


def test_a_quality_of_ones_own() -> None:
    check_hover(
        'quality gentleness : safety "soft"\nBehaviorTree Main\n    Pick satisfices <hover>gentle$0ness</hover>\n',
        "**gentleness** · safety\n\nsoft\n\n_declared in main.btq_",
    )


def test_an_entry_with_its_readers_and_writers() -> None:
    check_hover(
        """
        Action Look
            output pose : string
        Action Go
            input to : string
        Root Other
        BehaviorTree Main
            ->
                Look (pose = {<hover>tar$0get</hover>})
                Go (to = {target})
        """,
        """
        **target** · entry of this tree's blackboard

        Written by:
        - `Look` in `Main` (main.btq)

        Read by:
        - `Go` in `Main` (main.btq)
        """,
    )


@pytest.mark.parametrize(
    ("text", "markdown"),
    [
        ("QualityReq r\n    takes at most <hover>$030 min</hover>\n", "**30 min** = 1800 s (time)"),
        ("QualityReq r\n    keeps v <= <hover>36 k$0mh</hover>\n", "**36 kmh** = 10 m/s (speed)"),
        ("QualityReq r\n    keeps t <= <hover>25 deg$0C</hover>\n", "**25 degC** = 298.15 K (temperature)"),
        ("QualityReq r\n    in at least <hover>98 $0%</hover> of runs\n", "**98 %** = 0.98 (percentage)"),
        (
            "BehaviorTree Main\n    Timeout (msec = <hover>3$00 s</hover>)\n        Pick\n",
            "**30 s** = 30 s (time)\n\nWritten to the port as `30000`, in ms.",
        ),
        (
            "BehaviorTree Main\n    Timeout (<hover>ms$0ec</hover> = 30 s)\n        Pick\n",
            "`input msec : unsigned int` (in ms, required): The time limit; 0 means no limit",
        ),
        (
            "BehaviorTree Main\n    Pick (<hover>_skip$0If</hover> = x)\n",
            "`_skipIf`: if true when the node starts, the node returns SKIPPED without a tick; "
            "not checked while it runs",
        ),
        (
            "signal <hover>spe$0ed</hover> : m/s from {v}\n",
            "```btq\nsignal speed : m/s from {v}\n```\n\n_main.btq_",
        ),
        (
            "BehaviorTree Main\n    <hover>Pi$0ck</hover>\n",
            "`Pick`: a custom node without a model in this file or its includes.",
        ),
        (
            "Root <hover>Ma$0in</hover>\nBehaviorTree Main\n    Pick\n",
            "```btq\nBehaviorTree Main\n```\n\n1 node · main.btq\n\nRun by:\n- main.btq",
        ),
        ("signal v : <hover>km$0h</hover>\n", "**kmh** · speed · 1 kmh = 0.2777777778 m/s"),
        ("signal v : <hover>$0m/s</hover>\n", "**m/s** · speed"),
        ("$0\n", None),
        ("# on vio$0lation\n", None),
        ('QualityReq r "on vio$0lation"\n', None),
        (
            "<hover>Behavior$0Tree</hover> Main\n",
            "**BehaviorTree** (item) · `BehaviorTree Deliver`\n\nA tree: its ports, and one node with all below it.",
        ),
        (
            "QualityReq r\n    <hover>lea$0ves</hover> v > 3 m\n",
            "**leaves** (claim) · `leaves battery >= 3 %`\n\nViolated when it is false when the node has succeeded."
            " Activations that fail or are halted are not counted.",
        ),
        (
            "QualityReq r\n    takes at most 3 s\n    <hover>on viol$0ation</hover> fail\n",
            "**on violation** (clause) · `on violation fail`\n\n"
            "What the robot does: `fail` the node, `halt` the mission, `warn` or `log`; default: only monitored.",
        ),
        (
            "BehaviorTree Main\n    Pick <hover>satis$0fies</hover> r\n",
            "**satisfies** (clause of a node) · `satisfies in_time`\n\n"
            "Late design: a measurable requirement holds for the node.",
        ),
    ],
)
def test_hover(text: str, markdown: str | None) -> None:
    check_hover(text, markdown)


def test_a_rule() -> None:
    from btq_lang.diagnostics.rules import page

    check_hover("# btq: ignore[<hover>unused$0-tree</hover>]\nBehaviorTree Main\n    Pick\n", page("unused-tree"))


def test_the_parameters_of_a_requirement() -> None:
    check_hover(
        """
        context near : {people} > 0
        QualityReq <hover>sl$0ow</hover>(limit : m/s, wait : s = 10 s if near else  -1 s) : safety "Slow"
        """,
        """
        **slow** `(limit : m/s, wait : s = 10 s if near else -1 s)` · safety

        Slow
        """,
    )


def test_a_port_of_an_older_engines_word_is_that_of_its_replacement() -> None:
    check_hover(
        "BehaviorTree Main\n    RetryUntilSuccesful (<hover>num_$0attempts</hover> = 3)\n        Pick\n",
        "`input num_attempts : int` (required): The total number of attempts; -1 means endless",
    )
