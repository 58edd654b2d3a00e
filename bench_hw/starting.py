"""How a program of ours starts: with modules from the installation, names that are text, and streams that are there.

`python -m` puts the current folder first on the path of modules, where a `fem.py` or `numpy.py` of the user's would
come before ours. `leave_current_folder` puts it last: a user's own modules are still found, in the place of nothing.

A program may be started with its standard input, output or error closed. The next file it opens then has the number of
that stream, and what a library says there would stand in the file: `open_streams`. One that is full, or whose reader
went away, is told by name: `end`. An option of one value that is given twice is refused: `refuse_repeats`. Ctrl-C
before the verb or after it ends the program in one line. Nothing is imported here at the top that is not there since
the start of Python.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]
import _thread
import io
import os
import sys
import time

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import typer

EXIT_UNSAID = 2
EXIT_INTERRUPTED = 130
PAUSE = 0.02
"""Before an interruption comes once more, s."""
NAMED = 5
"""Shadowing names that are told."""
OURS = ("bench_hw", "benchmark", "fem", "reports", "wavemodel")


def leave_current_folder(root: str) -> list[str]:
    """Put the current folder last on the path of modules, here and in processes that are started from now on.

    Parameters
    ----------
    root
        Folder of our packages; it is left where it is if it is the current one.

    Returns
    -------
    list of str
        Files and folders here that have the name of a module, which would have been taken for it.
    """
    os.environ["PYTHONSAFEPATH"] = "1"
    try:
        here = os.path.realpath(os.getcwd())
    except OSError:  # it was removed
        return []
    if here == os.path.realpath(root):
        return []
    others = [entry for entry in sys.path if os.path.realpath(entry or here) != here]
    if root not in others:  # an editable installation finds our packages by other means than the path
        others.append(root)
    sys.path[:] = [*others, here]
    return _shadowing(here, others)


def speak_utf8() -> None:
    """Start anew in Python's UTF-8 mode where the locale is ASCII, in which names of files would not be text.

    Python does so by itself in the C locale, unless `PYTHONUTF8=0` or an older setting is in the way.
    """
    if os.name == "posix" and not sys.flags.utf8_mode and sys.getfilesystemencoding() != "utf-8":
        os.environ["PYTHONUTF8"] = "1"
        try:
            os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])
        except OSError:
            pass
    reconfigure = getattr(sys.stdout, "reconfigure", None)
    if reconfigure is not None:
        reconfigure(errors="backslashreplace")  # names of files need be no text at all


def keep_caches() -> None:
    """Give libraries a folder for this run where they could not write the user's, and would say so on stderr."""
    config = os.environ.get("XDG_CONFIG_HOME") or "~/.config"
    cache = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    given = os.environ.get("MPLCONFIGDIR")
    if _can_be_written(given or f"{config}/matplotlib") and _can_be_written(f"{cache}/matplotlib"):
        return
    import atexit
    import shutil
    import tempfile

    try:
        folder = tempfile.mkdtemp(prefix="tissuebench-")
    except OSError:  # nothing can be written here; what draws says so
        return
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.environ["XDG_CACHE_HOME"] = folder  # for fontconfig, which matplotlib asks
    if not (given and _can_be_written(given)):
        os.environ["MPLCONFIGDIR"] = folder


def _can_be_written(folder: str) -> bool:
    """Whether a folder can be written, or made where it is not there."""
    folder = os.path.abspath(os.path.expanduser(folder))
    while not os.path.lexists(folder):
        folder = os.path.dirname(folder)
    return os.path.isdir(folder) and os.access(folder, os.W_OK | os.X_OK)


def tell(names: list[str], arguments: list[str]) -> None:
    """Say on stderr, in one line, what is passed over; nothing with --quiet."""
    if not names or "--quiet" in arguments:
        return
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    verb = "has the name of a module and is" if len(names) == 1 else "have names of modules and are"
    print(f"note: {', '.join(names[:NAMED])}{more} in this folder {verb} not imported", file=sys.stderr)


def not_installed(error: ModuleNotFoundError) -> int:
    """Say in one line that a library is not there for this Python, and how it comes there; the exit code.

    Raises
    ------
    ModuleNotFoundError
        It is a module of ours: the installation is broken.
    """
    name = (error.name or "").partition(".")[0]
    if not name or name in OURS:
        raise error
    print(
        f"error: {name} is not installed for {sys.executable}: in a checkout `make run` once, then "
        "`. .venv/bin/activate`; elsewhere `pip install .`",
        file=sys.stderr,
    )
    return EXIT_UNSAID


def _shadowing(here: str, others: list[str]) -> list[str]:
    """What in `here` would come in the place of a module that is there without it."""
    from importlib.machinery import PathFinder

    try:
        entries = sorted(os.listdir(here))
    except OSError:
        return []
    found = []
    for entry in entries:
        name, ending = os.path.splitext(entry)
        package = not ending and os.path.isfile(os.path.join(here, entry, "__init__.py"))
        if not (package or ending == ".py") or not name.isidentifier():
            continue
        if name in sys.stdlib_module_names or _is_there(PathFinder.find_spec(name, others)):
            found.append(f"{entry}/" if package else entry)
    return found


def _is_there(spec: object) -> bool:
    """Whether a module was found that is more than a folder."""
    return getattr(spec, "origin", None) is not None


class _Raw(io.FileIO):
    """A standard stream that keeps the fault it met; one that is `deaf` goes on as if nothing had happened."""

    def __init__(self, handle: int, *, deaf: bool) -> None:
        super().__init__(handle, "w", closefd=False)
        self.fault: OSError | None = None
        self._deaf = deaf

    def write(self, data: memoryview, /) -> int:  # type: ignore[override]
        try:
            return super().write(data)
        except OSError as error:
            self.fault = error
            if self._deaf:
                return len(data)
            raise


def open_streams() -> None:
    """Open closed standard streams onto nothing; no command fails by words that standard error cannot take."""
    for handle in range(3):
        try:
            os.fstat(handle)
        except OSError:
            _onto_nothing(handle)
    if sys.stdin is None:
        sys.stdin = open(0, encoding="utf-8", closefd=False)
    sys.stdout = _wrapped(sys.stdout, _Raw(1, deaf=False))
    sys.stderr = _wrapped(sys.stderr, _Raw(2, deaf=True), line_buffering=True)


def _wrapped(old: object, raw: _Raw, *, line_buffering: bool = False) -> io.TextIOWrapper:
    """A text stream as Python makes it, over `raw`."""
    return io.TextIOWrapper(
        io.BufferedWriter(raw),  # type: ignore[type-var]
        encoding=getattr(old, "encoding", "utf-8"),
        errors=getattr(old, "errors", "backslashreplace"),
        line_buffering=line_buffering or raw.isatty(),
        write_through=bool(getattr(old, "write_through", False)),
    )


def refuse_repeats(app: typer.Typer) -> None:
    """Have every verb refuse an option that takes one value and is given twice: the first was passed over."""
    from typer.core import TyperCommand, TyperOption

    class Verb(TyperCommand):
        def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
            given = self.make_parser(ctx).parse_args(args=[*args])[2]
            single = [each for each in given if isinstance(each, TyperOption) and not (each.multiple or each.is_flag)]
            for option in single:
                if single.count(option) > 1:
                    ctx.fail(f"{option.opts[0]} is given {single.count(option)} times; it takes one value")
            return super().parse_args(ctx, args)

    for command in app.registered_commands:
        command.cls = Verb
    for group in app.registered_groups:
        if group.typer_instance is not None:
            refuse_repeats(group.typer_instance)


def usage_words(error: Any, program: str) -> str:
    """A usage error of the command-line library as one sentence, and whose help tells more."""
    said = " ".join(error.format_message().replace("Value error, ", "").split()).rstrip(".")
    context = getattr(error, "ctx", None)
    verb = program if context is None else context.command_path
    return f"{said}{'' if said.endswith('?') else '.'} See {verb} --help."


def end(code: int) -> int:
    """Pass on what is left for standard output, and give the exit code: 2, and why, where that cannot be done."""
    known = unsaid() is not None
    try:
        sys.stdout.flush()
    except (OSError, ValueError):  # the fault is kept, or it is closed
        pass
    fault = unsaid()
    _signal.signal(_signal.SIGINT, _signal.SIG_DFL)  # no traceback out of what Python does at its end
    if fault is None:
        return code
    _onto_nothing(1)  # or Python would fail by it again at its very end
    if not known or not code:
        print(f"error: {fault}", file=sys.stderr)
    return code or EXIT_UNSAID


def interrupted() -> int:
    """Say in one line that Ctrl-C ended the program where no verb was at work, and give the exit code."""
    _signal.signal(_signal.SIGINT, _signal.SIG_DFL)
    print("error: interrupted", file=sys.stderr)
    return EXIT_INTERRUPTED


def keep_interruptions() -> None:
    """Let Ctrl-C end the program where it met code that passes over every error, as a library's callback may."""
    before = sys.unraisablehook

    def hook(unraisable: sys.UnraisableHookArgs, /) -> None:
        if unraisable.exc_type is KeyboardInterrupt:
            _thread.start_new_thread(_interrupt_again, ())
        else:
            before(unraisable)

    sys.unraisablehook = hook


def _interrupt_again() -> None:
    time.sleep(PAUSE)  # until that code is left
    _thread.interrupt_main()


def unsaid() -> str | None:
    """In words, what kept standard output from being written; None where nothing did."""
    stream = getattr(sys.stdout, "wrapped", sys.stdout)  # the command-line library wraps a broken pipe
    fault = getattr(getattr(getattr(stream, "buffer", None), "raw", None), "fault", None)
    if fault is None:
        return None
    return f"standard output cannot be written: {fault.strerror}; results that are in their place stay there"


def _onto_nothing(handle: int) -> None:
    nothing = os.open(os.devnull, os.O_RDWR)
    if nothing != handle:
        os.dup2(nothing, handle)
        os.close(nothing)
