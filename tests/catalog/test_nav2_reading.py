"""Which inputs Nav2's nodes read only when the tree is created: the table against the code of every branch."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator

import pytest
from nav2_clone import files, read

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.catalog.nav2.creation import READ_ONCE, is_read_once
from btq_lang.commands.explain_nav2 import models_of

HEAD = re.compile(r"^(?:[\w:<>&*]+ )*(\w+)::(\w+)\(", re.MULTILINE)
READS = re.compile(r'(?:getInput(?:OrBlackboard)?|deconflictPortAndParamFrame)(?:<[^>]*>)?\(\s*(?:\w+,\s*)?"(\w+)"')
TICKED = ("tick", "on_tick", "on_wait_for_result", "on_completion")


def test_the_table_is_of_existing_ports() -> None:
    for node, ports in READ_ONCE.items():
        for port, letters in ports.items():
            of = [each for each in DISTRIBUTIONS if each[0] in letters]
            has = [each for each in of if node in models_of(each) and port in port_names(each, node)]
            # Where a node has the port in some distributions only, the letters of the others do no harm.
            assert has, (node, port)


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_the_table_is_what_the_code_says(distribution: str) -> None:
    names = {node.class_name.rpartition("::")[2]: node.name for node in read(distribution).nodes}
    functions: dict[str, dict[str, str]] = defaultdict(dict)
    for path, text in files(distribution).items():
        for owner, name, body in definitions(text) if path.endswith(".cpp") else ():
            functions[owner][name] = body
    checked = 0
    for owner, bodies in functions.items():
        if owner not in names:
            continue
        node = names[owner]
        ticked = {port for start in TICKED if start in bodies for port in reads(bodies, start)}
        for port in reads(bodies, owner) | ticked:
            ports = port_names(distribution, node)
            assert is_read_once(distribution, node, port, ports) == (port not in ticked), (node, port)
            checked += 1
    assert checked > 70


def port_names(distribution: str, node: str) -> set[str]:
    return {port.id.text for port in models_of(distribution)[node].ports if port.id is not None}


def definitions(text: str) -> Iterator[tuple[str, str, str]]:
    """The member functions that a file defines: class, name and body."""
    for head in HEAD.finditer(text):
        start = text.find("\n{", head.end())
        end = text.find("\n}", start)
        if 0 < start < end:
            yield head[1], head[2], text[start:end]


def reads(bodies: dict[str, str], start: str) -> set[str]:
    """The inputs that a function reads, itself or through others of its class."""
    return {port for body in called_from(bodies, start) for port in READS.findall(body)}


def called_from(bodies: dict[str, str], start: str) -> Iterator[str]:
    """The bodies of a function and of all others of its class that it calls."""
    waiting, seen = [start], {start}
    while waiting:
        body = bodies.get(waiting.pop(), "")
        yield body
        called = {name for name in re.findall(r"\b(\w+)\(", body) if name in bodies} - seen
        seen |= called
        waiting += called
