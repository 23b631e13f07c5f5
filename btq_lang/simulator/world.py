"""What nodes read beside entries and the time: where the robot is, how fast it is, and which services are called."""

from __future__ import annotations

from typing import Final


class World:
    """The world of a simulated program, which changes it.

    Attributes:
        position: of the robot, in metres; None: nothing says where it is.
        speed: of the robot, in metres per second.
        calls: the services that were called and have not been served, in order.
    """

    def __init__(self) -> None:
        self.position: tuple[float, float] | None = None
        self.speed = 0.0
        self.calls: Final[list[str]] = []

    def serve(self, service: str) -> bool:
        """Serve the first call of a service that waits; whether there was one."""
        if service not in self.calls:
            return False
        self.calls.remove(service)
        return True

    def memory(self) -> tuple[object, ...]:
        """All of it that changes, as a value."""
        return self.position, self.speed, tuple(self.calls)
