"""Writes `btq_lang/catalog/nav2/*.btq`, the nodes of Nav2 by distribution, from a clone of navigation2, and `ports.py`
beside them, and prints where Nav2's own list of its nodes differs from its code.

    python tools/nav2_nodes.py CLONE

What the nodes are called and which ports they have is read from the C++ code of the branches; descriptions, and without
which inputs a node cannot do its work, are ours (nav2_words.py).
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from textwrap import wrap

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from nav2_differences import differences  # noqa: E402  # beside this script
from nav2_sources import PALETTE, sources  # noqa: E402  # as above
from nav2_words import NODES, OF_MESSAGES, PORTS, REQUIRED, REQUIRED_IN  # noqa: E402  # as above

from btq_lang.catalog.nav2 import FILES, ports  # noqa: E402  # of this checkout
from btq_lang.commands.explain_nav2 import models_of  # noqa: E402  # as above
from btq_lang.cpp.model import CppNode, CppPort  # noqa: E402  # as above
from btq_lang.cpp.nodes import read_nodes  # noqa: E402  # as above
from btq_lang.projects.node_writers import models_in_btq  # noqa: E402  # as above
from btq_lang.util.record import replace  # noqa: E402  # as above


def model_file(clone: Path, distribution: str) -> str:
    """The text of a distribution's file; prints what Nav2's list says otherwise."""
    files = sources(clone, distribution)
    palette = files.pop(PALETTE)
    found = read_nodes(files)
    for each in differences(found.nodes, palette):
        print(f"{distribution}: {each.name}: {each.kind}: {each.why}")
    if found.unseen:
        raise SystemExit("\n".join(f"{each.place}: {each.message}" for each in found.unseen))
    headline = f"The nodes of Nav2 in ROS 2 {distribution.capitalize()}; tools/nav2_nodes.py writes this file."
    return models_in_btq(_described(found.nodes, distribution), headline, NODES)


def _described(nodes: tuple[CppNode, ...], distribution: str) -> Iterator[CppNode]:
    for node in nodes:
        required = {*REQUIRED.get(node.name, ()), *REQUIRED_IN.get(distribution, {}).get(node.name, ())}
        yield replace(node, ports=tuple(_described_port(port, port.name in required) for port in node.ports))


def _described_port(port: CppPort, is_required: bool) -> CppPort:
    default = port.default
    if is_required:
        default = None
    elif port.direction != "output" and default is None:
        default = ""
    return replace(port, type=OF_MESSAGES.get(port.type, port.type), default=default, text=PORTS[port.name])


def ports_module() -> str:
    """The text of `ports.py`, from the files of all distributions."""
    of_node: dict[str, set[str]] = {}
    for distribution in FILES:
        for name, model in models_of(distribution).items():
            of_node.setdefault(name, set()).update(port.id.text for port in model.ports if port.id is not None)
    rows = []
    for name in sorted(of_node):
        lines = wrap(" ".join(sorted(of_node[name])), 109 - len(name)) or [""]
        rows += [f'    "{name}": "{lines[0]}"', *(f'    " {line}"' for line in lines[1:])]
        rows[-1] += ","
    return _PORTS.format("\n".join(rows))


_PORTS = '''"""The ports that each node of Nav2 has in any distribution; tools/nav2_nodes.py writes this file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

PORTS: Final[Mapping[str, str]] = {{
{}
}}
'''

if __name__ == "__main__":
    for distribution, path in FILES.items():
        Path(path).write_text(model_file(Path(sys.argv[1]), distribution), encoding="utf-8")
        print(path)
    Path(ports.__file__).write_text(ports_module(), encoding="utf-8")
