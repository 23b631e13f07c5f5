"""The formatter, case by case: what a text looks like before and after."""

from __future__ import annotations

from pathlib import Path

import pytest
from layouts import places, said
from syntax_asserts import written

from btq_lang.formatter import FormatOptions, Formatted, format_range, format_text
from btq_lang.util.text import Edit, Span, apply_edits

DEFAULTS = FormatOptions()


def assert_formats(before: str, after: str, options: FormatOptions = DEFAULTS) -> None:
    """One text becomes the other, by its edits too, and the other stays as it is."""
    before, after = written(before), written(after)
    done = format_text(before, options)
    assert done.refused is None
    assert done.text == after
    assert apply_edits(before, done.edits) == after
    assert format_text(after, options) == Formatted(after)


def assert_stays(text: str) -> None:
    assert_formats(text, text)


# ---- the file -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["", "\n", "\ufeff", "  \n\t\r\n \r"])
def test_a_file_that_says_nothing_is_empty(text: str) -> None:
    assert format_text(text).text == ""


def test_a_file_ends_with_one_line_end() -> None:
    assert format_text("Root X").text == "Root X\n"
    assert format_text("Root X\n\n \n\t\n").text == "Root X\n"
    assert format_text("# c").text == "# c\n"


def test_line_ends_are_those_of_the_file_and_the_byte_order_mark_goes() -> None:
    text = '\ufeffBehaviorTree X{0}\tFoo (a = "one\r\n  two") /* three\r  four */\r\tBar\n'
    formatted = 'BehaviorTree X\n    Foo (a = "one\n  two")  /* three\n  four */\n    Bar\n'
    assert format_text(text.format("\n")).text == formatted
    assert format_text(text.format("\r")).text == formatted
    assert format_text(text.format("\r\n")).text == formatted.replace("\n", "\r\n")


def test_a_formatted_file_of_windows_stays_as_it_is() -> None:
    text = "signal a : s\r\n\r\nBehaviorTree A\r\n    Foo  # a\r\n"
    assert format_text(text).edits == ()
    assert format_text(text.replace("Foo ", "Foo")).edits == (Edit(Span(40, 40), " "),)


def test_no_blanks_at_the_end_of_a_line_but_in_strings() -> None:
    assert_formats(
        'include "a.btq"\t \n# c \t\nxml "<a> \n  </a>"  \n// d  \n',
        'include "a.btq"\n# c\nxml "<a> \n  </a>"\n// d\n',
    )


def test_blank_lines() -> None:
    assert_formats(
        """


        include "a.btq"


        include "b.btq"
        signal a : s
        QualityReq r

            takes at most 3 s



            on violation fail
        signal b : s

        signal c : s
        # about A

        # more about A
        BehaviorTree A

            # first

            ->


                Foo

                Bar
        # about B
        BehaviorTree B
            Foo
        """,
        """
        include "a.btq"

        include "b.btq"
        signal a : s

        QualityReq r
            takes at most 3 s

            on violation fail

        signal b : s

        signal c : s
        # about A

        # more about A
        BehaviorTree A
            # first

            ->
                Foo

                Bar

        # about B
        BehaviorTree B
            Foo
        """,
    )


def test_blank_lines_in_a_root() -> None:
    assert_formats(
        """
        Root Main

            signal a : s
            BehaviorTree Main
                Foo
            BehaviorTree Other
                Foo
        signal b : s
        """,
        """
        Root Main
            signal a : s

            BehaviorTree Main
                Foo

            BehaviorTree Other
                Foo

        signal b : s
        """,
    )


# ---- indentation ----------------------------------------------------------------------------------------------------


def test_every_level_is_four_blanks() -> None:
    assert_formats(
        """
        BehaviorTree A
          ->
                Foo
                ?
                 Foo
          -> # a second one is a mistake of meaning, not of syntax
             Foo
        """,
        """
        BehaviorTree A
            ->
                Foo
                ?
                    Foo
            ->  # a second one is a mistake of meaning, not of syntax
                Foo
        """,
    )


def test_tabs() -> None:
    assert_formats(
        "Root A\n\tBehaviorTree ID  = A\n\t\t?\t\t\n\t\t\tFoo\t(a=1)\n",
        "Root A\n    BehaviorTree ID = A\n        ?\n            Foo (a = 1)\n",
    )


def test_other_options() -> None:
    assert_formats(
        'BehaviorTree A\n    Foo (a = "12345" b = 2)\n',
        'BehaviorTree A\n  Foo (\n    a = "12345"\n    b = 2\n  )\n',
        FormatOptions(columns=24, indent=2),
    )


# ---- blanks between words -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('include   "a.btq"', 'include "a.btq"'),
        ('include "a.xml"(ros_pkg="p" )', 'include "a.xml" (ros_pkg = "p")'),
        ("qualities  iso25010-2011", "qualities iso25010-2011"),
        ('quality  calm:safety . fail-safe "t"', 'quality calm : safety.fail-safe "t"'),
        ("quality calm : safety  < fail-safe >", "quality calm : safety <fail-safe>"),
        ("signal a:% from {a}", "signal a : % from {a}"),
        ("signal a :m/s^2 from {a}  level fresh within 5s initially -3m/s^2",
         "signal a : m/s^2 from {a} level fresh within 5 s initially -3 m/s^2"),
        ("signal a : 1/s", "signal a : 1/s"),
        ("context a:b<3%", "context a : b < 3 %"),
        ("context a : ( b+c )*2>=- 1 and not(d or e)", "context a : (b + c) * 2 >= - 1 and not (d or e)"),
        ("context a : b -c-2 == x/ y", "context a : b - c-2 == x / y"),
        ("context a : -5 % <= b and - 2<c", "context a : -5 % <= b and -2 < c"),
        ("context a : node A /* b */ /C", "context a : node A /* b */ /C"),
        ("context a : max (b)!=3 or node A /B/ \"C\"", 'context a : max(b) != 3 or node A/B/"C"'),
        ('apply a( x=3s,y = 4 if b else 5 ),c to every A under B / C , every node tagged t except D',
         "apply a(x = 3 s, y = 4 if b else 5), c to every A under B/C, every node tagged t except D"),
        ('Action A( a = b , c=d )"t"', 'Action A (a = b, c = d) "t"'),
        ("Root  A ( )", "Root A ()"),
        ('BehaviorTree  ID=A("x"=3)', 'BehaviorTree ID = A ("x" = 3)'),
        ("xml\t'<a/>'", "xml '<a/>'"),
        ('QualityReq a(b:s=3s,c:%):d.e"t"goal b', 'QualityReq a(b : s = 3 s, c : %) : d.e "t" goal b'),
        ('QualityReq ID="a",description="t"', 'QualityReq ID = "a", description = "t"'),
        ("QualityReq a from A/B starts to when c>3 takes between 1s and 2 s",
         "QualityReq a from A/B starts to when c > 3 takes between 1 s and 2 s"),
        ("QualityReq a sum  of A,B /C uses at most 3Wh of e", "QualityReq a sum of A, B/C uses at most 3 Wh of e"),
        ("QualityReq a runs at least 1 per 1s with probability>=98% of runs",
         "QualityReq a runs at least 1 per 1 s with probability >= 98 % of runs"),
        ("QualityReq a tries at most 3 per A / B over last 7d", "QualityReq a tries at most 3 per A/B over last 7 d"),
    ],
)  # fmt: skip
def test_items(before: str, after: str) -> None:
    assert_formats(before + "\n", after + "\n")


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("->Foo", "-> Foo"),
        ("R?", "R?"),
        ("→  Foo(a={=})", "→ Foo (a = {=})"),
        ("'Retry' \"the  label\" ( num_attempts=6 )", "'Retry' \"the  label\" (num_attempts = 6)"),
        ("Condition  BatteryLow?", "Condition BatteryLow?"),
        ("SubTree(ID=A)", "SubTree (ID = A)"),
        ("Timeout (msec=30s)", "Timeout (msec = 30 s)"),
        ("Foo (a = -1 b=1e3,c = 30   % )", "Foo (a = -1 b = 1e3, c = 30 %)"),
        ('Foo satisfices a,b<c>satisfies d( x=1 ),e tags f,"g h"',
         'Foo satisfices a, b <c> satisfies d(x = 1), e tags f, "g h"'),
        ("Foo (satisfices Quality=a(QualityReq ID=b), Quality = c tags d)",
         "Foo (satisfices Quality = a (QualityReq ID = b), Quality = c tags d)"),
        ("Foo (parameters a=1,b=2 satisfies c)", "Foo (parameters a = 1, b = 2 satisfies c)"),
        ("input a:std::string=\"x\"(b=c)\"text\"", 'input a : std::string = "x" (b = c) "text"'),
        ("satisfies a , b", "satisfies a, b"),
    ],
)  # fmt: skip
def test_lines_of_a_tree(before: str, after: str) -> None:
    assert_formats(f"BehaviorTree T\n {before}\n", f"BehaviorTree T\n    {after}\n")


def test_models() -> None:
    assert_formats(
        """
        TreeNodesModel
          Action  A  "t"
            input  x:double=0.5 "how much"
            inout  : int
            metadata( color="red" )
            xml '<a/>'
          xml '<b/>'
        """,
        """
        TreeNodesModel
            Action A "t"
                input x : double = 0.5 "how much"
                inout : int
                metadata (color = "red")
                xml '<a/>'
            xml '<b/>'
        """,
    )


# ---- brackets -------------------------------------------------------------------------------------------------------


def test_brackets_over_lines_have_a_line_for_each_attribute() -> None:
    assert_formats(
        """
        BehaviorTree A
            ScriptAction (
            name =
            "MoveBase" n
            = 3,
              satisfices Quality = performance
            (QualityReq ID = "rq1"
            description = "Each pump
                    within 90 sec.")
                )
            SubTree (ID = B parameters a = 1, b = 2
                satisfies QualityReq
                ID = "rq2", c) tags d
        """,
        """
        BehaviorTree A
            ScriptAction (
                name = "MoveBase"
                n = 3,
                satisfices Quality = performance (
                    QualityReq ID = "rq1"
                        description = "Each pump
                    within 90 sec."
                )
            )
            SubTree (
                ID = B
                parameters a = 1,
                b = 2
                satisfies QualityReq ID = "rq2", c
            ) tags d
        """,
    )


def test_brackets_on_one_line_stay_there_if_they_fit() -> None:
    fits = 'BehaviorTree A\n    Foo (a = "' + "x" * 70 + '", b = "' + "y" * 6 + '")\n'
    assert max(map(len, fits.splitlines())) == 100
    assert_stays(fits)
    assert_formats(
        fits.replace("y", "yy", 1),
        'BehaviorTree A\n    Foo (\n        a = "' + "x" * 70 + '",\n        b = "' + "y" * 7 + '"\n    )\n',
    )


def test_brackets_are_spread_for_what_stands_behind_them_only_if_that_helps() -> None:
    name = "a" * 70
    assert_formats(
        f"BehaviorTree A\n    Foo (b = 12345678901234567890) satisfies {name}\n",
        f"BehaviorTree A\n    Foo (\n        b = 12345678901234567890\n    ) satisfies {name}\n",
    )
    assert_stays(f"BehaviorTree A\n    Foo (b = 1) satisfies {name}, {name}\n")


def test_an_attribute_that_is_too_long_is_broken_before_description_and_clauses() -> None:
    assert_formats(
        """
        BehaviorTree A
            Foo (
                satisfies QualityReq a keeps speed <= 0.25 m/s while humans_near because "movement next to people"
                satisfies QualityReq b keeps speed <= 0.25 m/s
                satisfies QualityReq ID = "rq3" description = "The information on the label is processed on the robot."
            )
        """,
        """
        BehaviorTree A
            Foo (
                satisfies QualityReq a
                    keeps speed <= 0.25 m/s
                    while humans_near
                    because "movement next to people"
                satisfies QualityReq b keeps speed <= 0.25 m/s
                satisfies QualityReq ID = "rq3"
                    description = "The information on the label is processed on the robot."
            )
        """,
    )


def test_line_ends_inside_an_attribute_stay() -> None:
    """They may be what keeps words apart: `6 s` would be a quantity, and `limit -1` a difference."""
    assert_formats(
        """
        BehaviorTree A
            Foo (satisfies a, QualityReq b goal 6
                s takes less than 3 s, QualityReq c keeps x and
              -1 < y)
        """,
        """
        BehaviorTree A
            Foo (
                satisfies a, QualityReq b goal 6
                    s takes less than 3 s, QualityReq c keeps x and
                    -1 < y
            )
        """,
    )


def test_line_ends_in_conditions_stay() -> None:
    assert_formats(
        """
        context a : ( b and
            c or max(
              d) > 3
        )
        context e : ( - 2 < b and
          - 3 < c or # f
             d # g
        )
        """,
        """
        context a : (b and
            c or max(d) > 3)
        context e : (- 2 < b and
            - 3 < c or  # f
            d  # g
        )
        """,
    )


def test_parameters_and_their_values_over_lines() -> None:
    assert_formats(
        """
        QualityReq a(b : s = 3 s,
           c : %)
            takes at most b
        apply a(
        b = 4 s) to A
        """,
        """
        QualityReq a(
            b : s = 3 s,
            c : %
        )
            takes at most b

        apply a(
            b = 4 s
        ) to A
        """,
    )


def test_brackets_behind_a_string_over_lines() -> None:
    assert_formats(
        """
        BehaviorTree A
         Foo "one
                                 two" (
           a = 1)
        """,
        """
        BehaviorTree A
            Foo "one
                                 two" (
                a = 1
            )
        """,
    )


# ---- clauses --------------------------------------------------------------------------------------------------------


def test_clauses_of_a_block_have_one_order_and_take_their_comments_along() -> None:
    assert_formats(
        """
        QualityReq a : safety "t"
            verified by test # h
            # why
            because "x"
              # below because
            goal 10 s on violation fail

            /* w */ over last 3 runs
            confidence 95 %
            in at least 8 % of time   in at least 9 % of runs   on average
            while b # s
            # what
            takes at most 20 s
            # at the end
        signal b : bool
        """,
        """
        QualityReq a : safety "t"
            # what
            takes at most 20 s
            while b  # s
            on average
            in at least 8 % of time
            in at least 9 % of runs
            confidence 95 %

            /* w */ over last 3 runs
            on violation fail
            goal 10 s
            # why
            because "x"
                # below because
            verified by test  # h
            # at the end

        signal b : bool
        """,
    )


def test_two_claims_keep_the_order() -> None:
    assert_formats(
        """
        QualityReq a
            on violation fail
            takes at most 20 s while b
            keeps c
            while d
        """,
        """
        QualityReq a
            on violation fail
            takes at most 20 s
            while b
            keeps c
            while d
        """,
    )


def test_when_something_is_kept_is_written_after_it() -> None:
    assert_formats(
        """
        QualityReq a
            on violation fail
            from B starts or C starts until D fails
            keeps c
            while d
        """,
        """
        QualityReq a
            keeps c
            while d
            from B starts or C starts until D fails
            on violation fail
        """,
    )


def test_clauses_behind_the_head_stay_in_their_order_if_they_fit() -> None:
    assert_stays('QualityReq a : safety "t" on violation fail takes at most 20 s\n')
    assert_formats(
        """
        QualityReq a : safety "Slow next to people" on violation fail because "visitors" keeps speed <= 0.25 m/s # c
            # d
            while near
        # e
        QualityReq b : safety "Slow next to people" on violation fail because "visitors" keeps speed <= 0.25 m/s
            # f
        # g
        """,
        """
        QualityReq a : safety "Slow next to people"  # c
            keeps speed <= 0.25 m/s
            # d
            while near
            on violation fail
            because "visitors"

        # e
        QualityReq b : safety "Slow next to people"
            keeps speed <= 0.25 m/s
            on violation fail
            because "visitors"
            # f
        # g
        """,
    )


def test_requirements_in_a_tree() -> None:
    long = "because " + repr("x" * 60)
    assert_formats(
        f"""
        BehaviorTree A
          Foo
            satisfies a,QualityReq b : c goal 3 s {long} takes at most 4 s
            satisfies QualityReq d
              on violation fail
              takes at most 4 s
            Bar satisfies QualityReq e goal 3 s {long} takes at most 4 s
              satisfies QualityReq f goal 3 s {long} takes at most 4 s tags g
              Foo
        """,
        f"""
        BehaviorTree A
            Foo
                satisfies a, QualityReq b : c
                    takes at most 4 s
                    goal 3 s
                    {long}
                satisfies QualityReq d
                    takes at most 4 s
                    on violation fail
                Bar satisfies QualityReq e goal 3 s {long} takes at most 4 s
                    satisfies QualityReq f goal 3 s {long} takes at most 4 s tags g
                    Foo
        """,
    )


# ---- comments -------------------------------------------------------------------------------------------------------


def test_a_comment_line_goes_to_the_level_where_it_belongs() -> None:
    assert_formats(
        """
          # at the top
        BehaviorTree A
        # first in A
          ->
             # a child of the sequence
           # a child of it too
        # between siblings
              Foo
               # below Foo
         # between siblings too
              Bar
            # a child of the sequence, at its end
          # a child of A
        # at the end
        """,
        """
        # at the top
        BehaviorTree A
            # first in A
            ->
                # a child of the sequence
                # a child of it too
                # between siblings
                Foo
                    # below Foo
                # between siblings too
                Bar
                # a child of the sequence, at its end
            # a child of A
        # at the end
        """,
    )


def test_a_tab_before_a_comment_is_four_columns() -> None:
    assert_formats(
        "BehaviorTree A\n\t->\n\t\tFoo\n    # of A\n        # of the sequence\n             # of Foo\n",
        "BehaviorTree A\n    ->\n        Foo\n    # of A\n        # of the sequence\n            # of Foo\n",
    )


def test_comments_on_one_line_stay_on_it() -> None:
    assert_formats(
        """
        BehaviorTree A // a
          /* b */   /* c */
          /* d */-> /* e */Foo # f
            Bar /* g */  // h
            /* i
          j */ Baz
        """,
        """
        BehaviorTree A  // a
            /* b */ /* c */
            /* d */ -> /* e */ Foo  # f
                Bar  /* g */ // h
                /* i
          j */ Baz
        """,
    )


def test_comments_that_are_aligned_stay_aligned() -> None:
    assert_formats(
        """
        signal a : s from {x} # a
        signal b :   s        # b
        signal cc : s from   {long}   # c
        signal d:s # d
        BehaviorTree A
          ->
             Foo   (x = 1)    # f
             Bar              # g
               Baz            # h

             Foo              # not beside the line above
             Bar
             X (               # i
               x = 1           # j
               yyyyyyyyyyy = 2 # k
             )                 # l
        """,
        """
        signal a : s from {x}  # a
        signal b : s           # b
        signal cc : s from {long}  # c
        signal d : s  # d

        BehaviorTree A
            ->
                Foo (x = 1)  # f
                Bar          # g
                    Baz      # h

                Foo  # not beside the line above
                Bar
                X (                  # i
                    x = 1            # j
                    yyyyyyyyyyy = 2  # k
                )                    # l
        """,
    )


def test_a_tab_before_an_aligned_comment_is_four_columns() -> None:
    assert_formats(
        "BehaviorTree A\n\t->\n\t\tFoo\t\t# a\n\t\tBazes\t# b\n",
        "BehaviorTree A\n    ->\n        Foo    # a\n        Bazes  # b\n",
    )


def test_comments_in_brackets() -> None:
    assert_formats(
        """
        BehaviorTree A
            Foo ( # a

                /* b */ x = 1, # c
              # d

              # e
              y # f
              = 2 /* g */ z = 3
              satisfies a, # h
              // i
                b # j
            /* k */

            ) # l
            Bar (/* m */ x = 1 /* n */)
        """,
        """
        BehaviorTree A
            Foo (  # a
                /* b */
                x = 1,  # c
                # d

                # e
                y  # f
                    = 2  /* g */
                z = 3
                satisfies a,  # h
                    // i
                    b  # j
                /* k */
            )  # l
            Bar (/* m */ x = 1 /* n */)
        """,
    )


# ---- what is not changed --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("BehaviorTree  A\n   Foo (a = 1\n", "unclosed-bracket"),
        ("BehaviorTree  A\n   Foo\n  Bar\n", "inconsistent-indentation"),
        ("BehaviorTree  A\n   Foo (a = 30sek)\n", "unknown-unit"),
        ("Fallback  A\r\n", "syntax-error"),
    ],
)
def test_a_text_with_a_syntax_error_comes_back_as_it_was(text: str, rule: str) -> None:
    done = format_text(text)
    assert done.refused is not None
    assert done.refused.rule == rule
    assert (done.text, done.edits, format_range(text, 0, len(text))) == (text, (), ())


def test_the_first_error_is_named() -> None:
    refused = format_text("Foo\nBar\n").refused
    assert refused is not None
    assert refused.span == Span(0, 3)


def test_hints_are_no_reason_to_refuse() -> None:
    assert_formats('include  "a\\d"\n', 'include "a\\d"\n')


def test_the_authors_example_says_the_same(shared: Path) -> None:
    text = (shared / "original" / "paper_example.qualitybtcpp").read_bytes().decode()
    done = format_text(text)
    assert done.refused is None
    assert said(done.text) == said(text)
    assert format_text(done.text) == Formatted(done.text)
    lines = done.text.splitlines()
    assert "\t" not in "".join(line[: len(line) - len(line.lstrip())] for line in lines if "FailureIf" not in line)
    assert [line for line in lines if line.strip() == ")"] == [
        " " * 20 + ")", " " * 16 + ")", " " * 16 + ")", " " * 28 + ")",
    ]  # fmt: skip
    assert places(done.text) == places(text) == []


# ---- edits ----------------------------------------------------------------------------------------------------------


def test_edits_are_gaps() -> None:
    text = "signal a:s\nsignal b : s\nBehaviorTree A\n  Foo  (a = 1)\n"
    assert format_text(text).edits == (
        Edit(Span(8, 8), " "),
        Edit(Span(9, 9), " "),
        Edit(Span(24, 24), "\n"),
        Edit(Span(41, 41), "  "),
        Edit(Span(45, 46), ""),
    )


def test_edits_do_not_cut_a_line_end_in_two() -> None:
    assert format_text("# a\nRoot A\r\n").edits == (Edit(Span(10, 12), "\n"),)
    assert format_text("# a\r\nRoot A\n").edits == (Edit(Span(11, 12), "\r\n"),)


RANGE = """\
signal a  : s
BehaviorTree A
    ->
        Foo  (a = 1)
        Bar  (a = 1)
BehaviorTree B
  ->
    Foo  (a = 1)
    Bar  (a = 1)
"""


def test_a_range_takes_the_lines_it_touches() -> None:
    at = RANGE.index("Foo")
    assert format_range(RANGE, at, at) == (Edit(Span(at + 4, at + 5), ""),)
    assert format_range(RANGE, at, at + 21) == (Edit(Span(at + 4, at + 5), ""), Edit(Span(at + 25, at + 26), ""))
    assert format_range(RANGE, 0, len(RANGE)) == format_text(RANGE).edits
    assert format_range("Root A  ", 8, 8) == (Edit(Span(6, 8), "\n"),)


def test_a_range_takes_all_lines_where_they_end_as_on_old_machines() -> None:
    text = "signal a:s\r\rsignal b:s\r"
    assert format_range(text, 0, 0) == format_text(text).edits != ()


def test_a_range_takes_the_whole_block_where_other_lines_would_not_fit_to_it() -> None:
    at = RANGE.rindex("Foo")
    formatted = apply_edits(RANGE, format_range(RANGE, at, at))
    assert formatted == RANGE[: RANGE.index("BehaviorTree B")] + (
        "\nBehaviorTree B\n    ->\n        Foo (a = 1)\n        Bar (a = 1)\n"
    )


def test_scenarios() -> None:
    assert_formats(
        """
        given   MoveTo takes 20s
        scenario "S"   of Deliver  # a
            # b
            given Low answers false,true
            when  Deliver / Dock(a=1) fails for the 2 time :mission halts  # c
            when battery<3% : {x}=2
            expect MoveTo( a = 1,b ) runs "A",{x}
        scenario "T"
            expect succeeds
        """,
        """
        given MoveTo takes 20 s

        scenario "S" of Deliver  # a
            # b
            given Low answers false, true
            when Deliver/Dock (a = 1) fails for the 2 time: mission halts  # c
            when battery < 3 %: {x} = 2
            expect MoveTo (a = 1, b) runs "A", {x}

        scenario "T"
            expect succeeds
        """,
    )
