"""docs/what-can-happen.md: its commands print what it shows, and its table has all answers."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.catalog.standard_answers import STANDARD_ANSWERS
from btq_lang.exploration import report

PAGE = Path(__file__).resolve().parents[2] / "docs" / "what-can-happen.md"
BLOCK = re.compile(r"^```(xml|btq|console)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def test_the_commands_print_what_the_page_shows(tmp_path: Path, update: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")

    def with_output(block: re.Match[str]) -> str:
        language, text = block.groups()
        if language != "console":
            (tmp_path / text.split()[1]).write_text(text, encoding="utf-8")
        else:
            command = text.splitlines()[0]
            _, out, err = run_btq(*shlex.split(command)[2:], cwd=tmp_path)
            text = f"{command}\n{out}{err}"
        return f"```{language}\n{text}```"

    page = PAGE.read_text(encoding="utf-8")
    after = BLOCK.sub(with_output, page)
    if update:
        PAGE.write_text(after, encoding="utf-8")
    assert after == (PAGE.read_text(encoding="utf-8") if update else page)


def test_the_page_explain_and_the_schema_have_the_same_answers(tmp_path: Path) -> None:
    rows = re.findall(r"^\| `([\w-]+)` \| ([^|]*) \| ([^|]*) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert rows == [(answer.name, answer.meaning, answer.then) for answer in STANDARD_ANSWERS.values()]
    schema = json.loads((Path(report.__file__).parent / "explore.schema.json").read_text(encoding="utf-8"))
    finding = schema["properties"]["missions"]["items"]["properties"]["survey"]["properties"]["findings"]["items"]
    assert sorted(finding["properties"]["kind"]["enum"]) == sorted(STANDARD_ANSWERS)
    for answer in STANDARD_ANSWERS.values():
        code, out, err = run_btq("explain", answer.name, cwd=tmp_path)
        plain = " ".join(out.split())
        assert (code, err) == (0, "")
        assert f"An answer of `btq explore`. {answer.meaning[0].upper()}{answer.meaning[1:]}. ## What to do" in plain
        assert plain.endswith(f"{answer.then[0].upper()}{answer.then[1:]}.")
