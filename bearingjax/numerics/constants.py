"""Constants: standard gravity, and tables shipped beside the modules that use them."""

import tomllib
from importlib.resources import files
from typing import Any

GRAVITY = 9.80665
"""Standard acceleration of free fall [m/s²].

Source: 3rd General Conference on Weights and Measures (1901).
"""


def read_package_table(package: str, name: str) -> dict[str, Any]:
    """Return what a TOML file of a package says.

    Args:
        package: Name of the package, "bearingjax.fits".
        name: Name of the file in it, "clearance_classes.toml".
    """
    return tomllib.loads((files(package) / name).read_text(encoding="utf-8"))


def rows_by_name(table: dict[str, list[float]]) -> dict[str, tuple[float, ...]]:
    """Return the rows of a table by each of the names in a key such as "62, 622"."""
    return {k: tuple(row) for key, row in table.items() for k in key.split(", ")}
