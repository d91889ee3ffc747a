"""The faults found, one line each, with a remedy to type."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """`wrong` is a sentence's worth; `remedy` what to type, and where it is not here, where."""

    wrong: str
    remedy: str

    def __str__(self) -> str:
        return f"WRONG  {self.wrong}. Type: {self.remedy}"


def is_loopback(address: str) -> bool:
    """Whether an IPv4 address leads every machine to itself."""
    return address.startswith("127.")
