"""The code frames, to the letter."""

from __future__ import annotations

import pytest

from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.render import Finding, Report, render, with_paths
from btq_lang.util.text import Span

MISSION = """\
BehaviorTree mainTree
    R?
        Rety (num_attempts = 6)
            MoveBase (station = "solid")
        Charge
"""


def span(text: str, piece: str) -> Span:
    start = text.index(piece)
    return Span(start, start + len(piece))


def full(
    text: str,
    *diagnostics: Diagnostic,
    texts: dict[str, str] | None = None,
    colour: bool = False,
    width: int = 120,
) -> str:
    report = Report(tuple(Finding("lab.btq", text, one) for one in diagnostics), texts or {}, ("lab.btq",))
    return "".join(render("full", report, colour=colour, width=width))


def frame_of(text: str, piece: Span, width: int = 120) -> str:
    """The rows between the place and the summary."""
    block = full(text, Diagnostic("unknown-node", piece, "message"), width=width)
    lines = block.split("\n\n")[0].splitlines()
    return "\n".join(lines[2:])


def test_a_frame_with_its_neighbours_a_note_and_a_fix() -> None:
    fix = replace_fix("replace `Rety` by `Retry`", span(MISSION, "Rety"), "Retry", safe=True)
    diagnostic = Diagnostic(
        "unknown-node", span(MISSION, "Rety"), "no node `Rety` is known", notes=("models count\nas well",), fixes=(fix,)
    )
    assert (
        full(MISSION, diagnostic)
        == """\
warning[unknown-node]: no node `Rety` is known
 --> lab.btq:3:9
  |
2 |     R?
3 |         Rety (num_attempts = 6)
  |         ^^^^
4 |             MoveBase (station = "solid")
  |
  = note: models count
          as well
  = help: replace `Rety` by `Retry` (--fix)

Found 1 warning (1 fixable with --fix)
"""
    )


def test_related_places_have_frames_of_their_own_also_in_other_files() -> None:
    other = "# skills\n" * 9 + "Action Charge\n"
    diagnostic = Diagnostic(
        "duplicate-definition",
        span(MISSION, "Charge"),
        "two definitions of `Charge`",
        related=(
            Related(Place(span(MISSION, "mainTree")), "in this tree"),
            Related(Place(span(other, "Charge"), "skills.btq"), "the first one"),
            Related(Place(Span(0, 1), "lost.btq"), "and one in a file nobody has"),
        ),
        fixes=(Fix("remove it", ()),),
    )
    assert (
        full(MISSION, diagnostic, texts={"skills.btq": other})
        == """\
error[duplicate-definition]: two definitions of `Charge`
  --> lab.btq:5:9
   |
 4 |             MoveBase (station = "solid")
 5 |         Charge
   |         ^^^^^^
   |
note: in this tree
  --> lab.btq:1:14
   |
 1 | BehaviorTree mainTree
   |              --------
 2 |     R?
note: the first one
  --> skills.btq:10:8
   |
 9 | # skills
10 | Action Charge
   |        ------
note: and one in a file nobody has
  --> lost.btq
   |
   = help: remove it

Found 1 error
"""
    )


def test_a_span_over_lines_that_begins_within_a_line() -> None:
    text = 'a\n  b "one\ntwo\nthree" c\nd\n'
    assert (
        frame_of(text, span(text, '"one\ntwo\nthree"'))
        == """\
  |
1 |   a
2 |     b "one
  |  _____^
3 | | two
4 | | three" c
  | |______^
5 |   d"""
    )


def test_a_span_over_lines_that_begins_with_its_line() -> None:
    assert (
        frame_of(MISSION, span(MISSION, MISSION[MISSION.index("Rety") : MISSION.index("Charge") + 6]))
        == """\
  |
2 |       R?
3 | /         Rety (num_attempts = 6)
4 | |             MoveBase (station = "solid")
5 | |         Charge
  | |______________^"""
    )


def test_a_long_span_is_shortened_in_its_middle() -> None:
    text = "".join(f"line {number}\n" for number in range(1, 21))
    assert (
        frame_of(text, Span(0, len(text)))
        == """\
   |
 1 | / line 1
 2 | | line 2
 3 | | line 3
 4 | | line 4
   | | ...
19 | | line 19
20 | | line 20
   | |________^"""
    )
    seven = text[: text.index("line 8")]
    assert "..." not in frame_of(seven, Span(0, len(seven)))


@pytest.mark.parametrize(
    ("text", "at", "expected"),
    [
        ("", Span(0, 0), "  |\n1 |\n  | ^"),
        ("ab", Span(2, 2), "  |\n1 | ab\n  |   ^"),
        ("ab\n", Span(3, 3), "  |\n1 | ab\n2 |\n  | ^"),
        ("ab\r\ncd", Span(2, 4), "  |\n1 | ab\n  |   ^\n2 | cd"),
        ("ab\n", Span(0, 3), "  |\n1 | ab\n  | ^^^"),
        ("ab", Span(7, 9), "  |\n1 | ab\n  |   ^"),
        ("ab", Span(-4, 1), "  |\n1 | ab\n  | ^"),
        ("ab", Span(1, 0), "  |\n1 | ab\n  |  ^"),
    ],
    ids=["empty text", "end", "last line", "line end", "with its line end", "beyond", "before", "reversed"],
)
def test_spans_at_the_edges(text: str, at: Span, expected: str) -> None:
    assert frame_of(text, at) == expected


@pytest.mark.parametrize(
    ("text", "piece", "expected"),
    [
        ("\tx", "x", "  |\n1 |     x\n  |     ^"),
        ("ab\tx", "x", "  |\n1 | ab  x\n  |     ^"),
        ("a\tx", "\t", "  |\n1 | a   x\n  |  ^^^"),
        ('"日本" x', "x", '  |\n1 | "日本" x\n  |        ^'),
        ("日本 x", "本", "  |\n1 | 日本 x\n  |   ^^"),
        ("e\u0301 x", "x", "  |\n1 | e\u0301 x\n  |   ^"),
        ("e\u0301 x", "\u0301", "  |\n1 | e\u0301 x\n  | ^"),
        ("🤖 x", "x", "  |\n1 | 🤖 x\n  |    ^"),
        ("한\u1161 x", "x", "  |\n1 | 한\u1161 x\n  |    ^"),
        ("a\x1b[31m x", "x", "  |\n1 | a␛[31m x\n  |        ^"),
        ("a\u202eb x", "x", "  |\n1 | a\ufffdb x\n  |     ^"),
        ("a\fb", "b", "  |\n1 | a␌b\n  |   ^"),
    ],
    ids=["tab", "tab stop", "in a tab", "wide", "on wide", "combining", "on combining", "emoji", "hangul", "escape",
         "bidi", "form feed"],
)  # fmt: skip
def test_marks_stand_below_what_they_mark(text: str, piece: str, expected: str) -> None:
    assert frame_of(text, span(text, piece)) == expected


def test_a_long_line_is_cut_around_the_span() -> None:
    text = "a" * 100 + " Rety " + "b" * 100
    assert (
        frame_of(text, span(text, "Rety"), width=40)
        == """\
  |
1 | …aaaaaaaaaaaaaa Rety bbbbbbbbbbbbbb…
  |                 ^^^^"""
    )
    assert (
        frame_of(text, Span(0, 3), width=40)
        == f"""\
  |
1 | {"a" * 34}…
  | ^^^"""
    )
    assert (
        frame_of(text, Span(len(text) - 2, len(text)), width=40)
        == f"""\
  |
1 | …{"b" * 34}
  | {" " * 33}^^"""
    )
    assert (
        frame_of(text, Span(50, len(text)), width=40)
        == f"""\
  |
1 | …{"a" * 34}…
  |  {"^" * 34}"""
    )


def test_a_cut_through_a_wide_character_leaves_a_blank() -> None:
    text = "x" + "日" * 40 + "Rety"
    assert (
        frame_of(text, span(text, "Rety"), width=30)
        == f"""\
  |
1 | …{"日" * 10}Rety
  | {" " * 21}^^^^"""
    )
    assert (
        frame_of("y" + text, span("y" + text, "Rety"), width=31)
        == f"""\
  |
1 | … {"日" * 10}Rety
  | {" " * 22}^^^^"""
    )


def test_neighbours_of_a_cut_line_are_cut_alike() -> None:
    text = "b" * 150 + "\n" + "a" * 100 + " Rety\nshort\n"
    assert (
        frame_of(text, span(text, "Rety"), width=30)
        == f"""\
  |
1 | …{"b" * 24}…
2 | …{"a" * 19} Rety
  | {" " * 21}^^^^
3 | …"""
    )


@pytest.mark.parametrize(
    ("fix", "expected"),
    [
        (
            Fix("rename", (FixEdit(Place(Span(13, 21)), "main"), FixEdit(Place(Span(0, 4), "other.btq"), "MAIN"))),
            "rename\n1 - BehaviorTree mainTree\n1 + BehaviorTree main\n ::: other.btq\n1 - main\n1 + MAIN\n",
        ),
        (
            Fix("remove", (FixEdit(Place(span(MISSION, "        Charge\n")), ""),)),
            "remove\n5 -         Charge\n",
        ),
        (
            Fix(
                "wrap",
                (
                    FixEdit(Place(span(MISSION, "    R?")), "    Inverter\n        R?"),
                    FixEdit(Place(span(MISSION, "Charge")), "Recharge"),
                ),
            ),
            "wrap\n2 -     R?\n2 +     Inverter\n3 +         R?\n5 -         Charge\n6 +         Recharge\n",
        ),
        (
            Fix(
                "two on one line", (FixEdit(Place(span(MISSION, "6")), "7"), FixEdit(Place(span(MISSION, "Rety")), "X"))
            ),
            "two on one line\n3 -         Rety (num_attempts = 6)\n3 +         X (num_attempts = 7)\n",
        ),
        (
            Fix("impossible", (FixEdit(Place(Span(0, 4)), ""), FixEdit(Place(Span(2, 6)), ""))),
            "impossible\n",
        ),
        (
            Fix("long", (FixEdit(Place(Span(0, 0)), "x\n" * 40),)),
            "long\n" + "".join(f"{n:>2} + x\n" for n in range(1, 12)) + "   | ... 29 more lines\n",
        ),
        (Fix("elsewhere", (FixEdit(Place(Span(0, 1), "lost.btq"), ""),)), "elsewhere\n ::: lost.btq\n"),
    ],
    ids=lambda value: value.title if isinstance(value, Fix) else "",
)
def test_a_fix_that_its_title_does_not_tell_is_shown_as_a_diff(fix: Fix, expected: str) -> None:
    shown = full(MISSION, Diagnostic("unknown-node", Span(0, 1), "m", fixes=(fix,)), texts={"other.btq": "main\n"})
    assert shown.partition("= help: ")[2].rpartition("\n\n")[0] + "\n" == expected


def test_colours_only_where_asked_for() -> None:
    diagnostic = Diagnostic(
        "unknown-node", span(MISSION, "Rety"), "m", fixes=(Fix("x", (FixEdit(Place(Span(0, 0)), "y"),)),)
    )
    assert "\x1b" not in full(MISSION, diagnostic)
    coloured = full(MISSION, diagnostic, colour=True)
    assert coloured.startswith(
        "\x1b[1;33mwarning[unknown-node]\x1b[0m\x1b[1m: m\x1b[0m\n \x1b[1;34m-->\x1b[0m lab.btq:3:9\n"
    )
    assert "\x1b[1;34m  |\x1b[0m         \x1b[1;33m^^^^\x1b[0m\n" in coloured
    assert "\x1b[1;34m1\x1b[0m \x1b[32m+ yBehaviorTree mainTree\x1b[0m\n" in coloured


def test_severities_and_their_sum() -> None:
    diagnostics = [Diagnostic("unknown-node", Span(0, 1), "m", severity=severity) for severity in Severity]
    shown = full("x", *diagnostics, diagnostics[0])
    assert [line.split(":")[0] for line in shown.splitlines() if "[unknown-node]" in line] == [
        f"{word}[unknown-node]" for word in ("error", "warning", "info", "hint", "error")
    ]
    assert shown.endswith("\n\nFound 2 errors, 1 warning, 1 info message, 1 hint\n")


def test_nothing_found() -> None:
    assert full("x") == "No problems found in 1 file\n"
    assert "".join(render("full", Report((), {}, ("a", "b")))) == "No problems found in 2 files\n"


def test_messages_and_paths_cannot_command_the_terminal() -> None:
    diagnostic = Diagnostic("unknown-node", Span(0, 1), "a\nb\x1b]0;x\x07", notes=("\x9b1m",))
    report = Report((Finding("l\x1b[2Jab\n.btq", "x", diagnostic),), {}, ())
    assert "".join(render("full", report)).splitlines()[:2] == [
        "warning[unknown-node]: a␊b␛]0;x␇",
        " --> l␛[2Jab␊.btq:1:1",
    ]
    assert "= note: \ufffd1m\n" in "".join(render("full", report))


def test_paths_are_shown_as_asked() -> None:
    place, other = Place(Span(0, 1)), Place(Span(0, 1), "/p/other.btq")
    diagnostic = Diagnostic(
        "unknown-node",
        Span(0, 1),
        "m",
        related=(Related(other, "r"),),
        fixes=(Fix("f", (FixEdit(place, ""), FixEdit(other, ""))),),
    )
    plain = Diagnostic("unused-tree", Span(0, 1), "m")
    report = Report(
        (Finding("/p/lab.btq", "x", diagnostic), Finding("/p/lab.btq", "x", plain)),
        {"/p/other.btq": "y"},
        ("/p/lab.btq",),
    )
    shown = with_paths(report, lambda path: path.removeprefix("/p/"))
    assert [finding.path for finding in shown.findings] == ["lab.btq", "lab.btq"]
    assert shown.findings[0].diagnostic.related[0].place.path == "other.btq"
    assert [change.place.path for change in shown.findings[0].diagnostic.fixes[0].changes] == [None, "other.btq"]
    assert shown.findings[1].diagnostic is plain
    assert (shown.texts, shown.checked) == ({"other.btq": "y"}, ("lab.btq",))


def test_an_unknown_format_is_refused() -> None:
    known = "full, concise, json, sarif, github, gitlab, junit"
    with pytest.raises(ValueError, match=f"unknown format 'xml'; expected one of {known}"):
        render("xml", Report((), {}))
