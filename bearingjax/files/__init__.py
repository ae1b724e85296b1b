"""Scene files: quantities, tables, the schema of keys, and files that are written.

Names
-----

- Scenes: `shipped_scenes`, `SceneError`.
"""

from .quantity import SceneError
from .scene_file import shipped_scenes

__all__ = [
    "shipped_scenes", "SceneError",
]  # fmt: skip
