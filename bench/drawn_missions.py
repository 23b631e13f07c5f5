"""Missions that nobody tunes a parser to: drawn from docs/grammar.md, with a new seed each day.

One invariant: they are written from docs/grammar.md and docs/language.md alone.  Whoever changes the parser leaves this
generator as it is, or it measures what the parser was made for.  Every production is drawn, as often as in files that
people write; every file is without a syntax error, but not without findings: names and units are drawn too.

As a command it prints one file: `python drawn_missions.py --seed 20261125 --nodes 300`.
"""

from __future__ import annotations

import argparse
import datetime
import sys
from collections.abc import Callable, Iterator, Sequence

from drawn_requirements import clause_line, condition, hazard, node_clause, quality, reference, requirement
from drawn_scenarios import scenarios
from drawn_words import AFTERWARDS, BREAK, CONDITIONS, KEYS, MEASURED, PROSE, SCRIPTS, TYPES, Hand, Line

SYMBOLS = {
    "->": 12,
    "?": 6,
    "R->": 3,
    "R?": 3,
    "||": 1.5,
    "All||": 0.5,
    "M->": 0.5,
    "A->": 0.4,
    "A?": 0.4,
    "→": 0.2,
    "⇉": 0.1,
}
CONTROLS = ("Sequence", "Fallback", "IfThenElse", "WhileDoElse", "ReactiveSequence", "Parallel", "PipelineSequence")
DECORATORS = {
    "Inverter": "",
    "ForceSuccess": "",
    "ForceFailure": "",
    "KeepRunningUntilFailure": "",
    "RunOnce": "",
    "Retry": "num_attempts",
    "RetryUntilSuccessful": "num_attempts",
    "Repeat": "num_cycles",
    "Timeout": "msec",
    "Delay": "delay_msec",
    "RateController": "hz",
}
DEEPEST = 12
SIZES = {3: 2, 6: 3, 12: 4, 25: 4, 50: 2, 110: 1}


def seed_of_the_day() -> int:
    """The date as a number: 20261125."""
    return int(datetime.date.today().strftime("%Y%m%d"))


def missions(nodes: int, seed: int) -> list[str]:
    """Files with as many nodes together, most of them with tens or hundreds."""
    texts: list[str] = []
    chance = Hand(seed)
    while nodes:
        size = min(nodes, chance.pick({8: 2, 20: 4, 60: 4, 150: 3, 400: 2, 900: 1}))
        texts.append(mission(size, seed * 1_000 + len(texts)))
        nodes -= size
    return texts


def mission(nodes: int, seed: int) -> str:
    """The text of one file with exactly so many nodes."""
    hand = Hand(seed)
    lines = list(_lay_out(hand, _items(hand, nodes), ""))
    if hand.maybe(0.5):
        lines[:0] = [hand.sign + hand.pick(PROSE) for _ in hand.some(6, 0.7)]
    text = "\n".join(lines) + hand.pick({"\n": 9, "": 1, "\n\n\n": 1})
    return hand.pick({"": 40, "\ufeff": 1}) + (text.replace("\n", "\r\n") if hand.maybe(0.05) else text)


# ---- lines ----------------------------------------------------------------------------------------------------------


def _lay_out(hand: Hand, lines: Sequence[Line], indent: str) -> Iterator[str]:
    """Lines with their indentation, and what people put around them: comments, blank lines, blanks at the end."""
    for line in lines:
        if hand.maybe(0.4 if not indent and line.block else 0.02):
            yield hand.pick({"": 9, indent: 1})
        if hand.maybe(hand.comments / 2):
            yield from _comment(hand, indent)
        inside = indent + (hand.unit if hand.maybe(0.7) else hand.pick(("", " ", hand.unit * 2)))
        text = line.text.replace(BREAK + ")", f"\n{indent})").replace(BREAK, f"\n{inside}")
        after = (
            f"{hand.pick((' ', '  ', '    '))}{hand.sign}{hand.pick(PROSE)}" if hand.maybe(hand.comments / 3) else ""
        )
        yield indent + text + (after or hand.pick({"": 60, " ": 1, "   ": 0.5}))
        below = indent + (hand.unit if hand.maybe(0.98) else hand.pick(("  ", "   ", "\t")))
        yield from _lay_out(hand, line.block, below)


def _comment(hand: Hand, indent: str) -> Iterator[str]:
    where = hand.pick({indent: 9, "": 1, indent + " ": 0.5})
    kind = hand.pick({"prose": 10, "code": 4, "ruler": 1, "block": 0.7})
    if kind == "block":
        yield f"{where}/* {hand.pick(PROSE)}\n   {hand.pick(PROSE)} */"
    elif kind == "code":
        yield f"{where}{hand.sign}{hand.name('model')} ({hand.pair(hand.pick(KEYS), hand.value())})"
    elif kind == "ruler":
        yield f"{where}# ---- {hand.pick(PROSE)} " + "-" * 40
    else:
        yield from (where + hand.sign + hand.pick(PROSE) for _ in range(hand.pick({1: 6, 2: 2, 3: 1})))


# ---- items ----------------------------------------------------------------------------------------------------------


def _items(hand: Hand, nodes: int) -> list[Line]:
    """All items of a file: first what trees refer to, then the trees, mostly written in this order too."""
    some = max(1, min(14, nodes // 12))  # the larger a file, the more it declares
    sizes = _sizes(hand, nodes)
    for _ in sizes:
        hand.new("tree")
    for _ in range(3):
        hand.new("tag")
    trees = list(hand.names["tree"])
    groups: list[list[Line]] = [
        [_include(hand) for _ in hand.some(3, 0.25)],
        [Line(f"qualities {hand.pick(('iso25010-2023', 'iso25010-2011'))}")] if hand.maybe(0.05) else [],
        [_quality_declaration(hand) for _ in hand.some(2, 0.1)],
        [_signal(hand, name) for name in hand.chance.sample(list(MEASURED), min(len(MEASURED), some))],
        [_context(hand) for _ in hand.some(some, 0.6)],
        _models(hand, 2 + some),
        [hazard(hand) for _ in hand.some(some, 0.25)],
        [requirement(hand) for _ in hand.some(2 * some, 0.85)],
        [_tree(hand, name, size) for name, size in zip(trees, sizes, strict=True)],
        [_application(hand) for _ in hand.some(4, 0.4)],
        [_verbatim(hand)] if hand.maybe(0.03) else [],
        scenarios(hand) if not hand.classic else [],
    ]
    if hand.maybe(0.3):
        hand.chance.shuffle(groups)
    items = [item for group in groups for item in group]
    root = hand.words(
        "Root", trees[0] if hand.maybe(0.9) else "", hand.pick({"": 9, "()": 1, '(BTCPP_format = "4")': 1})
    )
    if hand.classic:
        return [Line(root, items)]
    if len(sizes) > 1 or hand.maybe(0.2):
        items.insert(0 if hand.maybe(0.7) else len(items), Line(root))
    return items


def _sizes(hand: Hand, nodes: int) -> list[int]:
    sizes = []
    while nodes:
        sizes.append(min(nodes, hand.pick(SIZES)))
        nodes -= sizes[-1]
    return sizes


def _include(hand: Hand) -> Line:
    path = hand.string(f"{hand.pick(('skills', '../shared/stations', 'trees/recovery'))}.{hand.pick(('btq', 'xml'))}")
    return Line(hand.words("include", path, '(ros_pkg = "robot_missions")' if hand.maybe(0.1) else ""))


def _quality_declaration(hand: Hand) -> Line:
    above = f": {quality(hand)}" if hand.maybe(0.8) else ""
    return Line(hand.words("quality", hand.new("quality"), above, hand.prose() if hand.maybe(0.7) else ""))


def _signal(hand: Hand, name: str) -> Line:
    hand.names.setdefault("signal", []).append(name)
    unit, measure = MEASURED[name]
    first = {"truth": "false", "text": hand.string("lobby"), "number": hand.number()}.get(measure)
    return Line(
        hand.words(
            f"signal {name} : {unit}",
            f"from {{{name}_{hand.pick(('level', 'now'))}}}" if hand.maybe(0.9) else "",
            hand.pick({"": 3, "level": 1, "counter": 1, "gauge": 1}),
            f"fresh within {hand.quantity('time')}" if hand.maybe(0.4) else "",
            f"initially {first or hand.quantity(measure)}" if hand.maybe(0.6) else "",
        )
    )


def _context(hand: Hand) -> Line:
    means = condition(hand)
    return Line(hand.words("context", hand.new("context"), ":", means))


def _models(hand: Hand, count: int) -> list[Line]:
    drawn = [_model(hand) for _ in range(count)]
    if not hand.maybe(0.2):
        return drawn
    return [Line("TreeNodesModel", drawn + ([_verbatim(hand)] if hand.maybe(0.05) else []))]


def _model(hand: Hand) -> Line:
    kind = hand.pick({"Action": 10, "Condition": 5, "Control": 0.5, "Decorator": 0.7, "SubTree": 0.5})
    name = hand.new("condition" if kind == "Condition" else "model")
    extra = hand.brackets(hand.pairs(1)) if hand.maybe(0.04) else ""
    line = Line(hand.words(kind, name, extra, hand.prose() if hand.maybe(0.5) else ""), _ports(hand, 5))
    if hand.maybe(0.03):
        line.block.append(Line(f"metadata {hand.brackets([hand.pair('author', hand.string('R. Diaz'))])}"))
    if hand.maybe(0.02):
        line.block.append(_verbatim(hand))
    return line


def _ports(hand: Hand, most: int) -> list[Line]:
    keys = hand.chance.sample(KEYS, len(hand.some(most, 0.55)))
    width = max(map(len, keys), default=0) if hand.maybe(0.2) else 0  # in columns
    return [
        Line(
            hand.words(
                hand.pick({"input": 8, "output": 4, "inout": 1, "input ": 0.5}),
                (key if hand.maybe(0.99) else "").ljust(width),
                f": {hand.pick(TYPES)}" if hand.maybe(0.8) else "",
                hand.pick({"": 32, f"= {hand.value()}": 7, f"= {hand.entry()} (note = 1)": 0.5, "(note = 1)": 0.5}),
                hand.prose() if hand.maybe(0.4) else "",
            ).rstrip()
        )
        for key in keys
    ]


def _application(hand: Hand) -> Line:
    uses = hand.listed(reference(hand) for _ in range(hand.pick({1: 5, 2: 1})))
    chosen = hand.listed(_selector(hand) for _ in range(hand.pick({1: 4, 2: 2, 3: 1})))
    excluded = f"except {hand.listed(_selector(hand) for _ in range(hand.pick((1, 2))))}" if hand.maybe(0.2) else ""
    return Line(hand.words("apply", uses, "to", chosen, excluded))


def _selector(hand: Hand) -> str:
    kind = hand.pick({"every": 4, "tagged": 1, "path": 4})
    if kind == "path":
        return hand.path()
    if kind == "tagged":
        return f"every node tagged {hand.name('tag')}"
    return f"every {hand.name('model')}" + (f" under {hand.path()}" if hand.maybe(0.3) else "")


def _verbatim(hand: Hand) -> Line:
    return Line(hand.pick(("xml '<Mine attr=\"1\"/>'", 'xml "<Palette><Item>a</Item></Palette>"', "xml '<Anything/>'")))


# ---- trees ----------------------------------------------------------------------------------------------------------


def _tree(hand: Hand, name: str, nodes: int) -> Line:
    given = hand.brackets(hand.pairs(2)) if hand.maybe(0.05) else ""
    line = Line(hand.words("BehaviorTree", f"ID = {name}" if hand.classic else name, given))
    if hand.maybe(0.25):
        line.block += _ports(hand, 4)
    line.block += [clause_line(hand) for _ in hand.some(2, 0.04)]
    line.block.append(_node(hand, nodes, 1))
    return line


def _node(hand: Hand, nodes: int, depth: int) -> Line:
    """A node with so many below it, itself among them."""
    if nodes == 1:
        return _leaf(hand)
    if depth < DEEPEST and hand.maybe(0.9 if nodes == 2 else 0.15):
        name, port = hand.pick(list(DECORATORS.items()))
        value = hand.quantity("time") if port.endswith("msec") and hand.maybe(0.5) else str(hand.chance.randint(1, 99))
        pairs = [hand.pair(port, value if hand.maybe(0.8) else hand.entry())] if port else []
        line = _line(hand, name, pairs, labelled=0.1)
        if hand.maybe(0.03):
            line = _line(hand, f"Decorator {hand.name('model')}", hand.pairs(), labelled=0.1)
        line.block.append(_node(hand, nodes - 1, depth + 1))
        return line
    kind = hand.pick(SYMBOLS) if hand.maybe(0.85) else hand.pick(CONTROLS)
    if hand.maybe(0.02):
        kind = f"Control {hand.name('model')}"
    pairs = [hand.pair("success_count", hand.pick("123"))] if kind in ("||", "Parallel") and hand.maybe(0.6) else []
    line = _line(hand, kind, pairs, labelled=0.35)
    line.block += [_node(hand, part, depth + 1) for part in _parts(hand, nodes - 1, depth)]
    if hand.maybe(0.004):
        line.block.append(_verbatim(hand))
    return line


def _parts(hand: Hand, nodes: int, depth: int) -> list[int]:
    """How many nodes each child has; at the greatest depth each is a leaf."""
    if depth >= DEEPEST:
        return [1] * nodes
    count = min(nodes, hand.pick({1: 1, 2: 5, 3: 6, 4: 4, 5: 2, 7: 1, 12: 0.3}))
    cuts = sorted(hand.chance.sample(range(1, nodes), count - 1))
    return [end - start for start, end in zip([0, *cuts], [*cuts, nodes], strict=True)]


def _leaf(hand: Hand) -> Line:
    drawn: dict[Callable[[], Line], float] = {
        lambda: _line(hand, hand.name("model"), hand.pairs(5), labelled=0.3): 10,
        lambda: _line(hand, f"Action {hand.name('model')}", hand.pairs(4), labelled=0.3): 4,
        lambda: _line(hand, hand.name("condition"), hand.pairs(2), labelled=0.1): 3,
        lambda: _line(hand, f"Condition {hand.name('condition')}", hand.pairs(2), labelled=0.1): 2,
        lambda: _line(hand, f"SubTree {hand.name('tree')}", _passed(hand), labelled=0.2): 3,
        lambda: _line(hand, "Script", [hand.pair("code", hand.string(_script(hand)))], labelled=0.1): 2,
        lambda: _line(hand, "ScriptCondition", [hand.pair("code", hand.string(_script(hand)))], labelled=0.3): 0.6,
        lambda: _line(hand, "Sleep", [hand.pair("msec", hand.quantity("time"))], labelled=0.05): 1,
        lambda: _line(hand, hand.pick(("AlwaysSuccess", "AlwaysFailure", '"Retry"')), [], labelled=0.05): 1,
    }
    if hand.classic:
        skill, check, called = hand.name("model"), hand.name("condition"), hand.name("tree")
        drawn |= {
            lambda: _line(hand, "ScriptAction", [hand.pair("name", f'"{skill}"')], labelled=0): 30,
            lambda: _line(hand, "ScriptCondition", [hand.pair("name", f'"{check}"')], labelled=0): 10,
            lambda: _line(hand, "SubTree", [hand.pair("ID", called)], labelled=0): 10,
        }
    return hand.pick(drawn)()


def _passed(hand: Hand) -> list[str]:
    """What a subtree is given."""
    pairs = hand.pairs(3)
    if hand.maybe(0.15):
        pairs.append(hand.pair("_autoremap", "true"))
    if pairs and hand.maybe(0.05):
        pairs = [f"parameters {', '.join(pairs)}"]
    return pairs


def _script(hand: Hand) -> str:
    return "; ".join(hand.pick(SCRIPTS) for _ in range(hand.pick({1: 7, 2: 2, 4: 1})))


def _line(hand: Hand, kind: str, pairs: list[str], labelled: float) -> Line:
    """A node's own line and the clauses that begin its block."""
    label = ""
    if hand.maybe(labelled):
        if hand.classic:
            pairs = [hand.pair("name", hand.string(hand.new("label"))), *pairs]
        else:
            label = hand.new("label") if hand.maybe(0.95) else hand.string(f"{hand.new('label')} #{hand.number()}")
    if hand.maybe(0.06):
        key = hand.pick(CONDITIONS + AFTERWARDS)
        pairs.append(hand.pair(key, hand.string(_script(hand))))
    clauses = [node_clause(hand) for _ in hand.some(3, 0.12)]
    where = hand.pick({"line": 5, "block": 4, "brackets": 6 if hand.classic else 0.3})
    block = [Line(clause) for clause in clauses] if where == "block" else []
    if where == "block" and hand.maybe(0.02):
        block.append(clause_line(hand))
    if where == "brackets":
        pairs = pairs + clauses
    brackets = hand.brackets(pairs) if pairs or hand.maybe(0.01) else ""
    glued = brackets and hand.maybe(0.05)  # `Drive(place = "a")`
    head = hand.words(kind, label) + brackets if glued else hand.words(kind, label, brackets)
    return Line(hand.words(head, *clauses) if where == "line" else head, block)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=seed_of_the_day(), help="default: the date as a number")
    parser.add_argument("--nodes", type=int, default=200)
    options = parser.parse_args()
    print(f"seed {options.seed}", file=sys.stderr)
    print(mission(options.nodes, options.seed), end="")


if __name__ == "__main__":
    main()
