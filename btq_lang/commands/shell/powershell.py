"""Completion for PowerShell, 5.1 and later."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.commands.shell import Command, valued_options


def script(commands: tuple[Command, ...]) -> str:
    """The script, to be dot-sourced from the profile, or piped into `Out-String | Invoke-Expression`."""
    return _SCRIPT.format(
        program=commands[0].line,
        lines=_list(command.line for command in commands[1:]),
        values="\n".join(_values(commands)),
        options="\n".join(map(_options, commands)),
        words="\n".join(map(_words, commands)),
    )


def _values(commands: tuple[Command, ...]) -> Iterator[str]:
    for lines, choices in valued_options(commands):
        for line in lines:
            yield f"    $values[{_quoted(line)}] = @({_list(choices)})"


def _options(command: Command) -> str:
    names = (_described(name, option.help) for option in command.options for name in option.names)
    return f"        {_quoted(command.line)} = @({', '.join(names)})"


def _words(command: Command) -> str:
    names = [_described(name, help_) for name, help_ in command.commands]
    return f"        {_quoted(command.line)} = @({', '.join([*names, *map(_quoted, command.choices)])})"


def _described(name: str, help_: str) -> str:
    return _quoted(f"{name}\t{help_}" if help_ else name)


def _list(words: Iterable[str]) -> str:
    return ", ".join(map(_quoted, words))


def _quoted(text: str) -> str:
    return "'" + text.replace("'", "''") + "'"


# A word may be followed by a tab and its help.  `@{}` would treat -f and -F as one key.  Without other proposals,
# PowerShell itself offers files.
_SCRIPT = """\
# Completion of {program} for PowerShell.

Register-ArgumentCompleter -Native -CommandName '{program}' -ScriptBlock {{
    param($wordToComplete, $commandAst, $cursorPosition)
    $lines = @({lines})
    $values = [System.Collections.Hashtable]::new([System.StringComparer]::Ordinal)
{values}
    $options = @{{
{options}
    }}
    $words = @{{
{words}
    }}
    $line = '{program}'
    $last = ''
    foreach ($element in $commandAst.CommandElements | Select-Object -Skip 1) {{
        if ($element.Extent.EndOffset -ge $cursorPosition) {{ break }}
        $word = $element.Extent.Text
        if ($values.ContainsKey("$line $last")) {{ $last = ''; continue }}
        $last = $word
        if ($lines -ccontains "$line $word") {{ $line = "$line $word"; $last = '' }}
    }}
    $found = if ($values.ContainsKey("$line $last")) {{ $values["$line $last"] }}
    elseif ($wordToComplete -like '-*') {{ $options[$line] }}
    else {{ $words[$line] }}
    foreach ($entry in $found) {{
        $name, $help = $entry -split "`t", 2
        if ($name -like "$wordToComplete*") {{
            $tip = if ($help) {{ $help }} else {{ $name }}
            [System.Management.Automation.CompletionResult]::new($name, $name, 'ParameterValue', $tip)
        }}
    }}
}}
"""
