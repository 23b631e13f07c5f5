"""The cases: files, and what `btq` is asked about them.

A case is told by its group and its number alone.  What it consists of comes from the frozen commit, from `../shared`,
and from chance with the number as its seed.
"""

from __future__ import annotations

import base64
import re
import shlex
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import damaged
import drawn
import frozen

CHECKS = ("full", "concise", "json", "sarif", "github", "junit")
TRACES = ("table", "csv", "json", "markdown", "html")
GRAPHS = ("svg", "svg --qualities", "mermaid --qualities", "dot --qualities --direction right", "dot", "mermaid")
DIFFS = ("text", "markdown", "json")
VERDICTS = ("table --verbose", "json", "csv", "junit", "markdown", "html")
TARGETS = ("4.6", "4.7", "4.8", "4.9", "4.10")
BUILDS = ("", "--bundle", "--no-enforce", "--verbatim", *(f"--target {target}" for target in TARGETS))
FILE = re.compile(r"^//- (.*)\n", re.MULTILINE)
WORD = re.compile(r"[^\W\d][\w-]*")

Case = dict[str, Any]  # as JSON: files by name, and steps


class Group(NamedTuple):
    """Cases of one sort.

    Attributes:
        make: the case of a number.
        count: how many there are.
    """

    make: Callable[[int], Case]
    count: Callable[[], int]
    needs_shared: bool = False


def of(files: Mapping[str, str | bytes], *lines: str | Mapping[str, str]) -> Case:
    """A case.

    Args:
        lines: arguments of `btq`; with `stdin`, or where they have a sense only if a file is there, as a mapping.
    """
    steps = [line if isinstance(line, Mapping) else {"line": line} for line in lines]
    contents = {
        name: content if isinstance(content, str) else f"\0{base64.b64encode(content).decode()}"
        for name, content in files.items()
    }
    return {
        "files": contents,
        "steps": [
            {"words": shlex.split(step["line"]), **{name: step[name] for name in ("stdin", "needs") if name in step}}
            for step in steps
        ],
    }


def on_file(line: str, needs: str = "main.xml") -> Mapping[str, str]:
    """What is asked only where a file is there."""
    return {"line": line, "needs": needs}


def turn(choices: Sequence[str], number: int) -> str:
    """Each choice in its turn."""
    return choices[number % len(choices)]


# ---- missions ----


def everything(files: Mapping[str, str | bytes], path: str = "main.btq") -> Case:
    """All commands in all their formats; `path`: the mission, or a folder."""
    xml = path.rpartition(".")[0] + ".xml" if "." in path[1:] else ""
    lines: list[str | Mapping[str, str]] = [
        *(f"check --output-format {form} {path}" for form in CHECKS),
        *(f"format --diff {path}", f"format --check {path}"),
        *(f"trace --format {form} {path}" for form in TRACES),
        *(f"trace --bundle {path}", f"build --check {path}"),
        *(f"build --verbose --force -o built{number} {option} {path}" for number, option in enumerate(BUILDS)),
    ]
    lines += [f"graph --format {form} {path}" for form in GRAPHS] if xml else []
    lines += [f"build {path}", f"build --check {path}"]
    if xml:
        lines += [on_file(line, xml) for line in (f"import {xml} -o back", f"check {xml}", f"import {xml} -o back")]
        lines += [on_file(f"diff --format {form} {path} built{at}/{xml}", xml) for at, form in enumerate(DIFFS)]
        lines += [f"diff {path} back/{path}"]
    lines += [f"check --fix {path}", f"check {path}", f"format {path}", f"build --bundle --force {path}"]
    return of(files, *lines)


@cache
def _pages() -> tuple[str, ...]:
    """The missions of pages, in one text each."""
    return tuple(text for _, text in frozen.missions())


def page(number: int) -> Case:
    """A mission that a page shows, or a golden one."""
    _, *parts = FILE.split(f"//- main.btq\n{_pages()[number]}")
    files = {name.strip(): text for name, text in zip(parts[::2], parts[1::2], strict=True) if text or len(parts) == 2}
    return everything(files, next(iter(files)) if len(files) == 1 else ".")


@cache
def _examples() -> tuple[str, ...]:
    return tuple(dict.fromkeys("/".join(path.split("/")[:2]) for path in frozen.paths("examples") if "/" in path[9:]))


def example(number: int) -> Case:
    """A folder of the examples, as a whole and mission by mission."""
    folders = _examples()
    folder = folders[number % len(folders)]
    files = {path[len(folder) + 1 :]: frozen.text(path) for path in frozen.paths(folder)}
    if number < len(folders):
        return everything(files, ".")
    missions = [path for path in files if path.endswith((".btq", ".qualitybtcpp"))]
    return of(
        files,
        *(f"graph --format {form} {path}" for form in GRAPHS for path in missions),
        *(f"build --verbose -o one {path}" for path in missions),
        *(f"trace --format {form} {path}" for form in TRACES for path in missions),
        *(f"diff {one} {other}" for one in missions for other in missions),
    )


def damaged_mission(number: int) -> Case:
    """A mission damaged by chance."""
    whole, text = damaged.damaged_mission(number)
    others = (f"trace --format {turn(TRACES, number)} main.btq", f"graph --format {turn(GRAPHS, number)} main.btq")
    return of(
        {"whole.btq": whole, "main.btq": text},
        "check main.btq",
        f"check --output-format {turn(CHECKS[1:], number)} main.btq",
        f"build --verbose {turn(BUILDS, number)} main.btq",
        turn((*others, f"diff --format {turn(DIFFS, number // 3)} whole.btq main.btq"), number),
        on_file("import main.xml -o back"),
        turn(("check --fix main.btq", "format main.btq"), number // 3),
    )


def sound_mission(text: str, number: int) -> Case:
    """A mission that chance has made, with clauses."""
    others = (
        f"trace --format {turn(TRACES, number // 5)} main.btq",
        f"graph --format {turn(GRAPHS, number // 5)} main.btq",
        "format --diff main.btq",
        "check --fix main.btq",
        f"diff --format {turn(DIFFS, number // 5)} main.btq main.xml",
    )
    return of(
        {"main.btq": text},
        f"check --output-format {turn(CHECKS, number)} main.btq",
        f"build --verbose {turn(BUILDS, number)} main.btq",
        on_file("import main.xml -o back"),
        turn(others, number),
    )


def judged_mission(number: int) -> Case:
    """A mission with requirements of every verb, and two logs of it."""
    return of(
        {"main.btq": drawn.judged_mission(number)},
        f"check --output-format {turn(CHECKS, number)} main.btq",
        f"build --verbose {turn(BUILDS, number)} main.btq",
        on_file(f"log {number}"),
        on_file(f"verify run.btlog --mission main.btq --format {turn(VERDICTS, number)}", "run.btlog"),
        on_file(f"verify run.db3 --signals signals.csv --format {turn(VERDICTS, number + 1)}", "run.btlog"),
        on_file(
            f"verify run.btlog --mission main.btq --signals signals.csv --format {turn(VERDICTS, number + 2)}",
            "run.btlog",
        ),
    )


# ---- inputs of others ----


def shared() -> Path:
    """The folder of inputs made by other people, as the fixture of the tests finds it."""
    return _shared


_shared = Path()


def set_shared(folder: Path) -> None:
    """Take the inputs of others from a folder."""
    global _shared
    _shared = folder


@cache
def _corpus() -> tuple[Path, ...]:
    names = ("corpus", "original")
    found = (path for name in names for path in (shared() / name).rglob("*") if path.suffix not in (".md", ".tsv"))
    return tuple(sorted(path for path in found if path.is_file()))


def corpus_file(number: int) -> Case:
    """A file of the corpus."""
    path = _corpus()[number]
    if path.suffix != ".xml":
        return everything({f"main{path.suffix}": path.read_bytes()}, f"main{path.suffix}")
    return of(
        {"a.xml": path.read_bytes()},
        f"check --output-format {turn(CHECKS, number)} a.xml",
        f"import {'--keep-v3 ' if number % 5 == 4 else ''}a.xml -o b",
        *(
            on_file(line, "b/a.btq")
            for line in (
                f"check --output-format {turn(CHECKS[1:], number)} b/a.btq",
                "format --diff b/a.btq",
                f"build --verbose {turn(BUILDS, number)} -o c b/a.btq",
                f"trace --format {turn(TRACES, number)} b/a.btq",
                f"graph --format {turn(GRAPHS, number)} b/a.btq",
                f"diff --format {turn(DIFFS, number)} a.xml b/a.btq",
                "check --fix b/a.btq",
            )
        ),
        on_file("diff a.xml c/a.xml", "c/a.xml"),
    )


@cache
def _repositories() -> tuple[str, ...]:
    return tuple(sorted({"__".join(path.name.split("__")[:1]) for path in _corpus() if "__" in path.name}))


def repository(number: int) -> Case:
    """All files of a repository, in one folder."""
    name = _repositories()[number]
    files = {path.name: path.read_bytes() for path in _corpus() if path.name.startswith(f"{name}__")}
    named = shlex.join(files)
    return of(
        files,
        f"check --output-format concise {named}",
        f"import -o btq {named}",
        "check --output-format concise btq",
        "build btq -o xml",
        "trace --format csv btq",
        on_file("diff --format text btq xml", "xml"),
    )


def logged(number: int) -> Case:
    """Logs that the engine has written."""
    logs = [path for path in sorted((shared() / "logs").iterdir()) if path.suffix in (".btlog", ".db3")]
    log, form = logs[number % len(logs)], turn(VERDICTS, number // len(logs))
    files: dict[str, str | bytes] = {log.name: log.read_bytes()}
    if log.name.startswith("lab"):
        files |= {"lab.btq": frozen.text(frozen.named("lab.btq"))}
        files |= {"battery.csv": (shared() / "logs" / "lab.battery.csv").read_bytes()}
        return of(
            files,
            f"verify {log.name} --format {form}",
            f"verify {log.name} --mission lab.btq --signals battery.csv --strict --format {form}",
            f"verify . --mission lab.btq -o out.{'json' if number % 2 else 'md'}",
        )
    (page,) = (text for text in frozen.blocks("docs/nav2.md") if text.startswith("include"))
    files |= {"navigate.xml": (shared() / "logs" / "nav.xml").read_bytes(), "nav.btq": page}
    return of(files, "import navigate.xml", "check nav.btq", f"verify {log.name} --mission nav.btq --format {form}")


# ---- commands ----


@cache
def _explained() -> tuple[str, ...]:
    """Words that `btq explain` may know: those of the documentation, and the names of rules."""
    words = {word for path in frozen.pages() for word in WORD.findall(frozen.text(path))}
    rules = {Path(path).stem for path in frozen.paths("rules")}
    signs = {"->", "?", "||", "R->", "R?", "M->", "A->", "A?", "All||", "{", "{=}", "#", "0.5 h", "3 %", "on violation"}
    return tuple(sorted(words | rules | signs))


PER_CASE = 40


def explained(number: int) -> Case:
    """What `btq explain` says of some words."""
    words = _explained()[number * PER_CASE : (number + 1) * PER_CASE]
    return of({}, *(f"explain {shlex.quote(word)}" for word in words))


MISSION = """include "skills.btq"
signal battery : % from {battery} initially 80 %
QualityReq rq1 : performance-efficiency.time-behaviour "In time"
    takes at most 30 sek
    on violation fail
QualityReq rq2 : performance
    keeps battery > 2
Root Main
BehaviorTree Main
    -> Work
        Moev (to = {x}, speed = fast) satisfies rq1
        Retry (num_attempts = a)
            Move satisfies rq2  # btq: ignore
        SubTree Prat
"""
SKILLS = """Action Move "drives"
    input to : string
BehaviorTree Part
    Move (to = "a")
"""
FILES = {"main.btq": MISSION, "skills.btq": SKILLS, "clean.btq": "Action A\nRoot M\nBehaviorTree M\n    A\n"}
PROJECTS = (
    'engine = ["4.6"]\n[rules]\nunknown-node = "off"\nmissing-port = "error"\n',
    'engine = ["4.6", "4.10"]\nqualities = "iso25010-2011"\nignore = ["unknown-unit"]\n',
    'select = ["unknown-node", "unknown-tree"]\n[rules]\nunknown-node = "hint"\n',
    'exclude = ["skills.btq"]\ninclude-paths = ["lib"]\n',
    'engine = "4.6"\nunknown = 3\n[rules]\nno-such-rule = "error"\nunknown-node = "loud"\n',
    'engine = ["3.8", "5"]\nqualities = "iso9126"\nselect = "x"\n',
    "engine = [\n",
    "[evidence]\nlogs = 3\n[evidence.signals]\nbattery = {}\n",
    '[evidence]\nlogs = ["*.btlog"]\n[evidence.signals]\nbattery = { topic = "/b", field = "p", unit = "%" }\n',
    '[[factory]]\nname = "a"\nload = ["*.btq"]\nmain = "Main"\n',
)
USAGE = (
    *("", "--help", "--version", "-V", "chekc", "check --frmat x", "check --output-format xml", "check nowhere.btq"),
    *("check ''", "check --severity warning", "check --severity error main.btq", "check --select unknown-node ."),
    *(
        "check --ignore unknown-node,missing-port .",
        "check --select no-such-rule",
        "check --jobs 2 .",
        "check --jobs x",
    ),
    *("build --target 5", "build -o x.xml", "build -o - main.btq", "build nowhere", "build clean.btq", "build --check"),
    *("build clean.btq --bundle -o out", "build --check -o out clean.btq", "build --verbatim main.btq -o out"),
    *("import nowhere.xml", "import clean.xml", "import --force clean.xml", "import main.btq", "import clean.xml -o d"),
    *("trace --format xml", "trace -o a.html .", "trace -o a.pdf .", "trace -o main.btq .", "trace nowhere"),
    *("graph main.btq -o a.svg", "graph main.btq -o a.dot", "graph main.btq -o a.png", "graph", "graph . main.btq"),
    *("diff main.btq", "diff main.btq clean.btq", "diff main.btq nowhere.btq", "diff a b c", "diff . ."),
    *("explain", "explain no-such-word", "explain unknown-node Retry safety takes", "explain ''"),
    *("format --check .", "format main.btq", "format --diff clean.btq", "format nowhere", "init .", "init robot"),
    *(
        "check robot",
        "build robot",
        "init robot",
        "lsp --help",
        "lsp --tcp x",
        "preview",
        "preview nowhere.btq --port x",
    ),
    *("completion bash", "completion zsh", "completion fish", "completion powershell", "completion x", "completion"),
    *(
        "verify",
        "verify nowhere.btlog",
        "verify clean.btq",
        "verify --mission main.btq",
        "verify --signals x .",
        "lsp -x",
    ),
    *(f"{command} --help" for command in ("check", "format", "build", "import", "trace", "verify", "graph", "preview")),
    *("diff --help", "explain --help"),
    *("init --help", "completion --help", "check --color always main.btq", "explain --color always unknown-node"),
    *("trace --color always main.btq", "format --diff --color always main.btq", "check clean.btq", "check --fix ."),
)
STDIN = (
    *("check -", "check - --stdin-filename lib/x.btq", "format -", "format --check -", "format --diff -", "build -"),
    *("build - --bundle --stdin-filename x.btq", "import -", "trace -", "graph -", "graph - --format dot"),
    *("diff - main.btq", "diff - clean.btq --stdin-filename y.btq", "check - main.btq", "check --fix -", "check - -"),
)
TEXTS = (MISSION, FILES["clean.btq"], "", "\ufeffRoot A\r\nBehaviorTree A\r\n\tB\r\n", "<root/>", "a\udc80b")


def used(number: int) -> Case:
    """Commands right and wrong; what they leave is there for the next ones."""
    return of(FILES, *USAGE)


def projects(number: int) -> Case:
    """A project file."""
    lines = (
        "check .",
        "check --output-format json .",
        "build --verbose .",
        "trace --format json .",
        "verify",
        "format .",
    )
    return of({**FILES, "btq.toml": PROJECTS[number]}, *lines)


def from_stdin(number: int) -> Case:
    """A text on standard input."""
    return of(FILES, *({"line": line, "stdin": TEXTS[number]} for line in STDIN))


def revisions(number: int) -> Case:
    """Revisions of a damaged mission in a repository."""
    whole, text = damaged.damaged_mission(number)
    form = turn(DIFFS, number)
    return of(
        {"main.btq": whole, "skills.btq": text},
        *("git init -q -b main", "git add main.btq", "git commit -q -m a", "git checkout -q -b work"),
        *("git add .", "git mv -f skills.btq main.btq", "git commit -q -m b"),
        *(f"diff --git main --format {form}", f"diff --git main..HEAD --format {form} main.btq"),
        *(f"diff --git main...HEAD --format {form} .", "diff --git HEAD", "diff --git nowhere"),
    )


GROUPS: Mapping[str, Group] = {
    "commands": Group(used, lambda: 1),
    "projects": Group(projects, lambda: len(PROJECTS)),
    "stdin": Group(from_stdin, lambda: len(TEXTS)),
    "explain": Group(explained, lambda: -(-len(_explained()) // PER_CASE)),
    "examples": Group(example, lambda: 2 * len(_examples())),
    "pages": Group(page, lambda: len(_pages())),
    "revisions": Group(revisions, lambda: 30),
    "damaged": Group(damaged_mission, lambda: 5_000),
    "missions": Group(lambda number: sound_mission(drawn.mission(number), number), lambda: 4_000),
    "odd": Group(lambda number: sound_mission(drawn.odd_mission(number), number), lambda: 1_000),
    "judged": Group(judged_mission, lambda: 1_000),
    "corpus": Group(corpus_file, lambda: len(_corpus()), needs_shared=True),
    "repositories": Group(repository, lambda: len(_repositories()), needs_shared=True),
    "logs": Group(logged, lambda: 5 * len(VERDICTS), needs_shared=True),
}
