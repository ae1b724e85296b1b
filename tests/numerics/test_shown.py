"""What `print` and notebooks show: numbers with units and meanings, of any module."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from registry import ball_elements, bearings
from test_units import with_axes

import bearingjax as bj
from bearingjax.numerics.shown import Printable, Shown, numbers_text
from bearingjax.numerics.units import meaning, real, units


def lines(module) -> list[list[str]]:
    """Words of each line that has a value."""
    return [line.split() for line in str(module).splitlines()]


@pytest.fixture(scope="module")
def solved():
    element = bj.BearingElement(bearings()["cylindrical, crowned ends"])
    load = jnp.array([0.0, -4e3, 0.0, 0.0, 0.0, 0.0])
    return bj.solve_load(element, load)


@pytest.mark.parametrize("name", [*bearings(), *ball_elements()])
def test_every_number_of_a_bearing_is_printed(name):
    made = bearings().get(name) or ball_elements()[name][0]
    text = str(made)
    for path, _ in jax.tree_util.tree_flatten_with_path(made)[0]:
        *_, last = (str(key).lstrip(".") for key in path if hasattr(key, "name"))
        assert f" {last} " in text
    assert str(made.__class__.__name__) == text.splitlines()[0]
    assert "f64[]" in repr(made) and "f64[]" not in text
    assert len(repr(made)) < 8000


def test_numbers_have_the_units_in_which_people_read_them():
    bearing = bj.load_bearing("7208 BE")
    found = {words[0]: words[1:] for words in lines(bearing) if len(words) > 1}
    assert found["contact_angle"][0] == "40°"
    assert found["pitch_diameter"][1:5] == ["mm", "diameter", "of", "the"]
    assert float(found["pitch_diameter"][0]) == pytest.approx(
        1e3 * float(bearing.pitch_diameter), rel=1e-4
    )
    assert found["elastic_modulus"][1] == "GPa"
    assert lines(bj.Speed(inner=10.0 * np.pi))[1][:3] == ["inner", "300", "rpm"]


def test_numbers_of_arrays():
    assert numbers_text(-0.0, "m") == "0 µm"
    assert numbers_text([1e-3, np.nan, np.inf], "") == "0.001, nan, inf"
    assert numbers_text(np.arange(8.0).reshape(2, 4), "N") == "0 to 0.007 kN (2 x 4)"
    assert numbers_text([np.nan] * 7, "Pa") == "nan MPa (7)"
    units = ["N", "N", "N m"]
    assert numbers_text([1e3, 1e-9, 2.0], units, "xyz") == "x 1 kN, z 2 N m"
    assert numbers_text([0.0, 0.0, 0.0], units, "xyz") == "0"
    assert numbers_text(np.zeros((0, 2)), "m") == "0"


def test_a_solution_prints_what_is_looked_at_first(solved):
    text = {words[0]: " ".join(words[1:]) for words in lines(solved)[1:] if words}
    largest = 1e-3 * float(solved.roller_load.max())
    assert text["result"].startswith("converged")
    assert "inner_uy -" in text["displacement"] and "outer" not in text["displacement"]
    assert f"to {largest:.5g} kN (7 x 2)" in text["roller_load"]
    assert text["load_zone"].startswith(f"{int(solved.load_zone.sum())} of 7")
    uy = 1e-6 * float(solved.stiffness[7, 7])
    assert f"uy {uy:.5g} kN/mm" in text["stiffness"]
    assert len(str(solved).splitlines()) < 25


def test_a_failed_solution_says_why(solved):
    failed = eqx.tree_at(
        lambda s: (s.result, s.unrestrained),
        solved,
        (jnp.asarray(int(bj.Result.NO_LOAD_PATH), jnp.int32), jnp.asarray(2)),
    )
    assert "No load path in uz of the inner ring" in " ".join(str(failed).split())


def test_batches_and_traced_modules_are_printed(solved):
    many = jax.tree.map(lambda x: jnp.stack([x, x]), solved)
    assert lines(many)[1][:3] == ["result", "2", "converged"]
    seen = []
    jax.eval_shape(lambda s: seen.extend([str(s), s._repr_html_()]), solved)
    assert "float64[12]" in seen[0] and "float64[12]" in seen[1]
    bearing = bearings()["taper, large rib"]
    jax.eval_shape(jax.vmap(lambda b: seen.append(str(b))), stack(bearing))
    assert "pitch_diameter             float64[]" in seen[-1]
    assert "52, 52 mm" in str(stack(bearing))
    for tree in (
        eqx.filter_eval_shape(lambda: bearing),
        eqx.filter(solved, lambda _: False),
    ):
        assert str(tree)
    single = jax.tree.map(lambda x: np.asarray(x, np.float32), bearing)
    assert "8.2 mm" in str(single)


def stack(module):
    return jax.tree.map(lambda x: jnp.stack([x, x]), module)


class Odd(Printable):
    """A module.

    Attributes:
        mass: Mass <of it> & more; the rest is not shown [kg].
    """

    mass: object = eqx.field(**real("kg"))
    label: str = eqx.field(static=True, metadata=meaning("<b>label</b>"))
    absent: None = None


def test_notebooks_show_a_table_with_text_escaped():
    page = Odd(2.0, "<script>")._repr_html_()
    assert "<script>" not in page and "&lt;script&gt;" in page
    assert "&lt;b&gt;label" in page and "mass &lt;of it&gt; &amp; more<" in page
    assert page.count("<tr>") == 2 and "2 kg" in page


@pytest.mark.parametrize(
    "made",
    [
        bj.LifeConditions(viscosity=1e-5, contamination=0.5),
        bj.Installed(bj.BearingElement(bearings()["taper, large rib"])),
        bj.ratings(bearings()["taper, large rib"]),
        bj.FitConditions(),
    ],
    ids=lambda made: type(made).__name__,
)
def test_conditions_and_ratings_are_printed(made):
    assert str(made).startswith(type(made).__name__ + "\n") and "[]" not in str(made)


@pytest.mark.parametrize("kind", list(with_axes()), ids=lambda kind: kind.__name__)
def test_every_result_with_axes_is_printed(kind):
    """Modules and runs; named tuples print their values already."""
    assert issubclass(kind, Shown | tuple)


def test_a_sweep_prints_units_and_how_many_cases_converged():
    cases = bj.Cases(np.zeros((9, 6)), prescribed={"gx": np.linspace(0, 2e-3, 9)})
    outputs = {
        "result": np.array([0] * 8 + [1]),
        "peak_pressure": np.linspace(1e9, 2e9, 9),
        "own": np.array(["a"] * 9),
    }
    text = str(bj.cases.Sweep(cases, outputs, "inner"))
    found = {
        words[0]: " ".join(words[1:]) for words in map(str.split, text.split("\n"))
    }
    assert found["prescribed.gx"] == "0 to 2 mrad (9)"
    assert found["outputs.result"] == "8 converged, 1 step_limit"
    assert found["outputs.peak_pressure"] == "1000 to 2000 MPa (9)"
    assert "moving_ring" in found and "array(" not in text


def test_complex_and_mixed_numbers_are_printed():
    three = jnp.arange(3.0)
    lines = bj.noise.Spectrum(three, three, jnp.full(3, 3 + 4j), bj.noise.Hann())
    text = " ".join(str(lines).split())
    assert "amplitude magnitude 5, 5, 5 complex" in text and "0, 1, 2 Hz" in text

    class Both(Printable):
        motion: np.ndarray = eqx.field(metadata=units("m", "rad"))

    assert "0.5, 2 [m, rad]" in str(Both(np.array([0.5, 2.0])))


@dataclasses.dataclass(frozen=True)
class Run(Shown):
    """A run.

    Attributes:
        task: What it was asked.
        lives: Lives by name.
        lines: Many parts.
    """

    task: Odd = dataclasses.field(repr=False)
    lives: dict
    lines: tuple
    code: bj.Result = bj.Result.STEP_LIMIT


def test_a_run_prints_its_parts_but_not_theirs():
    inner = Odd(2.0, "deep")
    part = Run(inner, {"mine": inner}, ())
    text = str(Run(inner, {"one": part, "two": inner}, (inner,) * 20))
    text = " ".join(text.split())
    assert (
        "task" not in text and "Run lives.one Run lives by name lives.mine Odd" in text
    )
    assert "lives.two Odd lives by name mass 2 kg" in text and text.count("2 kg") == 1
    assert "lines.0" not in text and text.endswith("code step_limit")
    assert "lives.two" in Run(inner, {"two": inner}, ())._repr_html_()
