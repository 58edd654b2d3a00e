"""Modules come from the installation, not from files of the same names in the current folder.

`python -m` puts the current folder first on the path of modules, where a `fem.py` or `numpy.py` of the user's would
come before ours. `leave_current_folder` puts it last: a user's own modules are still found, in the place of nothing.
Nothing is imported here at the top that is not there since the start of Python.
"""

from __future__ import annotations

import os
import sys

NAMED = 5
"""Shadowing names that are told."""


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
        try:  # noqa: SIM105 - nothing may be imported here
            os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])
        except OSError:
            pass
    reconfigure = getattr(sys.stdout, "reconfigure", None)
    if reconfigure is not None:
        reconfigure(errors="backslashreplace")  # names of files need be no text at all


def tell(names: list[str], arguments: list[str]) -> None:
    """Say on stderr, in one line, what is passed over; nothing with --quiet."""
    if not names or "--quiet" in arguments:
        return
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    verb = "has the name of a module and is" if len(names) == 1 else "have names of modules and are"
    print(f"note: {', '.join(names[:NAMED])}{more} in this folder {verb} not imported", file=sys.stderr)


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
