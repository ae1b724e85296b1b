"""Scene files: reading, running, reporting."""

from .cases_table import CaseTable as CaseTable
from .cases_table import read_cases as read_cases
from .optimise_report import optimisation_as_dict as optimisation_as_dict
from .optimise_report import optimisation_report as optimisation_report
from .optimise_table import Optimisation as Optimisation
from .optimise_table import read_optimisation as read_optimisation
from .output import as_dict as as_dict
from .output import write_json as write_json
from .quantity import SceneError as SceneError
from .read import Scene as Scene
from .read import load_bearing as load_bearing
from .read import read_scene as read_scene
from .read import shipped_scenes as shipped_scenes
from .report import report as report
from .run import run_optimisation as run_optimisation
from .run import run_scene as run_scene
from .sweep_run import design_columns as design_columns
from .sweep_run import run_cases as run_cases
from .sweep_run import sweep_report as sweep_report
from .sweep_run import write_sweep_json as write_sweep_json
