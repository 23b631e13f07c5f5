"""Requirements, conditions and what is attached to nodes, as drawn missions have them (drawn_missions.py)."""

from __future__ import annotations

from collections.abc import Callable

from drawn_words import KEYS, MEASURED, Hand, Line

QUALITIES = ["safety", "reliability", "performance-efficiency.time-behaviour", "time-behaviour", "comfort"]
QUALITIES += ["safety.operational-constraint", "interaction-capability", "energy-autonomy", "pose-accuracy"]
QUALITIES += [
    "performance-efficiency",
    "security.confidentiality",
    "contact-force-limit",
    "Reliability.Fault Tolerance",
]
CLASSIC_QUALITIES = ("performance", "performance <time-behavior>", "usability", "safety", "reliability", "security")
EVENTS = ("starts", "succeeds", "fails", "finishes", "halts")
SOURCES = ("ISO 13482, 5.10.2", "FMEA-12", "https://example.org/spec#4.2", "risk assessment 4, row 1", "customer")
WAYS = {"monitor": "", "test": "TC-", "analysis": "FTA ", "review": "R-"}
PRIORITIES = ("must", "should", "high", "low", '"nice to have"')
FUNCTIONS = ("max", "min", "mean", "p95", "stddev", "change", "count")


def quality(hand: Hand) -> str:
    """The path of a quality, of the standard or one that the file declares."""
    if hand.classic:
        return hand.pick(CLASSIC_QUALITIES)
    path = hand.name("quality") if hand.names.get("quality") and hand.maybe(0.1) else hand.pick(QUALITIES)
    return f'{path.split(".")[0]}."{path.split(".")[1]}"' if " " in path else path


# ---- requirements ---------------------------------------------------------------------------------------------------


def requirement(hand: Hand, lists: bool = True) -> Line:
    """A requirement as an item: its clauses on its line, in its block, or in both."""
    drawn = clauses(hand, lists)
    inline = hand.pick({0: 85, 1: 5, len(drawn): 10})
    head = _head(hand, hand.new("requirement"), titled=bool(inline) or hand.maybe(0.7))
    line = Line(hand.words(head, *drawn[:inline]), [Line(clause) for clause in drawn[inline:]])
    if len(line.block) > 1 and hand.maybe(0.05):  # two on a line
        last = line.block.pop()
        line.block[-1].text = hand.words(line.block[-1].text, last.text)
    return line


def _head(hand: Hand, name: str, titled: bool = True) -> str:
    """What a requirement begins with.  Without a title a string that begins the first clause would be one."""
    if hand.classic:
        return _classic(hand, name)
    parameters = ""
    if hand.maybe(0.12):
        default = hand.pair(" ", _bounded(hand, "speed")).rstrip() if hand.maybe(0.7) else ""
        more = f", patience : s{hand.equals}{hand.quantity('time')}" if hand.maybe(0.2) else ""
        parameters = f"(limit : m/s{default}{more})"
    colon = hand.pick({" : ": 12, ": ": 3, " :": 0.5})
    qualities = [quality(hand) for _ in range(hand.pick({1: 12, 2: 2, 3: 0.3}))]
    about = colon + hand.words(" and ".join(qualities)) if hand.maybe(0.85) else ""
    return hand.words(f"QualityReq {name}{parameters}{about}", hand.prose() if titled else "")


def _classic(hand: Hand, name: str) -> str:
    text = hand.pick(("The drive shall take at most 30 sec.", "No collision shall occur", "Each pump shall be reached"))
    if hand.maybe(0.3):
        text += hand.pick((" within 90 sec.", "\n\t\t\t\tand the robot shall report it", " (see 4.2)"))
    return hand.words(hand.pair("QualityReq ID", f'"{name}"'), hand.pair("description", f'"{text}"'))


def clauses(hand: Hand, lists: bool = True) -> list[str]:
    """The clauses of a requirement: mostly one claim, then what qualifies it.

    On a line with `satisfies`, and in brackets, a comma belongs to the list of requirements: no lists in clauses there.
    """
    claims = [claim(hand, lists)] if hand.maybe(0.92) else []
    most = 3 if lists else 1
    others: dict[float, Callable[[], str]] = {
        0.20: lambda: f"{hand.pick(('while', 'when'))} {condition(hand)}",
        0.04: lambda: f"from {_event(hand)} until {_event(hand)}",
        0.05: lambda: f"assuming {condition(hand)}",
        0.03: lambda: "on average",
        0.18: lambda: _odds(hand),
        0.08: lambda: f"confidence {hand.pick(('95 %', '99 %', '90%', '99.9 %'))}",
        0.10: lambda: f"over last {_window(hand)}",
        0.35: lambda: f"on violation {hand.pick({'fail': 4, 'halt': 2, 'warn': 2, 'log': 1})}",
        0.15: lambda: f"goal {_bounded(hand, 'time')}",
        0.25: lambda: f"because {hand.prose()}",
        0.14: lambda: f"verified by {_several(hand, lambda: _way(hand), most)}",
        0.12: lambda: _source(hand),
        0.07: lambda: f"refines {_several(hand, lambda: hand.name('requirement'), most)}",
        0.09: lambda: f"mitigates {_several(hand, lambda: hand.name('hazard'), most)}",
        0.11: lambda: f"priority {hand.pick(PRIORITIES)}",
        0.06: lambda: _approval(hand),
    }
    drawn = claims + [clause() for share, clause in others.items() if hand.maybe(share)]
    if hand.maybe(0.1):
        hand.chance.shuffle(drawn)
    drawn.sort(key=lambda clause: clause[0] not in "\"'")  # after `verified by test` a string would be its ID
    return drawn


def _several(hand: Hand, draw: Callable[[], str], most: int) -> str:
    """One, or a list of up to so many."""
    return hand.listed(draw() for _ in range(min(most, hand.pick({1: 8, 2: 3, 3: 1}))))


def _way(hand: Hand) -> str:
    way = hand.pick({"monitor": 3, "test": 4, "analysis": 1, "review": 2})
    number = hand.string(f"{WAYS[way]}{hand.chance.randint(1, 99)}")
    return hand.words(way, number if hand.maybe(0.1 if way == "monitor" else 0.6) else "")


def _source(hand: Hand) -> str:
    return f"source {hand.string(hand.pick(SOURCES))}"


def _approval(hand: Hand) -> str:
    """With the fingerprint that `btq approve` writes, or without one."""
    who = f"approved by {hand.string(hand.pick(('Kim', 'R. Diaz', 'safety board')))}"
    day = f"on {hand.string(f'2026-{hand.chance.randint(10, 12)}-{hand.chance.randint(10, 28)}')}"
    return hand.words(who, day, f"of {hand.string(f'1:{hand.chance.getrandbits(48):012x}')}" if hand.maybe(0.8) else "")


def hazard(hand: Hand) -> Line:
    """A hazard as an item: where it is from, why it is one, how severe it is."""
    title = hand.string(hand.pick(("Collision with a person", "The load falls", "Nobody is called")))
    line = Line(hand.words("hazard", hand.new("hazard"), title if hand.maybe(0.85) else ""))
    severity = hand.pick(("critical", "high", "low", "S2", '"very low"'))
    drawn = {_source(hand): 0.5, f"severity {severity}": 0.6, f"because {hand.prose()}": 0.2}
    line.block += [Line(clause) for clause, share in drawn.items() if hand.maybe(share)]
    if hand.maybe(0.2):
        hand.chance.shuffle(line.block)
    return line


def claim(hand: Hand, lists: bool = True) -> str:
    """A demand, perhaps with a subject; lists: with commas, too."""
    verbs = {
        "takes": 10,
        "succeeds": 4,
        "needs": 2,
        "keeps": 5,
        "never": 3,
        "leaves": 3,
        "uses": 2,
        "tries": 2,
        "runs": 2,
        "starts": 1,
        "ends": 1,
        "ends with": 1,
        "follows": 1,
        "counts": 2,
        "fails": 0.7,
        "visits": 1 if lists else 0,
        "each": 2,
    }
    verb = hand.pick(verbs)
    if verb == "each":
        answer = _event(hand) if hand.maybe(0.6) else condition(hand)
        within = f"within {_bounded(hand, 'time')}" if hand.maybe(0.7) else ""
        return hand.words(f"each {_event(hand)} is followed by {answer}", within)
    return hand.words(_subject(hand) if hand.maybe(0.25) else "", _verb(hand, verb))


def _subject(hand: Hand) -> str:
    kind = hand.pick({"path": 6, "mission": 2, "every": 3, "from": 2, "sum": 1, "word": 0.1})
    if kind == "every":
        return f"every {hand.name('model')}"
    if kind == "from":
        return f"from {_event(hand)} to {_event(hand)}"
    if kind == "sum":
        return "sum of " + hand.listed([hand.path(), hand.path(), *(hand.path() for _ in hand.some(2))])
    if kind == "word":  # which begins a clause where no verb follows
        return hand.pick(("source", "priority", "source/" + hand.name("label")))
    return "mission" if kind == "mission" else hand.path()


def _verb(hand: Hand, verb: str) -> str:
    if verb == "takes":
        return f"takes {_bound(hand, 'time')}"
    if verb == "succeeds":
        return f"succeeds within {_bounded(hand, 'time')}" if hand.maybe(0.7) else "succeeds"
    if verb in ("needs", "keeps", "never", "leaves", "ends with"):
        stretch = f"for more than {_bounded(hand, 'time')}" if verb == "never" and hand.maybe(0.25) else ""
        return hand.words(f"{verb} {condition(hand)}", stretch)
    if verb == "uses":
        return f"uses {_bound(hand, 'energy')} of {hand.name('signal')}"
    if verb == "tries":
        return f"tries {_bound(hand, 'number')}" + (f" per {hand.path()}" if hand.maybe(0.5) else "")
    if verb == "runs":
        often = f"runs {_bound(hand, 'number')} per {hand.quantity('time')}"
        return f"runs every {_bounded(hand, 'time')}" if hand.maybe(0.6) else often
    if verb == "follows":
        return f"follows {_event(hand)}"
    if verb == "visits":
        return _visits(hand)
    if verb in ("counts", "fails"):
        return _count(hand, rate=verb == "fails")
    return f"{verb} within {_bounded(hand, 'time')} after {_event(hand)}"


def _visits(hand: Hand) -> str:
    """Nodes, some with values of their ports: these distinguish nodes of one kind."""
    nodes = []
    for _ in range(hand.pick({2: 5, 3: 4, 5: 1})):
        keys = hand.chance.sample(KEYS, hand.pick({1: 4, 2: 1}))
        values = hand.listed(hand.pair(key, hand.value()) for key in keys)
        nodes.append(hand.words(hand.path(), f"({values})" if hand.maybe(0.4) else ""))
    return hand.words("visits", hand.listed(nodes), "in order" if hand.maybe(0.4) else "")


def _count(hand: Hand, rate: bool) -> str:
    """How often something happens in a run or at a node; or how often a node fails in a time."""
    if rate:
        of = f"of {hand.path()}" if hand.maybe(0.3) else ""
        return hand.words(f"fails at most {hand.chance.randint(0, 9)} per {hand.quantity('time')}", of)
    verb = hand.pick({"succeeds": 5, "starts": 3, "fails": 3, "finishes": 2})
    bound = "at most" if verb == "fails" else hand.pick(("at least", "at most"))
    return f"{verb} {bound} {hand.chance.randint(0, 40)} per {'run' if hand.maybe(0.6) else hand.path()}"


def _event(hand: Hand) -> str:
    """One event, or any of several; a condition comes last."""
    drawn = [
        f"{hand.path() if hand.maybe(0.85) else 'mission'} {hand.pick(EVENTS)}"
        for _ in range(hand.pick({1: 12, 2: 2, 3: 0.5}))
    ]
    if hand.maybe(0.15):
        drawn[-1] = f"when {comparison(hand) if hand.maybe(0.8) else condition(hand)}"
    return " or ".join(drawn)


def _bound(hand: Hand, measure: str) -> str:
    kind = hand.pick({"at most": 12, "at least": 3, "less than": 3, "more than": 1, "between": 2})
    if kind == "between":
        return f"between {_simple(hand, measure)} and {_simple(hand, measure)}"
    return f"{kind} {_bounded(hand, measure)}"


def _bounded(hand: Hand, measure: str) -> str:
    return _simple(hand, measure) if hand.maybe(0.93) else _cases(hand, measure)


def _cases(hand: Hand, measure: str) -> str:
    """A value for each situation."""
    cases = [f"{_simple(hand, measure)} if {_case(hand)}" for _ in range(hand.pick({1: 4, 2: 1}))]
    return f"{', '.join(cases)} else {_simple(hand, measure)}"


def _case(hand: Hand) -> str:
    return hand.pick({hand.name("context"): 6, f"not {hand.name('context')}": 2, comparison(hand): 2})


def _simple(hand: Hand, measure: str) -> str:
    return hand.pick({hand.quantity(measure): 60, "limit": 2, f"-{hand.quantity(measure)}": 1, hand.name("signal"): 1})


def _odds(hand: Hand) -> str:
    share = hand.pick(("98 %", "99 %", "99.9 %", "80%", "50 %"))
    of = f"of {hand.pick({'activations': 5, 'runs': 5, 'time': 2, 'occurrences': 1})}"
    said = f"with probability {hand.pick(('>=', '>'))} {share}" + (f" {of}" if hand.maybe(0.4) else "")
    return f"in at least {share} {of}" if hand.maybe(0.7) else said


def _window(hand: Hand) -> str:
    return (
        f"{hand.chance.randint(5, 900)} {hand.pick(('activations', 'runs'))}"
        if hand.maybe(0.7)
        else hand.pick(("7 d", "24 h"))
    )


# ---- conditions -----------------------------------------------------------------------------------------------------


def condition(hand: Hand, depth: int = 0) -> str:
    """Comparisons, contexts and nodes that run, joined."""
    parts = []
    for _ in range(hand.pick({1: 8, 2: 3, 3: 1}) if depth < 3 else 1):
        kind = hand.pick({"comparison": 8, "context": 4, "node": 1, "brackets": 1 if depth < 3 else 0})
        part = {
            "comparison": lambda: comparison(hand),
            "context": lambda: hand.name("context"),
            "node": lambda: f"node {hand.path()}",
            "brackets": lambda: f"({condition(hand, depth + 1)})",
        }[kind]()
        parts.append(f"not {part}" if hand.maybe(0.1) else part)
    text = parts[0]
    for part in parts[1:]:
        text = hand.words(text, hand.pick(("and", "or")), part)
    return text


def comparison(hand: Hand) -> str:
    """A signal beside a value, or by itself if it is one of truth."""
    signal = hand.name("signal")
    measure = MEASURED.get(signal, ("", "number"))[1]
    if measure == "truth":
        return signal if hand.maybe(0.8) else f"{signal} == {hand.pick(('true', 'false'))}"
    if measure == "text":
        return f"{signal} {hand.pick(('==', '!='))} {hand.string(hand.pick(('lobby', 'ward 3', 'auto')))}"
    sign = hand.pick({"<": 4, "<=": 5, ">": 3, ">=": 5, "==": 1, "!=": 1})
    if hand.maybe(0.03):
        return f"age({signal}) {hand.pick(('<', '<='))} {hand.quantity('time')}"
    value = hand.quantity(measure) if hand.maybe(0.95) else f"({_cases(hand, measure)})"
    if hand.maybe(0.08):
        return f"{value} {hand.pick(('<', '<='))} {signal} {hand.pick(('<', '<='))} {hand.quantity(measure)}"
    return f"{_expression(hand, signal, measure)}{hand.pick({f' {sign} ': 20, sign: 1})}{value}"


def _expression(hand: Hand, signal: str, measure: str) -> str:
    return hand.pick(
        {
            signal: 40,
            f"{hand.pick(FUNCTIONS)}({signal})": 8,
            f"{signal} {hand.pick('+-')} {hand.quantity(measure)}": 2,
            f"{hand.number()} * {signal}": 1,
            f"({signal} - {hand.name('signal')}) / {hand.number()}": 1,
            f"- {hand.quantity(measure)} + {signal}": 0.3,
        }
    )


# ---- at nodes -------------------------------------------------------------------------------------------------------


def node_clause(hand: Hand) -> str:
    """A concern, requirements or tags."""
    kind = hand.pick({"satisfices": 4, "satisfies": 6, "tags": 2})
    if kind == "tags":
        return "tags " + hand.listed(hand.name("tag") for _ in range(hand.pick({1: 3, 2: 2, 3: 1})))
    if kind == "satisfies":
        return "satisfies " + hand.listed(_use(hand) for _ in range(hand.pick({1: 5, 2: 2, 3: 1})))
    if hand.classic:
        inside = [_classic(hand, hand.new("requirement")) for _ in range(hand.pick({0: 4, 1: 6, 2: 1}))]
        return f"satisfices {hand.pair('Quality', quality(hand))}{hand.brackets(inside) if inside else ''}"
    return "satisfices " + hand.listed(quality(hand) for _ in range(hand.pick({1: 4, 2: 2, 3: 1})))


def _use(hand: Hand) -> str:
    if hand.classic:
        return _classic(hand, hand.new("requirement"))
    if hand.maybe(0.05):
        head = _head(hand, hand.new("requirement"))
        return hand.words(head, claim(hand, lists=False), *clauses(hand, lists=False)[1:2])
    return reference(hand)


def reference(hand: Hand) -> str:
    """A requirement by name, with its arguments."""
    argument = f"({hand.pair('limit', _bounded(hand, 'speed'))})" if hand.maybe(0.08) else ""
    return hand.name("requirement") + argument


def clause_line(hand: Hand) -> Line:
    """Clauses on a line of their own, perhaps with a requirement that has a block."""
    if hand.maybe(0.06):
        line = requirement(hand, lists=False)
        before = f"{hand.name('requirement')}, " if hand.maybe(0.3) and not hand.classic else ""
        line.text = f"satisfies {before}{line.text}"
        return line
    return Line(hand.words(*(node_clause(hand) for _ in range(hand.pick({1: 12, 2: 1})))))
