"""How fast XML is read and written: `btq import` beside lxml, `btq build` beside the parser.

One invariant: what is compared takes turns in one process, and a quotient is the median over the rounds.  The mission
is the one of `missions.py`, as `--verbatim` writes it; with `--corpus DIR` also every XML file of a folder, there and
back.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import missions
from lxml import etree
from report import Goal, machine, shown

from btq_lang.btcpp.document import Document, write
from btq_lang.btcpp.export import export
from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.reader import read
from btq_lang.parser import parse
from btq_lang.workspace.workspace import Workspace

STRICT = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)


def main() -> None:
    parser = argparse.ArgumentParser(description="Measure reading and writing XML.")
    parser.add_argument("--nodes", type=int, default=missions.NODES)
    parser.add_argument("--rounds", type=int, default=11)
    parser.add_argument("--corpus", type=Path, help="a folder of XML files, imported and built back")
    options = parser.parse_args()
    text = missions.mission(options.nodes, missions.SEED, "short")
    xml = write(built(text))
    steps: dict[str, Callable[[], object]] = {
        "lxml: parse and walk": lambda: walk(xml.encode()),
        "btq: read": lambda: read(xml),
        "btq: import": lambda: import_xml(xml),
        "btq: parse": lambda: parse(text),
        "btq: build": lambda: write(built(text)),
    }
    seconds = measured(steps, options.rounds)
    imported = quotient(seconds["btq: import"], seconds["lxml: parse and walk"])
    exported = quotient(seconds["btq: build"], seconds["btq: parse"])
    goals = [
        Goal("import, in times of lxml's parse and walk <= 5", imported, imported <= 5),
        Goal("build, its parse included, in times of the parse <= 3", exported, exported <= 3),
    ]
    if options.corpus:
        taken = corpus(options.corpus)
        goals.append(Goal(f"files of {options.corpus} there and back: s of processor <= 10", taken, taken <= 10))
    print(f"{machine()}; {options.nodes:,} nodes, {len(xml) / 1e6:.1f} MB of XML, {options.rounds} rounds\n")
    print("| step | processor ms, median | fastest |", "|---|---|---|", sep="\n")
    for name, times in seconds.items():
        print(f"| {name} | {statistics.median(times) * 1000:.1f} | {min(times) * 1000:.1f} |")
    print("", *shown(goals), sep="\n")


def walk(data: bytes) -> None:
    """Every element of a document with its attributes and its text, as Python objects."""
    for element in etree.fromstring(data, STRICT).iter():
        element.tag, element.items(), element.text  # looking is what is measured


def built(text: str) -> Document:
    """A mission as XML."""
    return export(Workspace.of({"mission.btq": text}), "mission.btq", verbatim=True).document


def measured(steps: dict[str, Callable[[], object]], rounds: int) -> dict[str, list[float]]:
    """Processor seconds of each step, in turns; the first round warms up."""
    seconds: dict[str, list[float]] = {name: [] for name in steps}
    for number in range(rounds + 1):
        for name, step in steps.items():
            begin = time.process_time()
            step()
            if number:
                seconds[name].append(time.process_time() - begin)
    return seconds


def quotient(own: list[float], theirs: list[float]) -> float:
    return statistics.median(one / other for one, other in zip(own, theirs, strict=True))


def corpus(folder: Path) -> float:
    """Seconds of processor to import every file and build it back."""
    texts = [path.read_bytes().decode().removeprefix("\ufeff") for path in sorted(folder.glob("*"))]
    begin = time.process_time()
    for text in texts:
        write(built(import_xml(text, keep_v3=True).text))
    return time.process_time() - begin


if __name__ == "__main__":
    main()
