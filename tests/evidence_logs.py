"""Logs made by hand: what an engine would have written, as bytes and as databases.

Rows are written as in `1R 2R 5 2S 1S`: a number alone is the time in ms since the log's start, then uid and status of
the rows at that time: I(DLE), R(UNNING), S(UCCESS), F(AILURE).
"""

from __future__ import annotations

import itertools
import json
import re
import shutil
import sqlite3
import struct
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from btq_lang.cli import main
from btq_lang.evidence.model import LogSession
from btq_lang.evidence.readers import read

START = 1_795_209_740_000_000  # µs since the epoch: 2026-11-20 21:22:20 UTC
MAIN = "Root Main\nBehaviorTree Main\n    ->\n        Action Move\n        Action Pick\nAction Move\nAction Pick\n"
MAIN_XML = (
    '<root BTCPP_format="4"><BehaviorTree ID="Main" _fullpath=""><Sequence name="Sequence" _uid="1">'
    '<Move name="Move" _uid="2"/><Pick name="Pick" _uid="3"/></Sequence></BehaviorTree></root>'
)
Row = tuple[int, int, int]


def rows(text: str) -> list[Row]:
    """The rows of a text: µs since the log's start, uid, status."""
    found: list[Row] = []
    time = 0
    for word in text.split():
        if match := re.fullmatch(r"(\d+)([IRSF])", word):
            found.append((time, int(match[1]), "IRSF".index(match[2])))
        else:
            time = round(float(word) * 1000)
    return found


def btlog(xml: str, transitions: Sequence[Row], start: int = START) -> bytes:
    """A file of FileLogger2."""
    tree = xml.encode()
    head = b"BTCPP4-FileLogger2" + struct.pack("<Bi", 1, len(tree)) + tree + struct.pack("<q", start)
    return head + b"".join(
        time.to_bytes(6, "little") + struct.pack("<HB", uid, status) for time, uid, status in transitions
    )


def logged(file: Path) -> tuple[str, int, list[Row]]:
    """The tree, the start and the rows of a .btlog, read without btq."""
    data = file.read_bytes()
    (length,) = struct.unpack_from("<i", data, 19)
    xml = data[23 : 23 + length].decode()
    (start,) = struct.unpack_from("<q", data, 23 + length)
    found = [
        (low | high << 32, uid, status) for low, high, uid, status in struct.iter_unpack("<IHHB", data[31 + length :])
    ]
    return xml, start, found


def write_db3(
    path: Path, xml: str, sessions: Sequence[Sequence[Row]], extra: Mapping[int, str] | None = None, start: int = START
) -> None:
    """A database of SqliteLogger, whose times strictly increase.

    Args:
        extra: `extra_data` of rows, by their index over all sessions.
    """
    database = sqlite3.connect(path)
    database.executescript(
        "CREATE TABLE Transitions (timestamp INTEGER PRIMARY KEY NOT NULL, session_id INTEGER NOT NULL,"
        " node_uid INTEGER NOT NULL, duration INTEGER, state INTEGER NOT NULL, extra_data VARCHAR);"
        "CREATE TABLE Nodes (session_id INTEGER NOT NULL, fullpath VARCHAR, node_uid INTEGER NOT NULL);"
        "CREATE TABLE Definitions (session_id INTEGER PRIMARY KEY AUTOINCREMENT, date TEXT NOT NULL,"
        " xml_tree TEXT NOT NULL);"
    )
    last = index = 0
    for number, transitions in enumerate(sessions, start=1):
        database.execute("INSERT INTO Definitions VALUES (?, '2026-11-20 21:22:20', ?)", (number, xml))
        for time, uid, status in transitions:
            last = max(last + 1, start + time)
            row = (last, number, uid, 0, status, (extra or {}).get(index, ""))
            database.execute("INSERT INTO Transitions VALUES (?, ?, ?, ?, ?, ?)", row)
            index += 1
    database.commit()
    database.close()


def sessions_of(log: Path) -> Iterator[LogSession]:
    """The sessions of a log that has the tree of each."""
    for session in read(str(log)):
        assert isinstance(session, LogSession)
        yield session


def samples(name: str, values: Mapping[int, object] | Mapping[float, object]) -> str:
    """A CSV file with the samples of one signal, by ms since the log's start."""
    lines = [f"{(START + round(ms * 1000)) / 1e6:.6f},{value}" for ms, value in values.items()]
    return "\n".join([f"t,{name}", *lines, ""])


class Verify:
    """`btq verify` in a folder of its own, on a mission and a log."""

    def __init__(self, folder: Path, output: pytest.CaptureFixture[str]) -> None:
        self.folder = folder
        self._output = output
        self.errors = ""
        self.code = 0

    def text(self, *arguments: str) -> str:
        """What the command prints."""
        self._output.readouterr()
        self.code = main(["verify", *arguments])
        printed = self._output.readouterr()
        self.errors = printed.err
        return printed.out

    def build(self, mission: str, *options: str) -> str:
        """What the engine writes in its logs as the tree of a mission, which is built and then forgotten."""
        source = self.folder / "built" / "main.btq"
        source.parent.mkdir()
        source.write_text(mission, encoding="utf-8")
        assert main(["build", str(source), *options]) == 0
        xml = source.with_suffix(".xml").read_text(encoding="utf-8")
        shutil.rmtree(source.parent)
        return as_logged(xml)

    def json(self, *arguments: str) -> dict[str, Any]:
        """What it prints as JSON."""
        found: dict[str, Any] = json.loads(self.text(*arguments, "--format", "json"))
        return found

    def clause(
        self,
        demand: str,
        runs: str,
        csv: str | None = None,
        *,
        mission: str = MAIN,
        xml: str = MAIN_XML,
        before: str = "",
    ) -> dict[str, Any]:
        """What one demand comes to: the only clause of the only requirement.

        Args:
            demand: the clauses of the requirement, a line each.
            runs: the log's rows, as `rows` reads them.
            before: signals and contexts.
        """
        lines = "".join(f"    {line.strip()}\n" for line in demand.splitlines())
        (self.folder / "main.btq").write_text(f"{before}\nQualityReq rq : safety\n{lines}{mission}", encoding="utf-8")
        (self.folder / "run.btlog").write_bytes(btlog(xml, rows(runs)))
        given = ["run.btlog", "--mission", "main.btq"]
        if csv is not None:
            (self.folder / "samples.csv").write_text(csv, encoding="utf-8")
            given += ["--signals", "samples.csv"]
        (requirement,) = self.json(*given)["requirements"]
        assert self.errors == ""
        (clause,) = requirement["clauses"]
        assert requirement["verdict"] == clause["verdict"]
        found: dict[str, Any] = clause
        return found


def as_logged(xml: str) -> str:
    """The tree of an XML file as the engine's loggers write it: numbered, with a tree for each instance of a subtree.

    An independent reading of `recursivelyCreateSubtree` and `WriteTreeToXML` in BehaviorTree.CPP's src/xml_parsing.cpp.
    """
    root = ElementTree.fromstring(xml.encode())
    trees = {tree.attrib["ID"]: tree for tree in root.iter("BehaviorTree")}
    logged = ElementTree.Element("root", BTCPP_format="4")
    numbers = itertools.count(1)

    def write_tree(name: str, path: str) -> None:
        tree = ElementTree.SubElement(logged, "BehaviorTree", ID=name, _fullpath=path)
        write(trees[name][0], tree, path)

    def write(node: ElementTree.Element, parent: ElementTree.Element, path: str) -> None:
        number = next(numbers)
        prefix = f"{path}/" if path else ""
        if node.tag == "SubTree":
            name = node.get("name", node.attrib["ID"])
            own = prefix + (name if name != node.get("ID") else f"{name}::{number}")
            ElementTree.SubElement(parent, "SubTree", ID=node.attrib["ID"], _fullpath=own, _uid=str(number))
            write_tree(node.attrib["ID"], own)
            return
        kind = node.attrib["ID"] if node.tag in ("Action", "Condition", "Control", "Decorator") else node.tag
        made = ElementTree.SubElement(parent, kind, name=node.get("name", kind), _uid=str(number))
        for child in node:
            write(child, made, path)

    write_tree(root.attrib["main_tree_to_execute"], "")
    return ElementTree.tostring(logged, encoding="unicode")
