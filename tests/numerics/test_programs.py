"""Kept programs: told apart, read from safe places only, loaded by new processes."""

import os
import subprocess
import sys

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import bearingjax as bj
from bearingjax.numerics.compiled import programs
from bearingjax.numerics.compiled.structure import UnknownStructure, structure
from bearingjax.studies.solve.run import run_scene

# Every choice of a scene that is not a number, beside the choice that it replaces.
OF_ROLLERS = (
    "",
    "contact.line_law=iso16281",
    "contact.line_law=coupled_slices",
    "contact.line_constant=7.8e9 N/m^(19/9)",
    "numerics.quadrature=midpoint",
    "numerics.points=20",
    "numerics.kinematics=finite",
    "numerics.equilibrium=bfgs",
    "bearing.ribs={}",
    "operating.fixed_ring=inner",
    "operating.inner_speed=0 rpm",
    "output.points=5",
)
OF_BALLS = (
    "",
    "contact.point_law=zero_angle",
    "contact.point_law=operating_angle",
    "numerics.kinematics=finite",
    "operating.raceway_control=inner",
    "operating.raceway_control=load_share",
    "bearing.outer_shoulder=2 mm",
    "set.arrangement=face_to_face",
    "set={arrangement='back_to_back',spacing='17 mm',preload_force='99 N'}",
    "set={arrangement='back_to_back',spacing='17 mm',spring_force='9 N',"
    "spring_stiffness='9 N/mm'}",
)


@pytest.fixture
def store(tmp_path):
    """Keep all programs in a folder of the test."""
    programs.keep_programs(tmp_path / "programs")
    yield tmp_path / "programs"
    programs.keep_programs(keep=False)


@pytest.fixture
def name_of(monkeypatch, store):
    """Name under which the program of a scene would be kept."""

    class Named(Exception):
        pass

    def name(name, function, given, _):
        if function.__module__ == "bearingjax.statics.load":
            raise Named(name)
        return function(*given[0], **given[1])  # such as a rating, while it is read

    monkeypatch.setattr(programs, "_run_kept", name)

    def call(scene, *settings):
        with pytest.raises(Named) as found:
            run_scene(bj.read_scene(scene, settings))
        return found.value.args[0]

    return call


@pytest.mark.parametrize(
    "scene, choices", [("tapered", OF_ROLLERS), ("ball_pair", OF_BALLS)]
)
def test_program_names_differ_between_choices(name_of, scene, choices):
    names = [name_of(scene, *([choice] if choice else [])) for choice in choices]
    assert None not in names
    assert len(set(names)) == len(names)


@pytest.mark.parametrize(
    "choice",
    [
        "operating.load.Fx=-2 kN",
        "bearing.roller_length=12 mm",
        "bearing.n_rollers=18",
        "numerics.tolerance=1e-9",
        "operating.free=['ux','uz']",
        "operating.prescribed={uy='1 um'}",
        "operating.prescribed={gy='1 mrad'}",
    ],
)
def test_bearings_and_loads_of_a_kind_share_a_program(name_of, choice):
    assert name_of("tapered") == name_of("tapered", choice)


def test_numbers_share_a_program(name_of):
    assert name_of("ball_pair") == name_of("ball_pair", "set.preload_offset=9 um")


def test_every_shipped_scene_is_kept(name_of):
    shipped = set(bj.files.shipped_scenes()) - {"taper_contact", "select_gearbox"}
    bearings = {name for name in shipped if not name.startswith(("rotor_", "shaft_"))}
    names = {scene: name_of(scene) for scene in bearings}
    assert all(names.values())
    assert len(set(names.values())) > len(names) / 2


@pytest.mark.parametrize("what", ["sources", "setting", "flags", "processor"])
def test_surroundings_are_part_of_the_name(name_of, monkeypatch, what):
    before = name_of("tapered")
    if what == "sources":
        monkeypatch.setattr(programs, "_sources", lambda: "changed")
    elif what == "flags":
        monkeypatch.setenv("XLA_FLAGS", "--xla_cpu_enable_fast_math=true")
    elif what == "processor":
        monkeypatch.setattr(programs, "_processor", lambda: "another")
    else:
        given = dict(jax.config.values) | {"jax_debug_nans": True}
        monkeypatch.setattr(type(jax.config), "values", given)
    assert name_of("tapered") != before


def test_commands_compile_load_solves_for_the_shortest_wait(monkeypatch, store):
    """A script calls a load solve often, a command once; each keeps its own program."""
    met = []

    def run(name, function, given, options):
        met.append((name, options))
        return function(*given[0], **given[1])

    monkeypatch.setattr(programs, "_run_kept", run)
    element = bj.BearingElement(bj.load_bearing("deep_groove"))
    for few in (False, True):
        programs.keep_programs(store, few_calls=few)
        bj.solve_load(element, [0.0, -1e3, 0.0, 0.0, 0.0, 0.0])
    (often, level), (once, quickest) = met
    assert often != once and (level, quickest) == programs.OPTIONS[::-1]


class Foreign(eqx.Module):
    """A class from outside the package."""

    factor: float = 2.0


def test_structure_rejects_unknown_objects():
    closure = bj.numerics.Result.label.fget  # named, but not found by its name
    for value in (Foreign(), lambda x: x, closure, {1, 2}, object(), np.array([None])):
        with pytest.raises(UnknownStructure):
            structure((1.0, [value]))
    with pytest.raises(UnknownStructure):
        structure({1: "a"})


def test_structure_includes_values_of_static_arrays():
    """Were one static field to hold an array, its values are in the program."""
    texts = {structure(np.array(values)) for values in ([1.0, 2.0], [1.0, 3.0])}
    assert len(texts) == 2
    traced = {structure(jnp.array(values)) for values in ([1.0, 2.0], [1.0, 3.0])}
    assert len(traced) == 1
    assert structure(jnp.zeros(2)) != structure(jnp.zeros(2, int))
    weak = jnp.array(1.0)
    assert weak.weak_type and structure(weak) != structure(weak.astype(float))
    assert len({structure((one,)) for one in (1, 1.0, True, "1", None)}) == 5
    assert structure(0.1) != structure(np.nextafter(0.1, 1.0).item())


@pytest.fixture
def kept(monkeypatch, tmp_path):
    """A function that notes when it is traced, and its programs' folder."""
    traced = []

    def doubled(tree, word):
        traced.append(word)
        return {"sum": 2.0 * tree["a"] + tree["b"][0], "word": word, "none": None}

    doubled.__module__, doubled.__qualname__ = programs.__name__, "doubled"
    doubled = programs.program(doubled, quick=True)
    monkeypatch.setattr(programs, "doubled", doubled, raising=False)
    folder = tmp_path / "cache" / "programs"

    def call(a=1.0, word="x"):
        tree = {"a": jnp.array([a, 2.0]), "b": (jnp.array(0.5),)}
        count = len(traced)
        programs.keep_programs(folder)  # with none at hand
        out = doubled(tree, word)
        assert np.array_equal(out["sum"], [2.0 * a + 0.5, 4.5])
        assert (out["word"], out["none"]) == (word, None)
        return len(traced) > count

    setattr(call, "folder", folder)  # noqa: B010 (a function has no such attribute)
    yield call
    programs.keep_programs(keep=False)


def test_a_kept_program_is_not_traced_again(kept):
    assert kept()
    assert not kept() and not kept(a=-7.0)
    assert kept(word="y")
    assert not kept(word="y") and not kept()
    assert kept.folder.stat().st_mode & 0o777 == 0o700
    files = list(kept.folder.iterdir())
    assert [file.stat().st_mode & 0o777 for file in files] == [0o600] * 2


def test_programs_of_the_last_run_are_loaded_ahead(kept):
    programs.keep_programs(kept.folder)
    with programs.load_ahead("a run"):
        assert not programs._STORE.ahead and kept()
    with programs.load_ahead("another run"):
        assert not programs._STORE.ahead
    with programs.load_ahead("a run"):
        (ahead,) = programs._STORE.ahead.values()
        assert callable(ahead.result()) and not kept()
        assert not programs._STORE.ahead
    for file in kept.folder.iterdir():
        spoil(file, "no program")
    with programs.load_ahead("a run"):
        assert not programs._STORE.ahead and kept()


def test_damaged_program_is_not_taken_ahead(kept):
    programs.keep_programs(kept.folder)
    with programs.load_ahead("a run"):
        kept()
    spoil(max(kept.folder.iterdir(), key=lambda file: file.stat().st_size), "one bit")
    with programs.load_ahead("a run"):
        (ahead,) = programs._STORE.ahead.values()
        assert ahead.result() is None and kept()
    assert not kept()


def test_program_with_callback_is_not_stored(store, monkeypatch):
    """A file cannot hold a function of Python; it runs all the same."""
    calls = []

    def called_back(x):
        return jax.pure_callback(lambda x: calls.append(1) or 2.0 * x, x, x)

    called_back.__module__, called_back.__qualname__ = programs.__name__, "called_back"
    called_back = programs.program(called_back)
    monkeypatch.setattr(programs, "called_back", called_back, raising=False)
    for _ in range(2):
        assert called_back(jnp.array(3.0)) == 6.0
    assert len(calls) == 2 and not list(store.iterdir())


def test_program_is_traced_once_for_each_structure(store, monkeypatch):
    traced = []

    def scaled(x, *, factor):
        traced.append(factor)
        return {"scaled": factor * x, "factor": factor}

    scaled.__module__, scaled.__qualname__ = programs.__name__, "scaled"
    scaled = programs.program(scaled, quick=True)
    monkeypatch.setattr(programs, "scaled", scaled, raising=False)
    for x in (np.ones(2), 2.0 * jnp.ones(2)):
        assert np.array_equal(scaled(x, factor=3)["scaled"], 3 * x)
    assert traced == [3] and scaled(jnp.ones(2), factor=4)["factor"] == 4
    programs.keep_programs(store)  # nothing at hand, all in the folder
    assert np.array_equal(scaled(jnp.ones(2), factor=3)["scaled"], [3.0, 3.0])
    assert traced == [3, 4] and len(list(store.iterdir())) == 2
    # Within another program, under transformations, and with keys of random numbers.
    slope = jax.grad(lambda x: jnp.sum(scaled(x, factor=3)["scaled"]))(jnp.ones(2))
    assert np.array_equal(slope, [3.0, 3.0])
    assert jax.vmap(lambda x: scaled(x, factor=3)["scaled"])(jnp.ones(2)).shape == (2,)
    whole = jax.jit(lambda: scaled(jnp.ones(2), factor=3)["scaled"])
    assert np.array_equal(whole(), [3.0, 3.0])
    assert len(list(store.iterdir())) == 2


OF_LAPACK = """
import sys

import jax

jax.config.update("jax_enable_x64", True)

import bearingjax as bj
from bearingjax.numerics.compiled import programs

bj.keep_programs(sys.argv[1])
programs._libraries = lambda lowered: print("lowered") or {"lapack_dgeev_ffi"}
shaft = bj.rotor.Shaft([0.0, 0.2], outer_diameter=0.02)
springs = [bj.rotor.LinearSupport(k, 1e6 * jax.numpy.eye(5)) for k in (0, 1)]
rotor = bj.rotor.Rotor(shaft, supports=springs)
print(*bj.rotor.modes(rotor, 100.0, count=2).frequency)
"""


@pytest.mark.slow
def test_stored_program_with_lapack_loads_in_new_process(tmp_path):
    """JAX finds LAPACK when it lowers a call of it; without, the program crashed."""
    folder = str(tmp_path / "programs")
    first, second = (
        subprocess.run(
            [sys.executable, "-c", OF_LAPACK, folder],
            capture_output=True,
            text=True,
            check=True,
        )
        for _ in range(2)
    )
    assert "lowered" in first.stdout and "lowered" not in second.stdout
    assert first.stdout.splitlines()[-1:] == second.stdout.splitlines()
    assert second.stderr == ""


BESIDE_JAX = """
import pathlib
import sys

import jax

here = pathlib.Path(sys.argv[1])
jax.config.update("jax_compilation_cache_dir", str(here / "jax"))
jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
jax.config.update("jax_persistent_cache_min_entry_size_bytes", 0)

import jax.numpy as jnp

from bearingjax.numerics.compiled import programs

def doubled(a, b):
    print("traced")
    return 2.0 * a + b

doubled.__module__, doubled.__qualname__ = programs.__name__, "doubled"
programs.doubled = doubled = programs.program(doubled, quick=True)
(here / "no folder").write_text("")
for name in ("no folder", "folder", "folder"):
    given = jnp.array([1.0, 2.0]), jnp.array(0.5)
    programs.keep_programs(here / name)
    print(doubled(*given))
"""


def test_stored_program_beside_jax_compilation_cache(tmp_path):
    """What JAX's own cache has of it would lack its functions when kept once more."""
    done = subprocess.run(
        [sys.executable, "-c", BESIDE_JAX, tmp_path],
        capture_output=True,
        text=True,
        check=True,
    )
    assert list((tmp_path / "jax").iterdir())
    lines = done.stdout.splitlines()
    assert [line for line in lines if line != "traced"] == 3 * ["[2.5 4.5]"]
    assert lines.count("traced") == 2  # the last call is that of the kept program


def spoil(path, how):
    if how == "empty":
        path.write_bytes(b"")
    elif how == "cut short":
        path.write_bytes(path.read_bytes()[:-100])
    elif how == "one bit":
        content = bytearray(path.read_bytes())
        content[-200] ^= 1
        path.write_bytes(bytes(content))
    elif how == "no program":
        path.write_bytes(b"something else")
    elif how == "writable by the group":
        path.chmod(0o620)
    elif how == "writable by all":
        path.chmod(0o602)
    elif how == "a link":
        path.rename(path.with_name("moved"))
        path.symlink_to("moved")
    elif how == "a folder":
        path.unlink()
        path.mkdir()


HOWS = (
    "empty",
    "cut short",
    "one bit",
    "no program",
    "writable by the group",
    "writable by all",
    "a link",
    "a folder",
)


@pytest.mark.parametrize("how", HOWS)
def test_untrusted_program_file_is_recompiled(kept, how, capsys):
    kept()
    (path,) = kept.folder.iterdir()
    spoil(path, how)
    assert kept()
    assert how == "a folder" or not kept()  # replaced by a sound one
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("how", ["group", "all", "link", "owner", "full", "no folder"])
def test_untrusted_program_folder_is_not_used(kept, monkeypatch, how, capsys):
    kept()
    folder = kept.folder
    before = sorted(folder.iterdir())
    if how in ("group", "all"):
        folder.chmod(0o770 if how == "group" else 0o707)
    elif how == "link":
        folder.rename(folder.with_name("moved"))
        folder.symlink_to("moved")
    elif how == "owner":
        me = os.geteuid()
        monkeypatch.setattr(os, "geteuid", lambda: me + 1)
    elif how == "full":

        def refuse(*_, **__):
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(os, "replace", refuse)
    else:
        for path in before:
            path.unlink()
        folder.rmdir()
        folder.write_bytes(b"")
    assert kept(word="y") and kept(word="y")
    if how != "no folder":
        assert sorted(folder.iterdir()) == before
    assert capsys.readouterr() == ("", "")


def test_store_evicts_least_recently_used_program(kept, monkeypatch):
    kept(word="old")
    (old,) = kept.folder.iterdir()
    os.utime(old, (1, 1))
    kept(word="used")
    (used,) = set(kept.folder.iterdir()) - {old}
    os.utime(used, (2, 2))
    monkeypatch.setattr(programs, "LARGEST_STORE", int(2.5 * old.stat().st_size))
    kept(word="old")  # from its file, which is thereby the youngest
    kept(word="new")
    names = set(kept.folder.iterdir())
    assert old in names and used not in names and len(names) == 2


def test_stored_program_failing_to_run_is_recompiled(kept, monkeypatch):
    assert kept()

    def broken(arrays):
        raise jax.errors.JaxRuntimeError("NOT_FOUND: Function")

    with monkeypatch.context() as here:
        here.setattr(programs, "_read_program", lambda place, name: lambda: broken)
        assert kept()
    assert not kept()


def test_program_with_unknown_xla_option_still_compiles(kept, monkeypatch):
    monkeypatch.setattr(programs, "OPTIONS", ({"xla_no_such_option": True},))
    assert kept() and not kept()


OF_TWO_DEVICES = """
import sys

import jax

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_num_cpu_devices", 2)

import numpy as np

import bearingjax as bj

bj.keep_programs(sys.argv[1])
element = bj.read_scene("tapered").element
loads = np.zeros((5, 6)) + [0.0, -1e3, 500.0, 0.0, 0.0, 0.0]
swept = [bj.sweep(element, bj.Cases(loads * k)) for k in (1.0, 2.0)]
print([s.converged.all() for s in swept], swept[1].displacement[:, 7])
for device in jax.devices():
    load = jax.device_put(loads[0], device)
    there = jax.device_put(element, device)
    print(bj.solve_load(there, load).displacement[6:9])
"""


@pytest.mark.slow
def test_programs_over_devices_and_on_another_one(tmp_path):
    """Sweeps over devices are kept; arrays on another device are solved there."""
    folder = str(tmp_path / "programs")
    first, second = (
        subprocess.run(
            [sys.executable, "-c", OF_TWO_DEVICES, folder],
            capture_output=True,
            text=True,
            check=True,
        ).stdout.splitlines()
        for _ in range(2)
    )
    assert first == second
    assert first[0].startswith("[np.True_, np.True_]")
    assert first[-2] == first[-1]
