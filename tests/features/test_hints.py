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


def test_classic_repeats_have_one_lens() -> None:
    check_lenses(
        "BehaviorTree Main\n    ->\n        A (satisfies QualityReq ID = x description = y)\n"
        "        B (satisfies QualityReq ID = x description = y)\n",
        "Main: 0 calls",
        "x: 1 use",
    )
