"""One parser in a process of its own, driven by parse.py: `python worker.py MODULE`, a module of `parsers/`.

One invariant: nothing but the parser under measurement is in the process, so that no other's heap slows its garbage
collection or counts as its memory.  Says first `{"version": …, "form": …}` or `{"missing": why}`; then answers each
line `{"do": …, "path": …}` by one line.  `time` answers seconds and nodes, `traced` and `resident` peak bytes.
"""

from __future__ import annotations

import gc
import importlib
import json
import re
import resource
import sys
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any


def main() -> None:
    try:
        tool = importlib.import_module(f"parsers.{sys.argv[1]}")
        parse = tool.load()
    except ImportError as error:
        _answer({"missing": str(error)})
        return
    _answer({"version": tool.VERSION, "form": getattr(tool, "FORM", "")})
    for line in sys.stdin:
        request = json.loads(line)
        text = Path(request["path"]).read_text(encoding="utf-8")
        if request["do"] == "time":
            _answer(_time(parse, tool.count, text, request["repeat"]))
        else:
            tree, peak = (_traced if request["do"] == "traced" else _resident)(parse, text)
            _answer({"nodes": tool.count(tree), "bytes": peak})


def _answer(value: dict[str, object]) -> None:
    print(json.dumps(value), flush=True)


def _time(parse: Callable[[str], object], count: Callable[[Any], int], text: str, repeat: int) -> dict[str, object]:
    """The collector stays on, as users have it, but starts each time with nothing to do."""
    seconds = []
    nodes = 0
    for _ in range(repeat):
        gc.collect()
        start = time.perf_counter()
        tree = parse(text)
        seconds.append(time.perf_counter() - start)
        nodes = nodes or count(tree)
        del tree
    return {"seconds": seconds, "nodes": nodes}


def _traced(parse: Callable[[str], object], text: str) -> tuple[object, int]:
    """The most that Python's allocators held at once: exact for parsers whose trees are Python objects."""
    gc.collect()
    tracemalloc.start()
    tree = parse(text)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return tree, peak


def _resident(parse: Callable[[str], object], text: str) -> tuple[object, int]:
    """How much the process grew at most: for parsers that allocate in C, in pages and with what malloc keeps."""
    gc.collect()
    linux = sys.platform == "linux"
    if linux:
        Path("/proc/self/clear_refs").write_text("5")  # the peak starts anew from here
    before = _status("VmRSS") if linux else _maxrss()
    tree = parse(text)
    return tree, (_status("VmHWM") if linux else _maxrss()) - before


def _status(key: str) -> int:
    found = re.search(rf"{key}:\s*(\d+) kB", Path("/proc/self/status").read_text())
    assert found is not None
    return int(found[1]) * 1024


def _maxrss() -> int:
    """Where the peak cannot be reset, what loading took is part of `before`."""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


if __name__ == "__main__":
    main()
