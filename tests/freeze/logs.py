"""Logs as BehaviorTree.CPP writes them, of runs that chance has drawn over an XML file."""

from __future__ import annotations

import random
import re
import sqlite3
import struct
from pathlib import Path
from xml.etree import ElementTree

START = 1_795_209_740_000_000  # µs since the epoch: 2026-11-20 21:22:20 UTC
IDLE, RUNNING, SUCCESS, FAILURE = range(4)
SIGNALS = re.compile(r"^signal (\w+) : (\S+)", re.MULTILINE)
Row = tuple[int, int, int]  # µs since the start, uid, status


def write(seed: str, folder: Path) -> None:
    """Write `run.btlog`, `run.db3` and `signals.csv` beside `main.xml` and `main.btq`."""
    chance = random.Random(seed)
    logged, children = _as_logged(ElementTree.parse(folder / "main.xml").getroot())
    xml = ElementTree.tostring(logged, encoding="unicode")
    rows: list[Row] = []
    time = 0
    for _ in range(chance.randint(1, 6)):
        begin = len(rows)
        time = _run(chance, children, 1, time, rows)
        if chance.random() < 0.2:  # cut off
            del rows[chance.randint(begin, len(rows)) :]
        else:
            rows.append((time, 1, IDLE))
        time += chance.choice((0, 250_000, 1_000_000))
    _write_btlog(folder / "run.btlog", xml, rows)
    _write_db3(folder / "run.db3", xml, rows)
    (folder / "signals.csv").write_text(_samples(chance, (folder / "main.btq").read_text("utf-8"), rows), "utf-8")


def _as_logged(root: ElementTree.Element) -> tuple[ElementTree.Element, dict[int, list[int]]]:
    """The tree as loggers write it: numbered, a tree for each instance of a subtree; and the children of each."""
    trees = {tree.attrib["ID"]: tree for tree in root.iter("BehaviorTree")}
    logged = ElementTree.Element("root", BTCPP_format="4")
    children: dict[int, list[int]] = {}

    def write_tree(name: str, path: str, above: int) -> None:
        tree = ElementTree.SubElement(logged, "BehaviorTree", ID=name, _fullpath=path)
        for node in trees[name]:
            write_node(node, tree, path, above)

    def write_node(node: ElementTree.Element, parent: ElementTree.Element, path: str, above: int) -> None:
        number = len(children) + 1
        children[number] = []
        children.get(above, []).append(number)
        kind = node.get("ID", node.tag)
        name = node.get("name", kind)
        if node.tag == "SubTree":
            own = f"{path}/{name}" if path else name
            own += f"::{number}" if name == kind else ""
            ElementTree.SubElement(parent, "SubTree", ID=kind, _fullpath=own, _uid=str(number))
            write_tree(kind, own, number)
            return
        made = ElementTree.SubElement(parent, kind, name=name, _uid=str(number))
        for child in node:
            write_node(child, made, path, number)

    write_tree(root.get("main_tree_to_execute") or next(iter(trees)), "", 0)
    return logged, children


def _run(chance: random.Random, children: dict[int, list[int]], uid: int, time: int, rows: list[Row]) -> int:
    """An activation; the time at its end.  No control node is obeyed: what is judged is what rows say."""
    below = children[uid]
    if below or chance.random() < 0.7:
        rows.append((time, uid, RUNNING))
        time += chance.choice((0, 250_000, 500_000, 1_000_000, 2_000_000))
    for child in below:
        for _ in range(chance.choice((0, 1, 1, 1, 1, 2))):
            time = _run(chance, children, child, time, rows)
            if chance.random() < 0.8:
                rows.append((time, child, IDLE))
    rows.append((time, uid, chance.choice((SUCCESS, SUCCESS, SUCCESS, FAILURE, IDLE))))
    return time


def _write_btlog(path: Path, xml: str, rows: list[Row]) -> None:
    """A file of FileLogger2."""
    tree = xml.encode()
    head = b"BTCPP4-FileLogger2" + struct.pack("<Bi", 1, len(tree)) + tree + struct.pack("<q", START)
    path.write_bytes(head + b"".join(row[0].to_bytes(6, "little") + struct.pack("<HB", *row[1:]) for row in rows))


def _write_db3(path: Path, xml: str, rows: list[Row]) -> None:
    """A database of SqliteLogger, whose times strictly increase."""
    database = sqlite3.connect(path)
    database.executescript(
        "CREATE TABLE Transitions (timestamp INTEGER PRIMARY KEY NOT NULL, session_id INTEGER NOT NULL,"
        " node_uid INTEGER NOT NULL, duration INTEGER, state INTEGER NOT NULL, extra_data VARCHAR);"
        "CREATE TABLE Nodes (session_id INTEGER NOT NULL, fullpath VARCHAR, node_uid INTEGER NOT NULL);"
        "CREATE TABLE Definitions (session_id INTEGER PRIMARY KEY AUTOINCREMENT, date TEXT NOT NULL,"
        " xml_tree TEXT NOT NULL);"
    )
    database.execute("INSERT INTO Definitions VALUES (1, '2026-11-20 21:22:20', ?)", (xml,))
    last = 0
    for time, uid, status in rows:
        last = max(last + 1, START + time)
        database.execute("INSERT INTO Transitions VALUES (?, 1, ?, 0, ?, '')", (last, uid, status))
    database.commit()
    database.close()


def _samples(chance: random.Random, mission: str, rows: list[Row]) -> str:
    """Samples of most signals, often just at the time of a row."""
    signals = [signal for signal in SIGNALS.findall(mission) if chance.random() < 0.9]
    lines = [",".join(("t", *(name for name, _ in signals)))]
    end = rows[-1][0] if rows else 0
    times = sorted({chance.choice([row[0] for row in rows] or [0]) for _ in range(12)} | {chance.randint(0, end)})
    for time in times:
        values = [_value(chance, unit) if chance.random() < 0.6 else "" for _, unit in signals]
        lines.append(f"{(START + time) / 1e6:.6f},{','.join(values)}")
    return "".join(f"{line}\n" for line in lines)


def _value(chance: random.Random, unit: str) -> str:
    words = {"bool": ("true", "false"), "text": ("up", "down")}
    return chance.choice(words.get(unit) or [f"{chance.randint(0, 20) * 5}", f"{chance.randint(-1, 8) / 4}"])
