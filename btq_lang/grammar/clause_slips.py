"""Whole clauses in the words of other notations: `during people_near`, `window 200 runs`, `response time < 200 ms`.

One invariant: no pattern matches a clause of this notation, so the parser may ask about any that it could not read.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final

from btq_lang.catalog.verbs import VERBS
from btq_lang.grammar.conditions import BOUNDS, HEADS, RELATIONS
from btq_lang.grammar.prose import MODALS
from btq_lang.util.record import Record


class ClauseMeant(Record):
    """The meaning of a clause of other notations.

    Attributes:
        length: of its text.
        clauses: in this notation, the likeliest first; a word in `<…>` is left to choose.
        note: in what the clauses differ, or what is left to choose; may be empty; without clauses, why there is none.
    """

    length: int
    clauses: tuple[str, ...]
    note: str


def clause_slip(text: str) -> ClauseMeant | None:
    """The meaning of the clause with which a text begins; None if the table has none."""
    for pattern, clauses, note in _table():
        if match := pattern.match(text):
            parts = {name: value or "" for name, value in match.groupdict().items()}
            bound = BOUNDS.get(tuple(parts.get("bound", "").split()), ("at", "most"))
            parts |= {"bound": " ".join(bound), "sign": RELATIONS[bound]}
            if "number" in parts:
                parts["number"] = _IN_DIGITS.get(parts["number"], parts["number"])
            if "tolerance" in parts:
                parts["limits"] = _limits(parts["other"], parts["value"], parts["tolerance"])
            subject = parts.get("subject", "")
            node = subject if not subject.startswith("every ") else ""
            parts |= {"subject": f"{subject} " if subject else "", "node": node or "<node>"}
            return ClauseMeant(match.end(), tuple([clause.format_map(parts) for clause in clauses]), note)
    return None


def _limits(signal: str, value: str, tolerance: str) -> str:
    """The condition that a signal is a value, more or less."""
    (number, unit), (by, other) = _NUMBER_AND_UNIT.findall(value)[0], _NUMBER_AND_UNIT.findall(tolerance)[0]
    if other == "%" and unit != "%":
        by = str(float(number) * float(by) / 100)
    elif unit != other:
        return f"-{tolerance} <= {signal} - {value} <= {tolerance}"
    low, high = (f"{limit:.10g} {unit}".rstrip() for limit in (float(number) - float(by), float(number) + float(by)))
    return f"{low} <= {signal} <= {high}"


@lru_cache(1)
def _table() -> list[tuple[re.Pattern[str], tuple[str, ...], str]]:
    """The table, compiled when the first clause of a process cannot be read."""
    return [(_compiled(pattern), clauses, note) for pattern, clauses, note in _SLIPS]


def _compiled(pattern: str) -> re.Pattern[str]:
    for name, piece in _PIECES.items():
        pattern = pattern.replace(name, piece)
    return re.compile(rf"(?:{pattern})(?= *(?:$|[),])| +{_any(*HEADS)}\b)".replace(" ", r"\s"))


def _any(*words: str) -> str:
    return f"(?:{'|'.join(words)})"


OF_MISSION: Final = (
    "what is about the whole mission is satisfied by the root node of its main tree: `-> satisfies calm`"
)
_GOES: Final = ("starts?", "runs?", "begins?", "comes?", "happens?", "goes", "executes?")
_PATH: Final = r"[^\W\d][\w-]*(?:/[^\W\d][\w-]*)*"
_SEVERAL: Final = r"mission|every +[^\W\d]\w*"
_BOUNDS: Final = sorted((" ".join(map(re.escape, words)) for words in BOUNDS), key=len, reverse=True)
_NO_NODES: Final = rf"(?!{_any(*HEADS, *VERBS, *MODALS, 'of', 'is', 'be', 'has', 'have', 'ought', 'needs', *_GOES)}\b)"
_PIECES: Final = {
    "SUBJECT": rf"(?:(?P<subject>{_SEVERAL}|{_NO_NODES}{_PATH}) +)?",
    "OTHER": rf"(?P<other>{_NO_NODES}{_PATH})",
    "BOUND": rf"(?:(?:is|be|of) )?(?P<bound>{'|'.join(_BOUNDS)}) *",
    "CONDITION": rf"(?P<condition>.+?)(?= +{_any(*HEADS - {'in', 'with'}, 'in at', 'with probability')}\b|$)",
    "TIME": r"(?P<time>[\d.]+ *(?:[num]?s|secs?|seconds?|mins?|minutes?|h|hrs?|hours?|d|days?))",
    "SHARE": r"(?P<share>[\d.]+ *%)",
    "VALUE": rf"(?P<value>[\d.]+ *(?:(?!{_any('of', *HEADS)}\b)[^\W\d][\w/^*]*|%))",
    "NUMBER": r"(?P<number>[\d.]+)",
    "COUNT": r"(?P<count>\d+ (?:activations|runs))",
    "EVENT": r"(?P<event>starts|succeeds|fails|finishes|halts)",
}
_LIMIT: Final = r"(?: (?:at most|under|less than|no more than|max))?"
_LATEST: Final = "(?: of)?(?: the)?(?: (?:last|past|latest|most recent|previous))?"
_TIMES: Final = _any(
    "(?:response|reaction|execution|completion|processing|cycle|run|running|elapsed|travel)[ _-]?time",
    *("latency", "duration", "time"),
)
_RATE: Final = _any("runs?", "ticks?", "repeats?", "executes", "is executed", "updates?", "is called")
_PER: Final = "(?:times )?(?:per|a|each|every) (?:1 ?)?(?P<unit>s|min|h)(?:ec|ecs|econd|econds|ute|utes|our|ours)?"
_IN_WORDS: Final = _any("during", "for as long as", "as long as", "so long as", "whilst")
_IF: Final = _any("whenever", "only when", "only if", "only while", "provided(?: that)?", "given(?: that)?", "for")
_WHENEVER: Final = _any("whenever", "after", "once", "if", "each time", "every time", "when")
_HAPPENS: Final = ("starts", "succeeds", "fails", "finishes", "halts")
_NOT: Final = _any("except(?: (?:when|while|if|during))?", "until", "but not (?:when|while|if)")
_MODAL: Final = _any(*MODALS, "has to", "have to", "ought to", "needs to")
_ENDS: Final = "(?:be |is )?(?:finish(?:es|ed)?|ends?|ended|over|terminate[sd]?|complete[sd]?|returns?|stops?)"
_STARTS: Final = "(?: (?:starts|runs|begins))?"
_USES: Final = "SUBJECT(?:uses?|consumes?|drains?|spends?)"
_SITUATION: Final = "`while` counts the time in which it holds, `when` the activations at whose start it holds"
_OVER_FOR: Final = (
    "an event is a moment: let a signal count the time since then, and write `until when clear_time >= 5 s`"
)
_FEATURE: Final = (
    "what only some robots have is not judged without it; a requirement of its own, which `apply` attaches where the "
    "feature is included, needs no condition"
)
_IF_THEN: Final = r"(?:[Ww]hen|[Ii]f) (?P<condition>[^,]+?),? then"
_COMPARISON: Final = r"[^,]+?(?:[<>]=?|[=!]=)[^,]+?"
_NO_VERB: Final = rf"(?!.*\b{_any('keeps', 'never', 'needs', 'leaves', 'is')}\b)"
_ANSWER: Final = rf"{_COMPARISON}|{_PATH} {_any('starts', 'succeeds', 'fails', 'finishes', 'halts')}"
_NIGHT: Final = ("night", "day", "hour", "shift", "week", "month", "season", "year")
SEASONS: Final = frozenset((*_NIGHT, *(f"{word}s" for word in _NIGHT)))
OF_SEASONS: Final = (
    "a share of nights or of all hours cannot be said: `keeps <signal> in at least 98 % of time` is a share of each "
    "run, `in at least 98 % of runs` counts the runs that keep a claim"
)
_FAILURE: Final = "`succeeds within` is violated by a failure too, `takes at most` is not"
_SIGNAL: Final = "a name alone is a signal or context: `signal latency : s from {latency}`"
_USED: Final = "a signal whose use is limited is a `counter` or a `level`: `signal energy : Wh from {energy} counter`"
_BEFORE: Final = "what happens before an event is the time from one event to another"
_EACH_TIME: Final = "`Place follows Pick succeeds` asks for another success of Pick before each start of Place"
_NUMBER_AND_UNIT: Final = re.compile(r"([\d.]+)\s*(.*)")
_IN_DIGITS: Final = {"once": "1", "twice": "2"}
ROBOTS: Final = frozenset(("robot", "system", "vehicle", "machine"))
_ROBOT: Final = f"(?:[Tt]he )?{_any(*sorted(ROBOTS))}"
_STOPS: Final = "(?:(?:be |is |comes? to |come to )?(?:halt(?:s|ed)?|stop(?:s|ped)?|brakes?|a stop|a halt))"
_ANSWERS: Final = (
    "the answer is an event, as `Stop succeeds`, or a condition, as `speed <= 0.01 m/s`, which one moment meets; "
    "what must stay so is written `never near and speed > 0.01 m/s for more than 1 s`"
)
_SPEED: Final = r"(?P<value>[\d.]+ *(?:m/s|km/h|mm/s|cm/s|mph))"
_EXCEEDS: Final = "(?:exceed|(?:be|drive|go|move|travel)(?: any)? (?:faster|more|higher|larger|greater) than|be above)"
_A_SIGNAL: Final = "what is measured is a signal: `signal speed : m/s from {speed}`"
# Patterns, in which a word in capitals is a piece of above; what is written instead; a note.
_SLIPS: Final[tuple[tuple[str, tuple[str, ...], str], ...]] = (
    # what the robot does
    (
        rf"{_ROBOT}(?:'s)?(?: speed)? (?:{_MODAL} )?(?:never|not) {_EXCEEDS} {_SPEED}",
        ("mission keeps speed <= {value}",),
        _A_SIGNAL,
    ),
    (
        rf"{_ROBOT} (?:{_MODAL} )?(?:never|not) {_EXCEEDS} VALUE",
        ("mission keeps <signal> <= {value}",),
        _A_SIGNAL,
    ),
    *(
        (
            rf"{_ROBOT} (?:{_MODAL} )?{_STOPS} (?:within|in) TIME (?:after|when|if) (?:when )?{event}",
            (f"each {written} is followed by <answer> within {{time}}",),
            _ANSWERS,
        )
        for event, written in (("OTHER EVENT", "{other} {event}"), ("CONDITION", "when {condition}"))
    ),
    (
        rf"(?:each )?[Ww]hen(?:ever)? (?P<condition>[^,]+?),? (?:then )?(?:{_ROBOT}|it) (?:{_MODAL} )?{_STOPS} "
        "(?:within|in) TIME",
        ("each when {condition} is followed by <answer> within {time}",),
        _ANSWERS,
    ),
    (rf"[Tt]he {_any(*sorted(ROBOTS))} (?P<claim>{_any(*VERBS)}\b.+)", ("mission {claim}",), ""),
    *(
        (
            rf"(?!mission\b)SUBJECT(?:{_MODAL} )?(?:halts?|(?:be |is )?(?:halted|stopped)|stops?|finish(?:es)?|"
            rf"completes?) (?:within|in) TIME (?:after|when) (?:when )?{event}",
            (f"{{subject}}ends within {{time}} after {written}",),
            "it counts where the node runs at that moment",
        )
        for event, written in (("OTHER EVENT", "{other} {event}"), ("CONDITION", "when {condition}"))
    ),
    # a value with two sides, or two values
    (
        rf"SUBJECT(?P<verb>(?:{_any('keeps', 'leaves', 'needs', 'ends with')} )?)OTHER *(?:(?:==?|of|is|at|:) *)?VALUE"
        r" *(?:\+ */? *-|±) *(?P<tolerance>[\d.]+ *(?:[^\W\d][\w/^*]*|%)?)",
        ("{subject}{verb}{limits}",),
        "",
    ),
    (
        r"(?P<claim>.+?(?:[<>]=?|==) *)VALUE (?:if|when|while) (?P<condition>.+?),? (?:else|otherwise) "
        r"(?P<second>[\d.]+ *(?:[^\W\d][\w/^*]*|%)?)",
        ("{claim}({value} if {condition} else {second})",),
        "",
    ),
    # how long
    (
        rf"SUBJECT(?:succeeds?|is done|done|is ready) (?:in|by|before|within){_LIMIT} TIME",
        ("{subject}succeeds within {time}",),
        "",
    ),
    (
        f"SUBJECT(?:{_MODAL} )?{_ENDS} (?:in|by|before|within){_LIMIT} TIME",
        ("{subject}succeeds within {time}", "{subject}takes at most {time}"),
        _FAILURE,
    ),
    (
        "(?P<name>latency|runtime|delay|[a-z]+_time) *BOUNDTIME",
        ("takes {bound} {time}", "keeps {name} {sign} {time}"),
        _SIGNAL,
    ),
    (
        rf"(?:the )?(?:(?:max(?:imum)?|total) )?{_TIMES}(?: of SUBJECT|[^<>=:]*?) *BOUNDTIME",
        ("{subject}takes {bound} {time}",),
        "",
    ),
    (rf"(?P<subject>{_SEVERAL}) {_TIMES} *BOUNDTIME", ("{subject}takes {bound} {time}",), ""),
    (rf"(?:(?:max(?:imum)? )?{_TIMES}|timeout|time limit)(?: *[:=]| of)? *TIME", ("takes at most {time}",), ""),
    ("deadline(?: *[:=]| of)? *TIME", ("succeeds within {time}",), ""),
    # what then
    ("on-?violation:? *(?P<action>fail|halt|warn|log)", ("on violation {action}",), ""),
    # how often
    (f"SUBJECT{_RATE} BOUNDNUMBER *Hz", ("{subject}runs {bound} {number} per 1 s",), ""),
    (f"SUBJECT{_RATE}(?: (?:at|with|every))? NUMBER *Hz", ("{subject}runs at least {number} per 1 s",), ""),
    (f"SUBJECT{_RATE} BOUNDNUMBER {_PER}", ("{subject}runs {bound} {number} per 1 {unit}",), ""),
    (f"SUBJECT{_RATE}(?: (?:at|with|every))? NUMBER {_PER}", ("{subject}runs at least {number} per 1 {unit}",), ""),
    (f"SUBJECT{_RATE} once {_PER}", ("{subject}runs at least 1 per 1 {unit}",), ""),
    (f"SUBJECT{_RATE} (?:once|each|at most|at least)(?: every)? TIME", ("{subject}runs every {time}",), ""),
    ("(?:the )?(?:update |tick |control )?(?:frequency|rate) *BOUNDNUMBER *Hz", ("runs {bound} {number} per 1 s",), ""),
    ("(?:the )?(?:period|cycle) *BOUNDTIME", ("runs every {time}",), ""),
    (r"(?:attempts|retries) *BOUND(?P<number>\d+)", ("tries {bound} {number}",), ""),
    (r"(?:the )?(?:number of )?failures *BOUND(?P<number>\d+)", ("fails {bound} {number} per run",), ""),
    ("(?:the )?(?:mtbf|MTBF|mean time between failures) *BOUNDTIME", ("fails at most 1 per {time}",), ""),
    (
        rf"(?:the )?(?:average|mean) {_TIMES}(?: of SUBJECT|[^<>=:]*?) *BOUNDTIME",
        ("{subject}takes {bound} {time} on average",),
        "",
    ),
    ("SUBJECTtakes on average BOUNDTIME", ("{subject}takes {bound} {time} on average",), ""),
    (
        f"{_USES} on average BOUNDVALUE (?:(?:of|from) )?OTHER",
        ("{subject}uses {bound} {value} of {other} on average",),
        "",
    ),
    (r"(?:the )?(?:number of )?successes *BOUND(?P<number>\d+)", ("succeeds {bound} {number} per run",), ""),
    *(
        (
            rf"SUBJECT(?:never|{_MODAL} (?:not|never)|does not) {word} more (?:often )?than (?P<number>\d+|once|twice)"
            "(?: times?)?(?: (?:per|in a|in one|in each) run)?",
            (f"{{subject}}{verb} at most {{number}} per run",),
            "",
        )
        for word, verb in (
            *(("(?:starts?|runs?)", "starts"), ("fails?", "fails")),
            *(("succeeds?", "succeeds"), ("finish(?:es)?", "finishes")),
        )
    ),
    # how probably
    ("(?:for |during )?(?:at least )?SHARE of (?:the |its |that )?time", ("in at least {share} of time",), ""),
    (
        "(?:the )?availability *(?:is |of )?(?:>=|at least|min|minimum|[:=]) *SHARE",
        ("keeps <signal> in at least {share} of time", "succeeds in at least {share} of runs"),
        "the first is a share of the time, of a signal that is true while it is available",
    ),
    (
        "(?:the )?(?:success[ _-]?(?:rate|ratio|probability)|probability of success|reliability) *"
        "(?:is |of )?(?:>=|at least|min|minimum|[:=]) *SHARE",
        ("succeeds in at least {share} of activations", "succeeds in at least {share} of runs"),
        "",
    ),
    (
        "SUBJECTsucceeds (?:at least )?SHARE of (?P<experiments>runs|activations)",
        ("{subject}succeeds in at least {share} of {experiments}",),
        "",
    ),
    (
        "SUBJECTsucceeds (?:at least )?SHARE(?: of (?:the time|times))?",
        ("{subject}succeeds in at least {share} of activations", "{subject}succeeds in at least {share} of runs"),
        "",
    ),
    (
        "SUBJECT(?:is )?available (?:in )?(?:>=|at least) SHARE(?: of (?:the )?time)?",
        ("{subject}keeps <signal> in at least {share} of time",),
        "the signal is true while it is available, and the share is that of each run",
    ),
    (
        rf"SUBJECT(?:is )?available (?:in )?(?:>=|at least) SHARE of (?:all |the )?{_any(*sorted(SEASONS))}",
        (),
        OF_SEASONS,
    ),
    ("SUBJECTsatisfies OTHER", (), f"`satisfies` goes after a node in its tree; {OF_MISSION}"),
    # of which activations
    (
        f"(?:(?:sliding |moving )?window|over|for|in|within|across|during|history)(?: size)?(?: *[:=])?{_LATEST} COUNT",
        ("over last {count}",),
        "",
    ),
    ("(?:the )?(?:last|past|latest|most recent) COUNT", ("over last {count}",), ""),
    (f"(?:(?:sliding |moving )?window(?: size)?(?: *[:=])?|over){_LATEST} TIME", ("over last {time}",), ""),
    (
        rf"(?:(?:sliding |moving )?window(?: size)?(?: *[:=])?|over){_LATEST} (?P<number>\d+)",
        ("over last {number} activations", "over last {number} runs"),
        "",
    ),
    # what follows an event
    *(
        (
            rf"{_WHENEVER} OTHER EVENT,? *(?:then )?(?P<answer>{_PATH} {_any(*_HAPPENS)}){within}",
            (f"each {{other}} {{event}} is followed by {{answer}}{deadline}",),
            "",
        )
        for within, deadline in ((" (?:within|in) TIME", " within {time}"), ("", ""))
    ),
    *(
        (
            rf"(?:mission )?(?:keeps )?{_NO_VERB}(?P<answer>{_COMPARISON}) within TIME after (?:when )?{after}",
            (f"each {event} is followed by {{answer}} within {{time}}",),
            "",
        )
        for after, event in (("OTHER EVENT", "{other} {event}"), ("(?P<condition>.+?)", "when {condition}"))
    ),
    # what holds, or happens, in a situation
    (
        rf"[Ww]hen(?:ever)? (?P<condition>[^,]+?),? (?:then )?(?:the )?[^\W\d]\w* {_MODAL} [^,]+? (?:within|in) TIME",
        ("each when {condition} is followed by <answer> within {time}",),
        "after `by` an event, as `Stop succeeds`, or a condition, as `speed <= 0.01 m/s`, then `within` and the time",
    ),
    (
        f"{_IF_THEN} (?P<answer>{_ANSWER}) within TIME",
        ("each when {condition} is followed by {answer} within {time}",),
        "",
    ),
    (
        rf"{_IF_THEN} (?P<answer>{_COMPARISON})",
        ("keeps {answer} while {condition}", "each when {condition} is followed by {answer}"),
        "the first holds all the while, the second at some moment after each time",
    ),
    (f"{_IF_THEN} (?P<answer>{_ANSWER})", ("each when {condition} is followed by {answer}",), ""),
    (
        rf"{_IF_THEN} (?P<answer>{_any(*VERBS)}\b.+?)",
        ("{answer} while {condition}", "{answer} when {condition}"),
        _SITUATION,
    ),
    # in which situation
    ("from .+? until when .+? for TIME", (), _OVER_FOR),
    ("for (?:BOUND)?TIME", (), "only `never` says how long a condition may hold: `never low for more than 30 s`"),
    (f"{_IN_WORDS} CONDITION", ("while {condition}",), ""),
    ("where CONDITION", ("assuming {condition}", "while {condition}"), _FEATURE),
    (f"{_IF} CONDITION", ("while {condition}", "when {condition}"), _SITUATION),
    ("until OTHER EVENT", ("from mission starts until {other} {event}",), "`from` begins with an event, too"),
    (rf"{_NOT} (?!\d)CONDITION", ("while not {condition}",), ""),
    (
        rf"SUBJECT(?:{_MODAL} )?(?:end|finish(?:es)?|completes?|stops?) with (?!\d)CONDITION",
        ("{subject}ends with {condition}",),
        "",
    ),
    # in which order
    (
        f"SUBJECT(?:{_any(*_GOES)} )?not (?:{_any(*_GOES)} )?before OTHER EVENT",
        ("mission never node {node} from mission starts until {other} {event}", "{subject}follows {other} {event}"),
        _EACH_TIME,
    ),
    (
        "SUBJECTstarts within TIME before OTHER EVENT",
        ("from {node} starts to {other} {event} takes at most {time}",),
        _BEFORE,
    ),
    (
        "SUBJECTends within TIME before OTHER EVENT",
        ("from {node} finishes to {other} {event} takes at most {time}",),
        _BEFORE,
    ),
    (
        f"SUBJECT(?P<event>starts|succeeds|fails) (?:only )?before OTHER{_STARTS}",
        ("mission never node {other} from mission starts until {node} {event}",),
        _EACH_TIME,
    ),
    (
        f"SUBJECT(?:ends|finishes|stops|completes|is done) (?:only )?before OTHER{_STARTS}",
        ("mission never node {other} from mission starts until {node} finishes",),
        _EACH_TIME,
    ),
    (
        f"(?!before)SUBJECT(?:{_MODAL} )?(?:{_any(*_GOES)} )?(?:only )?(?:before|precedes?|then|->) OTHER{_STARTS}",
        ("mission never node {other} from mission starts until {node} succeeds",),
        _EACH_TIME,
    ),
    (f"(?!mission)SUBJECT{_any(*_GOES)} (?:only )?after OTHER EVENT", ("{subject}follows {other} {event}",), ""),
    (
        f"(?!mission)SUBJECT(?:{_any(*_GOES)} (?:only )?after|follows) OTHER",
        ("{subject}follows {other} succeeds", "{subject}follows {other} finishes"),
        "`finishes` is a success or a failure",
    ),
    # how much of what
    (
        "SUBJECT(?:keeps )?OTHER *BOUNDVALUE on average",
        ("{subject}uses {bound} {value} of {other} on average",),
        "what is used is the change of a counter or a level; a signal has no mean over runs",
    ),
    (r"SUBJECT(?:keeps )?OTHER *(?:\+/?-|±) *VALUE", ("{subject}keeps -{value} <= {other} <= {value}",), ""),
    (f"{_USES} BOUNDVALUE (?:(?:of|from) )?OTHER", ("{subject}uses {bound} {value} of {other}",), ""),
    (f"{_USES} BOUNDVALUE(?: of)?", ("{subject}uses {bound} {value} of <signal>",), _USED),
    (f"{_USES} BOUNDNUMBER(?: of)?", ("{subject}uses {bound} {number} of <signal>",), _USED),
    (f"{_USES} VALUE (?:(?:of|from) )?OTHER", ("{subject}uses at most {value} of {other}",), ""),
    (f"{_USES} OTHER *BOUNDVALUE", ("{subject}uses {bound} {value} of {other}",), ""),
)
