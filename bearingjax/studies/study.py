"""Run the analysis described by a scene."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

from ..files.scene_file import find_scene, parse_scene
from .bearing.read_scene import read_scene
from .cases.life_run import run_life
from .cases.read_cases import read_cases
from .cases.sweep_run import run_cases
from .contact.read import read_contact
from .contact.run import run_contact
from .identify.read_identify import read_identification
from .identify.run import run_identification
from .noise.read import read_noise
from .noise.run import run_noise
from .optimise.read_shaft_optimise import read_optimisation
from .optimise.run import run_optimisation
from .rotor.read import read_rotor
from .rotor.run import run_rotor
from .select.read import read_select
from .select.run import run_select
from .shaft.read import read_shafts
from .shaft.run import run_shafts
from .skid.read import read_skid
from .skid.run import run_skid
from .solve.run import run_scene
from .tolerances.read import read_tolerances
from .tolerances.run import run_tolerances


class Study(NamedTuple):
    """An analysis that a scene may describe.

    Attributes:
        tables: Tables that a scene of this analysis must have.
        read: Reads such a scene, from its path and settings.
        run: Runs the scene read.
    """

    tables: frozenset[str]
    read: Callable[..., Any]
    run: Callable[[Any], Any]


STUDIES = {
    "optimise": Study(frozenset({"optimise"}), read_optimisation, run_optimisation),
    "identify": Study(frozenset({"identify"}), read_identification, run_identification),
    "select": Study(frozenset({"select"}), read_select, run_select),
    "tolerances": Study(frozenset({"tolerances"}), read_tolerances, run_tolerances),
    "shaft": Study(frozenset({"shaft"}), read_shafts, run_shafts),
    "rotor": Study(frozenset({"rotor"}), read_rotor, run_rotor),
    "contact": Study(frozenset({"roller"}), read_contact, run_contact),
    "noise": Study(frozenset({"vibration"}), read_noise, run_noise),
    "skid": Study(frozenset({"dynamics"}), read_skid, run_skid),
    "life": Study(frozenset({"cases", "life"}), read_cases, run_life),
    "sweep": Study(frozenset({"cases"}), read_cases, run_cases),
    "solve": Study(frozenset(), read_scene, run_scene),
}
"""Studies by command; a scene belongs to the first whose tables it has."""


def study_of(source: str | Path, settings: Iterable[str] = ()) -> str:
    """Return which of `STUDIES` a scene describes.

    Args: as `read_scene`.

    Raises:
        SceneError: If there is no such scene, or it cannot be read.
    """
    data = parse_scene(find_scene(source), settings)
    return next(name for name, study in STUDIES.items() if study.tables <= data.keys())


def run(source: str | Path, settings: Iterable[str] = ()) -> Any:
    """Run the analysis described by a scene.

    Args:
        source: Scene file, or the name of a shipped scene.
        settings: Changes to it, "key=value", as in `--set`.

    Returns:
        By the tables of the scene: `OptimisedDesign` of [optimise], `Identified` of
        [identify], `Selection` of [select], `ToleranceRun` of [tolerances], `ShaftRun`
        of [shaft.NAME], `RotorRun` of [rotor], a list of `SliceComparison` of [roller],
        `NoiseRun` of [vibration], `SkidRun` of [dynamics], `LifeRun` of [cases] and
        [life], `Sweep` of [cases], else the `Solution` of the bearing under its load.
        Read its result code: a failed solve does not raise, except at the start of a
        search.

    Raises:
        SceneError: If the scene cannot be read.
        SolveError: If the design from which a search starts does not solve.
    """
    settings = list(settings)
    study = STUDIES[study_of(source, settings)]
    return study.run(study.read(source, settings))
