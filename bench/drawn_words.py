"""The words and habits that drawn missions are made of (drawn_missions.py): names, values, brackets and spacing.

One invariant: everything is drawn from one `Random`, so a seed is a file.  Habits, such as the width of an indentation,
are drawn once for a file; the exceptions to them at each place.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

T = TypeVar("T")

VERBS = ["Move", "Drive", "Pick", "Place", "Scan", "Open", "Close", "Wait", "Dock", "Charge", "Align", "Grasp", "Lift"]
VERBS += ["Release", "Inspect", "Measure", "Follow", "Clean", "Pour", "Weigh", "Localize", "Announce", "Plan", "Clear"]
THINGS = ["Base", "Arm", "Gripper", "Shelf", "Tray", "Door", "Tube", "Pallet", "Charger", "Camera", "Path", "Costmap"]
THINGS += ["Elevator", "Cup", "Box", "Valve", "Pump", "Field", "Row", "Person", "Goal", "Pose", "Recovery", "Map"]
STATES = ("Low", "Full", "Ready", "Reached", "Open", "Blocked", "Empty", "Visible", "Safe", "Updated", "Stuck", "Idle")
FOREIGN = ("Größe", "Prüfung", "Déplacer", "Łapa", "Ανοιξε", "移動", "Ход")
KEYS = ["goal", "pose", "path", "speed", "place", "station", "target", "source", "from", "to", "error", "error_code_id"]
KEYS += [
    "planner_id",
    "controller_id",
    "max_effort",
    "position",
    "frame",
    "timeout",
    "object",
    "result",
    "service_name",
]
KEYS += [
    "server_timeout",
    "topic_name",
    "offset",
    "backup_dist",
    "time_allowance",
    "is_recovery",
    "count",
    "on",
    "node",
]
CONDITIONS = ("_skipIf", "_successIf", "_failureIf", "_while")
AFTERWARDS = ("_onSuccess", "_onFailure", "_onHalted", "_post")
PROSE = [
    "Reach the shelf in time",
    "people are not startled",
    "keep enough for the way back",
    "see ticket 1042",
    "TODO",  # as people write in comments
]
PROSE += ["the camera needs a moment after a turn", "nothing is dropped", "measured on the old robot", "50 % of cases"]
PROSE += [
    "stop before the yellow line (ISO 3691-4)",
    "worst case: door closed, lift busy",
    "was 30 s; too short in winter",
]
TYPES = ["string", "double", "int", "bool", "uint16", "float", "geometry_msgs::msg::PoseStamped", "nav_msgs::msg::Path"]
TYPES += ["std::string", "std::vector::double", "BT::AnyTypeAllowed"]
SCRIPTS = ["@placed := 0.0", "tries += 1", "state := 'idle'; done := false", "(battery < 20.0) && (!charging)", "x > 3"]
SCRIPTS += ["mode == 'auto' || mode == 'teach'", "a := (b + 1.5) * 2; c := a; d := c", "path_ok ? 1 : 0", "!@stopped"]
UNITS = {
    "time": {"s": 12, "ms": 5, "min": 4, "h": 1},
    "length": {"m": 8, "cm": 4, "mm": 2},
    "speed": {"m/s": 8, "cm/s": 2},
    "share": {"%": 1},
    "energy": {"Wh": 3, "J": 1, "W*h": 1},
    "force": {"N": 1},
    "turn": {"deg/s": 2, "rad/s": 1},
    "data": {"kB": 2, "B": 1},
    "number": {"": 1},
}
# What a signal has behind its `:`, and what it measures.
MEASURED = {
    "battery": ("%", "share"),
    "distance": ("m", "length"),
    "speed": ("m/s", "speed"),
    "force": ("N", "force"),
    "energy_used": ("Wh", "energy"),
    "track_error": ("m", "length"),
    "turn_rate": ("deg/s", "turn"),
    "acceleration": ("m/s^2", "number"),
    "sent": ("kB", "data"),
    "retries": ("1", "number"),
    "rear_is_clear": ("bool", "truth"),
    "lamp_on": ("bool", "truth"),
    "zone": ("text", "text"),
    "elapsed": ("s", "time"),
}


@dataclass
class Line:
    """A line and the block below it; `BREAK` in the text ends a line inside brackets."""

    text: str
    block: list[Line] = field(default_factory=list)


BREAK = "\v"


class Hand:
    """One author: a source of chance, and the habits that a whole file shares.

    Attributes:
        classic: writes the form of the paper.
        names: what a file may refer to, by what it is: tree, model, condition, label, requirement, signal, …
    """

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)
        self.classic = self.maybe(0.2)
        self.unit = "\t" if self.classic else self.pick({"    ": 14, "  ": 5, "\t": 3, "   ": 1})
        self.quote = self.pick({'"': 9, "'": 1})
        self.equals = self.pick({" = ": 8, "=": 4})
        self.commas = self.pick({0.0: 6, 0.1: 1, 1.0: 3})
        self.comments = self.pick({0.0: 2, 0.05: 3, 0.15: 3, 0.4: 1})
        self.sign = self.pick({"# ": 12, "// ": 2, "#": 1})
        self.names: dict[str, list[str]] = {}

    def maybe(self, share: float) -> bool:
        return self.chance.random() < share

    def pick(self, choices: Mapping[T, float] | Sequence[T]) -> T:
        """One of them; a mapping says how likely each is."""
        if isinstance(choices, Mapping):
            return self.chance.choices(list(choices), list(choices.values()))[0]
        return self.chance.choice(choices)

    def some(self, most: int, share: float = 0.5) -> range:
        """As many rounds as a coin falls well, at most `most`."""
        count = 0
        while count < most and self.maybe(share):
            count += 1
        return range(count)

    def words(self, *words: str) -> str:
        """What is there of them, with a blank between; now and then more, or a comment."""
        text = ""
        for word in filter(None, words):
            gap = self.pick({" ": 97, "  ": 2, "\t": 0.5, " /* was longer */ ": 0.1})
            text += gap + word if text else word
        return text

    def listed(self, words: Iterable[str]) -> str:
        return self.pick({", ": 30, ",": 2, " , ": 0.3}).join(words)

    # ---- names ----

    def name(self, kind: str) -> str:
        """One of the known names of a kind, or one that nothing declares."""
        known = self.names.get(kind)
        return self.pick(known) if known and self.maybe(0.97) else self.pick(VERBS) + self.pick(THINGS)

    def new(self, kind: str) -> str:
        """A name that the file did not have before."""
        known = self.names.setdefault(kind, [])
        makers: dict[str, Callable[[], str]] = {
            "requirement": lambda: f"{self.pick(('rq', 'rq-', 'nfr_', 'limit'))}{len(known) + 1}",
            "hazard": lambda: f"{self.pick(('H', 'H-', 'hazard_'))}{len(known) + 1}",
            "tree": self._tree,
            "context": lambda: f"{self.pick(THINGS).lower()}_{self.pick(STATES).lower()}",
            "tag": lambda: self.pick(VERBS).lower() + "ing",
            "quality": lambda: f"{self.pick(THINGS).lower()}-{self.pick(('care', 'hygiene', 'autonomy'))}",
            "condition": lambda: self.pick(THINGS) + self.pick(STATES) + self.pick({"": 9, "?": 1}),
        }
        name = makers.get(kind, self._action)()
        while name in known:
            name = f'{name[:-1]}2"' if name[0] == '"' else f"{name.rstrip('?')}2"
        known.append(name)
        return name

    def _action(self) -> str:
        return self.pick(FOREIGN) if self.maybe(0.02) else self.pick(VERBS) + self.pick(("", *THINGS))

    def _tree(self) -> str:
        if self.maybe(0.16):
            return f'"{self.pick(("3 ", ""))}{self.pick(VERBS)} and {self.pick(VERBS)} {self.pick(THINGS)}"'
        return self._action() + self.pick({"": 5, "Tree": 2, "Subtree": 1})

    def path(self) -> str:
        """A node: its kind, label or tree, with ancestors in front."""
        steps = [self.name(self.pick(("label", "model", "tree"))) for _ in self.some(2, 0.3)]
        return self.pick({"/": 30, " / ": 1}).join([*steps, self.name(self.pick(("label", "model")))])

    # ---- values ----

    def number(self) -> str:
        chance = self.chance
        kind = self.pick({"whole": 6, "decimal": 3, "large": 1, "power": 0.2})
        if kind == "whole":
            return str(chance.randint(1, 120))
        if kind == "decimal":
            return f"{chance.uniform(0, 20):.{chance.randint(1, 2)}f}"
        if kind == "large":
            return f"{chance.randint(1, 90)}00"
        return f"{chance.randint(1, 9)}e{chance.randint(-3, 4)}"

    def quantity(self, measure: str) -> str:
        """A value of what is measured, with a unit unless it is a plain number."""
        unit = self.pick(UNITS[measure])
        return f"{self.number()}{self.pick({' ': 20, '': 3, '  ': 0.3}) if unit else ''}{unit}"

    def string(self, text: str) -> str:
        """Quoted; what would end it is escaped."""
        quote = self.quote if self.maybe(0.95) else self.pick("\"'")
        return quote + text.replace("\\", "\\\\").replace(quote, "\\" + quote) + quote

    def prose(self) -> str:
        text = "; ".join(self.pick(PROSE) for _ in range(self.pick({1: 8, 2: 2, 3: 1})))
        return self.string(text + self.pick({"": 30, ' ("soft")': 1, "\n        and so on": 1, "\\n": 1}))

    def entry(self) -> str:
        name = self.pick(KEYS) + self.pick({"": 3, "_2": 1})
        return self.pick({f"{{{name}}}": 12, f"{{@{name}}}": 3, "{=}": 2, f"{{ {name} }}": 0.3})

    def value(self) -> str:
        kind = self.pick({"entry": 9, "string": 6, "number": 4, "name": 2, "quantity": 1, "literal": 2})
        if kind == "entry":
            return self.entry()
        if kind == "number":
            return self.pick({"": 9, "-": 1}) + self.number()
        if kind == "name":
            return self.pick(("true", "false", "GridBased", "FollowPath", "warehouse_2"))
        if kind == "quantity":
            return self.quantity(self.pick(("time", "length", "speed")))
        if kind == "string":
            return self.string(self.pick(VERBS).lower() + self.pick({"": 3, " the tray": 1, "_route.yaml": 1}))
        return self.string(self.pick(("0.5;1.2;-3", "/odom", '{"x": 1}', "", "#ff0000", "a // b", "{goal} at {speed}")))

    # ---- brackets ----

    def pair(self, key: str, value: str) -> str:
        return f"{key}{self.equals if self.maybe(0.95) else self.pick((' = ', '=', '= '))}{value}"

    def pairs(self, most: int = 3) -> list[str]:
        """Pairs of different keys."""
        return [self.pair(key, self.value()) for key in self.chance.sample(KEYS, len(self.some(most, 0.6)))]

    def brackets(self, parts: Sequence[str]) -> str:
        """Attributes in brackets, on one line or, if there are many, on several."""
        comma = "," if self.maybe(self.commas) else ""
        broken = parts and self.maybe(0.5 if len(parts) > 3 or self.classic else 0.04)
        if not broken:
            return "(" + f"{comma} ".join(parts) + self.pick({")": 40, " )": 1, f"{comma if parts else ''})": 1})
        rows = [part + comma for part in parts]
        rows = [row + (f" {self.sign}{self.pick(PROSE)}" if self.maybe(self.comments / 4) else "") for row in rows]
        begins = BREAK if self.maybe(0.8) else ""
        ends = ")" if "#" not in rows[-1] and "//" not in rows[-1] and self.maybe(0.3) else BREAK + ")"
        return "(" + begins + BREAK.join(rows) + ends
