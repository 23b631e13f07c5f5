"""Definition, references and highlights."""

from __future__ import annotations

import pytest
from feature_asserts import check_goto, check_highlights, check_implementation, check_references, check_type


@pytest.mark.parametrize(
    "text",
    [
        # Trees, from SubTree and Root.
        "Root <def></def>Main$0\n",
        "Root Ma$0in\nBehaviorTree <def>Main</def>\n    Pick\n",
        "BehaviorTree Main\n    SubTree $0Dock\nBehaviorTree <def>Dock</def>\n    Pick\n",
        'BehaviorTree Main\n    SubTree (ID = "My D$0ock")\nBehaviorTree <def>"My Dock"</def>\n    Pick\n',
        # Models.
        "Action <def>Pick</def>\nBehaviorTree Main\n    Pick$0\n",
        "Action <def>Pick</def>\nBehaviorTree Main\n    Action P$0ick\n",
        "BehaviorTree Main\n    Pick$0\n",
        "BehaviorTree Main\n    -$0>\n        Pick\n",
        # Ports, of a model and of a tree.
        "Action Pick\n    input <def>from</def> : string\nBehaviorTree Main\n    Pick (fr$0om = x)\n",
        "BehaviorTree Main\n    SubTree Dock (to$0 = x)\nBehaviorTree Dock\n    input <def>to</def>\n    Pick\n",
        "Root Main\nBehaviorTree Dock\n    input <def>to</def>\n    Pick (from = {t$0o})\n",
        # A key that nobody declares: where it is written.
        'BehaviorTree Main\n    ->\n        Script (code = "<def>n</def> := 1")\n        Pick (from = {$0n})\n',
        # Requirements: the first of classic repeats, references, apply.
        'QualityReq <def>rq1</def> "x"\nBehaviorTree Main\n    Pick satisfies rq1$0\n',
        'QualityReq <def>rq1</def> "x"\napply rq$01 to Pick\n',
        'BehaviorTree Main\n    ->\n        Pick (satisfies QualityReq ID = <def>"rq1"</def> description = "x")\n'
        '        Pick (satisfies QualityReq ID = "rq$01")\n',
        # Parameters and arguments.
        "QualityReq slow(<def>limit</def> : m/s)\n    keeps speed <= lim$0it\n",
        "QualityReq slow(<def>limit</def> : m/s)\n    keeps speed <= limit\napply slow(li$0mit = 1 m/s) to Pick\n",
        # What conditions name.
        "signal <def>speed</def> : m/s\ncontext fast : speed$0 > 1 m/s\n",
        "context <def>fast</def> : speed > 1 m/s\nQualityReq rq\n    takes at most 1 s if f$0ast else 2 s\n",
        "signal <def>speed</def> : m/s\nQualityReq rq\n    keeps max(spe$0ed) <= 1 m/s\n",
        "signal <def>sent</def> : kB\nQualityReq rq\n    uses at most 0 kB of $0sent\n",
        "Action <def>Pick</def>\nQualityReq rq\n    Main/Pi$0ck takes at most 1 s\n",
        "QualityReq rq\n    Fe$0tch takes at most 1 s\nBehaviorTree Main\n    Pick <def>Fetch</def>\n",
        # Qualities of one's own; the standard's are nowhere.
        'quality <def>gentleness</def> : safety "soft"\nQualityReq rq : Gentle$0ness "x"\n',
        "BehaviorTree Main\n    Pick satisfices safe$0ty\n",
        # Blanks and keywords mean nothing.
        "BehaviorTree Main\n $0   Pick\n",
        "Behav$0iorTree Main\n    Pick\n",
    ],
)
def test_goto(text: str) -> None:
    check_goto(text if "<def></def>" not in text else text.replace("<def></def>", ""))


@pytest.mark.parametrize(
    "text",
    [
        '//- main.btq\ninclude "li$0b.btq"\n//- lib.btq\n<def></def>Action Pick\n',
        '//- main.btq\ninclude "lib.btq"\nBehaviorTree Main\n    P$0ick\n//- lib.btq\nAction <def>Pick</def>\n',
        # What the file cannot see is found all the same.
        "//- main.btq\nBehaviorTree Main\n    SubTree Do$0ck\n//- lib.btq\nBehaviorTree <def>Dock</def>\n    Pick\n",
        '//- main.btq\ninclude "no$0where.btq"\n//- lib.btq\nAction Pick\n',
    ],
)
def test_goto_another_file(text: str) -> None:
    check_goto(text)


def test_references_cross_files() -> None:
    check_references("""
        //- main.btq
        include "lib.btq"
        BehaviorTree Main
            ->
                <ref>Pick</ref> (from = {shelf})
                Action <ref>Pi$0ck</ref>
                Retry (num_attempts = 3)
                    <ref>"Pick"</ref>
        QualityReq rq
            Main/<ref>Pick</ref> takes at most 1 s
        apply rq to every <ref>Pick</ref>
        //- lib.btq
        Action <def>Pick</def>
            input from : string
        //- other.btq
        BehaviorTree Other
            Pick
        """)


def test_references_of_a_requirement_that_classic_files_repeat() -> None:
    check_references("""
        BehaviorTree Main
            ->
                Pick (satisfies QualityReq ID = <def>"rq1"</def> description = "x")
                Place (satisfies QualityReq ID = <ref>"rq1"</ref> description = "x")
                Drop satisfies <ref>rq1$0</ref>
        """)


def test_references_of_a_port_are_those_of_its_node() -> None:
    check_references("""
        Action Pick
            input <def>from</def> : string
        Action Place
            input from : string
        BehaviorTree Main
            ->
                Pick (<ref>fr$0om</ref> = a)
                Place (from = a)
        """)


def test_an_entry_belongs_to_its_tree() -> None:
    check_references("""
        Root Main
        BehaviorTree Main
            ->
                Pick (from = {shelf})
                SubTree Carry (<ref>shelf</ref> = {shelf})
        BehaviorTree Carry
            input <def>shelf</def>
            ->
                Pick (from = {<ref>shelf$0</ref>})
                Script (code = "n := <ref>shelf</ref> + 1")
        """)


def test_the_root_blackboard_is_that_of_the_main_tree() -> None:
    check_references("""
        Root Main
        signal battery : % from {<ref>level</ref>}
        BehaviorTree Main
            ->
                Pick (from = {<ref>lev$0el</ref>})
                SubTree Carry
        BehaviorTree Carry
            ->
                Pick (from = {@<ref>level</ref>})
                Pick (from = {level})
        """)


def test_references_of_a_builtin_are_all_its_spellings() -> None:
    check_references("""
        BehaviorTree Main
            <ref>$0-></ref>
                <ref>Sequence</ref>
                    Pick
        """)


def test_references_of_a_tag() -> None:
    check_references("""
        QualityReq rq "x"
        apply rq to every node tagged <ref>heavy</ref>
        BehaviorTree Main
            Pick tags <def>hea$0vy</def>
        """)


def test_highlights_say_who_writes() -> None:
    check_highlights("""
        Action Look
            output pose : string
        Action Go
            input to : string
        BehaviorTree Main
            ->
                Look (pose = {<write>target</write>})
                Go (to = {<read>tar$0get</read>})
                Script (code = "<write>target</write> := 3; n := <read>target</read>")
        """)


def test_highlights_stay_in_the_file() -> None:
    check_highlights("""
        //- main.btq
        include "lib.btq"
        BehaviorTree Main
            <read>Pi$0ck</read>
        //- lib.btq
        Action Pick
        """)


def test_the_implementation_of_a_requirement_is_the_nodes_at_which_it_is_named() -> None:
    check_implementation("""
        //- lib.btq
        QualityReq r$0q1 "x"
        //- main.btq
        include "lib.btq"
        apply rq1 to every Place
        BehaviorTree Main
            <def>-></def>
                satisfies rq1
                <def>Pick</def> First satisfies rq1
                <def>Place</def> (satisfies QualityReq ID = rq1)
                Drop
        """)
    check_implementation("BehaviorTree Main\n    SubTree Do$0ck\nBehaviorTree <def>Dock</def>\n    Pick\n")
    check_implementation("BehaviorTree Main\n    $0\n")


@pytest.mark.parametrize(
    "text",
    [
        "Action <def>Pick</def>\nBehaviorTree Main\n    Pick Fe$0tch\n",
        "BehaviorTree Main\n    SubTree Dock Fe$0tch\nBehaviorTree <def>Dock</def>\n    Pick\n",
        "Action <def>Pick</def>\nQualityReq rq\n    Fe$0tch takes at most 1 s\nBehaviorTree Main\n    Pick Fetch\n",
        'quality <def>soft</def> : safety "x"\nQualityReq rq : soft "y"\nBehaviorTree Main\n    Pick satisfies r$0q\n',
        'QualityReq r$0q : safety "y"\n',
        'QualityReq r$0q "y"\n',
        "Action Pick\nBehaviorTree Main\n    Pi$0ck\n",
        "BehaviorTree Main\n    -> Fi$0rst\n        Pick\n",
    ],
)
def test_what_says_of_which_kind_it_is(text: str) -> None:
    check_type(text)
