"""The matrix of enforcement: every verb of a clause at every kind of node, with every qualifier, for several targets.

A case is a verb at a kind of node: a mission for each qualifier, built for the newest engine, and the plain qualifiers
for older ones too.  A row of `matrix.tsv` says of each mission how its clause is held, or why not, and four characters
for all that the build has written.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from cases import Case, of
from under_test import digest

TABLE = Path(__file__).with_name("matrix.tsv")
NEWEST, OLDER = "4.10", ("4.6", "4.8")

HEAD = """signal battery : % from {battery} level initially 80 %
signal energy : Wh from {energy} counter initially 0 Wh
signal speed : km/h from {speed} initially 0 km/h
signal door : bool from {door} initially true
signal state : text from {state} initially "up"
signal late : s from {late} initially 3 s
signal unset : N from {unset}
signal nowhere : N
context near : door and speed > 0 m/s
Condition Seen
Action Move
Action Rest
Action Wait
Action Look
Action Place
Action Grip
Action Hold
"""
TREES = """Root Main
BehaviorTree Part
    ->
        Grip
        Hold
BehaviorTree Main
    -> Shelf
"""

# `@` is the node that the clause is about.
CLAUSES = (
    "@ takes at most 30 s",
    "@ takes less than 30 s",
    "@ takes at least 2 s",
    "@ takes between 2 s and 30 s",
    "@ takes at most 20 s if near else 30 s",
    "@ takes at most late",
    "@ takes at most limit",
    "@ succeeds",
    "@ succeeds within 30 s",
    "@ needs battery >= 20 %",
    "@ needs near and 10 % < battery <= 90 % or not door",
    "@ needs state == 'up'",
    "@ needs unset > 3 N",
    "@ keeps speed <= 1 m/s",
    "@ keeps nowhere <= 3 N",
    "@ keeps max(speed) <= 1 m/s",
    "@ keeps node Look",
    "@ never speed > 1 m/s",
    "@ leaves battery >= 3 %",
    "@ uses at most 20 Wh of energy",
    "@ uses at most 5 % of battery",
    "@ uses at least 5 % of battery",
    "@ tries at most 3",
    "@ tries at most 3 per Shelf",
    "@ runs every 500 ms",
    "@ runs at least 2 per 1 s",
    "@ starts within 2 s after Look succeeds",
    "@ ends within 2 s after Look succeeds",
    "@ follows Look succeeds",
    "@ follows Look starts",
    "@ follows Look halts",
    "@ follows when near",
    "from @ starts to Place succeeds takes at most 45 s",
    "from Look starts to @ succeeds takes at most 45 s",
    "from Look starts to Place finishes takes at most 45 s",
    "sum of @, Look takes at most 45 s",
)

# Above and below the claim; what is in the first ones is built for older engines too.
PLAIN = ("on violation fail", "on violation halt")
QUALIFIERS = (
    *PLAIN,
    *("", "on violation warn", "on violation log"),
    *("on violation fail\n    while near", "on violation fail\n    when near", "on violation halt\n    while near"),
    *("on violation halt\n    when near", "on violation fail\n    while node Look"),
    *("on violation fail\n    in at least 98 % of activations", "on violation fail\n    in at least 98 % of runs"),
    "on violation fail\n    with probability >= 98 %\n    confidence 90 %",
    "on violation fail\n    in at least 90 % of activations\n    over last 20 activations",
    'on violation fail\n    because "of people"',
    *(f"on violation fail\n    verified by {how}" for how in ("monitor", "test", "review", "analysis")),
)

# How the node is called, and the lines of it; with the qualifiers of all, or with plain ones only.
KINDS = {
    "action": ("Move", "Move"),
    "condition": ("Seen", "Condition Seen"),
    "decorator": ("Again", "Retry Again (num_attempts = 3)\n    Move"),
    "control": ("Both", "-> Both\n    Move\n    Rest"),
    "subtree": ("Part", "SubTree Part"),
    "mission": ("mission", "Move"),
    "synchronous": ("AlwaysSuccess", "AlwaysSuccess"),
    "script": ("Say", 'Script Say (code = "x := 1")'),
    "reactive": ("Both", "R-> Both\n    Condition Seen\n    Move"),
    "parallel": ("Both", "|| Both (success_count = 1)\n    Move\n    Rest"),
    "inverter": ("Not", "Inverter Not\n    Move"),
    "switch": ("Which", 'Switch Which (variable = {state}, case_1 = "a", case_2 = "b")\n    Move\n    Rest\n    Wait'),
    "custom decorator": ("Guarded", "Decorator Guarded\n    Move"),
    "custom control": ("Choose", "Control Choose\n    Move\n    Rest"),
    "every": ("every Move", "->\n    Move A\n    Move B"),
    "in a subtree": ("Part/Grip", "SubTree Part"),
    "one instance": ("First/Grip", "->\n    SubTree Part First\n    SubTree Part Second"),
    "skipped": ("Move", 'Move (_skipIf = "@x > 1")'),
    "while": ("Move", 'Move (_while = "@x > 1", _onSuccess = "y := 1")'),
    "failing at start": ("Move", 'Move (_failureIf = "@x > 1")'),
    "with an end": ("Move", 'Move (_post = "y := 1")'),
    "asked": ("Seen", "IfThenElse\n    Condition Seen\n    Move\n    Rest"),
    "asking action": ("Move", "WhileDoElse\n    Move\n    Rest\n    Wait"),
    "swallowed": ("Move", "?\n    Move\n    Rest"),
    "below reactive": ("Move", "R->\n    Condition Seen\n    Move"),
}
IN_ALL = 6  # of the kinds
STATE = re.compile(r"(not enforced, monitored|enforced|monitored|reviewed): r, `[^`]*`(?: at `[^`]*`)?(?:: (.*))?$")

COUNT = len(CLAUSES) * len(KINDS)
PART = re.compile(r"^-- (?:\w+/)?(q\d+)\..*:$")
REMARK = re.compile(r"^! (q\d+)\.btq:[\d:]+ (.*)$")


def make(number: int) -> Case:
    """The case of a number."""
    clause, kind = _what(number)
    files = {f"q{at:02}.btq": _mission(clause, kind, qualifier) for at, qualifier in enumerate(_qualifiers(kind))}
    plain = " ".join([*files][: len(PLAIN)])
    older = (f"build --verbose -o old{at} --target {target} {plain}" for at, target in enumerate(OLDER))
    return of(files, f"build --verbose --target {NEWEST} .", *older)


def table(transcripts: Sequence[str]) -> str:
    """All rows, below what the numbers in them mean."""
    reasons: dict[str, int] = {}
    lines = [row(number, transcript, reasons) for number, transcript in enumerate(transcripts)]
    builds = [each.replace("\n    ", "; ").replace("on violation ", "") or "nothing" for each in QUALIFIERS]
    then = (f"{action.rpartition(' ')[2]} for {target}" for target in OLDER for action in PLAIN)
    return "\n".join(
        (
            "# E enforced, M monitored, N monitored, not enforceable, R reviewed, - not built; numbers say why",
            *(f"#{number}\t{reason}" for reason, number in reasons.items()),
            "\t".join(("case", "clause", "kind", *builds, *then)),
            *lines,
            "",
        )
    )


def known_reasons(text: str) -> dict[str, int]:
    """What the numbers of a table mean."""
    lines = (line.split("\t") for line in text.splitlines() if re.match(r"#\d", line))
    return {reason: int(number[1:]) for number, reason in lines}


def row(number: int, transcript: str, reasons: dict[str, int]) -> str:
    """A line of the table: the clause, the kind of node, and a cell for each build.

    Args:
        reasons: the numbers that stand for them; new ones are added.
    """
    clause, kind = _what(number)
    names = [f"q{at:02}" for at in range(len(_qualifiers(kind)))]
    newest, *older = transcript.split("$ btq ")[1:] or [""]
    cells = [_cell(newest, name, reasons) for name in names]
    cells += [_cell(build, name, reasons) for build in older for name in names[: len(PLAIN)]]
    return "\t".join((str(number), clause, kind, *cells))


def _what(number: int) -> tuple[str, str]:
    return CLAUSES[number // len(KINDS)], [*KINDS][number % len(KINDS)]


def _qualifiers(kind: str) -> tuple[str, ...]:
    return QUALIFIERS if [*KINDS].index(kind) < IN_ALL else PLAIN


def _mission(clause: str, kind: str, qualifier: str) -> str:
    name, node = KINDS[kind]
    head = "QualityReq r(limit : s = 30 s) : reliability" if "limit" in clause else "QualityReq r : reliability"
    claim = clause.replace("@", name)
    tree = "".join(f"        {line}\n" for line in ("Look", *node.split("\n"), "Place"))
    return f"{HEAD}{head}\n    {claim}\n    {qualifier}\n{TREES}{tree}"


def _cell(build: str, name: str, reasons: dict[str, int]) -> str:
    """What a build says of a mission's clause, and four characters for all that it says and writes of it."""
    found: list[str] = []
    states: dict[str, None] = {}
    is_part = False
    for line in build.splitlines():
        if start := PART.match(line):
            is_part = start[1] == name
        remark = REMARK.match(line)
        if remark and remark[1] == name and (state := STATE.match(remark[2])):
            number = reasons.setdefault(state[2], len(reasons) + 1) if state[2] else ""
            states[f"{state[1][0].upper()}{number}"] = None
        if is_part or (remark and remark[1] == name) or f"--> {name}." in line:
            found.append(line)
    return f"{'+'.join(states) or '-'}:{digest(chr(10).join(found))}"
