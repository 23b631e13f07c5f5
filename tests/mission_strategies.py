"""Missions that hypothesis makes up: sound ones, which use all that the engine offers, and such with odd names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from btq_lang.syntax.tree import quote


def made_up(strategy: st.SearchStrategy[str], number: int) -> Sequence[str]:
    """Texts, always the same ones, for tests that need many at once."""
    found: dict[str, None] = {}

    @settings(
        max_examples=number,
        derandomize=True,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(strategy)
    def collect(text: str) -> None:
        found[text] = None

    collect()
    return list(found)


# ---- sound missions -------------------------------------------------------------------------------------------------

# What skills there are, and what goes into their ports: literals and entries, each entry of one type only.
MODELS = """\
signal charge : % from {@charge} level initially 80 %
signal speed : m/s from {@speed} initially 0 m/s
signal energy : Wh from {@energy} counter initially 0 Wh
signal door : bool from {@door} initially true
context hurried : charge < 20 %
QualityReq quick : performance-efficiency.time-behaviour "Be quick"
    takes at most 1 h
    on violation fail
QualityReq quick_or_not : performance-efficiency.time-behaviour
    takes at most 1 h if hurried else 2 h
    on violation halt
QualityReq careful : safety
    keeps speed <= 1 m/s while not hurried
    needs door
    on violation fail
QualityReq thrifty(most : Wh = 5 Wh) : performance-efficiency.resource-utilization "Needs < 5 & > 0 Wh"
    uses at most most of energy
    leaves charge >= 3 %
    on violation halt
QualityReq persistent : reliability
    tries at most 100
    on violation fail
QualityReq watched : reliability
    succeeds within 30 s
    in at least 98 % of activations
Action Drive "Drives & waits"
    input to : string = "home" "a name"
    input speed : double = 0.5
    input tries : int = 2
Action Wait
    input pause : "unsigned int"
    input gently : bool = true
    output slept : double
Action Grip
    input force : float
    inout thing
Condition Sees
    input what : std::string
    input limit : double = 3
Condition Free
Decorator Guarded
    input level : int = 3
Control Choose
    input by : string = "a"
"""
NUMBERS = ("0", "1", "3", "-2", "7.5", "1e3", '"4"')
PORTS: Mapping[str, Mapping[str, Sequence[str]]] = {
    "Drive": {
        "to": ('"ward 3, bed 2"', "x", "{text}", "4"),
        "speed": ("1", "0.25", "{real}"),
        "tries": ("3", "-1", "{whole}"),
    },
    "Wait": {"pause": ("500", "{pause}"), "gently": ("true", "0", "{flag}"), "slept": ("{real}", "{@slept}")},
    "Grip": {"force": ("12.5", "3", "{force}"), "thing": ("tube", "5", "{any}")},
    "Sees": {"what": ('"<&>\'"', "{text}"), "limit": ("2", "{real}", "{=}")},
    "Free": {},
    "Guarded": {"level": ("1", "{whole}")},
    "Choose": {"by": ("b", "{text}")},
}
# The entries that every tree has as ports, with what a SubTree may give them.
GIVEN: Mapping[str, Sequence[str]] = {
    "text": ("left", '"a;b"', '"two words"', "{text}", "{=}"),
    "real": (*NUMBERS, "{real}"),
    "whole": ("1", "3", "-2", "{=}"),
    "pause": ("250", "5000000000", "{pause}"),
    "flag": ("1", "true", "false", "{flag}"),
    "force": ("1", "2.5", "{force}"),
    "any": (*NUMBERS, "word", "{any}", "{@any}"),
}
NEEDED = {"Wait": ("pause",), "Grip": ("force",), "Sees": ("what",)}
CONDITIONS = ("_skipIf", "_failureIf", "_successIf", "_while")
EXPRESSIONS = ("@n > 3", "((@n + 1) * 2) == 4", "(@on == 1) && (!(@n < 2))", "(@word == 'a') || (@n != 2)")
STATEMENTS = ("@n := 1.0", "@n = @n + 1", "x := 'a'; @word := 'b'", "@on := (@n > 2) ? 1 : 0")
# Entries that the scripts above read.
START: Mapping[str, object] = {"n": 2.0, "on": 1, "word": "a"}
CLAUSES = (
    *("satisfies quick", "satisfies quick_or_not", "satisfies careful", "satisfies thrifty(most = 2 Wh)"),
    *("satisfies persistent", "satisfies watched", "satisfices safety, reliability", "tags heavy"),
)
ONE_CHILD = (
    *("Inverter", "ForceSuccess", "ForceFailure", "RunOnce", "Retry (num_attempts = 3)", "Repeat (num_cycles = 2)"),
    *("Timeout (msec = 1.5 min)", "Delay (delay_msec = 10 ms)", "Timeout (msec = {pause})", "KeepRunningUntilFailure"),
    *('Precondition (if = "@n > 1" else = SKIPPED)', "RunOnce (then_skip = false)", "Decorator Guarded"),
    'LoopDouble (queue = "1;2" value = {real})',
)
SOME_CHILDREN = (
    *("->", "->", "?", "R?", "M->", "A->", "A?", "Choose", "|| (success_count = 1 failure_count = -1)", "All||"),
    "Control Choose",
)
LEAVES = ("Drive", "Wait", "Grip", "Sees", "Free", "Action Drive", "Condition Free")
BUILT_IN_LEAVES = (
    *("AlwaysSuccess", "AlwaysFailure", "Sleep (msec = 5 ms)", 'Script (code = "@n := 3.0")'),
    *('ScriptCondition (code = "@n > 1")', "SetBlackboard (value = b output_key = note)"),
    *("UnsetBlackboard (key = gone)", 'ScriptAction (name = "Say hello")', 'ScriptCondition (name = "Ready?")'),
)
STEPS = (
    *("given charge = 80 %", "given {@n} = 3", "when 30 s have passed: door = false", "when hurried: charge = 90 %"),
    *("when {n} > 3 or not door: mission halts", "expect mission succeeds within 2 min", "expect quick violated"),
    *(
        "expect finally {word} == 'a'",
        "expect mission does not end",
        "expect mission fails",
        "expect mission halts",
        "expect watched never exercised",
        "expect quick",
    ),
)
BEHAVIORS = ("fails", "fails twice, then succeeds after 3 s", "takes 3 s", "does not end", "succeeds and writes n = 2")
ANSWERS = ("answers true", "answers false, true")
RUNS = {"Drive": (("to", '"home", {text}'), ("tries", "3")), "Grip": (("force", "12.5, 3"),)}
TITLES = ('"All goes well"', "'Größe < 3'")
LABELS = ("", "", "", " Work", ' "Front door"', " Größe", ' "a < b"')
COMMENTS = ("", "", "", "  # slips -- at times", "  # <!-- no -->")


@st.composite
def missions(draw: st.DrawFn) -> str:
    """A mission of some trees in which nothing is wrong that a check would not tell; the first is the main one."""
    count = draw(st.integers(1, 3))
    names = ("Main", '"3 Way points"', "Part")[:count]
    lines = [MODELS + "Root Main"]
    for index, name in enumerate(names):
        lines.append(f"BehaviorTree {name}")
        if index:
            ports = draw(st.lists(st.sampled_from(sorted(GIVEN)), unique=True, max_size=3))
            lines += [f"    input {port}" for port in ports]
        lines += indented(draw(_node(names[index + 1 :], 0)))
    if draw(st.integers(0, 2)) == 0:
        lines += draw(_scenarios([skill for skill in PORTS if any(f" {skill}" in line for line in lines[1:])]))
    return "".join(f"{line}\n" for line in lines)


@st.composite
def _scenarios(draw: st.DrawFn, skills: Sequence[str]) -> list[str]:
    """The lines of givens and scenarios; skills: those that are in the trees."""
    others = [*STEPS]
    for skill in skills:
        others += [f"when {skill} fails for the {number} time: mission halts" for number in ("2", "second")]
        others += [f"expect {skill} tries at most 3", f"expect never node {skill}"]
        others += [f"expect {skill} ({port}) runs {value}" for port, value in RUNS.get(skill, ())]
    given = [skill for skill in skills if skill not in ("Guarded", "Choose")]
    lines = ["given {text} = left"] if draw(st.booleans()) else []
    for title in TITLES[: draw(st.integers(1, 2))]:
        verifies = draw(st.sampled_from(("", " verifies quick", " verifies quick, watched")))
        steps = [
            f"given {skill} {draw(st.sampled_from(ANSWERS if skill in ('Sees', 'Free') else BEHAVIORS))}"
            for skill in given
            if draw(st.booleans())
        ]
        steps += [*draw(st.lists(st.sampled_from(others), max_size=5)), "expect mission succeeds"]
        lines += [f"scenario {title} of Main{verifies}"]
        lines += [f"    {step}{draw(st.sampled_from(COMMENTS))}" for step in steps]
    return lines


@st.composite
def _node(draw: st.DrawFn, below: Sequence[str], depth: int) -> list[str]:
    """The lines of a node; below: the trees that it may run."""
    group = draw(st.integers(0, 9 if depth < 4 else 4))
    children = 0
    if group <= 1:
        head, pairs = _parted(draw(st.sampled_from(BUILT_IN_LEAVES)))
    elif group == 2 and below:
        head = f"SubTree {draw(st.sampled_from(below))}"
        pairs = [f"_autoremap = {draw(st.sampled_from(('true', 'false')))}"] if draw(st.booleans()) else []
        pairs += draw(_values(GIVEN))
    elif group <= 4:
        head = draw(st.sampled_from(LEAVES))
        skill = head.rpartition(" ")[2]
        pairs = draw(_values(PORTS[skill], NEEDED.get(skill, ())))
    elif group <= 6:
        head, pairs = _parted(draw(st.sampled_from(ONE_CHILD)))
        children = 1
    elif group == 7:
        head, shape, children = draw(st.sampled_from(_OF_SOME_SHAPE))
        pairs = [*shape]
    else:
        head, pairs = _parted(draw(st.sampled_from(SOME_CHILDREN)))
        children = draw(st.integers(2, 3))
    if draw(st.integers(0, 4)) == 0 and not head.startswith("Script"):
        pairs.append(f"{draw(st.sampled_from(CONDITIONS))} = {quote(draw(st.sampled_from(EXPRESSIONS)))}")
    if draw(st.integers(0, 6)) == 0 and not head.startswith("Script"):
        after = draw(st.sampled_from(("_onSuccess", "_onFailure", "_post")))
        pairs.append(f"{after} = {quote(draw(st.sampled_from(STATEMENTS)))}")
    label = draw(st.sampled_from(LABELS)) if not any(pair.startswith("name ") for pair in pairs) else ""
    line = head + label + (f" ({', '.join(pairs)})" if pairs else "")
    if draw(st.integers(0, 3)) == 0:
        line += f" {draw(st.sampled_from(CLAUSES))}"
    lines = [line + draw(st.sampled_from(COMMENTS))]
    for _ in range(children):
        lines += indented(draw(_node(below, depth + 1)))
    return lines


# Nodes that take a number of children of their own: head, pairs, children.
_OF_SOME_SHAPE = (
    ("IfThenElse", (), 2),
    ("IfThenElse", (), 3),
    ("WhileDoElse", (), 3),
    ("Switch2", ("variable = {text}", "case_1 = a", 'case_2 = "2"'), 3),
    ("Switch", ("variable = {text}", "case_1 = a", "case_2 = b", "case_3 = c"), 4),
    ("R->", (), 2),
)


@st.composite
def _values(draw: st.DrawFn, ports: Mapping[str, Sequence[str]], needed: Sequence[str] = ()) -> list[str]:
    given = [name for name in ports if name in needed or draw(st.booleans())]
    return [f"{name} = {draw(st.sampled_from(ports[name]))}" for name in given]


def _parted(text: str) -> tuple[str, list[str]]:
    """`Retry (num_attempts = 3)`: what stands before the brackets, and in them."""
    head, _, pairs = text.partition(" (")
    return head, [pairs[:-1]] if pairs else []


# ---- odd names --------------------------------------------------------------------------------------------------

# Names that people write, and some that nobody should.
NAMES = st.sampled_from(
    (
        "Pick",
        "Place",
        "BatteryLow?",
        "my node",
        "3 Way",
        "Größe",
        "a/b",
        "Root",
        "Sequence",
        "-",
        "é.b",
        "x<y",
        "MoveBase",
    )
)
TEXTS = st.text(st.sampled_from("ab \n\t\"'\\<>&;{}#-/*]\u2028é\ufeff"), max_size=8)
SYMBOLS = ("->", "?", "||", "R->", "R?", "M->", "A->", "Sequence", "Fallback", "IfThenElse")
DECORATORS = (
    "Inverter",
    "ForceSuccess",
    "Retry (num_attempts = 3)",
    "Timeout (msec = 3 s)",
    "Delay (delay_msec = 1 s)",
)


@st.composite
def _odd_node(draw: st.DrawFn, depth: int = 0) -> list[str]:
    """The lines of a node."""
    kind = draw(st.integers(0, 9 if depth < 4 else 4))
    name, text = quote(draw(NAMES)), draw(TEXTS)
    if kind <= 1:
        lines = [f"{name} {quote(text)} (a = {quote(draw(TEXTS))} _description = {quote(text)})"]
    elif kind == 2:
        lines = [f"Action {name}", f"Condition {name} (x = {{key}})"][draw(st.integers(0, 1)) :][:1]
    elif kind == 3:
        lines = [f"SubTree {draw(st.sampled_from(('A', quote('b c'), 'Missing')))} {name}"]
    elif kind == 4:
        lines = [draw(st.sampled_from((f"ScriptAction (name = {name})", f"ScriptCondition (name = {name} y = 1)")))]
    elif kind <= 6:
        lines = [draw(st.sampled_from(DECORATORS)), *indented(draw(_odd_node(depth + 1)))]
    else:
        lines = [f"{draw(st.sampled_from(SYMBOLS))} {name}"]
        for _ in range(draw(st.integers(1, 3))):
            lines += indented(draw(_odd_node(depth + 1)))
    if draw(st.integers(0, 3)) == 0:
        lines[0] += f"  # {' '.join(text.split())}"
    if draw(st.integers(0, 3)) == 0:
        lines.insert(0, f"/* {text.replace('*/', '')} */".replace("\n", " "))
    if draw(st.integers(0, 5)) == 0:
        lines[0] += " satisfices safety" if "#" not in lines[0] and not lines[0].startswith("/*") else ""
    return lines


@st.composite
def odd_missions(draw: st.DrawFn) -> str:
    """A file of two trees, with names and texts that nobody should use."""
    head = draw(st.sampled_from(("", "Root A\n", "Root A ()\n", "TreeNodesModel\n    Action Undock\nTreeNodesModel\n")))
    lines = ["BehaviorTree A", *indented(draw(_odd_node())), 'BehaviorTree "b c"', *indented(draw(_odd_node(3)))]
    return head + "".join(f"{line}\n" for line in lines)


def indented(lines: list[str]) -> list[str]:
    return [f"    {line}" for line in lines]
