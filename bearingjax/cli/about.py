"""What `bearingjax --version` and `--cite` print."""

import json
import re
from argparse import Namespace
from collections import Counter
from importlib.metadata import version
from importlib.resources import files
from typing import Any

from .._version import __version__


def describe_version(_: Any = None) -> str:
    """Return versions, backend, devices and precision, for a report of a fault."""
    import platform

    import jax

    jax.config.update("jax_enable_x64", True)  # as every command does
    try:
        kinds = Counter(device.device_kind for device in jax.devices())
        devices = ", ".join(f"{count} x {kind}" for kind, count in kinds.items())
        backend = jax.default_backend()
    except Exception as error:  # whatever keeps JAX from starting is to be told
        backend, devices = "none", repr(error).splitlines()[0]
    libraries = ("jax", "jaxlib", "equinox", "numpy", "scipy")
    rows = {
        "bearingjax": __version__,
        "Python": f"{platform.python_version()} on {platform.platform()}",
        **{name: version(name) for name in libraries},
        "backend": backend,
        "devices": devices,
        "precision": str(jax.numpy.result_type(float)),
    }
    return "\n".join(f"{name} {value}" for name, value in rows.items())


def citations(source: str) -> str:
    """Return BibTeX of this package and of what the study of a scene uses.

    Args:
        source: A scene, or the JSON of an earlier run; empty: of this package alone.

    Raises:
        SceneError: If the scene cannot be read.
    """
    echo = ""
    if source:
        from ..studies import jax_settings
        from ..studies.study import STUDIES, study_of

        jax_settings.configure(Namespace(command="cite"))
        echo = json.dumps(STUDIES[study_of(source)].read(source).inputs)
    entries = (files("bearingjax.cli") / "references.bib").read_text(encoding="utf-8")
    return "\n\n".join(
        entry.strip().replace("{VERSION}", f"{{{__version__}}}")
        for entry in re.split(r"\n(?=@)", entries)
        if (rules := re.search(r"usedby = \{(.*?)\}", entry)) is None
        or any(_fits(rule, echo) for rule in rules[1].split("; "))
    )


def _fits(rule: str, echo: str) -> bool:
    """Whether a scene has the keys and words of a rule, "lubricant & line_law=x"."""
    parts = (part.partition("=") for part in rule.split(" & "))
    words = ((key, rf'(\[[^]]*)?"{word}"' if word else "") for key, _, word in parts)
    return all(re.search(f'"{key}": {word}', echo) for key, word in words)
