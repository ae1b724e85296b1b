"""Scene files: quantities, tables, the schema of keys, and files that are written."""

from .output_files import Incomplete as Incomplete
from .output_files import check_outputs as check_outputs
from .output_files import scene_files as scene_files
from .output_files import write_outputs as write_outputs
from .quantity import SceneError as SceneError
from .scene_file import shipped_scenes as shipped_scenes
from .table import not_among as not_among
