"""A user's Python file: read, run, and called so that whatever goes wrong in it names the file and the line.

What its functions are asked for is in `user_model`.
"""

from __future__ import annotations

import ast
import hashlib
import inspect
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, TextIO

from bench_hw.storage.regular_file import read_regular
from benchmark.child_processes import forbid_ending
from benchmark.errors import InputError
from benchmark.files.sources import merge_conflict
from benchmark.models.model_result import UncoveredError

NAME = "NAME"
LONGEST_NAME = 60
NOT_FROM = "TISSUEBENCH_NOT_FROM"
"""Environment variable: a folder that a user's file must import nothing from, since another revision of it is meant."""
LIBRARIES = frozenset({"site-packages", "dist-packages"})
PRODUCT = frozenset({"bench_hw", "benchmark", "fem", "reports", "wavemodel"})
TAKEN = "fem"
"""The other model's name in tables and reports."""


@dataclass(frozen=True)
class UserFile:
    """A user's own model as a file.

    Attributes
    ----------
    path : str
        As it was given.
    name : str
        What the user calls the model: `NAME` in the file, or the file's name without .py.
    text : str
        Its content when it was read; this is what runs.
    """

    path: str
    name: str
    text: str

    @property
    def fingerprint(self) -> str:
        """SHA-256 of the text."""
        return hashlib.sha256(self.text.encode()).hexdigest()


def read_user_file(path: Path) -> UserFile:
    """Read a user's file and check its syntax; nothing in it runs.

    Raises
    ------
    InputError
        No such file, no UTF-8, no Python, or a `NAME` that cannot be shown.
    """
    try:
        text = read_regular(path).decode("utf-8-sig")
        tree = ast.parse(text, str(path))
    except SyntaxError as error:
        why = merge_conflict(text) or error.msg
        raise InputError(f"{path}, line {error.lineno}: this is no valid Python ({why})") from None
    except OSError as error:
        raise InputError(f"{path}: this model file cannot be read ({error.strerror or error})") from None
    except ValueError as error:
        raise InputError(f"{path}: this model file is no UTF-8 text ({error})") from None
    return UserFile(str(path), _name(tree, path), text)


def _name(tree: ast.Module, path: Path) -> str:
    """The text that the file assigns to `NAME`, its own name otherwise."""
    for node in tree.body:
        if not isinstance(node, ast.Assign | ast.AnnAssign) or not isinstance(node.value, ast.Constant):
            continue
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        if any(isinstance(target, ast.Name) and target.id == NAME for target in targets):
            value = node.value.value
            if not isinstance(value, str) or not value.isprintable() or not 0 < len(value.strip()) <= LONGEST_NAME:
                allowed = f"allowed: 1 to {LONGEST_NAME} printable characters"
                raise InputError(f"{path}, line {node.lineno}: {NAME} = {value!r} is no name; {allowed}")
            if value.strip().lower() == TAKEN:
                raise InputError(f"{path}, line {node.lineno}: {NAME} = {value!r} is what reports call the FEM's place")
            return value.strip()
    return path.name if path.stem.lower() == TAKEN else path.stem


def modules_of(folder: Path) -> dict[str, Path]:
    """Imported modules whose files lie in a folder, by name; neither installed libraries nor this product's own."""
    files = {
        name: Path(file)
        for name, module in tuple(sys.modules.items())
        if (file := getattr(module, "__file__", None)) and name.partition(".")[0] not in PRODUCT
    }
    return {
        name: file
        for name, file in files.items()
        if (whole := file.resolve()).is_relative_to(folder) and not LIBRARIES & set(whole.parts)
    }


class UserCode:
    """The functions of a user's file, its top level run once.

    What it prints goes to stderr, and it may import its neighbours. A `NotImplementedError` from it says that the
    model does not cover the scenario (`UncoveredError`).

    Raises
    ------
    InputError
        Any other exception in the file, with its line; a module from the folder `NOT_FROM`.
    """

    def __init__(self, file: UserFile):
        self._file, self._folder = file, str(Path(file.path).absolute().parent)
        self._module = ModuleType(f"user_model_{Path(file.path).stem}")
        self._module.__file__ = file.path
        sys.modules[self._module.__name__] = self._module
        self._known = len(sys.modules)
        forbid_ending(file.path)
        with self._guarded():
            exec(compile(file.text, file.path, "exec"), self._module.__dict__)
        self._see_imports()

    def has(self, function: str) -> bool:
        """Whether the file has a callable of that name."""
        return callable(getattr(self._module, function, None))

    def arguments(self, function: str) -> tuple[str, ...]:
        """Names of a function's arguments by place, without leading underscores; empty where they cannot be told."""
        try:
            found = inspect.signature(getattr(self._module, function)).parameters.values()
        except (AttributeError, TypeError, ValueError):
            return ()
        by_place = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
        return tuple(each.name.lstrip("_") for each in found if each.kind in by_place)

    def call(self, function: str, *arguments: Any, **keywords: Any) -> Any:
        """Call a function that the file has and return what it returns."""
        called: Callable[..., Any] = getattr(self._module, function)
        with self._guarded(function):
            found = called(*arguments, **keywords)
        self._see_imports()
        return found

    def _see_imports(self) -> None:
        """Refuse modules of the folder `NOT_FROM`; looked at only where new ones came."""
        if len(sys.modules) == self._known:
            return
        self._known = len(sys.modules)
        away = os.environ.get(NOT_FROM)
        found = {} if not away else modules_of(Path(away).resolve())
        if found:
            name, place = next(iter(found.items()))
            raise InputError(
                f"{self._file.path} imports {name} from {place}, not the other revision's; let the file find "
                "it from its own place (sys.path, __file__), or give its folder in PYTHONPATH"
            )

    def fault(self, function: str, text: str) -> InputError:
        """The error for what a function returned, or for one that is missing."""
        line = self._line(function)
        place = f"{self._file.path}, line {line}" if line else self._file.path
        return InputError(f"{place}, {function}: {text}")

    def _raises(self, frame: traceback.FrameSummary) -> bool:
        """Whether a place is a `raise` statement, so that nobody pressed Ctrl-C there."""
        own = frame.filename == self._file.path
        code = self._file.text.splitlines()[(frame.lineno or 1) - 1] if own else frame.line or ""
        return code.strip().startswith("raise")

    def _line(self, function: str) -> int:
        """Where a function begins; 0 where it is not the file's own."""
        called = getattr(self._module, function, None)
        code = getattr(inspect.unwrap(called), "__code__", None) if callable(called) else None
        return code.co_firstlineno if code is not None and code.co_filename == self._file.path else 0

    @contextmanager
    def _guarded(self, function: str | None = None) -> Iterator[None]:
        """Run the user's code, one of its functions or its top level; short, since a fast model's time has it in it.

        What it prints goes to stderr. It finds an empty stdin: nobody can answer a model, and the commands of a
        measured process are not for it.
        """
        sys.path.insert(0, self._folder)
        before = sys.stdin, sys.stdout
        try:
            sys.stdin, sys.stdout = _nothing(), sys.stderr
            yield
        except NotImplementedError as error:
            raise UncoveredError(str(error) or f"{self._file.path} raised NotImplementedError") from None
        except BaseException as error:
            frames = traceback.extract_tb(error.__traceback__)
            if _is_interrupt(error) and not self._raises(frames[-1]):
                raise
            lines = [frame.lineno for frame in frames if frame.filename == self._file.path]
            line = lines[-1] if lines else 1 if function is None else self._line(function)
            place = f"{self._file.path}, line {line}"
            raise InputError(f"{place}: {_in_words(error)}") from (None if _is_interrupt(error) else error)
        finally:
            sys.stdin, sys.stdout = before
            if self._folder in sys.path:
                sys.path.remove(self._folder)


def _nothing() -> TextIO:
    """A file without content, with a handle that programs which a model starts can be given; a closed one anew."""
    if _empty().closed:
        _empty.cache_clear()
    return _empty()


@cache
def _empty() -> TextIO:
    return Path(os.devnull).open(encoding="utf-8")


def _is_interrupt(error: BaseException) -> bool:
    return isinstance(error, KeyboardInterrupt)


def _in_words(error: BaseException) -> str:
    """An exception as the end of a message; the command line takes Ctrl-C's own name for Ctrl-C."""
    if _is_interrupt(error):
        return "the model ends itself as Ctrl-C would, by the exception of a keyboard interrupt"
    hint = " (a model has no input to read)" if isinstance(error, EOFError) else ""
    return f"{type(error).__name__}: {error}{hint}"
