"""Reading and writing files, on a real disk."""

from __future__ import annotations

import errno
import os
import re
import stat
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.util.text import Position
from btq_lang.workspace import loader
from btq_lang.workspace.config import Project
from btq_lang.workspace.loader import LoadProblem, collect, find_project, load, read, shown, stamp, write_whole

WINDOWS = sys.platform == "win32"
NO_LINKS = pytest.mark.skipif(WINDOWS, reason="making links needs rights on Windows")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, which is the current one."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def make(folder: Path, *files: str) -> None:
    """Files, each `path` or `path: text`."""
    for file in files:
        path, _, text = file.partition(": ")
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(text.encode())


def includes_of(path: str, text: str) -> list[str]:
    return re.findall(r"include (\S+)", text)


def names(paths: tuple[str, ...]) -> list[str]:
    return [shown(path) for path in paths]


def refusing(function: Callable[..., Any], name: str) -> Callable[..., Any]:
    """The function as it behaves where the rights to one path are missing; root, who may run the tests, has all."""

    def refuse(path: str, *args: Any, **kwargs: Any) -> Any:
        if path.endswith(f"/{name}"):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), path)
        return function(path, *args, **kwargs)

    return refuse


# ---- the project file ----


def test_the_nearest_project_file_holds(folder: Path) -> None:
    make(folder, 'btq.toml: engine = "4.6"', "a/b/x.btq", 'a/pyproject.toml: [tool.btq]\nengine = "4.8"')
    for start in ("a/b/x.btq", "a/b", "a", "a/b/new.btq"):
        found = find_project(start)
        assert (found.project.engines, found.path, found.problems) == (("4.8",), f"{folder}/a/pyproject.toml", ())
        assert found.project.root == f"{folder}/a"
    assert find_project(".").path == f"{folder}/btq.toml"


def test_a_pyproject_without_btq_is_passed_by_and_btq_toml_wins(folder: Path) -> None:
    make(folder, "btq.toml: ", "a/pyproject.toml: [tool.ruff]", "b/pyproject.toml: [tool.btq]", "b/btq.toml: ")
    assert find_project("a").path == f"{folder}/btq.toml"
    assert find_project("b").path == f"{folder}/b/btq.toml"


def test_without_a_project_file_the_folder_is_the_root(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(folder, "a/x.btq")
    monkeypatch.setattr(os.path, "isfile", lambda path: str(path).endswith(".btq"))  # none above the test's folder
    found = find_project("a/x.btq")
    assert (found.project, found.path) == (Project(root=f"{folder}/a"), None)


def test_problems_of_the_project_file_say_where(folder: Path) -> None:
    make(folder, "btq.toml: \nengin = 1\n")
    assert list(map(str, find_project(".").problems)) == ["btq.toml:2:1: unknown key `engin`; did you mean `engine`?"]
    (folder / "btq.toml").write_bytes(b'exclude = ["\xff"]')
    assert list(map(str, find_project(".").problems)) == ["btq.toml:1:13: this is not UTF-8: byte 0xff"]
    assert find_project(".").project.exclude == ("\ufffd",)


# ---- collecting ----


def test_a_folder_stands_for_its_files_in_order(folder: Path) -> None:
    make(folder, "b.btq", "a/z.btq", "a/y.qualitybtcpp", "a.btq", "c.txt", "d.xml", "a-1.btq", "B.btq")
    files, problems = collect(["."], Project())
    assert names(files) == ["B.btq", "a-1.btq", "a.btq", "a/y.qualitybtcpp", "a/z.btq", "b.btq"]
    assert problems == ()


def test_what_is_left_out_below_a_folder(folder: Path) -> None:
    left_out = [
        ".venv/a.btq",
        ".git/a.btq",
        "build/a.btq",
        "x/build/a.btq",
        "node_modules/a.btq",
        ".a.btq",
        "gen/a.btq",
    ]
    make(folder, *left_out, "x/old/a.btq", "x/a.btq", "x/b.old.btq", "builder/a.btq")
    project = Project(root=str(folder), exclude=("gen/", "x/old", "*.old.btq"))
    assert names(collect(["."], project)[0]) == ["builder/a.btq", "x/a.btq"]
    assert names(collect(["x"], project)[0]) == ["x/a.btq"]


def test_the_excluder_knows_folders_of_a_path(folder: Path) -> None:
    excluded = loader.excluder(Project(root=str(folder), exclude=("gen/", "x/old")))
    paths = ["gen/a.btq", "x/gen/y/a.btq", "gen/", "x/old/a.btq", "x/old", "gen", "x/a.btq", "old/a.btq"]
    assert [path for path in paths if excluded(f"{folder}/{path}")] == paths[:5]
    assert not loader.excluder(Project())("gen/a.btq")


def test_what_is_named_is_taken(folder: Path) -> None:
    make(folder, "build/a.btq", "gen/x.xml", ".hidden/c.btq")
    project = Project(root=str(folder), exclude=("gen/",))
    assert names(collect(["gen/x.xml", "build", ".hidden", "build/a.btq", "lost.btq"], project)[0]) == [
        "gen/x.xml",
        "build/a.btq",
        ".hidden/c.btq",
        "lost.btq",
    ]


@NO_LINKS
def test_links_are_followed_and_loops_end(folder: Path) -> None:
    make(folder, "real/a.btq", "other/b.btq")
    (folder / "real/up").symlink_to(folder)
    (folder / "real/again").symlink_to(folder / "real")
    (folder / "real/self").symlink_to("self")
    (folder / "real/gone.btq").symlink_to("nowhere")
    (folder / "real/self.btq").symlink_to("self.btq")
    (folder / "a-link").symlink_to(folder / "other")
    files, problems = collect(["."], Project())
    assert names(files) == ["other/b.btq", "real/a.btq"]
    assert list(map(str, problems)) == [
        "real/gone.btq: cannot be read: the link has no target",
        "real/self.btq: cannot be read: the link has no target",
    ]
    (folder / "real/up").unlink()
    (folder / "real/linked").symlink_to(folder / "other")
    assert names(collect(["real"], Project())[0]) == ["real/a.btq", "real/linked/b.btq"]


def test_a_folder_that_cannot_be_read_is_a_problem(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(folder, "locked/a.btq", "b.btq")
    monkeypatch.setattr(os, "scandir", refusing(os.scandir, "locked"))
    files, problems = collect(["."], Project())
    assert names(files) == ["b.btq"]
    assert list(map(str, problems)) == ["locked: cannot be read: Permission denied"]


# ---- reading ----


@pytest.mark.parametrize(
    ("data", "text", "problem"),
    [
        (b"", "", None),
        (b"a\r\nb\rc\n", "a\r\nb\rc\n", None),
        (b"\xef\xbb\xbfab", "ab", None),
        ("日本\n".encode(), "日本\n", None),
        (b"ab\xff", "ab\ufffd", (0, 2, "this is not UTF-8: byte 0xff")),
        ("日\r\n本".encode() + b" \xe9t\xe9", "日\r\n本 \ufffdt\ufffd", (1, 2, "this is not UTF-8: byte 0xe9")),
        (b"\xef\xbb\xbfa\x80", "a\ufffd", (0, 1, "this is not UTF-8: byte 0x80")),
        (b"x\xe6\x97", "x\ufffd", (0, 1, "this is not UTF-8: byte 0xe6")),
        ("a".encode("utf-16"), "a", (0, 0, "this is UTF-16; save it as UTF-8")),
    ],
)
def test_reading_bytes(folder: Path, data: bytes, text: str, problem: tuple[int, int, str] | None) -> None:
    (folder / "a.btq").write_bytes(data)
    expected = problem and LoadProblem("a.btq", problem[2], Position(problem[0], problem[1]))
    assert read("a.btq") == (text, expected)


def test_what_cannot_be_read_is_a_problem(folder: Path) -> None:
    make(folder, "a/x")
    assert read("lost.btq") == (None, LoadProblem("lost.btq", "cannot be read: No such file or directory"))
    assert read("nul\0")[0] is None
    if not WINDOWS:
        assert str(read("a")[1]) == "a: cannot be read: Is a directory"


@given(st.binary(max_size=50))
def test_every_file_has_a_text_but_for_binary_ones(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "any.btq"
    path.write_bytes(data)
    text, problem = read(str(path))
    if text is None:
        assert problem == LoadProblem(str(path), "this is not a text file")
        assert b"\0" in data
    else:
        assert (problem is None) == (data in (text.encode(), b"\xef\xbb\xbf" + text.encode()))


# ---- loading with includes ----


def test_included_files_are_loaded_too(folder: Path) -> None:
    make(folder, "m/a.btq: include b.btq include ../c.btq", "m/b.btq: include common.btq", "c.btq: include m/a.btq")
    make(folder, "lib/common.btq: include common.btq", "lib/b.btq: not this one", "m/unused.btq")
    project = Project(root=str(folder), include_paths=(f"{folder}/lib",))
    loaded = load(["m/a.btq"], project, includes_of)
    assert names(tuple(loaded.texts)) == ["m/a.btq", "m/b.btq", "c.btq", "lib/common.btq"]
    assert names(loaded.given) == ["m/a.btq"]
    assert loaded.texts[f"{folder}/c.btq"] == "include m/a.btq"
    assert (loaded.damaged, loaded.absent, loaded.problems) == ((), (), ())


def test_files_that_are_missing(folder: Path) -> None:
    make(folder, "sub/x")
    known = {f"{folder}/a.btq": "include lost.btq include sub include nul\0"}
    loaded = load(["gone.btq"], Project(include_paths=(f"{folder}/lib",)), includes_of, known)
    assert names(loaded.given) == ["a.btq"]
    assert list(map(str, loaded.problems)) == ["gone.btq: cannot be read: No such file or directory"]
    assert names(loaded.absent) == ["lost.btq", "lib/lost.btq", "sub", "lib/sub", "nul\0", "lib/nul\0"]


def test_texts_from_elsewhere_are_not_read_from_the_disk(folder: Path) -> None:
    make(folder, "a.btq: include c.btq", "b.btq: include a.btq", "c.btq: c")
    loaded = load(["b.btq"], Project(), includes_of, {f"{folder}/a.btq": "nothing", f"{folder}/new.btq": "new"})
    assert names(loaded.given) == ["a.btq", "new.btq", "b.btq"]
    assert list(loaded.texts.values()) == ["nothing", "new", "include a.btq"]


def test_damaged_files_are_loaded_and_named(folder: Path) -> None:
    make(folder, "a.btq: include b.btq")
    (folder / "b.btq").write_bytes(b"\xff include c.btq")
    loaded = load(["."], Project(), includes_of)
    assert names(loaded.given) == ["a.btq", "b.btq"]
    assert names(loaded.damaged) == ["b.btq"]
    assert list(map(str, loaded.problems)) == ["b.btq:1:1: this is not UTF-8: byte 0xff"]


def test_an_included_file_that_cannot_be_read_is_a_problem(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(folder, "a.btq: include b.btq", "b.btq: x")
    monkeypatch.setattr("builtins.open", refusing(open, "b.btq"))
    loaded = load(["a.btq"], Project(), includes_of)
    assert names(tuple(loaded.texts)) == ["a.btq"]
    assert list(map(str, loaded.problems)) == ["b.btq: cannot be read: Permission denied"]


@pytest.mark.skipif(not os.path.isdir("/dev/fd"), reason="the system has no /dev/fd")
def test_a_pipe_that_the_shell_has_opened_is_read() -> None:
    begin, end = os.pipe()
    with os.fdopen(end, "w") as writer:
        writer.write("BehaviorTree A")
    assert read(f"/dev/fd/{begin}") == ("BehaviorTree A", None)
    os.close(begin)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
def test_an_included_pipe_is_not_waited_for(folder: Path) -> None:
    make(folder, "a.btq: include pipe.btq")
    os.mkfifo("pipe.btq")
    assert names(load(["."], Project(), includes_of).absent) == ["pipe.btq"]


# ---- writing ----


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
def test_a_pipe_is_not_waited_for(folder: Path) -> None:
    os.mkfifo("pipe.btq")
    why = "cannot be read: expected a regular file, found a pipe or a device"
    assert read("pipe.btq") == (None, LoadProblem("pipe.btq", why))
    assert [each.message for each in load(["pipe.btq"], Project(), includes_of).problems] == [why]


def test_writing_a_new_file_and_over_an_old_one(folder: Path) -> None:
    write_whole("a.btq", "日本\r\nx")
    assert (folder / "a.btq").read_bytes() == "日本\r\nx".encode()
    write_whole(str(folder / "a.btq"), "")
    assert (folder / "a.btq").read_bytes() == b""
    assert os.listdir() == ["a.btq"]


def test_the_byte_order_mark_stays(folder: Path) -> None:
    (folder / "a.btq").write_bytes(b"\xef\xbb\xbfold")
    write_whole("a.btq", "new")
    assert (folder / "a.btq").read_bytes() == b"\xef\xbb\xbfnew"
    write_whole("a.btq", "\ufeffnewer")
    assert (folder / "a.btq").read_bytes() == b"\xef\xbb\xbfnewer"


@pytest.mark.skipif(WINDOWS, reason="Windows has no such modes")
def test_the_mode_stays_and_a_new_file_has_the_usual_one(folder: Path) -> None:
    make(folder, "a.btq: old")
    (folder / "a.btq").chmod(0o751)
    write_whole("a.btq", "new")
    write_whole("b.btq", "new")
    (folder / "usual").touch()
    modes = [stat.S_IMODE(os.stat(name).st_mode) for name in ("a.btq", "b.btq", "usual")]
    assert modes == [0o751, modes[2], modes[2]]


@NO_LINKS
def test_a_link_stays_a_link(folder: Path) -> None:
    make(folder, "real/a.btq: old")
    (folder / "link.btq").symlink_to("real/a.btq")
    write_whole("link.btq", "new")
    assert os.readlink("link.btq") == "real/a.btq"
    assert (folder / "real/a.btq").read_text() == "new"
    assert sorted(os.listdir("real")) == ["a.btq"]


@pytest.mark.parametrize("step", ["fsync", "replace", "chmod"])
def test_a_failure_on_the_way_leaves_the_old_file_and_nothing_else(
    folder: Path, monkeypatch: pytest.MonkeyPatch, step: str
) -> None:
    make(folder, "a.btq: old")

    def fail(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, step, fail)
    with pytest.raises(OSError, match="No space left"):
        write_whole("a.btq", "new")
    assert (os.listdir(), (folder / "a.btq").read_text()) == (["a.btq"], "old")


def test_a_file_that_another_program_reads_is_replaced_a_little_later(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on Windows, where a file that is open cannot be replaced."""
    make(folder, "a.btq: old")
    refusals, replace = [PermissionError(), PermissionError()], os.replace

    def refuse(old: str, new: str) -> None:
        if refusals:
            raise refusals.pop()
        replace(old, new)

    monkeypatch.setattr(loader, "_PAUSES", (0, 0))
    monkeypatch.setattr(os, "replace", refuse)
    write_whole("a.btq", "new")
    assert (os.listdir(), (folder / "a.btq").read_text()) == (["a.btq"], "new")


def test_what_cannot_be_written_is_refused_before_anything_happens(folder: Path) -> None:
    make(folder, "a.btq: old", "sub/x")
    with pytest.raises(UnicodeEncodeError):
        write_whole("a.btq", "\ud800")
    with pytest.raises(FileNotFoundError):
        write_whole("lost/a.btq", "new")
    with pytest.raises(OSError, match="sub"):
        write_whole("sub", "new")
    assert (sorted(os.listdir()), (folder / "a.btq").read_text()) == (["a.btq", "sub"], "old")


def test_a_protected_file_is_not_replaced(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(folder, "a.btq: old")
    monkeypatch.setattr(os, "access", lambda path, mode: mode != os.W_OK)  # also where root runs the tests
    with pytest.raises(PermissionError, match=r"a\.btq"):
        write_whole("a.btq", "new")
    assert (os.listdir(), (folder / "a.btq").read_text()) == (["a.btq"], "old")


def test_a_temporary_file_that_was_left_behind_is_in_nobodys_way(folder: Path) -> None:
    make(folder, f".btq-{os.getpid()}-0.tmp: left", "a.btq: old")
    write_whole("a.btq", "new")
    assert (folder / "a.btq").read_text() == "new"
    assert sorted(os.listdir()) == [f".btq-{os.getpid()}-0.tmp", "a.btq"]


# ---- paths and stamps ----


def test_paths_are_shown_relative_where_they_are_inside(folder: Path) -> None:
    assert loader.absolute("a/../b//c.btq") == f"{folder}/b/c.btq"
    assert shown(f"{folder}/b/c.btq") == "b/c.btq"
    assert shown(f"{folder}2/c.btq") == f"{folder}2/c.btq"
    assert shown("/elsewhere/c.btq") == "/elsewhere/c.btq"


def test_a_stamp_changes_with_its_file(folder: Path) -> None:
    assert stamp("a.btq") is None
    make(folder, "a.btq: x")
    os.utime("a.btq", ns=(0, 5_000))
    assert stamp("a.btq") == (5_000, 1)
    os.utime("a.btq", ns=(0, 6_000))
    assert stamp("a.btq") == (6_000, 1)
    assert stamp("nul\0") is None
