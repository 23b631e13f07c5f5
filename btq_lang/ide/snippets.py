"""Snippets: whole constructs with placeholders, proposed where such a construct may begin."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.ide.proposals import Proposal


def snippets_for(block: str) -> Iterator[Proposal]:
    """Those that begin a line of a block, if it is of items, models or nodes."""
    for label, detail, snippet in _SNIPPETS.get(block, ()):
        yield Proposal(label, "snippet", detail, label, snippet)


_MODELS = (
    (
        "skill",
        "the interface of a skill",
        '${1|Action,Condition|} ${2:MoveBase} "${3:Drives the base to a named station}"\n'
        "    ${4|input,output,inout|} ${5:station} : ${6:string}$0",
    ),
)
_ITEMS = (
    (
        "mission",
        "a tree with a guard and a skill, and a requirement on it",
        'QualityReq ${1:in_time} : performance-efficiency.time-behaviour "${2:Reach the station in time}"\n'
        "    takes at most ${3:30 s}\n"
        "\n"
        "BehaviorTree ${4:Mission}\n"
        "    ->\n"
        "        Condition ${5:BatteryGood}\n"
        '        Action ${6:MoveBase} (${7:station} = "${8:charger}") satisfies $1$0',
    ),
    ("tree", "a behavior tree", "BehaviorTree ${1:Name}\n    ${2|->,?,R->,R?|}$0"),
    (
        "req-time",
        "a requirement: a node takes no longer than this",
        'QualityReq ${1:in_time} : performance-efficiency.time-behaviour "${2:Done in time}"\n'
        "    takes at most ${3:30 s}\n"
        "    on violation ${4|warn,fail,halt,log|}$0",
    ),
    (
        "req-resource",
        "a requirement: a node leaves enough of what a signal measures",
        "signal ${1:battery} : ${2:%} from {${3:battery_level}\\}\n"
        "\n"
        'QualityReq ${4:way_home} : performance-efficiency.resource-utilization "${5:Arrive with some battery left}"\n'
        "    leaves $1 >= ${6:20 %}$0",
    ),
    (
        "req-keeps",
        "a requirement: a condition holds as long as a node runs",
        'QualityReq ${1:slow} : safety.operational-constraint "${2:Never faster than people walk}"\n'
        "    keeps ${3:speed} <= ${4:0.5 m/s}\n"
        "    on violation ${5|halt,fail,warn,log|}$0",
    ),
    (
        "req-odds",
        "a requirement: a node succeeds often enough",
        'QualityReq ${1:dependable} : reliability.faultlessness "${2:Nearly always works}"\n'
        "    succeeds within ${3:30 s}\n"
        "    in at least ${4:98 %} of ${5|activations,runs|}\n"
        "    over last ${6:200} $5$0",
    ),
    (
        "scenario",
        "a run to test: what nodes do, and what is expected then",
        'scenario "${1:The station cannot be reached}" of ${2:Mission}\n'
        "    given ${3:MoveBase} ${4|fails,succeeds,takes 20 s,does not end,answers false|}\n"
        "    expect ${5:mission succeeds}$0",
    ),
    *_MODELS,
)
_NODES = (
    (
        "guard",
        "do something only if a condition does not hold",
        "?\n    Condition ${1:BatteryGood}\n    -> ${2:Recharge}\n        $0",
    ),
    (
        "reactive",
        "a condition is checked at every tick while an action runs",
        "R->\n    Condition ${1:AreaFree}\n    ${2:MoveBase}$0",
    ),
    ("retry", "try again after a failure", "Retry (num_attempts = ${1:3})\n    $0"),
    ("timeout", "halt what takes too long", "Timeout (msec = ${1:30 s})\n    $0"),
    (
        "classic-action",
        "an action with a requirement in the classic syntax",
        "ScriptAction (\n"
        '    name = "${1:MoveBase}"\n'
        "    satisfices Quality = ${2:performance}\n"
        '    (QualityReq ID = "${3:rq1}"\n'
        '    description = "${4:SuccessIf it takes at most 30 s}")\n'
        ")$0",
    ),
)
_SNIPPETS = {"items": _ITEMS, "models": _MODELS, "tree": _NODES, "node": _NODES}
