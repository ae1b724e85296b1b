"""The script with which a shell completes commands, options, scenes, designations."""

import argparse
import importlib
from pathlib import Path

SHELLS = ("bash", "zsh", "fish")


def completion_script(top: argparse.ArgumentParser, shell: str) -> str:
    """Return the script for one of `SHELLS`; it has all words, and starts no Python.

    Raises:
        SceneError: Without shtab.
    """
    from ..catalogue import catalogue_entries
    from ..files import SceneError, shipped_scenes

    try:
        shtab = importlib.import_module("shtab")
    except ImportError as error:
        problem = '--completion needs shtab: pip install "bearingjax[completion]"'
        raise SceneError(problem) from error
    scenes = " ".join(shipped_scenes())
    fish = f"(printf '%s\\n' {scenes}; __fish_complete_path (commandline -ct))"
    scene = {"bash": "_bearingjax_scenes", "zsh": "_bearingjax_scenes", "fish": fish}
    known = [entry.designation.replace(" ", "") for entry in catalogue_entries()]
    parts = [top]
    for part in parts:
        for action in part._actions:
            if isinstance(action, argparse._SubParsersAction):
                parts.extend(action.choices.values())
            elif action.metavar == "SCENE":
                action.complete = scene  # type: ignore[attr-defined]
            elif action.type is Path:
                action.complete = shtab.FILE  # type: ignore[attr-defined]
            elif action.metavar == "DESIGNATION":
                action.choices = known
            elif part.prog.endswith(" examples") and action.metavar == "NAME":
                action.choices = scenes.split()
    words = {
        "bash": f'compgen -W "{scenes}" -- "$1"; compgen -f -- "$1"',
        "zsh": f"compadd -- {scenes}; _files",
    }
    preamble = {name: f"_bearingjax_scenes() {{ {words[name]}; }}" for name in words}
    return shtab.complete(top, shell, preamble=preamble)
