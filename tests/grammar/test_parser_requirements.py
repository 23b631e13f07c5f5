"""Requirements, their clauses and conditions, language.md §3: each production as it should be, and broken."""

from __future__ import annotations

import pytest
from syntax_asserts import assert_fix, assert_parse

from btq_lang.parser import parse

COMPARISONS = ("<=", "<", ">=", ">", "==", "!=")
USES = "this clause is written `uses at most 3 Wh of <signal>`"
END = "found the end of the line"
A_CLAUSE = "a clause: takes, keeps, in at least, on violation, …"
A_BOUND = "a bound: at most, at least, less than, more than or between"
A_VERB = "a verb: takes, succeeds, needs, keeps, …"
A_CONDITION = "a condition: a signal, a context, a value, …"
A_VALUE = "a value with its unit: 30 s"


def assert_clause(clause: str, shown: str, *problems: str) -> None:
    """One clause, in a requirement's block between two others; the columns of problems count from the clause."""
    moved = [f"3:{int(problem[2:].split(' ', 1)[0]) + 4} {problem.split(' ', 1)[1]}" for problem in problems]
    text = f"QualityReq a\n    never b\n    {clause}\n    never c\n"
    block = "".join(f"\n  {line}" for line in ("never b", *([shown] if shown else []), "never c"))
    assert_parse(text, f"requirement a{block}", *moved)


def assert_condition(condition: str, shown: str, *problems: str) -> None:
    """One condition, of a context; the columns of problems count from the condition."""
    moved = [f"1:{int(problem[2:].split(' ', 1)[0]) + 12} {problem.split(' ', 1)[1]}" for problem in problems]
    assert_parse(f"context a : {condition}\nsignal z : m", f"context a : {shown}\nsignal z : m", *moved)


# ---- ReqItem, ReqHead, Params ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("QualityReq a", "requirement a"),
        ("QualityReq 'a b'", "requirement 'a b'"),
        ("QualityReq a 'title'", "requirement a 'title'"),
        ("QualityReq a : b", "requirement a : b"),
        ("QualityReq a : performance <time-behaviour> 'title'", "requirement a : performance.time-behaviour 'title'"),
        ("QualityReq a : b.c 'title' keeps d", "requirement a : b.c 'title'\n  keeps d"),
        ("QualityReq a : b 'title' 'a node' keeps d", "requirement a : b 'title'\n  <'a node'> keeps d"),
        ("QualityReq a keeps b never c", "requirement a\n  keeps b\n  never c"),
        ("QualityReq a(b : m)", "requirement a(b : m)"),
        (
            "QualityReq a (b : m/s = 0.25 m/s, c : 1/s, d : % = 3 %) : e",
            "requirement a(b : m/s = 0.25m/s, c : 1/s, d : % = 3%) : e",
        ),
        ("QualityReq a(b : s = 20 s if near else 30 s)", "requirement a(b : s = [20s if near, 30s else])"),
        ("QualityReq a(b : bool = true, c : 1 = -5)", "requirement a(b : bool = true, c : 1 = -5)"),
        ("QualityReq ID", "requirement ID"),
        ("QualityReq ID : a", "requirement ID : a"),
        ("QualityReq description", "requirement description"),
        ("QualityReq ID = a", "requirement classic a"),
        ("QualityReq ID = 'a' description = 'b'", "requirement classic 'a' 'b'"),
        ("QualityReq ID = 'a', description = b", "requirement classic 'a' b"),
        ("QualityReq ID = 'a' description = 'b' keeps c", "requirement classic 'a' 'b'\n  keeps c"),
        ("QualityReq ID = 'a' keeps c", "requirement classic 'a'\n  keeps c"),
    ],
)
def test_requirement(text: str, tree: str) -> None:
    assert_parse(text, tree)
    assert_parse(f"{text}\n  never z\n", f"{tree}\n  never z")


def test_a_requirement_that_says_nothing_is_a_reference() -> None:
    said = [
        ("QualityReq a", True),
        ("QualityReq ID = a", True),
        ("QualityReq a 'b'", False),
        ("QualityReq a : b", False),
        ("QualityReq a keeps b", False),
        ("QualityReq a(b : m)", False),
        ("QualityReq ID = a description = b", False),
    ]
    for text, reference in said:
        (entry,) = assert_parse(text).entries
        assert getattr(entry.item, "is_reference", None) is reference


def test_clauses_on_the_line_and_in_the_block() -> None:
    text = """
        QualityReq a keeps b
            # c
            never d while e

            on violation fail because "f"
        signal z : m
    """
    tree = """
        requirement a
          keeps b
          never d
          while e
          on violation fail
          because "f"
        signal z : m
    """
    assert_parse(text, tree)


@pytest.mark.parametrize(
    ("text", "tree", "problem"),
    [
        ("QualityReq", "MISSING", f"1:11 syntax-error «» expected the requirement's ID, {END}"),
        ("QualityReq : a", "MISSING", "1:12 syntax-error «:» expected the requirement's ID, found `:`"),
        ("QualityReq a :", "a", f"1:15 syntax-error «» expected a quality, {END}"),
        ("QualityReq a 'b' : c", "a : c 'b'", "1:18 syntax-error «:» a requirement's quality goes before its title"),
        (
            "QualityReq a 'b' 'c'",
            "a 'b'",
            f"1:21 syntax-error «» expected a verb after `'c'` (takes, succeeds, needs, keeps, …), {END}",
        ),
        (
            "QualityReq a b",
            "a b",
            "1:14 syntax-error «b» a title goes in quotes, and a quality goes after `:`",
        ),
        ("QualityReq ID =", "classic MISSING", f"1:16 syntax-error «» expected the requirement's ID, {END}"),
        ("QualityReq ID = a description =", "classic a", f"1:32 syntax-error «» expected the description, {END}"),
        ("QualityReq ID = a, b", "classic a", "1:18 syntax-error «,» expected the end of the line, found `,`"),
        ("QualityReq a()", "a", "1:14 syntax-error «)» expected a parameter's name, found `)`"),
        ("QualityReq a(b)", "a(b : MISSING)", "1:15 syntax-error «)» expected `:`, found `)`"),
        (
            "QualityReq a(b :)",
            "a(b : MISSING)",
            "1:17 syntax-error «)» expected a unit: s, m/s, %, 1, bool, text, …, found `)`",
        ),
        ("QualityReq a(b : m =)", "a(b : m)", f"1:21 syntax-error «)» expected {A_VALUE}, found `)`"),
        (
            "QualityReq a(b : foot/sek)",
            "a(b : foot/sek)",
            "1:18 unknown-unit «foot/sek» unknown unit `foot/sek`; did you mean `ft/s`?",
        ),
        ("QualityReq a(b : m c : s)", "a(b : m)", "1:20 syntax-error «c» expected `,` or `)`, found `c`"),
        ("QualityReq a(b : m,)", "a(b : m)", "1:20 syntax-error «)» expected a parameter's name, found `)`"),
    ],
)
def test_broken_requirement(text: str, tree: str, problem: str) -> None:
    assert_parse(f"{text}\n  keeps z\nsignal z : m", f"requirement {tree}\n  keeps z\nsignal z : m", problem)


# ---- Claim: [ Subject ] Verb ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("clause", "shown"),
    [
        ("takes at most 30 s", "takes <= 30s"),
        ("takes at least 30 s", "takes >= 30s"),
        ("takes less than 30 s", "takes < 30s"),
        ("takes more than 30 s", "takes > 30s"),
        ("takes between 0.2 s and 1 s", "takes between 0.2s 1s"),
        ("takes between -1 and limit", "takes between -1 limit"),
        ("takes at most limit", "takes <= limit"),
        ("takes at most - 5 s", "takes <= -5s"),
        ("takes at most 20 s if not near else 30 s", "takes <= [20s if (not near), 30s else]"),
        (
            "takes at most 20 s if a > 3 and b, 5 s if c else limit",
            "takes <= [20s if (and (a > 3) b), 5s if c, limit else]",
        ),
        ("succeeds", "succeeds"),
        ("succeeds within 30 s", "succeeds <= 30s"),
        ("succeeds within 30 s if a else 3 s", "succeeds <= [30s if a, 3s else]"),
        ("needs battery > 3 %", "needs (battery > 3%)"),
        ("keeps a", "keeps a"),
        ("never a", "never a"),
        ("leaves 3 N <= force <= 8 N", "leaves (3N <= force <= 8N)"),
        ("uses at most 50 Wh of energy", "uses <= 50Wh of energy"),
        ("uses between 1 Wh and 2 Wh of energy", "uses between 1Wh 2Wh of energy"),
        ("tries at most 3", "tries <= 3"),
        ("tries at most 3 per a/b", "tries <= 3 per a/b"),
        ("tries at most 3 per run", "tries <= 3 per run"),
        ("succeeds at least 12 per run", "succeeds >= 12 per run"),
        ("starts between 1 and 3 per 'run'", "starts between 1 3 per 'run'"),
        ("fails at most 1 per 200 h", "fails <= 1 per 200h"),
        ("fails less than 0.5 per 1 d of a/b", "fails < 0.5 per 1d of a/b"),
        ("fails at most 3 if a else 1 per run", "fails <= [3 if a, 1 else] per run"),
        ("runs every 5 s", "runs every <= 5s"),
        ("runs at least 1 per 1 s", "runs >= 1 per 1s"),
        ("starts within 2 s after a succeeds", "starts <= 2s after a succeeds"),
        ("ends within 2 s after mission starts", "ends <= 2s after (mission) starts"),
        ("ends within 2 s after when a > 3", "ends <= 2s after when (a > 3)"),
        ("follows a/b fails", "follows a/b fails"),
        ("follows when a", "follows when a"),
        ("follows 'mission' halts", "follows 'mission' halts"),
        ("follows mission finishes", "follows (mission) finishes"),
        ("follows a/b fails or c fails", "follows a/b fails or c fails"),
        ("follows or succeeds or 'or' fails", "follows or succeeds or 'or' fails"),
        (
            "starts within 2 s after mission starts or a fails or when b or c",
            "starts <= 2s after (mission) starts or a fails or when (or b c)",
        ),
    ],
)
def test_verb(clause: str, shown: str) -> None:
    assert_clause(clause, shown)
    assert_clause(f"X/Y {clause} goal 1", f"<X/Y> {shown}\n  goal 1")
    assert_parse(f"BehaviorTree t\n  X (satisfies QualityReq a {clause}, b = 1)",
                 f"tree t\n  X (b=1)\n    satisfies {{a; {shown}}}")  # fmt: skip


@pytest.mark.parametrize(
    ("subject", "shown"),
    [
        ("MoveBase", "MoveBase"),
        ("'Move base'", "'Move base'"),
        ("a/'b c'/d", "a/'b c'/d"),
        ("a / b", "a/b"),
        ("mission", "mission"),
        ("'mission'", "'mission'"),
        ("every MoveBase", "every MoveBase"),
        ("every 'node'", "every 'node'"),
        ("from a starts to b succeeds", "from a starts to b succeeds"),
        ("from when a > 3 to mission finishes", "from when (a > 3) to (mission) finishes"),
        ("from a starts or b starts to c fails or when d", "from a starts or b starts to c fails or when d"),
        ("sum of a, b/c, d", "sum of a, b/c, d"),
        ("at", "at"),
        ("'on'", "'on'"),
        ("'takes'", "'takes'"),
        ("starts-here", "starts-here"),
    ],
)
def test_subject(subject: str, shown: str) -> None:
    assert_clause(f"{subject} takes at most 3 s", f"<{shown}> takes <= 3s")
    assert_clause(f"{subject} keeps a", f"<{shown}> keeps a")


@pytest.mark.parametrize(
    ("clause", "shown"),
    [
        ("each a fails is followed by b starts", "<each a fails> followed b starts"),
        ("each a/b fails is followed by 'c d'/e starts within 2 s", "<each a/b fails> followed <= 2s 'c d'/e starts"),
        (
            "each a fails or b fails is followed by c starts or when d",
            "<each a fails or b fails> followed c starts or when d",
        ),
        ("each when a > 3 is followed by b within 2 s", "<each when (a > 3)> followed <= 2s b"),
        ("each when a is followed by when b < 3 m within 2 s", "<each when a> followed <= 2s when (b < 3m)"),
        (
            "each mission starts is followed by a < 3 m and (b or node c) within 2 s if d else 3 s goal 1 s",
            "<each (mission) starts> followed <= [2s if d, 3s else] (and (a < 3m) (or b (node c)))\n  goal 1",
        ),
        ("each a fails is followed by b on violation warn", "<each a fails> followed b\n  on violation warn"),
        ("each a fails is followed by b starts takes at most 3 s", "<each a fails> followed b starts\n  takes <= 3s"),
        # The verb of another clause, and no event.
        (
            "each a fails is followed by b starts within 2 s after c succeeds",
            "<each a fails> followed b\n  starts <= 2s after c succeeds",
        ),
        ("each each starts is followed by followed starts", "<each each starts> followed followed starts"),
        ("each 'is' starts is followed by is within 3 s", "<each 'is' starts> followed <= 3s is"),
    ],
)
def test_what_follows_an_event(clause: str, shown: str) -> None:
    assert_clause(clause, shown.replace("goal 1", "goal 1s"))


@pytest.mark.parametrize(
    ("clause", "shown"),
    [
        ("keeps a from b starts until c succeeds", "keeps a\n  from b starts until c succeeds"),
        ("from when a > 3 or b until mission finishes", "from when (or (a > 3) b) until (mission) finishes"),
        ("from a starts or b/c fails until d fails or when e", "from a starts or b/c fails until d fails or when e"),
        ("from until starts until until fails", "from until starts until until fails"),
        ("from to starts until to fails", "from to starts until to fails"),
        ("from when to until until starts", "from when to until until starts"),
        ("from until starts to b succeeds takes at most 3 s", "<from until starts to b succeeds> takes <= 3s"),
        ("from a starts until b fails in at least 3 % of runs", "from a starts until b fails\n  odds >= 3% of runs"),
    ],
)
def test_from_an_event_until_another(clause: str, shown: str) -> None:
    assert_clause(clause, shown)


@pytest.mark.parametrize("word", ["each", "is", "followed", "occurrences", "until"])
def test_words_of_later_versions_are_names(word: str) -> None:
    assert_clause(f"{word} takes at most 3 s", f"<{word}> takes <= 3s")
    assert_clause(f"follows {word} succeeds", f"follows {word} succeeds")
    assert_clause(f"keeps {word}", f"keeps {word}")
    assert_parse(f"BehaviorTree {word}\n  {word}", f"tree {word}\n  {word}")


@pytest.mark.parametrize("verb", ["starts", "succeeds", "keeps", "takes"])
def test_a_verb_is_no_subject_without_quotes(verb: str) -> None:
    assert_clause(f"'{verb}' keeps a", f"<'{verb}'> keeps a")


@pytest.mark.parametrize(
    ("clause", "shown", "problem"),
    [
        (
            "takes",
            "takes MISSING",
            f"1:6 syntax-error «» expected a bound: at most, at least, less than, more than or between, {END}",
        ),
        (
            "takes 30 s",
            "takes MISSING",
            f"1:7 syntax-error «30 s» expected {A_BOUND}, found `30 s`",
        ),
        (
            "takes at 30 s",
            "takes MISSING",
            "1:7 syntax-error «at» expected a bound: at most, at least, less than, more than or between, found `at`",
        ),
        ("takes at most", "takes <= MISSING", f"1:14 syntax-error «» expected {A_VALUE}, {END}"),
        ("takes at most '3'", "takes <= MISSING", f"1:15 syntax-error «'3'» expected {A_VALUE}, found `'3'`"),
        ("takes at most {a}", "takes <= MISSING", f"1:15 syntax-error «{{a}}» expected {A_VALUE}, found `{{a}}`"),
        ("takes at most -a", "takes <= MISSING", f"1:16 syntax-error «a» expected {A_VALUE}, found `a`"),
        ("takes at most 30 sek", "takes <= 30", "1:18 unknown-unit «sek» unknown unit `sek`; did you mean `s`?"),
        ("takes at most 30 m/sek", "takes <= 30m", "1:18 unknown-unit «m/sek» unknown unit `m/sek`"),
        ("takes between 3 s", "takes between 3s MISSING", f"1:18 syntax-error «» expected `and`, {END}"),
        ("takes between 3 s or 4 s", "takes between 3s MISSING", "1:19 syntax-error «or» expected `and`, found `or`"),
        ("takes at most 3 s if", "takes <= [3s if MISSING]", f"1:21 syntax-error «» expected {A_CONDITION}, {END}"),
        ("takes at most 3 s if a", "takes <= [3s if a]", f"1:23 syntax-error «» expected `else`, {END}"),
        (
            "takes at most 3 s if a, 4 s",
            "takes <= [3s if a]",
            f"1:28 syntax-error «» expected `if` and a condition, or `else` instead of the comma, {END}",
        ),
        ("takes at most 3 s if a else", "takes <= [3s if a]", f"1:28 syntax-error «» expected {A_VALUE}, {END}"),
        ("succeeds within", "succeeds <= MISSING", f"1:16 syntax-error «» expected {A_VALUE}, {END}"),
        ("needs", "needs MISSING", f"1:6 syntax-error «» expected {A_CONDITION}, {END}"),
        ("keeps on violation fail", "keeps MISSING", f"1:7 syntax-error «on» expected {A_CONDITION}, found `on`"),
        ("keeps in at least 3 % of runs", "keeps MISSING", f"1:7 syntax-error «in» expected {A_CONDITION}, found `in`"),
        ("uses at most 3 Wh", "uses <= 3Wh of MISSING", f"1:1 syntax-error «uses at most 3 Wh» {USES}"),
        ("uses at most 3 Wh of", "uses <= 3Wh of MISSING", f"1:1 syntax-error «uses at most 3 Wh of» {USES}"),
        (
            "uses at most 3 Wh of 'a'",
            "uses <= 3Wh of MISSING",
            "1:22 syntax-error «'a'» expected a signal, found `'a'`",
        ),
        ("tries at most 3 per", "tries <= 3", f"1:20 syntax-error «» expected `run`, or a node, {END}"),
        (
            "succeeds at least 3 per 200 s",
            "succeeds >= 3 per MISSING",
            "1:25 syntax-error «200 s» expected `run`, or a node, found `200 s`",
        ),
        ("fails at most 3 per 200 h of", "fails <= 3 per 200h", f"1:29 syntax-error «» expected a node, {END}"),
        (
            "fails at most 3",
            "fails <= 3 per MISSING",
            f"1:16 syntax-error «» expected `per`, and `run` or a node, {END}",
        ),
        (
            "runs",
            "runs MISSING per MISSING",
            f"1:5 syntax-error «» expected a bound: at most, at least, less than, more than or between, {END}",
        ),
        ("runs every", "runs every <= MISSING", f"1:11 syntax-error «» expected {A_VALUE}, {END}"),
        ("runs at least 3", "runs >= 3 per MISSING", f"1:16 syntax-error «» expected `per` and a time, {END}"),
        ("runs at least 3 per 3", "runs >= 3 per MISSING", "1:21 syntax-error «3» expected a duration: 1 s, found `3`"),
        (
            "starts after a succeeds",
            "starts MISSING after MISSING",
            "1:1 syntax-error «starts after a succeeds» this clause is written `follows a succeeds`",
        ),
        ("starts within 3 s", "starts <= 3s after MISSING", f"1:18 syntax-error «» expected `after`, {END}"),
        (
            "starts within 3 s after",
            "starts <= 3s after MISSING",
            f"1:24 syntax-error «» expected an event: a node and what happens to it, {END}",
        ),
        (
            "starts within 3 s after a",
            "starts <= 3s after MISSING",
            f"1:26 syntax-error «» expected starts, succeeds, fails, finishes or halts, {END}",
        ),
        (
            "follows a begins",
            "follows MISSING",
            "1:11 syntax-error «begins» expected starts, succeeds, fails, finishes or halts, found `begins`",
        ),
        (
            "follows a or b fails",
            "follows MISSING",
            "1:11 syntax-error «or» expected starts, succeeds, fails, finishes or halts, found `or`",
        ),
        (
            "follows a fails or",
            "follows a fails or MISSING",
            f"1:19 syntax-error «» expected an event: a node and what happens to it, {END}",
        ),
        (
            "follows a fails || b fails",
            "follows a fails or b fails",
            "1:17 syntax-error «||» in conditions `||` is written `or`",
        ),
        (
            "every a fails is followed by b starts",
            "<each a fails> followed b starts",
            "1:1 syntax-error «every» all occurrences of an event are written `each …`",
        ),
        (
            "a fails is followed by b starts",
            "",
            "1:3 syntax-error «fails» expected `each` before `a fails`",
        ),
        (
            "each a fails must be followed by b starts",
            "<each a fails> followed b starts",
            "1:14 syntax-error «must be followed by» this is written `is followed by`",
        ),
        (
            "each a fails followed by b starts",
            "<each a fails> followed b starts",
            "1:14 syntax-error «followed by» this is written `is followed by`",
        ),
        (
            "each a is followed by b starts",
            "<each MISSING> followed b starts",
            "1:8 syntax-error «is» expected starts, succeeds, fails, finishes or halts, found `is`",
        ),
        (
            "each a fails is followed by",
            "<each a fails> followed",
            f"1:28 syntax-error «» expected {A_CONDITION}, {END}",
        ),
        (
            "each a fails is followed by b within",
            "<each a fails> followed <= MISSING b",
            f"1:37 syntax-error «» expected {A_VALUE}, {END}",
        ),
        (
            "whenever a fails, b starts",
            "",
            "1:1 syntax-error «whenever a fails, b starts» this clause is written "
            "`each a fails is followed by b starts`",
        ),
        (
            "after a succeeds then b starts within 3 s",
            "",
            "1:1 syntax-error «after a succeeds then b starts within 3 s» this clause is written "
            "`each a succeeds is followed by b starts within 3 s`",
        ),
        (
            "from a starts until",
            "from a starts until MISSING",
            f"1:20 syntax-error «» expected an event: a node and what happens to it, {END}",
        ),
        (
            "keeps a until b succeeds",
            "keeps a",
            "1:9 syntax-error «until b succeeds» this clause is written `from mission starts until b succeeds`",
        ),
        ("X", "", f"1:2 syntax-error «» expected a verb after `X` (takes, succeeds, needs, keeps, …), {END}"),
        ("X/", "", f"1:3 syntax-error «» expected a node, {END}"),
        (
            "X at most 3 s",
            "",
            "1:3 syntax-error «at» expected a verb after `X` (takes, succeeds, needs, keeps, …), found `at`",
        ),
        ("3 s", "", f"1:1 syntax-error «3 s» expected {A_CLAUSE}, found `3 s`"),
        ("mission", "", f"1:8 syntax-error «» expected {A_VERB}, {END}"),
        ("every takes at most 3 s", "", f"1:13 syntax-error «at» expected {A_VERB}, found `at`"),
        ("every", "", f"1:6 syntax-error «» expected a node's ID or kind, {END}"),
        ("sum a takes at most 3 s", "", "1:5 syntax-error «a» expected `of`, found `a`"),
        ("sum of takes at most 3 s", "", f"1:14 syntax-error «at» expected {A_VERB}, found `at`"),
        (
            "from a starts takes at most 3 s",
            "",
            "1:15 syntax-error «takes» expected `to`, found `takes`",
        ),
        (
            "from a to b starts",
            "",
            "1:8 syntax-error «to» expected starts, succeeds, fails, finishes or halts, found `to`",
        ),
    ],
)
def test_broken_claim(clause: str, shown: str, problem: str) -> None:
    assert_clause(clause, shown, problem)


@pytest.mark.parametrize(
    ("clause", "word", "likely"),
    [
        ("take at most 3 s", "take", "takes"),
        ("X keep a", "keep", "keeps"),
        ("X/Y suceeds", "suceeds", "succeeds"),
        ("every X takse at most 3 s", "takse", "takes"),
        ("becuase 'a'", "becuase", "because"),
        ("goals 3 s", "goals", "goal"),
        ("verfied by test", "verfied", "verified"),
    ],
)
def test_a_misspelt_clause(clause: str, word: str, likely: str) -> None:
    problem = f"1:{clause.index(word) + 1} syntax-error «{word}» unknown word `{word}`; did you mean `{likely}`?"
    assert_clause(clause, "", problem)
    text = f"QualityReq a\n    {clause}\n"
    assert_fix(text, f"Replace `{word}` with `{likely}`", text.replace(word, likely))


@pytest.mark.parametrize(
    ("clause", "shown"),
    [
        ("a succeeds less than 3 per a/b", "<a> succeeds < 3 per a/b"),
        ("mission finishes more than 0 per run", "<mission> finishes > 0 per run"),
        ("fails takes at most 3 s", "<fails> takes <= 3s"),
        ("finishes succeeds", "<finishes> succeeds"),
        ("fails/finishes fails at most 3 per fails", "<fails/finishes> fails <= 3 per fails"),
        ("run tries at most 3 per run", "<run> tries <= 3 per run"),
        ("a follows fails fails", "<a> follows fails fails"),
        ("from fails starts to a fails takes at most 3 s", "<from fails starts to a fails> takes <= 3s"),
    ],
)
def test_words_that_are_verbs_before_a_bound_alone(clause: str, shown: str) -> None:
    assert_clause(clause, shown)


# ---- the other clauses ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("clause", "shown"),
    [
        ("while a", "while a"),
        ("when a > 3 and not b", "when (and (a > 3) (not b))"),
        ("in at least 98 % of activations", "odds >= 98% of activations"),
        ("in at least 98% of runs", "odds >= 98% of runs"),
        ("with probability >= 98 %", "odds >= 98%"),
        ("with probability > 98 % of runs", "odds > 98% of runs"),
        ("on average", "on average"),
        ("in at least 98 % of time", "odds >= 98% of time"),
        ("with probability > 98 % of time", "odds > 98% of time"),
        ("confidence 95 %", "confidence 95%"),
        ("over last 200 activations", "over last 200 activations"),
        ("over last 7 runs", "over last 7 runs"),
        ("over last 7 d", "over last 7d"),
        ("on violation fail", "on violation fail"),
        ("on violation halt", "on violation halt"),
        ("on violation warn", "on violation warn"),
        ("on violation log", "on violation log"),
        ("goal 15 Wh", "goal 15Wh"),
        ("goal 15 Wh if a else 3 Wh", "goal [15Wh if a, 3Wh else]"),
        ("because 'a'", "because 'a'"),
        ("verified by monitor", "verified by monitor"),
        ("verified by analysis", "verified by analysis"),
        ("verified by test", "verified by test"),
        ("verified by review", "verified by review"),
    ],
)
def test_clause(clause: str, shown: str) -> None:
    assert_clause(clause, shown)
    assert_clause(f"{clause} {clause}", f"{shown}\n  {shown}")
    assert_parse(f"BehaviorTree t\n  X (satisfies QualityReq a {clause}, b = 1)",
                 f"tree t\n  X (b=1)\n    satisfies {{a; {shown}}}")  # fmt: skip


@pytest.mark.parametrize(
    ("clause", "shown", "problem"),
    [
        ("while", "while MISSING", f"1:6 syntax-error «» expected {A_CONDITION}, {END}"),
        ("in", "odds >= MISSING", f"1:3 syntax-error «» expected `at`, {END}"),
        (
            "in 98 % of runs",
            "odds >= 98% of runs",
            "1:4 syntax-error «98 %» a probability is written `in at least 98 %`",
        ),
        ("in at most 98 % of runs", "odds >= MISSING", "1:7 syntax-error «most» expected `least`, found `most`"),
        ("in at least 98 of runs", "odds >= MISSING", "1:13 syntax-error «98» expected a percentage: 98 %, found `98`"),
        ("in at least 98 %", "odds >= 98%", f"1:17 syntax-error «» expected `of`, {END}"),
        (
            "in at least 98 % of times",
            "odds >= 98%",
            "1:21 syntax-error «times» expected activations, runs, occurrences or time, found `times`",
        ),
        (
            "with probability 98 %",
            "odds >= 98%",
            "1:18 syntax-error «98 %» a probability is written `with probability >= 98 %`",
        ),
        ("with >= 98 %", "odds >= MISSING", "1:6 syntax-error «>=» expected `probability`, found `>=`"),
        (
            "with probability < 98 %",
            "odds >= MISSING",
            "1:18 syntax-error «<» expected `>=` or `>` and a percentage, found `<`",
        ),
        ("confidence", "confidence MISSING", f"1:11 syntax-error «» expected a percentage: 95 %, {END}"),
        ("confidence 95", "confidence MISSING", "1:12 syntax-error «95» expected a percentage: 95 %, found `95`"),
        (
            "over 200 runs",
            "over last MISSING",
            "1:1 syntax-error «over 200 runs» this clause is written `over last 200 runs`",
        ),
        (
            "over last",
            "over last MISSING",
            f"1:10 syntax-error «» expected a number of runs or activations, or a duration, {END}",
        ),
        (
            "over last 200",
            "over last 200",
            "1:1 syntax-error «over last 200» this clause is written "
            "`over last 200 activations` or `over last 200 runs`",
        ),
        ("on violation", "on violation MISSING", f"1:13 syntax-error «» expected fail, halt, warn or log, {END}"),
        (
            "on violation stop",
            "on violation MISSING",
            "1:14 syntax-error «stop» expected fail, halt, warn or log, found `stop`",
        ),
        (
            "on violation fails goal 3 s",
            "on violation MISSING\n  goal 3s",
            "1:14 syntax-error «fails» expected fail, halt, warn or log, found `fails`",
        ),
        ("on failure warn", "on violation warn", "1:4 syntax-error «failure» expected `violation`, found `failure`"),
        ("goal", "goal MISSING", f"1:5 syntax-error «» expected {A_VALUE}, {END}"),
        ("because", "because MISSING", f"1:8 syntax-error «» expected the reason in quotes, {END}"),
        ("because it moves", "because MISSING", "1:9 syntax-error «it» expected the reason in quotes, found `it`"),
        (
            "verified by",
            "verified by MISSING",
            f"1:12 syntax-error «» expected monitor, analysis, test or review, {END}",
        ),
        ("verified review", "verified by MISSING", "1:10 syntax-error «review» expected `by`, found `review`"),
    ],
)
def test_broken_clause(clause: str, shown: str, problem: str) -> None:
    assert_clause(clause, shown, problem)


@pytest.mark.parametrize(
    "head", ["in", "on", "over", "goal", "while", "when", "with", "because", "confidence", "verified"]
)
def test_a_clause_head_is_a_subject_only_in_quotes(head: str) -> None:
    assert_clause(f"'{head}' keeps a", f"<'{head}'> keeps a")


@pytest.mark.parametrize(
    ("condition", "title", "mended"),
    [
        *((f"battery {sign} 3", "Put `keeps` before it", f"keeps battery {sign} 3") for sign in COMPARISONS),
        ("time < 3 s", "Write `takes less than 3 s`", "takes less than 3 s"),
        ("time <= 3 s", "Write `takes at most 3 s`", "takes at most 3 s"),
        ("duration > 3 s", "Write `takes more than 3 s`", "takes more than 3 s"),
        ("duration >= 3 s", "Write `takes at least 3 s`", "takes at least 3 s"),
        ("time == 3 s", "Put `keeps` before it", "keeps time == 3 s"),
    ],
)
def test_a_condition_without_a_verb(condition: str, title: str, mended: str) -> None:
    assert_fix(f"QualityReq r\n    {condition}\n", title, f"QualityReq r\n    {mended}\n")


@pytest.mark.parametrize(
    "clause",
    [
        "over last 7 runs",
        "in at least 90 % of runs",
        "with probability >= 90 %",
        "confidence 95 %",
        "goal a takes at most 3 s",
        "on violation fail",
        "verified by review",
        "every a takes at most 3 s",
        "from a starts until b starts takes at most 3 s",
        "sum of energy in a takes at most 3 J",
        "mission takes at most 3 s",
        "takes at most 3 s",
    ],
)
def test_a_clause_outside_of_a_requirement(clause: str) -> None:
    head = clause.split()[0]
    (entry,) = parse(clause).entries
    (alone,) = entry.diagnostics
    assert alone.message == f"expected an item: BehaviorTree, QualityReq, include, signal, …, found `{head}`"
    assert alone.notes == ("a clause goes in the block of a QualityReq, indented",)
    (entry,) = parse(f"BehaviorTree Main\n    Go\n    {clause}\n").entries
    (in_tree,) = entry.diagnostics
    assert in_tree.message == f"unexpected clause `{head}` in a tree; clauses go in a requirement"
    assert in_tree.notes == ("write `satisfies QualityReq` and an ID before it, or indent it below a line that does",)


# ---- Cond -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("condition", "shown"),
    [
        ("a", "a"),
        ("'a b'", "'a b'"),
        ("true", "true"),
        ("a or b or c", "(or (or a b) c)"),
        ("a or b and c", "(or a (and b c))"),
        ("a and b or c", "(or (and a b) c)"),
        ("(a or b) and c", "(and (or a b) c)"),
        ("not a and not b", "(and (not a) (not b))"),
        ("not a > 3", "(not (a > 3))"),
        ("not (a and b)", "(not (and a b))"),
        ("a > 3", "(a > 3)"),
        (
            "a >= 3 and b <= 3 and c < 3 and d == 3 and e != 3",
            "(and (and (and (and (a >= 3) (b <= 3)) (c < 3)) (d == 3)) (e != 3))",
        ),
        ("x!=3", "(x != 3)"),
        ("3 < a < 5", "(3 < a < 5)"),
        ("a == 'b'", "(a == 'b')"),
        ("a + b - c", "(- (+ a b) c)"),
        ("a - b", "(- a b)"),
        ("a-b", "a-b"),
        ("a -1", "(- a 1)"),
        ("a + b * c / 2", "(+ a (/ (* b c) 2))"),
        ("(a + b) * c", "(* (+ a b) c)"),
        ("10 m/speed", "(/ 10m speed)"),
        ("a / b > 2", "((/ a b) > 2)"),
        ("a > -5", "(a > -5)"),
        ("a > - 5", "(a > (- 5))"),
        ("max(speed) > 3 m/s", "((max speed) > 3m/s)"),
        ("min (a) < mean(b) + p95(c)", "((min a) < (+ (mean b) (p95 c)))"),
        ("stddev(a) == change(b) * count(c)", "((stddev a) == (* (change b) (count c)))"),
        ("max > 3", "(max > 3)"),
        ("node a", "(node a)"),
        ("node a/'b c'", "(node a/'b c')"),
        ("node a and not node b", "(and (node a) (not (node b)))"),
        ("node", "node"),
        ("node > 3", "(node > 3)"),
        ("node and a", "(and node a)"),
        ("(((a)))", "a"),
        ("goal > 3", "(goal > 3)"),
        ("goal", "goal"),
        ("in and on", "(and in on)"),
        ("on + while", "(+ on while)"),
        ("mission == 'a'", "(mission == 'a')"),
    ],
)
def test_condition(condition: str, shown: str) -> None:
    assert_condition(condition, shown)
    assert_clause(f"keeps {condition} on violation fail", f"keeps {shown}\n  on violation fail")
    assert_clause(f"keeps ({condition}) X keeps b", f"keeps {shown}\n  <X> keeps b")


@pytest.mark.parametrize(
    ("condition", "shown", "problem"),
    [
        ("a and", "a", f"1:6 syntax-error «» expected {A_CONDITION}, {END}"),
        ("and a", "MISSING", f"1:1 syntax-error «and» expected {A_CONDITION}, found `and`"),
        ("a or or b", "a", f"1:6 syntax-error «or» expected {A_CONDITION}, found `or`"),
        ("not", "MISSING", f"1:4 syntax-error «» expected {A_CONDITION}, {END}"),
        ("a >", "a", f"1:4 syntax-error «» expected {A_CONDITION}, {END}"),
        ("> 3", "MISSING", f"1:1 syntax-error «>» expected {A_CONDITION}, found `>`"),
        ("1 < a < 3 < b", "(1 < a < 3)", "1:11 syntax-error «<» expected at most two comparisons in a row, found `<`"),
        ("a = 3", "(a == 3)", "1:3 syntax-error «=» values are compared with `==`"),
        ("(a = 3) and b", "(and (a == 3) b)", "1:4 syntax-error «=» values are compared with `==`"),
        ("a || b", "(or a b)", "1:3 syntax-error «||» in conditions `||` is written `or`"),
        ("a && b", "(and a b)", "1:3 syntax-error «&&» in conditions `&&` is written `and`"),
        ("!a", "(not a)", "1:1 syntax-error «!» in conditions `!` is written `not`"),
        ("a +", "a", f"1:4 syntax-error «» expected {A_CONDITION}, {END}"),
        ("a * / b", "a", f"1:5 syntax-error «/» expected {A_CONDITION}, found `/`"),
        ("-a", "MISSING", "1:2 syntax-error «a» expected a number or a quantity after `-`, found `a`"),
        ("{a} > 3", "MISSING", f"1:1 syntax-error «{{a}}» expected {A_CONDITION}, found `{{a}}`"),
        ("()", "MISSING", f"1:2 syntax-error «)» expected {A_CONDITION}, found `)`"),
        ("(a b) or c", "(or a c)", "1:4 syntax-error «b» expected `)`, found `b`"),
        ("max() > 3", "((max MISSING) > 3)", "1:5 syntax-error «)» expected a signal, found `)`"),
        ("max(3)", "(max MISSING)", "1:5 syntax-error «3» expected a signal, found `3`"),
        ("max(a b)", "(max a)", "1:7 syntax-error «b» expected `)`, found `b`"),
        ("node a/", "(node a)", f"1:8 syntax-error «» expected a node, {END}"),
        ("a b", "a", "1:3 syntax-error «b» expected the end of the line, found `b`"),
        ("a > 3 sek", "(a > 3)", "1:7 unknown-unit «sek» unknown unit `sek`; did you mean `s`?"),
    ],
)
def test_broken_condition(condition: str, shown: str, problem: str) -> None:
    assert_condition(condition, shown, problem)


def test_what_other_languages_write_can_be_replaced() -> None:
    assert_fix("context a : b || c", "Write `or`", "context a : b or c", safe=True)
    assert_fix("context a : b && c", "Write `and`", "context a : b and c", safe=True)
    assert_fix("context a : b and !c", "Write `not`", "context a : b and not c", safe=True)
    assert_fix("context a : b = c", "Write `==`", "context a : b == c", safe=True)


@pytest.mark.parametrize(
    ("sign", "words"),
    [("<", "less than"), ("<=", "at most"), (">", "more than"), (">=", "at least"), ("under", "less than")],
)
def test_a_bound_as_others_write_it(sign: str, words: str) -> None:
    text = "QualityReq a\n    takes {} 3 s"
    assert_parse(text.format(sign), None, f"2:11 syntax-error «{sign}» this bound is written `{words}`")
    assert_fix(text.format(sign), f"Write `{words}`", text.format(words), safe=True)


@pytest.mark.parametrize("words", ["no more than", "up to", "=<", "max"])
def test_a_bound_in_other_words_is_the_bound_all_the_same(words: str) -> None:
    tree = """
        requirement a
          takes <= 3s
    """
    assert_parse(
        f"QualityReq a\n    takes {words} 3 s", tree, f"2:11 syntax-error «{words}» this bound is written `at most`"
    )


def test_a_word_of_few_that_is_misspelt() -> None:
    text = "QualityReq a\n    {}"
    for wrong, right in (("fails", "fail"), ("failure", "fail"), ("halts", "halt"), ("warning", "warn")):
        line = f"on violation {wrong}"
        assert_fix(text.format(line), f"Replace `{wrong}` with `{right}`", text.format(f"on violation {right}"))
    assert_fix(text.format("verified by tests"), "Replace `tests` with `test`", text.format("verified by test"))


def test_brackets_in_brackets_have_an_end() -> None:
    problem = "1:52 nested-too-deep «(» more than 50 nested brackets"
    assert_condition("(" * 50 + "a" + ")" * 50, "a")
    assert_condition("(" * 51 + "a" + ")" * 51, "MISSING", problem.replace("(", "a"))
    assert_condition("(" * 5000 + "a" + ")" * 5000, "MISSING", problem)
    assert_condition("not (" * 5000 + "a" + ")" * 5000, "MISSING",
                     "1:256 nested-too-deep «not» more than 50 nested brackets")  # fmt: skip


@pytest.mark.parametrize("operator", ["and", "or", "+", "*", "-"])
def test_chains_of_operators_have_an_end(operator: str) -> None:
    chain = f" {operator} ".join("a" * 101)
    assert_parse(f"context a : {chain}")
    at = len(f"context a : {chain} {operator} a ")
    word = operator if operator != "-" else "-"
    problem = f"1:{at + 1} nested-too-deep «{word}» more than 100 operators in one condition"
    for length in (103, 5000):
        assert_parse(f"context a : {f' {operator} '.join('a' * length)}\nsignal z : m", None, problem)


def test_a_value_of_many_cases_has_an_end() -> None:
    def limit(cases: int) -> str:
        return "QualityReq a takes at most " + "1 s if b, " * (cases - 1) + "1 s if b else 2 s\nsignal z : m"

    assert_parse(limit(100))
    at = len("QualityReq a takes at most " + "1 s if b, " * 100)
    for cases in (101, 5000):
        assert_parse(limit(cases), None, f"1:{at + 1} nested-too-deep «1 s» more than 100 cases in one value")


@pytest.mark.parametrize(
    "clause",
    [
        *("in at least 98 % of runs", "with probability >= 98 %", "on violation fail", "over last 20 runs"),
        *("verified by test", 'because "of people"'),
    ],
)
def test_a_title_without_quotes_ends_where_a_clause_begins(clause: str) -> None:
    text = f"QualityReq r : safety The arm stays still {clause}\n"
    (found,) = parse(text).diagnostics
    assert (found.message, text[found.span.start : found.span.end]) == ("a title goes in quotes", "The arm stays still")


@pytest.mark.parametrize(("value", "fixes"), [("30 s", ["Put `takes` before it"]), ("30 m", []), ("thirty", [])])
def test_a_bound_without_its_verb_is_one_of_takes_only_if_it_is_a_time(value: str, fixes: list[str]) -> None:
    (found,) = parse(f"QualityReq r : safety\n    at most {value}\n").diagnostics
    assert [fix.title for fix in found.fixes] == fixes
