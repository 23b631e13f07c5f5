"""Requirements, conditions and what is attached to nodes, as drawn missions have them (drawn_missions.py)."""

from __future__ import annotations

from collections.abc import Callable

from drawn_words import MEASURED, Hand, Line

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
FUNCTIONS = ("max", "min", "mean", "p95", "stddev", "change", "count")


def quality(hand: Hand) -> str:
    """The path of a quality, of the standard or one that the file declares."""
    if hand.classic:
        return hand.pick(CLASSIC_QUALITIES)
    path = hand.name("quality") if hand.names.get("quality") and hand.maybe(0.1) else hand.pick(QUALITIES)
    return f'{path.split(".")[0]}."{path.split(".")[1]}"' if " " in path else path


# ---- requirements ---------------------------------------------------------------------------------------------------


def requirement(hand: Hand) -> Line:
    """A requirement as an item: its clauses on its line, in its block, or in both."""
    drawn = clauses(hand)
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
        default = hand.pair(" ", hand.quantity("speed")).rstrip() if hand.maybe(0.7) else ""
        more = f", patience : s{hand.equals}{hand.quantity('time')}" if hand.maybe(0.2) else ""
        parameters = f"(limit : m/s{default}{more})"
    colon = hand.pick({" : ": 12, ": ": 3, " :": 0.5})
    about = colon + quality(hand) if hand.maybe(0.85) else ""
    return hand.words(f"QualityReq {name}{parameters}{about}", hand.prose() if titled else "")


def _classic(hand: Hand, name: str) -> str:
    text = hand.pick(("The drive shall take at most 30 sec.", "No collision shall occur", "Each pump shall be reached"))
    if hand.maybe(0.3):
        text += hand.pick((" within 90 sec.", "\n\t\t\t\tand the robot shall report it", " (see 4.2)"))
    return hand.words(hand.pair("QualityReq ID", f'"{name}"'), hand.pair("description", f'"{text}"'))


def clauses(hand: Hand) -> list[str]:
    """The clauses of a requirement: mostly one claim, then what qualifies it."""
    claims = [_claim(hand)] if hand.maybe(0.92) else []
    others: dict[float, Callable[[], str]] = {
        0.20: lambda: f"{hand.pick(('while', 'when'))} {condition(hand)}",
        0.18: lambda: _odds(hand),
        0.08: lambda: f"confidence {hand.pick(('95 %', '99 %', '90%', '99.9 %'))}",
        0.10: lambda: f"over last {_window(hand)}",
        0.35: lambda: f"on violation {hand.pick({'fail': 4, 'halt': 2, 'warn': 2, 'log': 1})}",
        0.15: lambda: f"goal {_bounded(hand, 'time')}",
        0.25: lambda: f"because {hand.prose()}",
        0.12: lambda: f"verified by {hand.pick(('monitor', 'analysis', 'test', 'review'))}",
    }
    drawn = claims + [clause() for share, clause in others.items() if hand.maybe(share)]
    if hand.maybe(0.1):
        hand.chance.shuffle(drawn)
    return drawn


def _claim(hand: Hand) -> str:
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
        "follows": 1,
    }
    return hand.words(_subject(hand) if hand.maybe(0.25) else "", _verb(hand, hand.pick(verbs)))


def _subject(hand: Hand) -> str:
    kind = hand.pick({"path": 6, "mission": 2, "every": 3, "from": 2, "sum": 1})
    if kind == "every":
        return f"every {hand.name('model')}"
    if kind == "from":
        return f"from {_event(hand)} to {_event(hand)}"
    if kind == "sum":
        return "sum of " + hand.listed([hand.path(), hand.path(), *(hand.path() for _ in hand.some(2))])
    return "mission" if kind == "mission" else hand.path()


def _verb(hand: Hand, verb: str) -> str:
    if verb == "takes":
        return f"takes {_bound(hand, 'time')}"
    if verb == "succeeds":
        return f"succeeds within {_bounded(hand, 'time')}" if hand.maybe(0.7) else "succeeds"
    if verb in ("needs", "keeps", "never", "leaves"):
        return f"{verb} {condition(hand)}"
    if verb == "uses":
        return f"uses {_bound(hand, 'energy')} of {hand.name('signal')}"
    if verb == "tries":
        return f"tries {_bound(hand, 'number')}" + (f" per {hand.path()}" if hand.maybe(0.5) else "")
    if verb == "runs":
        often = f"runs {_bound(hand, 'number')} per {hand.quantity('time')}"
        return f"runs every {_bounded(hand, 'time')}" if hand.maybe(0.6) else often
    return (
        f"follows {_event(hand)}"
        if verb == "follows"
        else f"{verb} within {_bounded(hand, 'time')} after {_event(hand)}"
    )


def _event(hand: Hand) -> str:
    if hand.maybe(0.15):
        return f"when {comparison(hand)}"
    return f"{hand.path() if hand.maybe(0.85) else 'mission'} {hand.pick(EVENTS)}"


def _bound(hand: Hand, measure: str) -> str:
    kind = hand.pick({"at most": 12, "at least": 3, "less than": 3, "more than": 1, "between": 2})
    if kind == "between":
        return f"between {_simple(hand, measure)} and {_simple(hand, measure)}"
    return f"{kind} {_bounded(hand, measure)}"


def _bounded(hand: Hand, measure: str) -> str:
    if hand.maybe(0.93):
        return _simple(hand, measure)
    cases = [f"{_simple(hand, measure)} if {_case(hand)}" for _ in range(hand.pick({1: 4, 2: 1}))]
    return f"{', '.join(cases)} else {_simple(hand, measure)}"


def _case(hand: Hand) -> str:
    return hand.pick({hand.name("context"): 6, f"not {hand.name('context')}": 2, comparison(hand): 2})


def _simple(hand: Hand, measure: str) -> str:
    return hand.pick({hand.quantity(measure): 60, "limit": 2, f"-{hand.quantity(measure)}": 1, hand.name("signal"): 1})


def _odds(hand: Hand) -> str:
    share = hand.pick(("98 %", "99 %", "99.9 %", "80%", "50 %"))
    of = f"of {hand.pick(('activations', 'runs'))}"
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
    value = hand.quantity(measure)
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
        return hand.words(_head(hand, hand.new("requirement")), _claim(hand), *clauses(hand)[1:2])
    return reference(hand)


def reference(hand: Hand) -> str:
    """A requirement by name, with its arguments."""
    argument = f"({hand.pair('limit', hand.quantity('speed'))})" if hand.maybe(0.08) else ""
    return hand.name("requirement") + argument


def clause_line(hand: Hand) -> Line:
    """Clauses on a line of their own, perhaps with a requirement that has a block."""
    if hand.maybe(0.06):
        line = requirement(hand)
        before = f"{hand.name('requirement')}, " if hand.maybe(0.3) and not hand.classic else ""
        line.text = f"satisfies {before}{line.text}"
        return line
    return Line(hand.words(*(node_clause(hand) for _ in range(hand.pick({1: 12, 2: 1})))))
