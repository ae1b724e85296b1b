"""Our docstrings as reStructuredText and napoleon want them."""

import re
import sys

from sphinx.pycode import ModuleAnalyzer

# The signature that runs is shown, not the overloads that type checkers read.
setattr(ModuleAnalyzer, "overloads", property(lambda _: {}, lambda _, value: None))  # noqa: B010


def to_rst(app, what, name, obj, options, lines):
    """Rewrite the lines of a docstring in place, as Sphinx has it."""
    if what == "data":
        lines[:] = _words_on(name)
    if what in ("property", "attribute", "data"):
        lines.insert(0, "\\ ")  # or napoleon takes what precedes a colon for a type
    text = "\n".join(_escaped(line) for line in lines)
    # "Attributes are those of `X`, and" goes straight on with a list of others.
    opening = r"(?m)^((?:.*\bAttributes are|follows from the sphere, and).*)\n(?= {4})"
    text = re.sub(opening, r"\1\n\nAttributes:\n", text)
    # An indented block after a colon and an empty line is code.
    text = re.sub(r"(?m)(?<!:):\n\n(?= {4,}[\w#])", "::\n\n", text)
    # "Source: …" with its further lines is a field.
    label = r"(?m)^(Source|Fails|Valid|Traced|Static): (.+(?:\n(?![A-Z]\w*:).+)*)"
    indented = lambda m: f"\n:{m[1]}: " + m[2].replace("\n", "\n    ")  # noqa: E731
    lines[:] = re.sub(label, indented, text).split("\n")


def _escaped(line):
    """The line with what stands outside of backticks taken literally."""
    parts = line.split("`")
    parts[::2] = [re.sub(r"(\*(?! )|[|]|_(?!\w))", r"\\\1", p) for p in parts[::2]]
    return re.sub(r"(`[^`]+`)(?=\w)", r"\1\\ ", "`".join(parts))


def _words_on(name):
    """The docstring below a constant, in the module of its package that has it."""
    package, _, word = name.rpartition(".")
    for module in [one for one in sys.modules if one.startswith(f"{package}.")]:
        words = ModuleAnalyzer.for_module(module).find_attr_docs()
        if ("", word) in words:
            return words["", word]
    return [""]


def short_signature(app, what, name, obj, options, signature, returns):
    """Arrays under the name by which users know them."""
    return tuple(part and _short(part) for part in (signature, returns))


def short_types(app, what, name, obj, options, lines):
    """The types that napoleon has found for fields, with their shapes."""
    for k, line in enumerate(lines):
        if line.startswith(":vartype"):
            lines[k] = _short(line).replace("*", r"\*")


def _short(words):
    """Types without their modules; one array for those of JAX and NumPy."""
    words = re.sub(r"\b(jaxlib\._jax|jaxtyping|equinox\._module\._module)\.", "", words)
    alike = r"\[Array, ('[^']*')\](?: \| \w+\[(?:ndarray|floating), \1\])+"
    return re.sub(alike, r"[Array, \1]", words).replace("Float[Array, '']", "Scalar")
