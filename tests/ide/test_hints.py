"""Inlay hints and code lenses."""

from __future__ import annotations

from feature_asserts import check_hints, check_lenses


def test_the_quality_of_a_requirement_that_is_only_named() -> None:
    check_hints("""
        //- main.btq
        include "lib.btq"
        QualityReq own "no quality"
        apply rq1<hint>: time-behaviour</hint> to Place
        BehaviorTree Main
            ->
                Pick satisfies rq1<hint>: time-behaviour</hint>, own
                Place satisfies unknown
        //- lib.btq
        QualityReq rq1 : performance-efficiency.time-behaviour "In time"
        """)


def test_the_quality_that_encloses_a_classic_requirement() -> None:
    check_hints("""
        BehaviorTree Main
            ->
                Pick (satisfices Quality = performance (QualityReq ID = "rq1" description = "In time"))
                Place (satisfies QualityReq ID = "rq1"<hint>: performance</hint>)
        """)


def test_what_is_written_to_the_port() -> None:
    check_hints("""
        BehaviorTree Main
            ->
                Timeout (msec = 2 min<hint>= 120000</hint>)
                    Delay (delay_msec = 30 ms)
                        Pick (speed = 3 m/s)
        """)


def test_lenses() -> None:
    check_lenses(
        """
        //- lib.btq
        QualityReq rq1 "shared"
        QualityReq rq2 "unused"
        BehaviorTree Dock
            Pick satisfies rq1
        //- main.btq
        include "lib.btq"
        Root Main
        BehaviorTree Main
            ->
                SubTree Dock satisfies rq1
                SubTree Dock
        """,
        "rq1: 2 uses",
        "rq2: 0 uses",
        "Dock: 2 calls",
    )


def test_a_requirement_that_is_defined_at_its_only_node_has_no_lens() -> None:
    """It is used where it is defined: neither `0 uses` nor a line for nothing."""
    check_lenses(
        'BehaviorTree Main\n    ->\n        A (satisfices Quality = safety (QualityReq ID = "rq1" description = "d"))\n'
        '        B satisfies QualityReq rq2 "Soon" takes at most 3 s\n'
        '        C satisfies QualityReq rq3 "Soon" takes at most 3 s\n        D satisfies rq3\n',
        "Main: main tree",
        "rq3: 2 uses",
    )


def test_a_requirement_at_a_node_holds_for_the_nodes_that_it_names() -> None:
    check_lenses(
        'BehaviorTree Main\n    ->\n        A satisfies QualityReq rq "Soon" B takes at most 3 s\n        B\n',
        "Main: main tree",
        "rq: holds for 1 node",
    )


def test_the_main_tree_is_called_so() -> None:
    check_lenses("BehaviorTree A\n    SubTree B\nBehaviorTree B\n    C\n", "A: main tree", "B: 1 call")
    check_lenses("Root B\nBehaviorTree A\n    SubTree B\nBehaviorTree B\n    C\n", "A: 0 calls", "B: main tree, 1 call")
    check_lenses("BehaviorTree A\n    C\nBehaviorTree B\n    C\n", "A: 0 calls", "B: 0 calls")


def test_the_main_tree_of_a_mission_may_be_in_a_library() -> None:
    library = "BehaviorTree Dock\n    Pick\nBehaviorTree Home\n    Drive\n"
    check_lenses(
        f'//- lib.btq\n{library}//- main.btq\ninclude "lib.btq"\nRoot Dock\n', "Dock: main tree", "Home: 0 calls"
    )


def test_classic_repeats_have_one_lens() -> None:
    check_lenses(
        "BehaviorTree Main\n    ->\n        A (satisfies QualityReq ID = x description = y)\n"
        "        B (satisfies QualityReq ID = x description = y)\n",
        "Main: main tree",
        "x: 2 uses",
    )


def test_requirements_that_name_their_own_subjects() -> None:
    check_lenses(
        """
        Root Main
        QualityReq soon "Soon"
            MoveBase takes at most 3 s
        QualityReq all_of_them "All"
            every MoveBase takes at most 3 s
            ToA succeeds
        QualityReq run "Run"
            mission takes at most 1 min
        QualityReq between "Between"
            from ToA starts to Pick succeeds takes at most 20 s
        QualityReq added "Added"
            sum of ToA, Pick takes at most 20 s
        QualityReq both "Both"
            takes at most 1 s
            ToA takes at most 1 s
        QualityReq nothing "Nothing"
            Unknown takes at most 3 s
        BehaviorTree Main
            ->
                MoveBase ToA satisfies both
                MoveBase ToB
                Pick
        """,
        "soon: 0 uses",
        "all_of_them: holds for 2 nodes",
        "all_of_them: how can this be violated?",
        "run: holds for 1 node",
        "between: holds for 2 nodes",
        "added: holds for 2 nodes",
        "both: 1 use, holds for 1 node",
        "nothing: 0 uses",
        "Main: main tree",
    )


def test_a_library_holds_for_nodes_of_its_missions() -> None:
    check_lenses(
        """
        //- lib.btq
        QualityReq rq "Soon"
            Pick takes at most 3 s
        //- a.btq
        include "lib.btq"
        BehaviorTree A
            Pick
        //- b.btq
        include "lib.btq"
        BehaviorTree B
            Pick
        """,
        "rq: holds for 2 nodes",
    )


def test_each_scenario_has_a_lens_that_runs_it_and_calls_no_tree() -> None:
    check_lenses(
        """
        //- main.btq
        given Go fails
        scenario "far" of Main
            expect Go runs "A"
        scenario "near"
            expect Go runs "A"
        scenario "" of Main
        BehaviorTree Main
            Go (place = "A")
        """,
        "Main: main tree",
        '"far": run',
        '"near": run',
    )
