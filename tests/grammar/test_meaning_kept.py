"""What version 1.0 of the language reads, later versions read alike: their new words are names where they were names.

`meaning_of_1_0.json` has the digests of what 1.0 read, by the digest of the text; a text that has changed has none.
"""

from __future__ import annotations

import json
import random
from hashlib import sha256
from pathlib import Path

import pytest

from btq_lang.btcpp.importing import import_xml
from btq_lang.parser import parse
from btq_lang.syntax.tree import How, Word
from btq_lang.util.record import fields_of

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples"
KEPT: dict[str, str] = json.loads((HERE / "meaning_of_1_0.json").read_text(encoding="utf-8"))
# Names in 1.0; later versions begin or continue clauses with them.
WORDS = (
    *("source", "refines", "mitigates", "approved", "priority", "assuming", "average", "hazard", "severity"),
    *("scenario", "each", "followed", "visits", "age", "time", "occurrences", "ends", "starts", "fails", "finishes"),
    *("until", "order", "run", "given", "expect", "by", "is", "for", "Dock", "battery"),
)
HAPPENINGS = ("starts", "succeeds", "fails", "finishes", "halts")
BOUNDS = ("at most {}", "at least {}", "less than {}", "more than {}", "between {} and 90 s")


def mission(seed: int) -> str:
    """A mission without a syntax error in 1.0, whose names are words of later versions."""
    draw = random.Random(seed)

    def name() -> str:
        word = draw.choice(WORDS)
        return word if word != "run" or draw.random() < 0.5 else '"run"'

    def path() -> str:
        return "/".join(name() for _ in range(draw.choice((1, 1, 2))))

    def condition() -> str:
        compared = f"{name()} {draw.choice(('<', '>=', '=='))} {draw.choice(('3', '2 s', name()))}"
        forms = (compared, compared, f"not {name()}", f"node {path()}", f"max({draw.choice(WORDS)}) > 1 m")
        first = draw.choice(forms)
        return f"{first} {draw.choice(('and', 'or'))} {compared}" if draw.random() < 0.3 else first

    def event() -> str:
        if draw.random() < 0.2:
            return f"when {compared_to()}"
        return f"{draw.choice(('mission', path()))} {draw.choice(HAPPENINGS)}"

    def compared_to() -> str:
        return f"{draw.choice(WORDS)} > {draw.randrange(9)} m"

    def duration() -> str:
        value = f"{draw.randrange(1, 90)} s"
        return f"{value} if {compared_to()} else 2 s" if draw.random() < 0.1 else value

    def bound(value: str) -> str:
        form = draw.choice(BOUNDS)
        return form.format(value.partition(" if ")[0] if "between" in form else value)

    def verb() -> str:
        return draw.choice(
            (
                f"takes {bound(duration())}",
                draw.choice(("succeeds", f"succeeds within {duration()}")),
                f"{draw.choice(('needs', 'keeps', 'never', 'leaves'))} {condition()}",
                f"uses at most 3 Wh of {draw.choice(WORDS)}",
                f"tries at most 3{draw.choice(('', f' per Top/{path()}'))}",
                draw.choice((f"runs every {duration()}", "runs at least 3 per 10 s")),
                f"{draw.choice(('starts', 'ends'))} within {duration()} after {event()}",
                f"follows {event()}",
            )
        )

    def subject() -> str:
        several = f"sum of {path()}, {path()}"
        span = f"from {event()} to {event()}"
        return draw.choice(("", "", "mission ", f"every {name()} ", f"{several} ", f"{span} ", f"Top/{path()} "))

    def clause() -> str:
        return draw.choice(
            (
                subject() + verb(),
                subject() + verb(),
                f"{draw.choice(('while', 'when'))} {condition()}",
                f"in at least 98 % of {draw.choice(('runs', 'activations'))}",
                "confidence 95 %",
                f"over last {draw.choice(('20 runs', '7 d'))}",
                f"on violation {draw.choice(('fail', 'halt', 'warn', 'log'))}",
                "goal 3 s",
                'because "of it"',
                f"verified by {draw.choice(('monitor', 'review', 'test', 'analysis'))}",
            )
        )

    lines: list[str] = []
    for _ in range(draw.randrange(1, 4)):
        lines.append(
            draw.choice(
                (
                    f"signal {draw.choice(WORDS)} : m from {{x}}",
                    f"context {draw.choice(WORDS)} : {condition()}",
                    f"apply {name()} to every {name()} except Top/{path()}",
                    f'quality {name()} : safety "one"',
                )
            )
        )
    for _ in range(draw.randrange(1, 4)):
        quality = draw.choice(("", f" : {draw.choice(('safety', name()))}"))
        lines.append(f"QualityReq {name()}{quality}" + draw.choice(("", ' "Title"')))
        lines += [f"    {clause()}" for _ in range(draw.randrange(1, 5))]
    lines += [f"BehaviorTree {name()}", "    -> Top"]
    for _ in range(draw.randrange(1, 4)):
        inline = f"QualityReq {name()} {verb()}"
        attached = draw.choice(("", f" satisfies {name()}", f" satisfies {name()}, {inline}", f" tags {name()}"))
        lines.append(f"        {draw.choice(('', 'Action '))}{name()}{attached}")
    return "".join(f"{line}\n" for line in lines)


def meaning(part: object) -> object:
    """A part of the tree by what it consists of; what a later version adds is left out where it is empty."""
    if isinstance(part, Word):
        return part.kind, part.raw
    if isinstance(part, tuple):
        return [meaning(element) for element in part]
    if isinstance(part, str | int | None):
        return part
    if isinstance(part, How) and len(part.ways) == 1 and part.ways[0].id is None:
        return ["How", {"method": meaning(part.ways[0].method)}]  # 1.0 had one
    values = {name: getattr(part, name) for name in fields_of(part) if name not in ("start", "end")}
    return [
        type(part).__name__,
        {name: meaning(value) for name, value in values.items() if value not in (None, (), "")},
    ]


def digest(value: object) -> str:
    return sha256(json.dumps(value).encode()).hexdigest()[:16]


def read(text: str) -> str:
    """The digest of what a text is read as, with its messages."""
    parsed = parse(text)
    messages = [(diagnostic.span.start, diagnostic.message) for diagnostic in parsed.diagnostics]
    return digest([[meaning(entry.item) for entry in parsed.entries], messages])


def test_drawn_missions_are_read_as_1_0_read_them() -> None:
    texts = [mission(seed) for seed in range(5_000)]
    assert [parse(text).diagnostics for text in texts if parse(text).diagnostics] == []
    batches = [texts[begin : begin + 100] for begin in range(0, len(texts), 100)]
    assert [digest([read(text) for text in batch]) for batch in batches] == [KEPT[digest(batch)] for batch in batches]


@pytest.mark.parametrize(
    "text",
    [
        "QualityReq a succeeds over last 7 d\n",
        "BehaviorTree T\n    A satisfies QualityReq a every M keeps z, QualityReq b each A fails is followed by z\n",
        "QualityReq a\n    starts within 2 s after A fails over last 20 runs\n",
    ],
)
def test_a_clause_ends_where_another_begins(text: str) -> None:
    assert parse(text).diagnostics == ()


def test_examples_are_read_as_1_0_read_them() -> None:
    texts = [path.read_text(encoding="utf-8") for path in sorted(EXAMPLES.rglob("*.btq"))]
    assert unchanged(texts) != []
    assert differing(texts) == []


def test_published_files_are_read_as_1_0_read_them(shared: Path) -> None:
    example = (shared / "original" / "paper_example.qualitybtcpp").read_text(encoding="utf-8")
    assert unchanged([example]) == [example]
    files = sorted((shared / "corpus" / "dev").iterdir())
    texts = [import_xml(path.read_bytes().decode(errors="replace")).text for path in files]
    assert len(unchanged(texts)) > 400
    assert differing([example, *texts]) == []


def unchanged(texts: list[str]) -> list[str]:
    """The texts whose digests are kept."""
    return [text for text in texts if digest(text) in KEPT]


def differing(texts: list[str]) -> list[str]:
    """The unchanged texts that are read otherwise."""
    return [text for text in unchanged(texts) if read(text) != KEPT[digest(text)]]
