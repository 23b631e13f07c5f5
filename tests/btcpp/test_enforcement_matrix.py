"""Every verb × qualifier × kind of node × action: enforced, with which XML, or why not.

`enforcement_matrix.txt` has a line for each, what comes of it and a hash of the XML, so that no clause silently becomes
enforced, or is enforced otherwise; `tests/engine` shows that the engine does what such XML asks of it.  `pytest
--update` writes the lines of today: read the difference before it is committed.
"""

from __future__ import annotations

from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path

from btq_lang import Workspace
from btq_lang.btcpp.document import write
from btq_lang.btcpp.enforcement import enforced
from btq_lang.btcpp.export import export
from btq_lang.catalog.verbs import VERBS

GOLDEN = Path(__file__).parent / "enforcement_matrix.txt"

CLAUSES = {
    "takes": (
        "takes at most 30 s",
        "takes at least 1 s",
        "takes between 1 s and 30 s",
        "takes at most 4 s if low else 9 s",
    ),
    "succeeds": ("succeeds", "succeeds within 30 s"),
    "needs": ("needs battery > 15 %", "needs low"),
    "keeps": (
        "keeps battery > 15 %",
        "keeps age(battery) <= 1 s",
        "keeps battery > 15 %\n    from Other succeeds until Step fails or mission finishes",
        "keeps battery > 15 %\n    from Other succeeds until Step halts",
    ),
    "never": ("never low and door",),
    "keeps of time": ("keeps battery > 15 % in at least 95 % of time",),
    "never of time": ("never low in at least 95 % of time",),
    "never for": ("never low for more than 30 s",),
    "leaves": ("leaves battery > 3 %",),
    "ends with": ("ends with battery > 3 %",),
    "uses": ("uses at most 20 % of battery", "uses at least 1 % of battery", "uses at most 3 of load"),
    "takes on average": ("takes at most 30 s on average",),
    "uses on average": ("uses at most 20 % of battery on average",),
    "tries": ("tries at most 3", "tries at most 3 per Top", "tries at least 2"),
    "succeeds per": ("succeeds at most 3 per run", "succeeds at most 3 per Top", "succeeds at least 12 per run"),
    "starts per": ("starts at most 3 per run", "starts at most 3 per Top"),
    "fails per": ("fails at most 3 per run", "fails at most 3 per Top"),
    "fails per time": ("fails at most 1 per 200 h", "fails at most 1 per 200 h of Top"),
    "finishes per": ("finishes at most 3 per run", "finishes between 1 and 3 per Top"),
    "runs": ("runs every 500 ms", "runs at most 9 per 10 s"),
    "starts": ("starts within 2 s after Other succeeds",),
    "ends": ("ends within 2 s after Other fails",),
    "visits": ("visits Other, Step in order",),
    "follows": (
        *(f"follows Other {happening}" for happening in ("starts", "succeeds", "fails", "finishes", "halts")),
        "follows mission starts",
        "follows Other succeeds or Other starts",
        "follows Other succeeds or when door",
        "follows when door",
    ),
    "followed": (
        "each Other fails is followed by Work starts within 2 s",
        "each Other fails or when door is followed by battery > 15 %",
    ),
}
QUALIFIERS = {
    "": "",
    "odds": "in at least 90 % of activations",
    "window": "in at least 90 % of activations\n    over last 10 runs",
    "while": "while door",
    "when": "when door",
    "context": "when night",
    "assuming": "assuming door",
    "span": "from Other succeeds until Step fails or mission finishes",
    "review": "verified by review",
}
# What the clause is about, as it is named in it.
SUBJECTS = {
    "action": "Work",
    "condition": "Ask",
    "control": "Steps",
    "decorator": "Again",
    "subtree": "Inner",
    "root": "Top",
    "every": "every Work",
    "below an instance": "one/Deep",
    "skipped": "Maybe",
    "asked by IfThenElse": "Which",
    "own control": "Mine",
    "mission": "mission",
}
MISSION = """\
signal battery : % from {{level}} level
signal load : 1 from {{load}}
signal door : bool from {{door}}
context low : battery < 10 %
context night : not door
QualityReq q : safety
    on violation {action}
    {clause}
    {qualifier}
Root Main
BehaviorTree Main
    -> Top
        Action Work
        Condition Ask
        -> Steps
            Action Other
        Retry Again (num_attempts = 3)
            Action Step
        SubTree Inner
        SubTree Twice one
        SubTree Twice two
        Action Maybe (_skipIf = "door", _onSuccess = "x := 1")
        IfThenElse
            Action Which
            Action Then
        Mine Mine
            Action Held
BehaviorTree Inner
    Action Leaf
BehaviorTree Twice
    Action Deep
Control Mine
"""


def test_what_is_enforced_and_why_the_rest_is_not(update: bool) -> None:
    lines = list(matrix())
    if update:
        GOLDEN.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    assert lines == GOLDEN.read_text(encoding="utf-8").splitlines()


def test_every_verb_is_there() -> None:
    assert CLAUSES.keys() == VERBS.keys()


def matrix() -> Iterator[str]:
    for clauses in CLAUSES.values():
        for clause in clauses:
            for qualifier, written in QUALIFIERS.items() if clause is clauses[0] else [("", "")]:
                for action in ("fail", "halt") if not qualifier else ("fail",):
                    for kind, subject in {"event": ""}.items() if clause.startswith("each ") else SUBJECTS.items():
                        comes_of_it = outcome(f"{subject} {clause}".strip(), written, action)
                        yield f"{kind} {' '.join(clause.split())}; {qualifier or 'always'}; {action}: {comes_of_it}"


def outcome(clause: str, qualifier: str, action: str) -> str:
    """What comes of a requirement."""
    text = MISSION.format(clause=clause, qualifier=qualifier, action=action)
    workspace = Workspace.of({"m.btq": text})
    assert workspace.files["m.btq"].problems == ()
    enforcement = enforced(workspace, "m.btq", export(workspace, "m.btq"))
    found = [each for applied in enforcement.clauses for each in applied if each.asked]
    if not found:
        return "nothing"
    ways = {(each.way, each.why) for each in found}
    assert len(ways) == 1, "instances of one kind are alike here"
    ((way, why),) = ways
    if way != "enforced":
        return f"{way}: {why}"
    digest = sha256(write(enforcement.export.document).encode()).hexdigest()[:8]
    return f"{way} {digest}{f' ({why})' if why else ''}"
