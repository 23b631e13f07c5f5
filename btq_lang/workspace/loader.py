"""Files: finding the project file, collecting files, reading them with what they include, and writing.

The only module that reads or writes the user's disk.  One invariant: what cannot be read is reported as a problem,
never as an exception, and what is written is written whole or not at all.  Paths inside btq are absolute and
normalised, with `/` between names; `shown` makes them readable.  Not known here: what the texts mean, not even the
syntax of includes.
"""

from __future__ import annotations

import errno
import os
import re
import stat
import time
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from typing import BinaryIO

from btq_lang.util.record import Record, replace
from btq_lang.util.text import LineIndex, Position
from btq_lang.workspace.config import (
    PROJECT_FILES,
    Project,
    has_btq_table,
    include_candidates,
    keys_above,
    parse_project,
)
from btq_lang.workspace.file import SUFFIXES

_SKIPPED_FOLDERS = frozenset({"build", "node_modules"})  # besides the hidden ones: .git, .venv
_OF_COLCON = frozenset({"build", "install", "log"})  # colcon makes these in the folder that it runs in
_FOLDERS_OF_TESTS = frozenset({"test", "tests"})  # of C++, whose mocks have the names of real nodes
_PACKAGE_NAME = re.compile(r"<name>\s*(\S+?)\s*</name>")
_HEAD = 4096  # bytes that nearly always show what a file is
IS_SPECIAL = "cannot be read: expected a regular file, found a pipe or a device"
_BOM = "\ufeff"
_PAUSES = (0.01, 0.1, 0.5) if os.name == "nt" else ()  # seconds between attempts to rename


class LoadProblem(Record):
    """A problem with a file that kept btq from a part of its task."""

    path: str
    message: str
    position: Position | None = None

    def __str__(self) -> str:
        """`path:line:column: message`, counted from 1, the path as `shown` writes it."""
        place = f":{self.position.line + 1}:{self.position.column + 1}" if self.position else ""
        return f"{shown(self.path)}{place}: {self.message}"


class FoundProject(Record):
    """The project of a folder, and the file it was read from; None if there is no such file."""

    project: Project
    path: str | None
    problems: tuple[LoadProblem, ...] = ()


class LoadedFiles(Record):
    """Files with all that they include.

    Attributes:
        texts: the text of each file that could be read: first the given ones, then the included ones.
        given: the paths of `texts` that the caller named.
        damaged: the paths of `texts` that are not UTF-8, so that writing the text back would lose something.
        absent: where included files that were not found would be, for watchers.
        problems: what could not be read, or not fully.  A missing included file is not one of them: the rule
            `missing-include` reports it at the include.
    """

    texts: dict[str, str]
    given: tuple[str, ...]
    damaged: tuple[str, ...] = ()
    absent: tuple[str, ...] = ()
    problems: tuple[LoadProblem, ...] = ()


def find_project(start: str, overlay: Mapping[str, str] | None = None) -> FoundProject:
    """The project of a file or folder: the nearest folder above with a btq.toml, or a pyproject.toml with `[tool.btq]`.

    If a folder has both, btq.toml counts.

    Args:
        overlay: texts that replace those on the disk, by path.
    """
    overlay = overlay or {}
    if _project_file:
        return _project_in(_project_file, absolute("."), overlay)
    start = absolute(start)
    folder = start if os.path.isdir(start) else os.path.dirname(start)
    for root in _upwards(folder):
        for kind in PROJECT_FILES:
            path = absolute(os.path.join(root, kind))
            if path not in overlay and not os.path.exists(path):  # a folder of that name is a mistake worth reporting
                continue
            if kind == "pyproject.toml" and not has_btq_table(overlay.get(path) or read(path)[0] or ""):
                continue
            return _project_in(path, root, overlay)
    return FoundProject(Project(folder), None)


def _project_in(path: str, root: str, overlay: Mapping[str, str]) -> FoundProject:
    text, problem = (overlay[path], None) if path in overlay else read(path)
    project, problems = parse_project(text or "", "pyproject.toml" if keys_above(path) else "btq.toml", root)
    reported = tuple(LoadProblem(path, complaint.message, complaint.position) for complaint in problems)
    lost = tuple(folder for folder in project.include_paths if not os.path.isdir(folder))
    return FoundProject(replace(project, lost_paths=lost), path, (problem, *reported) if problem else reported)


def pool_of(folder: str, top: str) -> str:
    """The folder in whose files the XML of a folder finds what it lacks: the repository, else the package, else `top`,
    where there is no project file."""
    for name in (".git", "package.xml"):
        for above in _upwards(folder):
            if os.path.exists(f"{above}/{name}"):
                return above
    return top


def matching(folder: str, pattern: str) -> tuple[str, ...]:
    """The files that a pattern below a folder matches, sorted."""
    from glob import glob  # few projects name files by patterns

    names = glob(pattern, root_dir=folder, recursive=True)
    paths = sorted(absolute(os.path.join(folder, each)) for each in names)
    return tuple(path for path in paths if os.path.isfile(path))


def package_folder(name: str, start: str) -> str | None:
    """The folder of a ROS package: in the workspace around a folder, else where AMENT_PREFIX_PATH says."""
    for path in collect((_workspace_of(start),), Project(), ("package.xml",))[0]:
        match = _PACKAGE_NAME.search(read(path)[0] or "") if path.endswith("/package.xml") else None
        if match is not None and match[1] == name:
            return os.path.dirname(path)
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        share = absolute(os.path.join(prefix, "share", name))
        if prefix and os.path.isdir(share):
            return share
    return None


def _workspace_of(folder: str) -> str:
    """The folder with the packages that are built together: the outermost `src`, else the repository, else itself."""
    above = [*_upwards(folder)]
    sources = [each for each in above if os.path.basename(each) == "src"]
    return sources[-1] if sources else next((each for each in above if os.path.exists(f"{each}/.git")), folder)


def is_project_file(path: str) -> bool:
    """Whether a file has the name of a project file."""
    return path.rpartition("/")[2] in PROJECT_FILES


def load(
    paths: Iterable[str],
    project: Project,
    includes_of: Callable[[str, str], Iterable[str]],
    overlay: Mapping[str, str] | None = None,
    included: Mapping[str, str] | None = None,
) -> LoadedFiles:
    """Read files and folders, and all that the files include, directly or not.

    Args:
        paths: as for `collect`.
        includes_of: the include strings of a file, from its path and its text.
        overlay: texts from elsewhere (standard input), by path: they are given files that are not read from the disk.
        included: texts of files that are not given, but may be included, likewise.
    """
    named, unreachable = collect(paths, project)
    problems = list(unreachable)
    texts: dict[str, str] = {}
    damaged: list[str] = []
    absent: dict[str, None] = {}

    def add(path: str) -> bool:
        text, problem = (included[path], None) if included and path in included else read(path)
        problems.extend([problem] if problem else [])
        if text is not None:
            texts[path] = text
            damaged.extend([path] if problem else [])
        return text is not None

    texts.update(overlay or {})
    readable = (*texts, *(path for path in named if path not in texts and add(path)))
    waiting = list(readable)
    for path in waiting:
        for include in includes_of(path, texts[path]):
            candidates = include_candidates(project, path, include)
            # Only regular files: reading an included pipe or device could block.
            target = next((each for each in candidates if each in texts or os.path.isfile(each)), None)
            if target is None:
                absent.update(dict.fromkeys(candidates))
            elif target not in texts and add(target):
                waiting.append(target)
    return LoadedFiles(texts, readable, tuple(damaged), tuple(absent), tuple(problems))


def collect(
    paths: Iterable[str], project: Project, suffixes: tuple[str, ...] = SUFFIXES
) -> tuple[tuple[str, ...], tuple[LoadProblem, ...]]:
    """The files that paths denote, each once: a file itself, a folder all btq files below it, sorted.

    Left out below a folder: hidden files and folders, `build`, `node_modules`, what colcon makes or ignores, and what
    the project excludes.  Links are followed, but no folder is entered twice, and a file with two paths is one file.
    """
    files: dict[str, None] = {}
    problems: list[LoadProblem] = []
    for path in map(absolute, paths):
        if os.path.isdir(path):
            files.update(dict.fromkeys(sorted(_files_below(path, project, problems, suffixes))))
        else:
            files[path] = None
    return tuple(files), tuple(problems)


def without_tests(paths: Iterable[str], top: str, named: Container[str] = ()) -> tuple[str, ...]:
    """C++ sources below a folder, without those in folders of tests or in those that `collect` leaves out.

    Args:
        named: the names of folders that are not left out.
    """
    top = top.rstrip("/")
    left_out = {top: False}

    def is_left_out(folder: str) -> bool:
        if folder not in left_out:
            above, _, name = folder.rpartition("/")
            is_of_colcon = name in _OF_COLCON and all(os.path.isdir(f"{above}/{each}") for each in _OF_COLCON)
            is_skipped = is_of_colcon or name in _SKIPPED_FOLDERS or name in _FOLDERS_OF_TESTS
            is_ignored = (is_skipped and name not in named) or os.path.exists(f"{folder}/COLCON_IGNORE")
            left_out[folder] = is_left_out(above) or is_ignored
        return left_out[folder]

    return tuple(path for path in paths if not is_left_out(os.path.dirname(path)))


def read(path: str) -> tuple[str | None, LoadProblem | None]:
    """The text of a file without its byte order mark, and what is wrong with it.

    Bytes that are not UTF-8 become U+FFFD, and the problem locates the first one; UTF-16 is a problem but is decoded,
    so that its contents can be checked.  Without a text there is always a problem, for instance if the bytes contain a
    NUL.  Line ends stay as they are.
    """
    if is_special(path) and not path.startswith(("/dev/stdin", "/dev/fd/")):  # a stream that a shell has opened ends
        return None, LoadProblem(path, IS_SPECIAL)
    try:
        with open(path, "rb") as file:
            data = file.read()
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        return None, LoadProblem(path, f"cannot be read: {_reason(error)}")
    return decoded(path, data)


def head(path: str) -> str:
    """The first characters of a file; empty for one that cannot be read."""
    try:
        with open(path, "rb") as file:
            data = file.read(_HEAD)
    except (OSError, ValueError):
        return ""
    encoding = "utf-16" if data.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8"
    return data.decode(encoding, "replace").removeprefix(_BOM)


def decoded(path: str, data: bytes) -> tuple[str | None, LoadProblem | None]:
    """Decode the bytes of a file as `read` describes."""
    problem = None
    is_utf16 = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    if b"\0" in data and not is_utf16:
        return None, LoadProblem(path, "this is not a text file")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8").removeprefix(_BOM)
        message = (
            "this is UTF-16; save it as UTF-8" if is_utf16 else f"this is not UTF-8: byte 0x{data[error.start]:02x}"
        )
        problem = LoadProblem(path, message, LineIndex(before).position(len(before)))
        text = data.decode("utf-16" if is_utf16 else "utf-8", "replace")
    return text.removeprefix(_BOM), problem


def is_special(path: str) -> bool:
    """Whether a path is a pipe or a device, which might never end."""
    status = _status(path)
    return status is not None and not (stat.S_ISREG(status.st_mode) or stat.S_ISDIR(status.st_mode))


def write_whole(path: str, content: str | bytes) -> None:
    """Write a text, or bytes, into a file so that at every moment the file is entirely the old one or the new one.

    The new one goes into a temporary file beside it, which then takes the name (POSIX rename; MoveFileEx on Windows).
    A file that exists keeps its mode and its byte order mark, and a link stays a link.

    Raises:
        OSError: the file or its folder cannot be written; the file is then as it was.
        UnicodeEncodeError: the text holds a lone surrogate; likewise.
    """
    path = os.path.realpath(path)
    folder = os.path.dirname(path)
    data = content.encode("utf-8") if isinstance(content, str) else content
    mode = None
    if os.path.exists(path):
        if not os.access(path, os.W_OK):  # a rename would not check that
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), path)
        mode = stat.S_IMODE(os.stat(path).st_mode)
        with open(path, "rb") as old:
            bom = _bom_of(old)
            data = bom + data.removeprefix(bom)
    file = _temporary(folder)
    try:
        with file:
            if mode is not None:
                os.chmod(file.name, mode)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        _replace(file.name, path)
    except BaseException:
        os.unlink(file.name)
        raise
    _sync(folder)


def stamp(path: str) -> tuple[int, int] | None:
    """A value that changes when a file does: its modification time and its size; None if the file does not exist."""
    status = _status(path)
    return None if status is None else (status.st_mtime_ns, status.st_size)


def absolute(path: str) -> str:
    """The unique spelling of a path that btq uses inside; links stay as they are."""
    return os.path.abspath(path).replace(os.sep, "/")


def work_in(folder: str) -> None:
    """Show paths relative to an editor's folder from now on; its server may run in any other."""
    global _folder
    _folder = folder


def use_project_file(path: str | None) -> None:
    """Have a project file count for all files, its paths relative to the current folder; None: the nearest to each."""
    global _project_file
    _project_file = path


def shown(path: str) -> str:
    """An absolute path for display: relative to the working folder if it is inside it."""
    folder = (_folder or absolute(".")).rstrip("/") + "/"
    return path.removeprefix(folder)


_folder = ""  # else the current one
_project_file: str | None = None  # else the nearest


def _upwards(folder: str) -> Iterator[str]:
    while True:
        yield folder
        above = os.path.dirname(folder)
        if above == folder:
            return
        folder = above


def _files_below(top: str, project: Project, problems: list[LoadProblem], suffixes: tuple[str, ...]) -> Iterable[str]:
    excluded = excluder(project)
    folders = [top]
    links: list[str] = []
    seen: set[tuple[int, int]] = set()
    files: dict[tuple[int, int], str] = {}
    while folders or links:
        # Links come last: a folder is then found under its own name first.
        folder = folders.pop() if folders else links.pop(0)
        try:
            status = os.stat(folder)
            entries = [] if (status.st_dev, status.st_ino) in seen else list(os.scandir(folder))
        except OSError as error:
            problems.append(LoadProblem(folder, f"cannot be read: {_reason(error)}"))
            continue
        seen.add((status.st_dev, status.st_ino))
        names = {entry.name for entry in entries}
        if folder != top and "COLCON_IGNORE" in names:
            continue
        left_out = _SKIPPED_FOLDERS | (_OF_COLCON if names >= _OF_COLCON else frozenset())
        for entry in sorted(entries, key=lambda entry: entry.name):
            path = f"{folder.rstrip('/')}/{entry.name}"
            if entry.name.startswith("."):
                continue
            if _is_folder(entry):
                if entry.name not in left_out and not excluded(path + "/"):
                    (links if entry.is_symlink() else folders).append(path)
            elif entry.name.endswith(suffixes) and not excluded(path):
                if (identity := _identity(path)) is not None:
                    if identity not in files or not entry.is_symlink():
                        files[identity] = path
                elif entry.is_symlink() and not os.path.exists(path):
                    problems.append(LoadProblem(path, "cannot be read: the link has no target"))
    return files.values()


def excluder(project: Project) -> Callable[[str], bool]:
    """A function that tells whether the project excludes a path, or a folder that it is in; a folder's path ends with
    `/`."""
    if not project.exclude:
        return lambda path: False
    from btq_lang.util.globs import path_matcher  # few projects exclude anything

    return path_matcher(project.exclude, absolute(project.root))


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # a link to itself
        return False


def _identity(path: str) -> tuple[int, int] | None:
    """The identity of a regular file, the same for all its paths; None for anything else."""
    status = _status(path)
    return (status.st_dev, status.st_ino) if status is not None and stat.S_ISREG(status.st_mode) else None


def _status(path: str) -> os.stat_result | None:
    """The status of a path; None if nothing is there."""
    try:
        return os.stat(path)
    except (OSError, ValueError):  # ValueError: a NUL in the path
        return None


def _reason(error: Exception) -> str:
    return (error.strerror if isinstance(error, OSError) else None) or str(error)


def _bom_of(file: BinaryIO) -> bytes:
    bom = _BOM.encode()
    return bom if file.read(len(bom)) == bom else b""


def _temporary(folder: str) -> BinaryIO:
    """A new file in a folder; `tempfile` costs more to import than all the rest of a small run."""
    number = 0
    while True:
        try:
            return open(os.path.join(folder, f".btq-{os.getpid()}-{number}.tmp"), "xb")
        except FileExistsError:  # another thread's, or one that a killed process left
            number += 1


def _replace(new: str, path: str) -> None:
    """Rename a file; Windows refuses while another program reads the old one, such as one that looks for viruses."""
    for pause in _PAUSES:
        try:
            os.replace(new, path)
        except PermissionError:
            time.sleep(pause)
        else:
            return
    os.replace(new, path)


def _sync(folder: str) -> None:
    """Make a rename survive a power cut, if the system can synchronise a folder."""
    try:
        descriptor = os.open(folder, os.O_RDONLY)
    except OSError:  # Windows opens no folders
        return
    try:
        os.fsync(descriptor)
    except OSError:  # the file is in place all the same
        pass
    finally:
        os.close(descriptor)
