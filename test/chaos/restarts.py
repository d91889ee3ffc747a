"""A round by hand: one part of a drive ends at a random moment and is restarted."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from random import Random

from checks import wrong_logs
from drive import STARTED
from members import wait_until
from rounds import END_LIMIT, GRACE, LONGEST_STOP, START_LIMIT, WATCH_LIMIT, WATCHED, Round
from states import driven, drives_on
from terminals import OWNERS, ROSCORE, WORLD, Terminals


class PlayByHand:
    """Plays a round in a folder."""

    def __init__(self, played: Round, folder: Path):
        self._round, self._folder = played, folder
        self._victim = played.fault.victim
        self._terminal = OWNERS.get(self._victim, self._victim)
        # Nodes left by a killed roslaunch have the names of those started next: rosmaster would
        # shut down the old one, and the new one when the old one next logs.
        self._leaves_nodes = self._victim == "roslaunch" and played.fault.roscore
        self._rng = Random(f"{played.course.name}/{played.seed}/act")

    @property
    def _without_master(self) -> bool:
        """Whether the remaining nodes are unknown to the new master: they do not register again
        by themselves, as no rospy node does."""
        return self._terminal == ROSCORE or (self._terminal == WORLD and not self._round.roscore)

    def faults(self) -> list[str]:
        """Play the round; returns the errors found, one line each."""
        self._folder.mkdir(parents=True)
        return list(dict.fromkeys(self._play()))

    def _play(self) -> Iterator[str]:
        hands = Terminals(self._round.course, self._folder, self._round.roscore)
        try:
            if not self._wait_for_moment(hands):
                yield "never came so far"
                return
            yield from self._restart(hands)
            for name in reversed(list(hands.open)):
                yield from _end(hands, name)
        finally:
            left = hands.close(GRACE)
        yield from (f"left behind: {line[:100]}" for line in left)
        yield from wrong_logs(self._folder / "log")

    def _wait_for_moment(self, hands: Terminals) -> bool:
        if self._round.starting:
            last = self._terminal if self._terminal in hands.usual[-1:] else WORLD
            there = (hands.start_usual(START_LIMIT, last)
                     and hands.wait_for(lambda: hands.pids(self._victim), START_LIMIT))
        else:
            there = hands.start_usual(START_LIMIT) and hands.wait_for(hands.moves, START_LIMIT)
        if there:
            time.sleep(self._round.delay)  # a random moment, not a wait
        return there

    def _restart(self, hands: Terminals) -> Iterator[str]:
        told = {name: len(hands.said(name)) for name in hands.open}
        self._round.fault.begin(hands, self._rng)
        if not wait_until(lambda: not hands.pids(self._victim), GRACE):
            yield f"{self._victim} has not ended"
            return
        yield from self._meanwhile(hands)
        if self._terminal in hands.open and not hands.ended(self._terminal, END_LIMIT):
            yield f"{self._terminal} has not ended"
            return
        time.sleep(self._rng.uniform(0.3, LONGEST_STOP))  # part of the test, not a wait
        since = hands.now() if self._victim in self._round.course.drivers else 0.0
        if self._leaves_nodes and not hands.kill_nodes(END_LIMIT):
            yield "nodes do not end by rosnode kill -a"
            return
        if self._terminal == ROSCORE and self._round.starting:  # roslaunch may start its own then
            yield from self._end_others(hands, told)
        hands.start(self._terminal)
        if self._leaves_nodes:
            for name in [name for name in hands.open if name not in (ROSCORE, WORLD)]:
                if not hands.ended(name, END_LIMIT):
                    yield f"{name} has not ended by rosnode kill -a"
        elif self._without_master:
            yield from self._start_others_again(hands, told)
        else:
            yield from ended_by_themselves(hands, told, but=self._terminal)
        if not hands.start_usual(START_LIMIT):
            yield "does not start again"
        elif not hands.wait_for(
                lambda: driven([at for at in hands.places() if at[0] >= since]) > STARTED,
                START_LIMIT):
            yield "does not drive again"
        yield from self._wrong_nodes(hands)

    def _meanwhile(self, hands: Terminals) -> Iterator[str]:
        """Without its driver the car must stop; without a master or roslaunch it must drive on."""
        since = hands.now()
        if self._round.starting:
            return
        if self._victim in self._round.course.drivers:
            wait_until(lambda: hands.now() > since + WATCHED, WATCH_LIMIT)
            if late := drives_on(hands.places(), since, hands.now()):
                yield late
        elif (self._terminal == ROSCORE or self._leaves_nodes) and not wait_until(
                lambda: driven([at for at in hands.places() if at[0] >= since]) > STARTED,
                WATCH_LIMIT):
            yield "does not drive on"

    def _start_others_again(self, hands: Terminals, told: dict[str, int]) -> Iterator[str]:
        """Restart all nodes that the new master does not know."""
        if not hands.start_usual(START_LIMIT, self._terminal):
            yield f"{self._terminal} does not start again"
            return
        time.sleep(self._rng.uniform(0.3, LONGEST_STOP))  # part of the test, not a wait
        yield from self._end_others(hands, told)

    def _end_others(self, hands: Terminals, told: dict[str, int]) -> Iterator[str]:
        yield from ended_by_themselves(hands, told, but=self._terminal)
        yield from self._wrong_nodes(hands)
        for name in reversed([name for name in hands.open if name != self._terminal]):
            yield from _end(hands, name)

    def _wrong_nodes(self, hands: Terminals) -> Iterator[str]:
        """Dead nodes of the world; not while it starts without a master."""
        if WORLD in hands.open and not (self._round.starting and self._without_master):
            for node in sorted(hands.dead_nodes() - {self._victim}):
                yield f"node {node} has died"


def ended_by_themselves(hands: Terminals, told: dict[str, int], but: str) -> Iterator[str]:
    """Close terminals whose command ended by itself, which must print one line (roslaunch: any)."""
    for name in [name for name in hands.open if name != but]:
        if hands.open[name].poll() is not None:
            hands.ended(name, 0.0)
            if name != WORLD and (lines := len(hands.said(name)) - told[name]) != 1:
                yield f"{name} ended by itself with {lines} lines"


def _end(hands: Terminals, name: str) -> Iterator[str]:
    hands.interrupt(name)
    if not hands.ended(name, END_LIMIT):
        yield f"{name} has not ended within {END_LIMIT:g} s of Ctrl-C"
