"""One parser in a process of its own, driven by parse.py: `python worker.py MODULE`, a module of `parsers/`.

One invariant: nothing but the parser under measurement is in the process, so that no other's heap slows its garbage
collection or counts as its memory.  Says first `{"version": …}` or `{"missing": why}`; then answers each line
`{"do": …, "path": …}`, of a file or a folder of files, by one line.  `time` answers seconds and nodes, `traced` and
`resident` peak bytes.
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
    about = {"form": getattr(tool, "FORM", ""), "package": getattr(tool, "PACKAGE", "")}
    _answer({"version": tool.VERSION, **about})
    for line in sys.stdin:
        request = json.loads(line)
        texts = _texts(Path(request["path"]))
        if request["do"] == "time":
            _answer(_time(parse, tool.count, texts, request["repeat"]))
        else:
            trees, peak = (_traced if request["do"] == "traced" else _resident)(parse, texts)
            _answer({"nodes": sum(map(tool.count, trees)), "bytes": peak})


def _texts(path: Path) -> list[str]:
    """Line ends are as in the files."""
    files = sorted(path.iterdir()) if path.is_dir() else [path]
    return [file.read_bytes().decode("utf-8") for file in files]


def _answer(value: dict[str, object]) -> None:
    print(json.dumps(value), flush=True)


def _time(
    parse: Callable[[str], object], count: Callable[[Any], int], texts: list[str], repeat: int
) -> dict[str, object]:
    """Processor time, of which other load on the machine changes little.  The collector stays on, as users have it, but
    starts each time with nothing to do.
    """
    seconds = []
    nodes = 0
    for _ in range(repeat):
        gc.collect()
        start = time.process_time()
        trees = [parse(text) for text in texts]
        seconds.append(time.process_time() - start)
        nodes = nodes or sum(map(count, trees))
        del trees
    return {"seconds": seconds, "nodes": nodes}


def _traced(parse: Callable[[str], object], texts: list[str]) -> tuple[list[object], int]:
    """The most that Python's allocators held at once: exact for parsers whose trees are Python objects."""
    gc.collect()
    tracemalloc.start()
    trees = [parse(text) for text in texts]
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return trees, peak


def _resident(parse: Callable[[str], object], texts: list[str]) -> tuple[list[object], int]:
    """How much the process grew at most: for parsers that allocate in C, in pages and with what malloc keeps."""
    gc.collect()
    linux = sys.platform == "linux"
    if linux:
        Path("/proc/self/clear_refs").write_text("5")  # the peak starts anew from here
    before = _status("VmRSS") if linux else _maxrss()
    trees = [parse(text) for text in texts]
    return trees, (_status("VmHWM") if linux else _maxrss()) - before


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
