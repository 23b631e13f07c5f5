"""The pages of the documentation site that follow from the tables of btq_lang and from the examples; MkDocs' hook.

One invariant: nothing is said here that a table, a rule's page or an example does not say.  `pages()` makes the texts;
the functions below it hand them to MkDocs (https://www.mkdocs.org/user-guide/configuration/#hooks).
"""

from __future__ import annotations

import posixpath
import re
import sys
from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tools")]  # MkDocs loads this file as a module without a folder

from moving_pages import moving_pages  # noqa: E402  # after the path it is found on
from site_colours import register  # noqa: E402  # as above

from btq_lang.catalog.kinds import NodeKind, PortKind  # noqa: E402
from btq_lang.catalog.language import PHRASES, Phrase  # noqa: E402
from btq_lang.catalog.nodes import BUILTINS, spellings  # noqa: E402
from btq_lang.catalog.qualities import EDITIONS, Quality, get, parts, qualities  # noqa: E402
from btq_lang.diagnostics.rules import RULES, Rule, page  # noqa: E402

if TYPE_CHECKING:
    from mkdocs.structure.files import Files

# Files that are shown as they are.
ASSETS = {"qreq.schema.json": ROOT / "btq_lang" / "btcpp" / "qreq.schema.json"}
# Where a link out of docs/ leads on the site; every other one becomes plain text.
_ELSEWHERE = {
    "../examples": "examples/index.md",
    "../examples/classic/inspector.qualitybtcpp": "examples/classic.md",
    "../btq_lang/btcpp/qreq.schema.json": "qreq.schema.json",
}
_KINDS = {
    "product": "Qualities of a product, ISO/IEC 25010:2023",
    "in-use": "Qualities in use, ISO/IEC 25019:2023",
    "robotics": "Qualities of robots, not in the standard",
    "ai": "Qualities of systems with artificial intelligence, ISO/IEC 25059",
}


def pages() -> dict[str, str]:
    """Every generated page by its path below the site's root, in Markdown."""
    found = {"rules/index.md": _rules(), "nodes/index.md": _nodes(), "qualities.md": _qualities(), "words.md": _words()}
    found |= moving_pages()
    found |= {f"rules/{rule.name}.md": _rule(rule) for rule in RULES.values()}
    found |= {f"nodes/{kind.tag}.md": _node(kind) for kind in BUILTINS.values()}
    folders = sorted(folder for folder in (ROOT / "examples").iterdir() if folder.is_dir())
    found["examples/index.md"] = _lines("# Examples", "", *(f"* [{each.name}]({each.name}.md)" for each in folders))
    found |= {f"examples/{folder.name}.md": _example(folder) for folder in folders}
    return found


# ---- what MkDocs calls ----


def on_config(config: Any) -> Any:
    register()
    return config


def on_files(files: Files, config: Any) -> Files:
    from mkdocs.structure.files import File

    for path, text in pages().items():
        files.append(File.generated(config, path, content=text))
    for path, source in ASSETS.items():
        files.append(File.generated(config, path, abs_src_path=str(source)))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Files) -> str:
    """Links that lead out of docs/ lead to the page that was made of what stands there, if one was."""

    def led(match: re.Match[str]) -> str:
        target = match[2].rstrip("/")
        inside = _ELSEWHERE.get(target)
        if inside is None and target.startswith("../examples/"):
            inside = f"{target.removeprefix('../').removesuffix('/README.md')}.md"
        if inside is not None:
            return f"[{match[1]}]({inside})"
        return match[1] if target.startswith("../") and "/" not in page.file.src_uri else match[0]

    markdown = re.sub(r"(?m)^```btq (?:classic|scenario)$", "```btq", markdown)
    markdown = re.sub(r"\[([^\]]*)\]\(([^)#\s]+)\)", led, markdown)
    return re.sub(r"(?m)^\|.*", lambda row: re.sub(r"`[^`]+`", _plain_pipes, row[0]), markdown)


def _plain_pipes(code: re.Match[str]) -> str:
    """Code hosts want a `|` in a cell's code escaped, and show it plain; MkDocs shows the escape."""
    return code[0].replace("\\|", "|")


# ---- rules ----


def _rules() -> str:
    rows = (
        f"| [{each.name}]({each.name}.md) | {each.severity.value} | {_cell(each.summary)} |" for each in RULES.values()
    )
    told = "What `btq check` finds; how a rule is silenced or made worse: [commands](../commands.md#silencing-a-rule)."
    return _lines("# Rules", "", told, "", "| rule | severity | finds |", "|---|---|---|", *rows)


def _rule(rule: Rule) -> str:
    """Its page, with the severity below the heading."""
    heading, _, rest = page(rule.name).partition("\n")
    return f"{heading}\n\n*{rule.severity.value}*\n{rest}"


# ---- nodes ----


def _nodes() -> str:
    lines = ["# Nodes", "", "The built-in nodes of BehaviorTree.CPP 4.6 to 4.10."]
    by_category = sorted(BUILTINS.values(), key=lambda kind: kind.category)
    for category, kinds in groupby(by_category, key=lambda kind: kind.category):
        lines += ["", f"## {category}", "", "| node | also written | |", "|---|---|---|"]
        for kind in kinds:
            lines.append(f"| [{kind.tag}]({kind.tag}.md) | {_codes(spellings(kind)[1:])} | {_cell(kind.doc)} |")
    return _lines(*lines)


def _node(kind: NodeKind) -> str:
    least, most = kind.children
    children = f"{least} or more" if most is None else str(least) if least == most else f"{least} to {most}"
    lines = [f"# {kind.tag}", "", _sentence(kind.doc), "", kind.semantics, "", "| | |", "|---|---|"]
    lines += [f"| category | {kind.category} |", f"| written | {_codes(spellings(kind))} |"]
    lines += [f"| children | {children} |", f"| BehaviorTree.CPP | {kind.since} and newer |"]
    if kind.ports:
        lines += ["", "## Ports", "", "| port | direction | type | without it | |", "|---|---|---|---|---|"]
        lines += map(_port, kind.ports)
    return _lines(*lines)


def _port(port: PortKind) -> str:
    without = "an error" if port.required else f"`{port.default}`" if port.default else "nothing"
    unit = f", in {port.unit}" if port.unit else ""
    return f"| `{port.name}` | {port.direction} | `{_cell(port.type)}`{unit} | {_cell(without)} | {_cell(port.doc)} |"


# ---- qualities and words ----


def _qualities() -> str:
    known = qualities()
    lines = ["# Qualities", ""]
    lines += [f"What can stand behind `satisfices` and as a requirement's quality. Editions: {_codes(EDITIONS)}."]
    for kind, title in _KINDS.items():
        # Some are part of a characteristic that this edition does not have: they stand alone.
        tops = [each for each in known if each.kind == kind and (not each.parent or get(each.parent) is None)]
        if tops:
            lines += ["", f"## {title}"]
        for top in tops:
            lines += ["", f"### {top.id}", "", _quality(top)]
            lines += [line for part in parts(top.id) for line in ("", f"**`{part.id}`**: {_quality(part)}")]
    return _lines(*lines)


def _quality(quality: Quality) -> str:
    said = [_sentence(quality.definition)]
    if quality.measures:
        said.append(f"To measure: {_sentence(quality.measures)}")
    if quality.nearest:
        said.append(f"Nearest in ISO/IEC 25010: `{quality.nearest}`.")
    return " ".join((*said, f"({quality.source})"))


def _words() -> str:
    lines = ["# Words of the language"]
    for part, phrases in _by_part(PHRASES):
        lines += ["", f"## {part[0].upper()}{part[1:]}", "", "| | written | |", "|---|---|---|"]
        lines += [f"| **{each.words}** | `{_cell(each.form)}` | {_cell(each.sentence)} |" for each in phrases]
    return _lines(*lines)


def _by_part(phrases: Iterable[Phrase]) -> Iterator[tuple[str, list[Phrase]]]:
    found: dict[str, list[Phrase]] = {}
    for phrase in phrases:
        found.setdefault(phrase.part, []).append(phrase)
    yield from found.items()


# ---- examples ----


def _example(folder: Path) -> str:
    """Its page, and its missions in full."""
    lines = [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", (folder / "README.md").read_text(encoding="utf-8")).rstrip()]
    for file in sorted(path for path in folder.rglob("*") if path.suffix in (".btq", ".qualitybtcpp", ".toml")):
        language = "toml" if file.suffix == ".toml" else "btq"
        text = file.read_text(encoding="utf-8").rstrip()
        lines += ["", f"## {posixpath.join(*file.relative_to(folder).parts)}", "", f"```{language}", text, "```"]
    return _lines(*lines)


# ---- Markdown ----


def _lines(*lines: str) -> str:
    return "\n".join(lines) + "\n"


def _sentence(text: str) -> str:
    return text if text.endswith(".") else f"{text}."


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _codes(words: Iterable[str]) -> str:
    return " ".join(f"`{_cell(word)}`" for word in words)
