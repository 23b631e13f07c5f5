"""tree-sitter: its C parser, generated from grammar.js and built when first asked for, behind its Python binding.

Generating needs the `tree-sitter` command (or `BTQ_BENCH_TREE_SITTER`, its path), which needs `node`; building needs a
C compiler (`cc`, or `CC`).  Both are done once, into `bench/build/`.
"""

from __future__ import annotations

import ctypes
import importlib.metadata
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import tree_sitter

VERSION = importlib.metadata.version("tree-sitter")

_SOURCES = Path(__file__).parent / "tree_sitter"
_BUILD = Path(__file__).parents[1] / "build" / "tree_sitter"
# The last ABI that every binding of the past years reads; the tables do not differ otherwise.
_ABI = "14"


def load() -> Callable[[str], object]:
    parser = tree_sitter.Parser(_language(_library()))
    return lambda text: parser.parse(text.encode())


def count(tree: tree_sitter.Tree) -> int:
    assert not tree.root_node.has_error, "the grammar does not accept the mission"
    nodes = 0
    stack = [tree.root_node]
    while stack:
        node = stack.pop()
        nodes += node.type == "node"
        stack += node.named_children
    return nodes


def _library() -> Path:
    """The built grammar, made anew when its sources are newer.

    Raises:
        ImportError: no generator, no compiler, or they fail.
    """
    library = _BUILD / "btq_classic.so"
    sources = [_SOURCES / "grammar.js", _SOURCES / "scanner.c"]
    if library.exists() and library.stat().st_mtime > max(source.stat().st_mtime for source in sources):
        return library
    generator = os.environ.get("BTQ_BENCH_TREE_SITTER") or shutil.which("tree-sitter")
    if generator is None:
        raise ImportError("no `tree-sitter` command; BTQ_BENCH_TREE_SITTER may name one")
    _BUILD.mkdir(parents=True, exist_ok=True)
    generated = _BUILD / "src"
    compiler = os.environ.get("CC", "cc")
    _run(generator, "generate", "--abi", _ABI, "--output", str(generated), str(sources[0]))
    _run(
        compiler, "-shared", "-fPIC", "-O2", f"-I{generated}",
        str(generated / "parser.c"), str(sources[1]), "-o", str(library),
    )  # fmt: skip
    return library


def _run(*command: str) -> None:
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, cwd=_BUILD)
    except FileNotFoundError as error:
        raise ImportError(f"`{command[0]}` is not installed") from error
    except subprocess.CalledProcessError as error:
        raise ImportError(f"`{command[0]}` failed: {error.stderr.strip()}") from error


def _language(library: Path) -> tree_sitter.Language:
    function = ctypes.CDLL(str(library)).tree_sitter_btq_classic
    function.restype = ctypes.c_void_p
    new_capsule = ctypes.pythonapi.PyCapsule_New
    new_capsule.restype = ctypes.py_object
    new_capsule.argtypes = (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)
    return tree_sitter.Language(new_capsule(function(), b"tree_sitter.Language", None))
