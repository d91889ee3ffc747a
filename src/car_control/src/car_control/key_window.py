"""A window (Tk) that receives the driving keys."""

from __future__ import annotations

import ctypes
import ctypes.util
import time
import tkinter
from collections.abc import Callable

from car_control.keys import DRIVING_KEYS, QUIT_KEY, STOP_KEY, WindowKeys

TEXT = "Focus on this window and use the WASD keys to drive the car. Press Q to quit"
PERIOD_MS = 20
ARROWS = {"up": "w", "left": "a", "down": "s", "right": "d", "space": STOP_KEY}


@ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
def _ignored(_display: int, _event: int) -> int:
    """An Xlib error handler; Tk passes it the errors that it did not expect."""
    return 0


class NoScreen(Exception):
    """No window can be opened; the message says why."""


class KeyWindow:
    """Opens the window; raises NoScreen if that is impossible."""

    def __init__(self) -> None:
        _survive_x_errors()
        try:
            self.root = tkinter.Tk(className="key_control")
        except tkinter.TclError as error:
            raise NoScreen(str(error)) from error
        self.keys = WindowKeys()
        self.closed = False
        self.failure: BaseException | None = None
        self.root.title("key_control")
        # Bypass the input method: one for Chinese would keep W for itself.
        self.root.tk.call("tk", "useinputmethods", False)
        tkinter.Label(self.root, text=TEXT, padx=40, pady=30).pack()
        self.status = tkinter.Label(self.root, pady=10)
        self.status.pack()
        self.root.bind("<KeyPress>", self._press)
        self.root.bind("<KeyRelease>", self._release)
        self.root.bind("<FocusOut>", lambda _event: self._release_all())
        self.root.bind("<Destroy>", lambda _event: self._close())
        self.root.protocol("WM_DELETE_WINDOW", self._close)
        self.root.report_callback_exception = self._fail

    def run(self, turn: Callable[[frozenset[str]], str | None]) -> None:
        """Call `turn` repeatedly with the keys held, and show what it returns.

        Ends with Q, with the window, or when `turn` returns None.
        """
        self.turn = turn
        self.root.focus_force()
        self._again()
        self.root.mainloop()
        if self.failure is not None:
            raise self.failure

    def _close(self) -> None:
        self.closed = True
        self.root.quit()

    def _again(self) -> None:
        self._look()
        if not self.closed:
            self.root.after(PERIOD_MS, self._again)

    def _look(self) -> None:
        if self.closed:
            return  # the window is closing; its label may not exist any more
        shown = self.turn(self.keys.held(time.monotonic()))
        if shown is None:
            self._close()
        elif shown != self.status["text"]:
            self.status["text"] = shown

    def _press(self, event: tkinter.Event) -> None:
        key = _key(event)
        if key == QUIT_KEY:
            self._close()
        elif key == STOP_KEY:
            self._release_all()
        elif key in DRIVING_KEYS:
            self.keys.press(key)
            self._look()

    def _release(self, event: tkinter.Event) -> None:
        self.keys.release(_key(event), time.monotonic())

    def _release_all(self) -> None:
        self.keys.release_all()
        self._look()

    def _fail(self, _kind: type, error: BaseException, _trace: object) -> None:
        """By default Tk prints a callback's error and continues, with the car still moving."""
        self.failure = error
        self._close()


def _survive_x_errors() -> None:
    """If another program destroyed the window, Xlib would exit before the car is stopped."""
    library = ctypes.util.find_library("X11")
    if library:
        ctypes.CDLL(library).XSetErrorHandler(_ignored)


def _key(event: tkinter.Event) -> str:
    """The letter, whatever the state of Shift and Caps Lock."""
    name = event.keysym.lower()
    return ARROWS.get(name, name)
