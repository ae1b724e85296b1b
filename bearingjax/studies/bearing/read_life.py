"""The [life] table of a scene: conditions of the rating life."""

from ...design import AbstractBearing, BearingSet
from ...element import Speed
from ...files.schema import read_values
from ...files.table import Table
from ...life.life import LifeConditions
from ...life.rating import rated_axially
from ...life.reference_life import LEAST_LAMINAE
from ...numerics.warning import Warning
from .oil import Oil, read_oil
from .read_operating import relative_speed


def read_life(
    top: Table, bearing: AbstractBearing | BearingSet, speed: Speed | None, points: int
) -> LifeConditions | None:
    """Read the conditions of the rating life; `None` without a [life] table.

    Args:
        top: The scene.
        bearing: Bearing of the scene.
        speed: Ring speeds, or `None` at rest; [cases] may have others.
        points: Number of positions along the rollers.

    Raises:
        SceneError: For keys that are missing, unknown or not allowed.
    """
    if "life" not in top:
        return None
    table = top.table("life")
    turning = "cases" in top or relative_speed(speed) != 0.0  # each case has its own
    given = read_values(LifeConditions, table)
    if given["viscosity"] is not None and given["contamination"] is None:
        problem = "is missing; the modified life needs it beside `viscosity`"
        raise table.error("contamination", problem)
    if bearing.is_ball:
        if "edge_stress" in table:
            raise table.error("edge_stress", "is for rollers; balls have no ends")
        table.fill("edge_stress", None)
    if given["contamination"] is not None:
        given["viscosity"] = _viscosity(top, table, given["viscosity"])
    if given["viscosity"] is not None and not turning:
        problem = "needs a speed of one ring against the other, for its film"
        raise table.error("contamination", problem)
    if given["required"] is not None and not turning:
        problem = "is in hours, and the rings do not turn; write required_revolutions"
        raise table.error("required", problem)
    _check_points(top, bearing, points)
    table.finish()
    with table.building():
        rated_axially(bearing)  # which refuses sets of unlike rows
        return LifeConditions(**given)


def _viscosity(top: Table, table: Table, given: float | None) -> float:
    """Return the kinematic viscosity of the oil, given or of [lubricant] [m²/s]."""
    if given is not None:
        if "lubricant" in top:
            oil = f"[{top.path_of('lubricant')}]"
            problem = f"stands beside {oil}, whose oil has a viscosity; choose one"
            raise table.error("viscosity", problem)
        return given
    if "lubricant" not in top:
        oil = f"[{top.path_of('lubricant')}]"
        problem = f"is missing, and so is {oil}; `contamination` needs an oil"
        raise table.error("viscosity", problem)
    oil, _ = read_oil(top.table("lubricant"))
    return float(oil.lubricant.kinematic_viscosity(oil.temperature))


def lubrication_warnings(top: Table, oil: Oil | None) -> tuple[Warning, ...]:
    """Warn if contamination and supply are not both of grease or of oil."""
    dirt = top.table("life").word("contamination") if "life" in top else None
    greased = dirt is not None and dirt.startswith("grease")
    if oil is None or dirt is None or greased == (oil.supply == "grease"):
        return ()
    given = "" if "supply" in top.table("lubricant") else ", the default"
    cure = (
        'write `supply = "grease"`, or choose a class of oil'
        if greased
        else "choose a class of grease, or another supply"
    )
    words = (
        f'life: `contamination` is "{dirt}", but `lubricant.supply` is "{oil.supply}"'
        f"{given}: {cure}"
    )
    return (Warning("contamination", words),)


def _check_points(
    top: Table, bearing: AbstractBearing | BearingSet, points: int
) -> None:
    least = 2 * LEAST_LAMINAE + 1
    if bearing.is_ball or (points % 2 and points >= least):
        return
    problem = (
        f"{points} is not allowed with [{top.path_of('life')}]; odd and at least"
        f" {least}: every second position is the middle of a lamina"
    )
    raise top.table("output").error("points", problem)
