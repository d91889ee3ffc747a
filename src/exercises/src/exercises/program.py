"""Loads a learner's Python file as a module, and reports its errors as one line each."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Iterable
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

import numpy as np

from exercises.finding import CannotCheck, Mistake


def compiled(file: Path) -> CodeType:
    """The file's compiled code; CannotCheck reports a syntax error in one line."""
    try:
        return compile(file.read_bytes(), str(file), "exec")
    except OSError as error:
        raise CannotCheck(f"{file}: {error.strerror}: make it readable") from error
    except (SyntaxError, ValueError) as error:
        line = (getattr(error, "text", None) or "").strip()
        raise CannotCheck(f"{file}:{getattr(error, 'lineno', None) or 1}: {error.args[0]}"
                          + f": {line}" * bool(line)) from error


def load(file: Path) -> ModuleType:
    """Import the file afresh; CannotCheck reports an error in one line."""
    code = compiled(file)
    module = ModuleType(f"exercise_{file.stem}", None)
    module.__file__ = str(file)
    sys.modules[module.__name__] = module  # needed by dataclasses
    sys.path.insert(0, str(file.parent))
    try:
        exec(code, module.__dict__)
    except (Exception, SystemExit) as error:
        raise CannotCheck(f"{said(error, file)}; mend it, then check again") from error
    finally:
        sys.path.remove(str(file.parent))
    return module


def part(module: ModuleType, call: str) -> Any:
    """The module's function or class named in `call`, "steer(offset_px)"; CannotCheck if none."""
    found = getattr(module, call.partition("(")[0], None)
    if not callable(found):
        raise CannotCheck(f"{module.__file__}: has no `{call}`, which the check calls: keep it")
    return found


def line_in(error: BaseException, file: Path) -> int | None:
    """Number of the file's last line in an exception's traceback; None if there is none."""
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__)
             if frame.filename == str(file)]
    return lines[-1] if lines else None


def said(error: BaseException, file: Path) -> str:
    """The exception, and the file's line that it came from, in one line."""
    return f"{file}:{line_in(error, file) or 1}: {type(error).__name__}:" \
           f" {' '.join(str(error).split())}"


def numbers(value: Any, count: int, call: str) -> tuple[float, ...]:
    """Check that a call returned `count` finite numbers; Mistake for anything else."""
    given = value if isinstance(value, Iterable) else [value]
    try:
        found = tuple(float(each) for each in given)
    except (TypeError, ValueError):
        found = ()
    if len(found) != count or not np.isfinite(found).all():
        wanted = "a finite number" if count == 1 else f"{count} finite numbers"
        raise Mistake(f"{call} answered {value!r}, wanted {wanted}")
    return found


def mask_of(value: Any, shape: tuple[int, ...], call: str) -> np.ndarray:
    """The mask that a call returned, as bool (rows, columns); Mistake for anything else."""
    if not isinstance(value, np.ndarray) or value.shape != shape:
        seen = f"an array {value.shape}" if isinstance(value, np.ndarray) else repr(value)[:60]
        raise Mistake(f"{call} answered {seen}, wanted a mask {shape}")
    return value > 0
