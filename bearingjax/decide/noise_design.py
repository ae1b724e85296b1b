"""Levels of lines and bands of a bearing on its noise rig, as functions of numbers."""

from collections.abc import Iterator
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Complex, Float, Int

from ..cases.cases import Cases, case_speed, solve_case
from ..design import BearingSet, Harmonics
from ..design.checks import check, instance, must_be, of_class, one_of
from ..element import RINGS, BearingElement
from ..noise import REFERENCE_ACCELERATION, NoiseModel, level, transfer
from ..noise.bands import BANDS
from ..noise.model import bridged_surfaces
from ..numerics.types import Real, Scalar, as_real, with_fields
from ..numerics.units import real, unit
from ..numerics.warning import Warning, in_cases
from ..optimise.measure import AbstractMeasure
from ..optimise.smooth import largest
from ..optimise.system import AbstractSystem, Design, Reading
from ..statics import Solution
from ..statics.installed import Installed

TOTAL = "total_level"

UNLIKE = 0.1
"""Load of a rolling element over the largest one below which a warning is given [1]."""


class NoiseNumbers(eqx.Module):
    """Levels of the acceleration of a bearing on its rig in one case, by its RMS.

    Attributes:
        line: Level of each line (line,) [dB].
        band: Level of each band (band,) [dB].
        total: Level of all lines together [dB].
        frequency: Frequency of each line (line,) [Hz].
        solution: Solution of the bearing under its load.
        result: `Result` code of the bearing and of the rig, the larger of the two.
    """

    line: Float[Array, " line"] = eqx.field(metadata=unit("dB"))
    band: Float[Array, " band"] = eqx.field(metadata=unit("dB"))
    total: Scalar = eqx.field(metadata=unit("dB"))
    frequency: Float[Array, " line"] = eqx.field(metadata=unit("Hz"))
    solution: Solution
    result: Int[Array, ""]


_Line = tuple[int, int, int]
"""A line as integer multiples of the orbital speed, of the speed of the ring that turns
and of the speed of the rolling elements about their own axes; it is their sum."""


class NoiseDesign(AbstractSystem):
    """A bearing on its noise rig, for `bearingjax.identify` and `decide.tolerances`.

    Levels are of first order: each wave acts alone, on contacts with the stiffness of
    their mean load, through the receptance of the rig with its rolling elements at
    their places of time zero. Only the vibration in time (`noise.vibration`) has the
    effects of unequal rolling elements, of their passage through a radial load, and of
    sums and differences of lines. Levels differ from it by 0.03 dB under an axial load
    with small waves (by 2 dB for lines near modes, at an orbital frequency of 190 Hz);
    under a radial load by 0.3 dB for lines and 1 dB for totals, as long as each rolling
    element carries a tenth of the largest load; below that `warnings` say so. With
    waves as large as the approach of the contacts (1 µm) the loudest bands are off by
    0.5 dB, others by 4 dB, and quiet ones, to which such waves add, by 20 dB.

    Any number may be unknown or scatter: "installed.drawing.bearing.contact_angle",
    "rig.errors.outer.outwards.0.amplitude.1", "rig.retardation". Load and speeds are
    those of each case.

    Attributes:
        installed: The bearing, on its seats or as drawn.
        rig: The rig and the form errors, which must be waves; its bearing, load and
            speed are replaced by those of `installed` and of the case.
        bands: Bands of the levels, "octave" or "third_octave".
        direction: Unit vector along which the acceleration is measured (3,) [1].
        reference: Acceleration of 0 dB [m/s²].
        turning: Ring that turns, "inner" or "outer"; the other ring stands still.

    Traced: all numbers. Static: bands, turning.

    Raises:
        TypeError: If a part is of another class.
        ValueError: For a bearing of several rows, and form errors other than waves.
    """

    installed: Installed
    rig: NoiseModel
    bands: str = eqx.field(static=True, default="octave")
    direction: Float[Array | np.ndarray, "3"] = eqx.field(
        converter=as_real, metadata=unit("1"), default=(0.0, 1.0, 0.0)
    )
    reference: Real = eqx.field(
        **real("m/s²", "acceleration of 0 dB", above=0), default=REFERENCE_ACCELERATION
    )
    turning: str = eqx.field(static=True, default="inner")

    def __check_init__(self):
        instance(self, "installed", Installed)
        instance(self, "rig", NoiseModel)
        one_of(self, "bands", self.bands, BANDS)
        one_of(self, "turning", self.turning, RINGS, "'outer' or 'inner'")
        drawn, errors = self.installed.drawing.bearing, self.rig.errors_of_rows[0]
        shapes = *errors.outer.shapes, *errors.inner.shapes, *errors.elements
        kinds = ", ".join(dict.fromkeys(type(one).__name__ for one in shapes)) or "none"
        waves, allowed = kinds == Harmonics.__name__, "waves (Harmonics) alone"
        must_be("NoiseDesign", "rig.errors", kinds, waves, allowed)
        alone, kind = not isinstance(drawn, BearingSet), type(drawn).__name__
        must_be("NoiseDesign", "installed", kind, alone, "a bearing of one row")

    @property
    def element(self) -> BearingElement[Any]:
        return self.installed.element_at()

    def check(self, cases: Any) -> None:
        of_class("NoiseDesign", "cases", cases, Cases, "Cases")
        for ring in RINGS:
            name, turns = f"{ring}_speed", ring == self.turning
            given = getattr(cases, name)
            speed = np.zeros(1) if given is None else np.asarray(given)
            allowed = "other than 0 in every case" if turns else "0: one ring turns"
            check("NoiseDesign", name, (speed != 0.0) == turns, allowed, speed, "rad/s")
        moments = np.asarray(cases.load)[:, len(self.rig.freedoms) :]
        allowed = "0 for moments that the ring on the rig does not take"
        check("NoiseDesign", "load", moments == 0.0, allowed, moments, "N m")
        moved = bool(cases.prescribed) or cases.fixed_displacement is not None
        must_be("NoiseDesign", "cases", "with displacements", not moved, "loads alone")

    def warnings(self, cases: Cases, solved: Any = None) -> list[Warning]:
        """Return a warning if some rolling elements carry far less than others.

        Args:
            cases: Operating cases.
            solved: Not used: the loads alone are solved, without the vibration.
        """
        shares = np.ones(cases.count)
        for k in range(cases.count):
            case = jax.tree.map(lambda leaf, k=k: leaf[k], cases)
            rig, speed = with_fields(self.rig, load=case.load), case_speed(case)
            element = self.installed.element_at(speed, throw=False)
            load = rig.solve(element, speed).roller_load
            if (load > 0.0).any(axis=0).all():  # otherwise the case fails
                shares[k] = (load.min(axis=0) / load.max(axis=0)).min()
        if not (unlike := shares < UNLIKE).any():
            return []
        least, worst = float(shares.min()), int(shares.argmin())
        words = "bands and totals lack what the passing of unlike rolling elements adds"
        words += " (16 dB where most carry none; the vibration in time has it), and"
        words += f" lines may be 3 dB off: one carries {least:.2g} of the largest load"
        found = Warning("unlike_loads", words, least, UNLIKE)
        return [in_cases(found, int(unlike.sum()), cases.count, worst)]

    def _waves(self) -> Iterator[tuple[str, int, Harmonics, int, list[_Line]]]:
        """Yield of each wave its part, direction and shape, the multiple of the orbital
        speed (of rolling elements; else 0), and the line of each order."""
        z, errors = self.installed.drawing.bearing.n_places, self.rig.errors_of_rows[0]
        for ring in RINGS:
            own, turns = getattr(errors, ring), ring == self.turning
            directions: Any = own.axial, own.outwards, own.raised
            for k, shapes in enumerate(directions):
                for one in shapes:
                    lines = [(z * round(n / z), -n * turns, 0) for n in one.order]
                    yield ring, k, one, 0, lines
        each: Any = errors.elements
        for one in each:
            for m in (-1, 0, 1):
                yield "element", 2, one, m, [(m, 0, -n) for n in one.order]

    @property
    def _lines(self) -> tuple[_Line, ...]:
        """Lines of the spectrum, without long waves of a ring at rest, which stand
        still."""
        found = (one for *_, lines in self._waves() for one in lines if any(one))
        return tuple(dict.fromkeys(found))

    def _name(self, line: _Line) -> str:
        """Return the name of a line as of `noise.name_lines`, with signs as words."""
        orbit, ring, own = line
        passages = orbit // self.installed.drawing.bearing.n_places
        turning, still = ("BPFI", "BPFO")[:: 1 if self.turning == "inner" else -1]
        if own:
            terms = (-own, "BSF"), (orbit if turning == "BPFI" else -orbit, "cage")
        elif ring:
            terms = (passages, turning), (-ring - orbit, "shaft")
        else:
            terms = ((passages, still),)
        text = "line"
        for count, name in terms:
            if count:
                word = "" if text == "line" else "_plus" if count > 0 else "_minus"
                times = "" if abs(count) == 1 else f"_{abs(count)}"
                text += f"{word}{times}_{name}"
        return text

    def readings(self) -> dict[str, Reading]:
        """Return the levels that can be measured: of lines by name, as "line_2_BPFO" or
        "line_BPFI_plus_shaft", of bands by centre frequency, as "band_1000", and
        "total_level"."""
        found = {
            self._name(one): Reading("line", k, "dB")
            for k, one in enumerate(self._lines)
        }
        for k, centre in enumerate(BANDS[self.bands]().centre):
            found[f"band_{centre:g}"] = Reading("band", k, "dB")
        return found | {TOTAL: Reading("total", 0, "dB")}

    def solve_case(self, case: Any, support: Any, options: Any) -> NoiseNumbers:
        speed = case_speed(case)
        element = self.installed.element_at(speed, throw=False)
        solution = solve_case(element, case, support, options)
        model = with_fields(self.rig, element=element, load=case.load, speed=speed)
        frequency, pattern = self._patterns(model)
        moved = transfer(model, frequency)
        made = moved.acceleration_by_errors[:, :3] * pattern[:, None]
        along = jnp.sum(made, axis=(2, 3, 4)) @ self.direction.astype(made.dtype)
        square, place = 0.5 * (along.real**2 + along.imag**2), jnp.abs(frequency)
        lower, upper = (jnp.asarray(e)[:, None] for e in BANDS[self.bands]()[2:])
        inside = ((place[None] >= lower) & (place[None] < upper)).astype(square.dtype)
        powers = square, inside @ square, jnp.sum(square)
        # The level of a square is twice that of the amplitude.
        line, band, total = (0.5 * level(p / self.reference**2, 1.0) for p in powers)
        result = jnp.maximum(solution.result, moved.result)
        return NoiseNumbers(line, band, total, place, solution, result)

    def _patterns(
        self, model: NoiseModel
    ) -> tuple[Float[Array, " line"], Complex[Array, "line element 2 3"]]:
        """Return signed frequencies of the lines [Hz], and complex deviations [m]."""
        system = model.still_system()
        outer, inner, orbit, own = system.speeds
        (surfaces,) = bridged_surfaces(model, system.surfaces)
        azimuth, lines = system.row.azimuth, self._lines
        ring = inner if self.turning == "inner" else outer
        speeds = jnp.stack([orbit, ring, own]) / (2.0 * jnp.pi)
        place = {one: k for k, one in enumerate(lines)}
        shape = len(lines), azimuth.size, 2, 3
        pattern = jnp.zeros(shape, lax.complex(azimuth, azimuth).dtype)
        for part, k, one, m, of in self._waves():
            at = np.array([place.get(line, len(lines)) for line in of])
            order = jnp.asarray(one.order, azimuth.dtype)
            share = getattr(surfaces, part).bridged_share(order)
            if part == "element":
                # The part that all rolling elements have in common as they orbit.
                size = share[None] * one.amplitude
                each = _phasor(size, one.phase + m * azimuth[:, None])
                turned = _phasor(1.0, -m * azimuth)
                wave = jnp.mean(each, axis=0)[:, None] * turned[None]
                opposite = wave * _phasor(1.0, jnp.pi * order)[:, None]
                both = jnp.stack([wave, opposite], axis=-1)
                pattern = pattern.at[at, :, :, k].add(both)
            else:
                angle = jnp.outer(order, azimuth) + one.phase[:, None]
                size, there = share * one.amplitude, RINGS.index(part)
                wave = _phasor(size[:, None], angle)
                pattern = pattern.at[at, :, there, k].add(wave, mode="drop")
        return jnp.asarray(lines, azimuth.dtype) @ speeds, pattern

    def failure_message(self, solved: Any) -> str:
        return "the bearing finds no equilibrium on its noise rig"


class NoiseLevel(AbstractMeasure):
    """Measure: level of the acceleration of a `NoiseDesign`, largest of all cases [dB].

    Attributes:
        reading: Name of a level in its `readings`, such as "band_1000".

    Static: reading.
    """

    reading: str = eqx.field(static=True, default=TOTAL)

    def __call__(self, element: Design, cases: Any, solution: Any) -> Scalar:
        known = element.readings() if isinstance(element, NoiseDesign) else {}
        one_of("NoiseLevel", "reading", self.reading, known)
        place = known[self.reading]
        values = getattr(solution, place.output)
        return largest(values.reshape(values.shape[0], -1)[:, place.entry])

    @property
    def label(self) -> str:
        return self.reading.replace("_", " ")

    @property
    def unit(self) -> str:
        return "dB"


def _phasor(size: Any, angle: Array) -> Array:
    return lax.complex(size * jnp.cos(angle), size * jnp.sin(angle))
