"""The faults found, one line each, with a remedy to type."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """`wrong`: the error; `remedy`: what to type, and on which machine if not on this one."""

    wrong: str
    remedy: str

    def __str__(self) -> str:
        return f"WRONG  {self.wrong}. Type: {self.remedy}"


def is_loopback(address: str) -> bool:
    """Whether an IPv4 address leads every machine to itself."""
    return address.startswith("127.")
