"""The nodes of Nav2 by distribution of ROS 2: files with models, which `tools/nav2_nodes.py` writes.

One invariant: only names and paths; a file is read when a project names it.
"""

from __future__ import annotations

import os.path
from collections.abc import Mapping
from typing import Final

DISTRIBUTIONS: Final = ("humble", "iron", "jazzy", "kilted", "lyrical")

_FOLDER: Final = os.path.dirname(os.path.abspath(__file__)).replace(os.sep, "/")
# The path of the file for each name that a project may use.
PACKAGED: Final[Mapping[str, str]] = {f"nav2-{each}": f"{_FOLDER}/{each}.btq" for each in DISTRIBUTIONS}
