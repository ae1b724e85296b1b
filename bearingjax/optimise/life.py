"""Rating life as a measure: of all cases together, whose damage adds up."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp

from ..cases import Cases, spectrum_life
from ..design.checks import of_class
from ..element.bearing_element import BearingElement
from ..life.life import LifeConditions, rating_life
from ..life.life_warning import ALL, life_sizes
from ..numerics.warning import Warning, warnings_of_cases
from .measure import AbstractMeasure
from .smooth import smallest
from .system import element_of, loads_of


class OfLife(AbstractMeasure):
    """Life that the damage of the cases leaves.

    Attributes:
        conditions: Life conditions: with a lubricant the modified life, else the
            reference life.
        hours: Whether it is counted in hours, by the speeds of the cases; else in
            revolutions.

    Traced: conditions. Static: hours.
    """

    conditions: LifeConditions = eqx.field(default_factory=LifeConditions)
    hours: bool = eqx.field(static=True, default=False)

    def __check_init__(self):
        given = self.conditions
        of_class(self, "conditions", given, LifeConditions, "LifeConditions")
        of_class(self, "hours", self.hours, bool, "True or False")

    def life(self, element: BearingElement, cases: Cases, solution: Any) -> Any:
        """Life under all cases [1, h].

        Args: as `__call__`.

        Raises:
            ValueError: For hours of cases without speeds, cases with an oil of their
                own or that oscillate, and as `rating_life`.
        """

        cases.check_oil(type(self).__name__)

        def damage(solution):
            return rating_life(element, solution, self.conditions).damage

        found = spectrum_life(cases, jax.vmap(damage)(loads_of(solution)))
        if not self.hours:
            return found.rating_life
        if found.life_hours is None:
            raise ValueError(
                f"{type(self).__name__}: `hours` is True, but the cases have no speeds."
            )
        return found.life_hours

    @eqx.filter_jit
    def of_each_case(self, element: BearingElement, solution: Any) -> Any:
        """Life under each case, as if it were alone (case,) [1, h]; infinite without
        load.

        Args: as `life`.
        """

        def case_life(solution):
            found = rating_life(element, solution, self.conditions)
            if self.hours:
                return found.life_hours
            none = found.damage == 0
            return jnp.where(none, jnp.inf, 1.0 / jnp.where(none, 1.0, found.damage))

        return jax.vmap(case_life)(loads_of(solution))

    def warnings(self, element: Any, solution: Any) -> list[Warning]:
        """Warnings about the lives of all cases, each kind once.

        Args:
            element, solution: As in `__call__`, concrete.
        """
        sizes = jax.device_get(self._sizes(element_of(element), solution))
        return warnings_of_cases(sizes, ALL)

    @eqx.filter_jit
    def _sizes(self, element, solution):
        def case_sizes(solution):
            life = rating_life(element, solution, self.conditions)
            return life_sizes(element.bearing, life.ratings, vars(life))

        return jax.vmap(case_sizes)(loads_of(solution))


class RatingLife(OfLife):
    """Rating life under all cases [rev, h].

    By ISO/TS 16281, of the cases one after the other for their hours (Palmgren, Miner):
    for a bearing with a lubricant in its conditions modified by a_ISO. As an objective
    it is maximised: its inverse, the damage, is minimised.

    Attributes are `conditions` (`LifeConditions`; its capacity follows the design
    unless it is given) and `hours`: whether it is in hours, else in revolutions.

    Traced: conditions. Static: hours.
    """

    def __call__(self, element, cases, solution):
        return self.life(element_of(element), cases, solution)

    @property
    def as_objective(self) -> "AbstractMeasure":
        return Damage(self.conditions, self.hours)

    @property
    def label(self) -> str:
        return "rating life"

    @property
    def unit(self) -> str:
        return "h" if self.hours else "rev"


class Damage(OfLife):
    """Part of the rating life that a revolution or an hour uses [1/rev, 1/h].

    The inverse of `RatingLife`, with its attributes; finite without load.

    Traced: conditions. Static: hours.
    """

    def __call__(self, element, cases, solution):
        return 1.0 / self.life(element_of(element), cases, solution)

    @property
    def reported_as(self) -> "AbstractMeasure":
        return RatingLife(self.conditions, self.hours)

    def reported_value(self, value: Any) -> Any:
        return 1.0 / value

    @property
    def maximised(self) -> bool:
        return True

    @property
    def label(self) -> str:
        return "damage"

    @property
    def unit(self) -> str:
        return "1/h" if self.hours else "1/rev"


class StaticSafety(AbstractMeasure):
    """Smallest static safety C0/P0 of all cases [1].

    Attributes:
        conditions: Life conditions; of them the static load rating.

    Traced: conditions.
    """

    conditions: LifeConditions = eqx.field(default_factory=LifeConditions)

    def __check_init__(self):
        given = self.conditions
        of_class(self, "conditions", given, LifeConditions, "LifeConditions")

    def __call__(self, element, cases, solution):
        def safety(one):
            return rating_life(one.element, one, self.conditions).static_safety

        return smallest(jax.vmap(safety)(loads_of(solution)))

    @property
    def label(self) -> str:
        return "static safety"

    @property
    def unit(self) -> str:
        return ""
