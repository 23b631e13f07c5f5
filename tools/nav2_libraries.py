"""Writes `btq_lang/catalog/nav2/libraries.py`, the libraries of Nav2's nodes, from a clone of navigation2.

python tools/nav2_libraries.py CLONE
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from subprocess import run
from typing import Final

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from nav2_sources import sources  # noqa: E402  # beside this script

from btq_lang.catalog.nav2 import DISTRIBUTIONS  # noqa: E402  # of this checkout
from btq_lang.cpp.nodes import read_nodes  # noqa: E402  # as above

TABLE: Final = ROOT / "btq_lang/catalog/nav2/libraries.py"


def table_file(clone: Path) -> str:
    """The text of the module with the table."""
    nodes: dict[str, dict[str, None]] = {}
    known: dict[str, str] = {}
    loaded: dict[str, str] = {}
    for distribution in DISTRIBUTIONS:
        found = _libraries(clone, distribution)
        unnamed = _loaded_unnamed(clone, distribution)
        for library, names in found.items():
            nodes.setdefault(library, {}).update(dict.fromkeys(names))
            known[library] = known.get(library, "") + distribution[0]
            loaded[library] = loaded.get(library, "") + (distribution[0] if library in unnamed else "")
    rows = [_row(each, sorted(nodes[each]), known[each], loaded[each]) for each in sorted(nodes)]
    return _HEAD + "".join(rows) + "}\n"


def _row(library: str, nodes: list[str], known: str, loaded: str) -> str:
    names = ", ".join(f'"{each}"' for each in nodes)
    row = f'    "{library}": (({names},), "{known}", "{loaded}"),\n'
    if len(row) <= 121:
        return row
    return f'    "{library}": (\n        ({names}),\n        "{known}",\n        "{loaded}",\n    ),\n'


def _libraries(clone: Path, branch: str) -> dict[str, list[str]]:
    """The libraries that a branch builds, each with the nodes that its source registers."""
    texts = {path: text for path, text in sources(clone, branch).items() if not path.endswith(".xml")}
    registered: dict[str, list[str]] = {}
    for node in read_nodes(texts).nodes:
        registered.setdefault(node.place.path, []).append(node.name)
    found: dict[str, list[str]] = {}
    for folder in ("nav2_behavior_tree", "nav2_docking/opennav_docking_bt"):
        if not any(path.startswith(folder) for path in texts):
            continue
        for library, source in _ADDED.findall(_text(clone, branch, f"{folder}/CMakeLists.txt")):
            if f"{folder}/{source}" in registered:
                found[library] = registered[f"{folder}/{source}"]
    return found


def _loaded_unnamed(clone: Path, branch: str) -> set[str]:
    """The libraries that bt_navigator loads if its parameters name none."""
    text = _text(clone, branch, "nav2_bt_navigator/src/bt_navigator.cpp")
    if "BT_BUILTIN_PLUGINS" in text:
        return set(_BUILT_IN.findall(_text(clone, branch, "nav2_behavior_tree/CMakeLists.txt")))
    return set(_QUOTED.findall(text[text.index("plugin_libs = {") : text.index("};")]))


def _text(clone: Path, branch: str, path: str) -> str:
    command = ["git", "-C", str(clone), "show", f"{branch}:{path}"]
    return run(command, capture_output=True, check=True, text=True).stdout


_ADDED: Final = re.compile(r"add_library\(\s*(\w+)\s+SHARED\s+(\S+\.cpp)\s*\)")
_BUILT_IN: Final = re.compile(r"list\(APPEND plugin_libs (\w+)\)")
_QUOTED: Final = re.compile(r'"(\w+)"')
_HEAD: Final = '''"""The libraries in which Nav2's nodes are; `tools/nav2_libraries.py` writes this file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

# The nodes that each registers; the first letters of the distributions that have it, and of those in which bt_navigator
# loads it if the parameters name no library.  Humble and Iron then load only what the parameters name, later ones both.
LIBRARIES: Final[Mapping[str, tuple[tuple[str, ...], str, str]]] = {
'''

if __name__ == "__main__":
    TABLE.write_text(table_file(Path(sys.argv[1])), encoding="utf-8")
    print(TABLE)
