"""Published ratings and axial factors that bearings of the catalogue carry."""

import functools
from operator import attrgetter
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from published import theirs
from tolerances import ROUNDING

import bearingjax as bj
from bearingjax.catalogue.entry import catalogue_entries
from bearingjax.design.published import is_as_published, rated_dimensions
from bearingjax.life import equivalent_load, rating, ratings
from bearingjax.optimise.variable import with_numbers
from bearingjax.studies.bearing.read_scene import read_scene

LOAD = np.array([2e3, 0.0, 4e3, 0.0, 0.0, 0.0])


def rows(bearing) -> list[Any]:
    return [row.bearing for row in bj.design.rows_of(bearing)]


@functools.cache
def by_type():
    found = {}
    for entry in catalogue_entries():
        found.setdefault(entry.type, []).append(entry)
    return found


def some():
    """Three designations of each type that has published ratings."""
    for entries in by_type().values():
        printed = [entry for entry in entries if entry.dynamic_capacity is not None]
        for k in (0, len(printed) // 2, -1):
            yield printed[k]


def numbers(bearing):
    """C, C0, Pu, P, P0 and L10 of a bearing."""
    rated, load = ratings(bearing), equivalent_load(bearing, LOAD)
    power = 3 if rows(bearing)[0].is_ball else 10 / 3
    values = rated.dynamic_capacity, rated.static_capacity, rated.fatigue_load_limit
    life = 1e6 * (values[0] / load.dynamic) ** power
    return np.array([float(value) for value in (*values, *load, life)])


@pytest.mark.slow
def test_python_and_scenes_rate_catalogue_bearings_as_published(tmp_path):
    """C, C0, Pu, P and L10 of 39 designations of all types, from either side."""
    path, seen = tmp_path / "scene.toml", 0
    for entry in some():
        found = numbers(bj.load_bearing(entry.designation))
        path.write_text(
            f'[bearing]\ndesignation = "{entry.designation}"\n[operating]\n'
            'load = { Fz = "1 kN" }\n[life]\n',
            encoding="utf-8",
        )
        np.testing.assert_array_equal(
            found, numbers(read_scene(path).running().bearing)
        )
        names = "dynamic_capacity", "static_capacity", "fatigue_load_limit"
        own = [getattr(entry, name) for name in names]
        wanted = [value for value in own if value is not None]
        np.testing.assert_allclose(found[: len(wanted)], wanted, rtol=ROUNDING)
        seen += 1
    assert seen == 3 * len(by_type()) >= 39


def test_rated_fields_are_those_that_the_ratings_depend_on():
    """The numbers of the formulas change with a field of `rated_fields`, and no other.

    Fits change what a four-point bearing touches at, not its shim angle.
    """
    for entries in by_type().values():
        (row, *_) = rows(bj.load_bearing(entries[0].designation))
        before = jax.tree.leaves(rating._row(row))
        names = [f.name for f in row.__dataclass_fields__.values() if f.metadata]
        for name in names:
            value = getattr(row, name)
            if not isinstance(value, jax.Array) or name == "rated_contact_angle":
                continue
            if (entries[0].type, name) == (
                "four_point_ball",
                "radial_internal_clearance",
            ):
                continue
            moved = eqx.tree_at(attrgetter(name), row, 1.01 * value + 1e-5)
            after = jax.tree.leaves(rating._row(moved))
            same = np.allclose(before, after, rtol=1e-12, atol=0.0)
            assert same == (name not in row.rated_fields), (row, name)
            assert bool(is_as_published(moved)) == same


def test_changed_dimension_leaves_the_published_ratings():
    bearing = bj.load_bearing("22220 E")
    rated = ratings(bearing)
    own = bj.catalogue_entry("22220 E").dynamic_capacity
    assert (float(rated.dynamic_capacity), rated.dynamic_source) == (own, "published")
    assert rated.factors_source == "published"
    shorter = [eqx.tree_at(lambda r: r.roller_length, r, r.roller_length * 0.9)
               for r in rows(bearing)]  # fmt: skip
    other = eqx.tree_at(lambda b: [r.bearing for r in b.rows], bearing, shorter)
    rated = ratings(other)
    assert rated.dynamic_source == "ISO 281 from geometry"
    assert rated.limit_source == "ISO 281 from static capacity"
    assert rated.factors_source == "ISO 281 and ISO 76 from geometry"
    assert float(rated.dynamic_capacity) == float(bj.dynamic_capacity(other))
    # What is given counts before what is published.
    rated = ratings(bearing, dynamic_capacity=4e5)
    assert rated.dynamic_source == "given" and rated.static_source == "published"


def test_published_capacity_has_the_relative_slope_of_the_formula():
    bearing = bj.load_bearing("NU 205 EC")

    def log_of(rate):
        def at(length):
            return jnp.log(
                rate(eqx.tree_at(lambda b: b.roller_length, bearing, length))
            )

        return jax.jit(jax.value_and_grad(at))(bearing.roller_length)

    value, slope = log_of(lambda b: ratings(b).dynamic_capacity)
    own = bj.catalogue_entry("NU 205 EC").dynamic_capacity
    assert own is not None
    assert float(value) == pytest.approx(np.log(own), rel=ROUNDING)
    assert float(slope) == pytest.approx(7 / 9 / float(bearing.roller_length), rel=1e-9)
    assert float(slope) == pytest.approx(
        float(log_of(bj.dynamic_capacity)[1]), rel=1e-9
    )


def test_optimised_dimension_voids_the_published_ratings():
    """From the first step on, in the same structure; a clearance does not."""
    bearing = bj.load_bearing("6205")
    same = with_numbers(bearing, {"ball_diameter": bearing.ball_diameter})
    assert jax.tree.structure(same) == jax.tree.structure(bearing)
    assert ratings(same).dynamic_source == "ISO 281 from geometry"
    looser = with_numbers(bearing, {"radial_internal_clearance": jnp.asarray(2e-5)})
    own = bj.catalogue_entry("6205").dynamic_capacity
    assert float(ratings(looser).dynamic_capacity) == own


def test_sets_scale_the_published_ratings_of_their_rows():
    bearing = bj.load_bearing("7208 BE")
    own = ratings(bearing)
    assert own.dynamic_source == "published"
    for count, pair in (
        (2, bj.BearingSet.back_to_back(bearing, 0.02)),
        (3, bj.BearingSet.tandem(bearing, 0.02, 3)),
    ):
        rated = ratings(pair)
        capacity = count**0.7 * float(own.dynamic_capacity)
        assert float(rated.dynamic_capacity) == pytest.approx(capacity, rel=ROUNDING)
        for name in ("static_capacity", "fatigue_load_limit"):
            wanted = count * float(getattr(own, name))
            assert float(getattr(rated, name)) == pytest.approx(wanted, rel=ROUNDING)
    groove = bj.load_bearing("6205")
    capacity = float(ratings(bj.BearingSet.back_to_back(groove, 0.02)).dynamic_capacity)
    alone = float(ratings(groove).dynamic_capacity)
    assert capacity == pytest.approx(2**0.7 * 0.90 / 0.95 * alone, rel=ROUNDING)


def test_equivalent_loads_have_the_printed_axial_factors():
    """Of both types for which they are printed; the others have estimated angles."""
    listed = (*by_type()["self_aligning_ball"], *by_type()["spherical_roller"])
    assert len(listed) == 240
    for entry in listed[::16]:
        y1, y2, y0 = entry.printed.get("axial_factors", (None, None, None))
        x2 = 0.67
        if y2 is None:
            y2, x2 = entry.printed["axial_factor"], 0.65
            y1, y0 = y2 * 0.42 / 0.65, y2 * 0.44 / 0.65
        p, p0 = map(float, equivalent_load(bj.load_bearing(entry.designation), LOAD))
        assert p == pytest.approx(max(2e3 + y1 * 4e3, x2 * 2e3 + y2 * 4e3), rel=1e-9)
        assert p0 == pytest.approx(2e3 + y0 * 4e3, rel=1e-9)
    # The maker's angle, not that of the clearance with which one was measured.
    angle = bj.load_bearing("176211").nominal_contact_angle
    wanted = theirs("epk_176211", "contact angle")
    assert float(angle) == pytest.approx(float(wanted), rel=ROUNDING)


def test_mounted_bearings_keep_the_published_ratings():
    for name in (
        "7208 BE",
        "QJ 208",
        "1208 E",
        "30208 J2",
        "22208 E",
        "6208",
        "NU 208",
    ):
        bearing = bj.load_bearing(name)
        (row, *_) = rows(bearing)
        seat = bj.Mounting(
            bore=40e-3, outside_diameter=80e-3, shaft_interference=20e-6,
            housing_interference=0.0, housing_diameter=120e-3,
        )  # fmt: skip
        (found, *_) = rows(bj.fits.mount(bearing, seat))
        np.testing.assert_allclose(rated_dimensions(found), rated_dimensions(row))
        assert bool(is_as_published(found)), name
