"""Numbers of every shipped scene are those of its golden file; see `golden`."""

import json
import math

import pytest
from golden import agree, differences, digest

from bearingjax.files import shipped_scenes
from bearingjax.studies.study import study_of

SHORTENED = {
    "skid_combined": "dynamics.duration=10 ms",
    "skid_roller": "dynamics.duration=2 ms",
}
"""Settings of scenes whose runs take minutes."""


@pytest.mark.parametrize("name", shipped_scenes())
@pytest.mark.slow
@pytest.mark.usefixtures("untyped")
def test_numbers_of_a_shipped_scene(run, tmp_path, golden, name):
    out = tmp_path / "a.json"
    settings = ("--set", SHORTENED[name]) if name in SHORTENED else ()
    done = run(study_of(name), name, *settings, "--json", out)
    assert done.status == 0, done.err
    golden(name, json.loads(out.read_text(encoding="utf-8")))


def test_digest_of_each_kind_of_value():
    rows = [[1.0, None, -2.0], [0.5, 4.0, 1e-20], [0.0, 0.0, 0.0]]
    value = {
        "load": {"Fx": 1.23456789012345678, "steps": 7},
        "rows": rows,
        "few": [1.0, None],
        "texts": ["one", "two"],
        "many": ["converged"] * 9 + ["step_limit"],
        "parts": [{"a": 1}, {"a": "b"}],
        "version": "0",
        "none": None,
    }
    flat = [1.0, 0.0, -2.0, 0.5, 4.0]
    product = float(f"{sum(x * math.cos(k) for k, x in enumerate(flat, 1)):.13g}")
    norm = float(f"{math.sqrt(21.25):.13g}")
    wanted = {
        "few": [1.0, None],
        "load.Fx": 1.234567890123,
        "many": {"converged": 9, "step_limit": 1},
        "none": None,
        "parts[0].a": 1,
        "parts[1].a": "b",
        "rows": {"shape": [3, 3], "null": 1, "numbers": [norm, product]},
        "texts": ["one", "two"],
    }
    assert digest(value) == wanted


@pytest.mark.parametrize(
    "kept, same, other",
    [
        (1.0, 1.0 + 5e-10, 1.0 + 2e-9),
        (0.0, 0.0, 1e-20),
        ([1.0, 1e-20, None], [1.0, -1e-20, None], [1.0, 1e-20, 0.0]),
        (
            {"shape": [3], "numbers": [1.0, 1e-12]},
            {"shape": [3], "numbers": [1.0, -1e-12]},
            {"shape": [3], "numbers": [1.0, 1e-8]},
        ),
        (True, True, 1),
        ("text", "text", "texts"),
        (["a", "b"], ["a", "b"], ["a"]),
        (None, None, 0.0),
    ],
)
def test_entries_agree_to_round_off(kept, same, other):
    assert agree(kept, same) and not agree(kept, other) and not agree(other, kept)


def test_differences_name_what_is_new_gone_and_moved():
    assert differences({"a": 1.0, "b": 2.0}, {"b": 2.1, "c": None}) == [
        "a: 'absent' is now 1.0",
        "b: 2.1 is now 2.0",
        "c: None is now 'absent'",
    ]
