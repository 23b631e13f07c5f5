"""The words of the language: how each is written, a short description, and what it means.

One invariant: every word that the grammar knows has a row, alone or in its phrase.  How a parser reads them is not
known here.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import Final

from btq_lang.catalog.verbs import VERBS
from btq_lang.util.record import Record


class Phrase(Record):
    """A word of the language, or several that go together.

    Attributes:
        part: the group that it belongs to: `claim`, `part of a model` …
        brief: shown beside it in a list.
        meaning: what it means; for a claim, when it is violated.
    """

    words: str
    part: str
    form: str
    brief: str
    meaning: str

    @property
    def sentence(self) -> str:
        """The meaning of the phrase."""
        meaning = f"violated when {self.meaning}" if self.part == "claim" else self.meaning
        return f"{meaning[0].upper()}{meaning[1:]}."


def phrases_of(words: str) -> tuple[Phrase, ...]:
    """The phrases that consist of some words, or that contain them: `violation`."""
    wanted = words.split()
    exact = tuple(phrase for phrase in PHRASES if phrase.words.split() == wanted)
    if exact or len(wanted) != 1:
        return exact
    return tuple(phrase for phrase in PHRASES if wanted[0] in phrase.words.split())


def phrase_at(line: str, index: int) -> tuple[int, str] | None:
    """The phrase around a place in a line, the longest if there are several: its start and its words."""
    return next(
        ((match.start(), match[0]) for match in _words().finditer(line) if match.start() <= index <= match.end()), None
    )


def in_line(words: str, line: str) -> str:
    """The phrase that a word belongs to in its line: of `never near for more than 30 s`, `never` to `never for`."""
    return "never for" if words == "never" and " for more than " in line else words


def beginning(words: str) -> Phrase:
    """The longest phrase that begins a clause: `takes` for `takes at most`.

    Raises:
        ValueError: no phrase does.
    """
    return max(
        (phrase for phrase in PHRASES if f"{words} ".startswith(f"{phrase.words} ")), key=lambda each: len(each.words)
    )


_MODEL: Final = "a model: the interface of a node"
_PLACE: Final = "at the top level of a file, the interface of {}; in a tree, the category of the node that follows"
_SPAN: Final = "from FindPart succeeds to Sort succeeds takes at most 12 s"

_CLAIMS: Final = "\n".join("    " + " | ".join(phrase) for verb in VERBS.values() for phrase in verb.phrases)

# By group, a line a phrase: its words, how they are written, the short description in a list, and what they mean.  A
# line that is too long for the page goes on after a backslash.
_TABLE: Final = f"""\
item
    BehaviorTree | BehaviorTree Deliver | a tree | a tree: its ports, and one node with all below it
    Root | Root Deliver | the main tree | names the main tree: the tree that the engine runs
    include | include "skills.btq" | another file's names | \
        makes the trees, models and requirements of another file available, a .btq file or BehaviorTree.CPP XML
    QualityReq | QualityReq rq1 : reliability "In time" | a requirement | \
        a requirement: its ID, its quality, a title, and clauses with its demands
    signal | signal battery : % from {{battery_level}} level initially 100 % | a measured value | \
        a value on the robot's blackboard, with its unit, for use in conditions
    context | context humans_near : distance < 2 m | a named condition | a situation that conditions can name
    hazard | hazard H1 "Collision with a person" | a hazard | \
        what may go wrong, which requirements mitigate
    scenario | scenario "The station is closed" of Deliver verifies rq1 | a run to test | \
        a run that `btq test` makes: what nodes do, what changes, and what is expected then
    given | given MoveTo takes 20 s | for all scenarios | what is given in all scenarios of the file
    apply | apply slow to every MoveBase except ToDock | a requirement for many nodes | \
        attaches a requirement to nodes anywhere in the mission
    quality | quality hygiene : safety "Nothing is carried along" | a custom quality | \
        your own quality, below a known one
    qualities | qualities iso25010-2011 | the edition of the quality model | \
        the edition of ISO/IEC 25010 whose names the file uses
    TreeNodesModel | TreeNodesModel | models, and their place in the XML | \
        models that the XML contains at this place; without it they come last
    Action | Action MoveBase | {_MODEL} | {_PLACE.format("an action")}
    Condition | Condition BatteryLow | {_MODEL} | {_PLACE.format("a condition")}
    Control | Control RoundRobin | {_MODEL} | {_PLACE.format("a node with children")}
    Decorator | Decorator RateController | {_MODEL} | {_PLACE.format("a node with one child")}
    SubTree | SubTree PickPlace | a model: the ports of a tree | {_PLACE.format("a tree")}
    xml | xml '<Extra/>' | unchanged XML | one XML element, written unchanged by `btq build`
part of a signal
    level | signal charge : % level | goes down with use | its use is the initial minus the final value
    counter | signal energy : Wh counter | goes up with use | its use is the final minus the initial value
    gauge | signal speed : m/s gauge | a plain value | a value that is not used up
    fresh within | signal speed : m/s fresh within 200 ms | its age | \
        in a log an older reading counts as unknown; guards read the latest one, whatever its age
    initially | signal speed : m/s initially 0 m/s | for guards | \
        what a guard reads before the first sample; no measurement, so no verdict follows from it
part of a model
    input | input goal : Pose | a port | a port that the node reads
    output | output path : Path | a port | a port that the node writes
    inout | inout queue : Queue | a port | a port that the node reads and writes
    metadata | metadata (author = "me") | for other tools | values for other tools: `<Metadata>`
clause of a node
    satisfices | satisfices safety, comfort | mark a concern: a quality | \
        early design: the node affects a quality, not yet by a measurable amount
    satisfies | satisfies in_time | attach a requirement | late design: a measurable requirement holds for the node
    tags | tags driving, indoor | mark the node for `apply` | \
        makes the node one of those that `every node tagged driving` selects
    parameters | parameters station = home | ports, in the classic syntax | the node's ports
attribute of a node
    name | MoveBase (name = "ToBench") | instance name | the name of this one node; short: `MoveBase ToBench`
    ID | SubTree (ID = PickPlace) | the kind of node | the node's kind, or a SubTree's tree; short: `SubTree PickPlace`
    Quality | MoveBase (satisfices Quality = safety) | a quality, in the classic syntax | \
        a concern of the node; short: `satisfices safety`
attribute of the file
    BTCPP_format | Root Deliver (BTCPP_format = "4") | the version of the XML | \
        the version of the format; `btq build` writes 4 by default
    main_tree_to_execute | Root (main_tree_to_execute = "Deliver") | the main tree | \
        the tree that runs; short: `Root Deliver`
    ros_pkg | include "trees.xml" (ros_pkg = "my_robot") | the package of the file | \
        the ROS package below which the engine looks for an included file
classic form
    description | QualityReq ID = "rq1" description = "In time" | a requirement's text | \
        what is required, in words; short: `QualityReq rq1 : time-behaviour "In time"`
    SuccessIf | QualityReq ID = "rq1" description = "SuccessIf takes at most 30 s" | \
        a hard constraint in a description | \
        what must hold: `btq build` enforces a clause after it; prose is for people only
    FailureIf | QualityReq ID = "rq1" description = "FailureIf takes more than 30 s" | \
        a hard constraint in a description | \
        what must not happen: `btq build` enforces a clause after it; prose is for people only
subject
    mission | mission takes at most 1 h | subject: the whole run | the whole run: the main tree
    every | every MoveArm takes at most 8 s | subject: each node of a kind | each node of an ID or a kind
    from | {_SPAN} | subject: between two events | the time from an event to the next event after `to`
    to | {_SPAN} | the later event | the event that ends the time
    each | each Pick fails is followed by Recover starts | subject: every time that it happens | \
        each occurrence of an event; what is demanded is what follows it
    sum of | sum of ToBox, ToHome takes at most 120 s | subject: several nodes together | \
        the durations of several nodes in one run, added up
claim
{_CLAIMS}
bound
    at most | takes at most 30 s | an upper bound | this or less
    at least | takes at least 1 s | a lower bound | this or more
    less than | takes less than 30 s | an upper bound | less than this
    more than | takes more than 1 s | a lower bound | more than this
    between | takes between 0.2 s and 1 s | a lower and an upper bound | from the first value to the second
    for more than | never lamp_on for more than 30 s | the longest time | no longer than this at a stretch
    within | succeeds within 30 s | an upper bound | no later than this
    if | takes at most 6 min if night else 8 min | a value for a situation | the value while that holds
    else | takes at most 6 min if night else 8 min | the value otherwise | the value in all other situations
    per | tries at most 3 per PickTray | counting period | the period for counting: a node's activation, or a time
    of | uses at most 20 Wh of energy | of what | the signal that is used, or what a probability counts
    after | starts within 2 s after Batch succeeds | since when | the event that starts a time
event
    starts | follows Pick starts | it leaves IDLE | the node leaves IDLE
    succeeds | follows Pick succeeds | SUCCESS | the node returns SUCCESS
    fails | follows Pick fails | FAILURE | the node returns FAILURE
    finishes | follows Pick finishes | SUCCESS or FAILURE | the node returns SUCCESS or FAILURE
    halts | follows Pick halts | it is halted while it runs | another node or the program halts the node while it runs
    when | starts within 1 s after when humans_near | a condition | a condition becomes true
    or | follows Pick fails or Place fails | any of several | any of several events; a condition comes last
clause
    while | while humans_near | only while a condition holds | \
        `keeps`, `never`, `runs`: counts only the time in which it holds; others: activations in which it always holds
    when | when fragile | only when a condition holds | counts only activations at whose start the condition holds
    assuming | assuming visibility >= 1 m | not applicable otherwise | \
        in its requirement alone: runs, or activations, in which the condition does not hold all along are counted apart
    until | from Pick starts until Place succeeds | only between two events | \
        for `keeps` and `never`: only the time from an event until the next other one, or the end of the run
    on average | on average | the mean | \
        of `takes` and `uses`: the mean of all activations that succeed or fail keeps the bound, and not each of them
    in at least | in at least 98 % of activations | how often | \
        allows some violations; also `of runs`, of an event `of occurrences`, and `with probability >= 98 %`
    of time | in at least 95 % of time | a share of the time | \
        of `keeps` and `never`: in each run the condition may be broken for the rest of the time that the node runs
    with probability | with probability >= 98 % of runs | how often | allows some violations
    activations | in at least 98 % of activations | from its start to its end | each time that the node runs
    runs | in at least 98 % of runs | whole missions | each time that the mission runs
    occurrences | in at least 98 % of occurrences | each time that an event happens | \
        each time that the event of `each … is followed by` happens
    confidence | confidence 95 % | how sure | the required statistical confidence of a verdict on the probability
    over last | over last 200 activations | window | ignores older ones; also `over last 7 d`
    on violation | on violation fail | what happens: fail, halt, warn or log | \
        what the robot does: `fail` the node, `halt` the mission, `warn` or `log`; default: only monitored
    goal | goal 20 s | a better value | a value better than the bound; it never changes a verdict
    because | because "visitors do not know the robot" | the reason | the reason
    verified by | verified by review | monitor, analysis, test or review | \
        the verification method: `monitor`, `test`, `analysis` or `review`
    source | source "ISO 13482, 5.10.2" | where it is from | where it is from: a clause of a standard, a document, a URL
    refines | refines safe_speed | what it is a part of | the requirements of which this one is a part
    mitigates | mitigates H1, H2 | hazards | the hazards that it makes less likely or less severe
    priority | priority high | a tag | how important it is: a word of your own, which is shown and filtered
    approved by | approved by "Kim" on "2026-11-29" of "1:0123456789ab" | who, when, and what | \
        an approval, which `btq approve` writes; it counts until the requirement means something else
clause of a hazard
    severity | severity high | a tag | how severe it is: a word of your own
part of a scenario
    of | scenario "Closed" of Deliver | a tree | the tree that runs; without it the main tree
    verifies | scenario "Closed" verifies rq1, rq2 | requirements | the requirements that the scenario is a test of
step of a scenario
    given | given battery = 80 % | what is given | what nodes do, or the value of a signal or an entry at the start
    when | when 30 s have passed: person_near = true | what changes | something that changes during the run
    expect | expect mission succeeds within 2 min | what is expected | what must be true of the run
behavior of a node
    succeeds | given Dock succeeds | its result | the node returns SUCCESS
    fails | given Dock fails twice | its result | the node returns FAILURE
    skips | given Dock skips | its result | the node returns SKIPPED
    does not end | given Dock does not end | no result | the node runs until it is halted
    answers | given BatteryLow answers false, true | a condition's results | \
        the results of a condition, one for each time it is asked; the last one repeats
    takes | given Dock takes 3 s | its duration | how long the node runs; its result is given elsewhere
    after | given Dock fails after 3 s | its duration | how long the node runs before this result
    once | given Dock fails once, then succeeds | in one activation | in one activation, then the next behavior
    twice | given Dock fails twice, then succeeds | in two activations | in two activations, then the next behavior
    times | given Dock fails 3 times, then succeeds | in several activations | \
        in so many activations, then the next behavior
    then | given Dock fails once, then succeeds | next | what the node does in its next activations
    and writes | given Pick succeeds and writes tubes = 2 | entries | the entries that the node writes when it ends
change during the run
    have passed | when 30 s have passed: battery = 3 % | at a time | so long after the start of the run
    for the time | when Dock fails for the 2 time: mission halts | the second event | \
        when that happens for the second time
    first | when Dock fails for the first time: near = true | the first event | when that happens for the first time
    second | when Dock fails for the second time: near = true | the second event | \
        when that happens for the second time
    third | when Dock fails for the third time: near = true | the third event | when that happens for the third time
    mission halts | when 30 s have passed: mission halts | the program halts the tree | the program halts the tree
expectation
    runs | expect MoveTo runs "A", "B" | values of its port | \
        the values of a port in all activations, in order, no more and no less
    finally | expect finally {{done}} == true | at the end | a condition at the end of the run
    mission does not end | expect mission does not end | no end | the run goes on forever
    mission fails | expect mission fails | how it ends | the run ends with FAILURE
    mission halts | expect mission halts | how it ends | the program halts the tree, and the run is over
    satisfied | expect rq1 satisfied | a verdict | the requirement is satisfied; `expect rq1` means the same
    violated | expect rq1 violated | a verdict | the requirement is violated
    unknown | expect rq1 unknown | a verdict | what the requirement needs is not measured
    undecided | expect rq1 undecided | a verdict | one run does not tell, as of a probability
    never exercised | expect rq1 never exercised | a verdict | what the requirement is about did not happen
    not applicable | expect rq1 not applicable | a verdict | an assumption of the requirement did not hold
action
    fail | on violation fail | stop the node | stops the node and makes it fail; its parent handles the failure
    halt | on violation halt | stop the mission | \
        halts the mission at the next tick, even if a parent handles the failure
    warn | on violation warn | notify | notifies the operators; nothing stops
    log | on violation log | record | writes to the log; nothing stops
method
    monitor | verified by monitor | from logs | tools check it from logs; the default
    analysis | verified by analysis | by people | people analyze it; no tool computes it
    test | verified by test "TC-12" | by people | a test shows it; no tool computes it
    review | verified by review "R-3" | by people | people review it; no tool computes it
selector
    every | apply slow to every MoveBase | all nodes of a kind | all nodes of an ID or a kind
    under | apply slow to every MoveBase under Dock | below a node | only the nodes below another node
    every node tagged | apply slow to every node tagged driving | by a tag | all nodes with a tag
    except | apply slow to every MoveBase except ToDock | all but these | excludes these nodes
part of a condition
    and | needs calm and battery > 10 % | both | both sides hold
    or | needs calm or battery > 10 % | one of them | one of the sides holds
    not | needs not calm | it does not hold | the condition after it does not hold
    node | keeps calm or not node FollowPath | a node runs | that node is running
    true | keeps door == true | a bool value | a value of a bool signal
    false | keeps door == false | a bool value | a value of a bool signal
    max | leaves max(force) < 8 N | the largest value | the largest value, over the node's activation
    min | leaves min(force) < 8 N | the smallest value | the smallest value, over the node's activation
    mean | leaves mean(force) < 8 N | the mean | the mean, over the node's activation
    p95 | leaves p95(force) < 8 N | the 95th percentile | the 95th percentile, over the node's activation
    stddev | leaves stddev(force) < 8 N | the standard deviation | the standard deviation, over the node's activation
    change | leaves change(force) < 8 N | how much it changes | how much it changes, over the node's activation
    age | keeps age(position) <= 1 s | how old a value is | \
        the time since the last reading of a signal; before its first, since the node started
    count | leaves count(force) < 8 N | the number of readings | the number of readings, over the node's activation
"""


def _phrases(outline: str) -> Iterator[Phrase]:
    part = ""
    for line in outline.splitlines():
        if line.startswith(" "):
            words, form, brief, meaning = map(str.strip, line.split(" | "))
            yield Phrase(words, part, form, brief, meaning)
        else:
            part = line


PHRASES: Final = tuple(_phrases(_TABLE))

# Signs: the sign, how it is written, and what it means.
SIGNS: Final = (
    ("{ }", "MoveBase (goal = {pose})", "an entry of the blackboard: `{pose}` is the entry `pose` of this tree"),
    ("{=}", "MoveBase (goal = {=})", "the entry with the name of the port"),
    ("{@ }", "Sensors (battery = {@battery_level})", "an entry of the root blackboard, which all trees share"),
    ('" "', '"3 Waypoints"', "a string, or a name with spaces; a quoted word is never a keyword"),
    ("( )", 'MoveBase (station = "charger")', "the ports, attributes and clauses of the node before it"),
    ("#", "Charge  # until it is full", "a comment, to the end of the line, as `//`"),
    ("//", "Charge  // until it is full", "a comment, to the end of the line, as `#`"),
    ("/* */", "/* until it is full */", "a comment, over any number of lines"),
    (":", "signal battery : %", "the unit of a signal, the type of a port, the quality of a requirement"),
    ("/", "Recharge/MoveBase", "a path: the node MoveBase anywhere below Recharge; in a condition a division"),
    (
        "btq: ignore",
        "# btq: ignore[unused-tree]",
        "in a comment: silences all findings on this line, or only those of one rule",
    ),
)


@cache
def _words() -> re.Pattern[str]:
    words = sorted({phrase.words for phrase in PHRASES}, key=len, reverse=True)
    return re.compile(rf"(?<![\w-])(?:{'|'.join(words)})(?![\w-])")
