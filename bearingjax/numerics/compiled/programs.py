"""Compiled programs, kept from one process to the next.

Commands and starting scripts spend their time on tracing and compiling, not on
solving. Once `keep_programs` is called, the executable of every `program` of this
package is kept in a file. A later process that calls it with inputs of the same
structure loads it and neither traces, lowers nor compiles.

A kept executable is unpickled, and may then run any code. So it is read only from
a folder and a file that belong to the user and that no other user can write.
"""

import contextlib
import functools
import hashlib
import os
import pickle
import platform
import re
import stat
import sys
import threading
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax.core import Tracer

from .. import lapack
from .structure import UnknownStructure, structure

OPTIONS = tuple(
    {"xla_backend_optimization_level": level, "xla_cpu_use_fusion_emitters": False}
    for level in range(2)
)
"""XLA's options for programs whose runs are short compared with their compilation, by
levels."""

QUICK_COMPILATION = OPTIONS[1]
"""Options of XLA, for `jax.jit(f, compiler_options=QUICK_COMPILATION)`: functions of
this package compile in two thirds of the time and run as fast, on a CPU."""

LARGEST_STORE = 1024 * 1024 * 1024
"""Size of all that a folder keeps; what was not used for longest goes first [byte]."""

_MARK = b"bearingjax program\n"


class _Place(NamedTuple):
    """Placeholder of an array in the result of a program."""

    number: int


class _Program(NamedTuple):
    """Stored form of a program, for `pickle`.

    Attributes:
        executable: From `jax.experimental.serialize_executable`.
        inputs: Number of its arguments, all arrays.
        outputs: Result of the function, with a `_Place` for every array.
        n_outputs: Number of arrays that it returns.
        lapack: Whether it calls LAPACK.
        devices: Number of devices that it runs on.
    """

    executable: bytes
    inputs: int
    outputs: Any
    n_outputs: int
    lapack: bool
    devices: int


class _Store:
    """Folder of the kept programs, and those loaded in this process."""

    folder: Path | None = None
    few_calls: bool = False
    at_hand: dict[str, Callable]
    ahead: dict[str, Future]
    structures: dict[Any, str]
    telling: Callable[[str], contextlib.AbstractContextManager] | None = None
    compiled: Counter[str]

    def __init__(self):
        self.at_hand, self.ahead, self.structures = {}, {}, {}
        self.compiled = Counter()


_STORE = _Store()
F = TypeVar("F", bound=Callable)


def keep_programs(
    folder: str | Path | None = None, *, keep: bool = True, few_calls: bool = False
) -> None:
    """Keep the compiled programs of this package from one process to the next.

    Holds for solves, rotors, noise and skidding that are called from Python as they
    are; what your own `jax.jit` compiles, JAX's cache of compiled programs may keep.

    Args:
        folder: Their folder; `None`: `bearingjax/programs` in the user's cache
            (`XDG_CACHE_HOME`, or `~/.cache`). It is made if there is none; if others
            can write there, nothing is read or kept. 1 GB at most, those that were
            not used for longest go first.
        keep: Whether to keep them; `False` ends it.
        few_calls: Whether each is called a few times only, as by a command: a load
            solve then compiles in three quarters of the time, and takes up to twice as
            long. Such programs are kept beside the others.
    """
    if folder is None:
        folder = user_cache() / "programs"
    _STORE.folder = Path(folder) if keep else None
    _STORE.few_calls = few_calls
    _STORE.at_hand.clear()


@contextlib.contextmanager
def load_ahead(run: str) -> Iterator[None]:
    """Context of a run whose programs are loaded while it begins, in a thread.

    They are those that the last run of this name used; those of this one are noted.

    Args:
        run: Name of the run, such as its command and scene.
    """
    name = hashlib.sha256(f"{run}\n{_sources()}".encode()).hexdigest()
    if _STORE.folder is None:
        yield
        return
    with _open_folder(_STORE.folder) as place, ThreadPoolExecutor(1) as thread:
        noted = b""
        with contextlib.suppress(OSError):  # the first of this name
            noted = b"" if place is None else _read(place, name) or b""
        for one in noted.decode().split():
            _STORE.ahead[one] = thread.submit(_read_program(place, one))
        try:
            yield
        finally:
            thread.shutdown(cancel_futures=True)
            _STORE.ahead.clear()
        used = " ".join(_STORE.at_hand).encode()
        if place is not None and used != noted:
            _write(place, name, used)


def tell_compiling(telling: Callable[[str], Any] | None) -> None:
    """Have it said what is compiled, while it is, in place of what is kept.

    Args:
        telling: Words -> context that is entered meanwhile; `None`: nothing is said.
    """
    _STORE.telling = telling


def n_compiled() -> int:
    """Return how many programs this process has compiled in order to keep them."""
    return _STORE.compiled.total()


def _compiling(function: Callable) -> contextlib.AbstractContextManager:
    """Context in which a program is compiled, about which `tell_compiling` asked.

    Those of like words are numbered: no two lines are alike, and look like a hang.
    """
    what = _WHAT.get(_place_of(function), function.__module__.split(".")[1])
    _STORE.compiled[what] += 1
    if _STORE.telling is None:
        return contextlib.nullcontext()
    words = f"{what}, program {_STORE.compiled[what]} (each only once)"
    return _STORE.telling(f"compiling: {words}")


def _place_of(function: Callable) -> str:
    return f"{function.__module__}.{function.__qualname__}"


_WHAT: dict[str, str] = {}
"""What programs do, in words, by the names of their functions; others are called by
their package."""


def user_cache() -> Path:
    """Return the folder of this user's cache files of the package."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "bearingjax"


def program(
    function: F | None = None,
    *,
    quick: bool = False,
    level: int = 0,
    often: bool = False,
    what: str | None = None,
) -> F:
    """Compile as `equinox.filter_jit`; programs are kept if `keep_programs` is called.

    Args:
        function: Function of a module of this package, found there by its name; depends
            on its arguments only.
        quick: Whether kept programs are compiled for the shortest wait, `OPTIONS`, as
            suits a short run.
        level: Which of `OPTIONS` then: 0 for a run of less than a second, 1 for one of
            seconds, which is as fast as if compiled with all effort where matrices are
            small.
        often: Whether scripts call it in loops: level 1 then, but with `few_calls` of
            `keep_programs`.
        what: What it does, in words, for `tell_compiling`; `None`: that of its package.
    """
    if function is None:
        return functools.partial(  # pyright: ignore
            program, quick=quick, level=level, often=often, what=what
        )
    if what is not None:
        _WHAT[_place_of(function)] = what

    @functools.cache
    def jitted():  # takes a millisecond, which most programs of an import never need
        return eqx.filter_jit(function)

    @functools.wraps(function)
    def call(*args, **kwargs):
        given = jax.tree.map(_as_array, (args, kwargs))
        name = _name(call, given) if _can_keep(given) else None
        if name is None:
            return jitted()(*args, **kwargs)
        chosen = OPTIONS[1 if often and not _STORE.few_calls else level]
        return _run_kept(name, function, given, chosen if quick else {})

    return call  # pyright: ignore


def _can_keep(given: tuple) -> bool:
    """Whether a call may be one of a kept program: of its own, on the first CPUs."""
    if _STORE.folder is None or jax.config.values["jax_disable_jit"]:
        return False
    if jax.default_backend() != "cpu" or jax.process_count() > 1:
        return False
    devices = jax.devices()
    return not any(
        isinstance(x, Tracer)
        or jnp.issubdtype(x.dtype, jax.dtypes.prng_key)
        or x.devices() != set(devices[: len(x.devices())])
        for x in jax.tree.leaves(given)
        if isinstance(x, jax.Array)
    )


def _as_array(leaf: Any) -> Any:
    # `jnp.asarray` would compile a program for every shape.
    return jax.device_put(leaf) if isinstance(leaf, np.ndarray | np.generic) else leaf


def _run_kept(name: str, function: Callable, given: tuple, options: dict) -> Any:
    """Result of a program at hand, of one that was kept, or of one made now.

    Args:
        name: Name of its file.
        function: The function.
        given: Its arguments and keyword arguments.
        options: Options of the compiler.
    """
    assert _STORE.folder is not None  # checked by `_can_keep`
    flat = _flatten_function(lambda args, kwargs: function(*args, **kwargs), given)
    run = _STORE.at_hand.get(name)
    if run is not None:
        return run(flat[1])
    _STORE.at_hand[name], found = _first_run(
        flat, name, _STORE.folder, options, function
    )
    return found


def _first_run(
    flat: tuple, name: str, folder: Path, options: dict, called: Callable
) -> tuple[Callable, Any]:
    """Load or compile a program, and run it; return the program and its result.

    Args:
        flat: From `_flatten_function`.
        name: Name of its file.
        folder: As in `keep_programs`.
        options: Options of the compiler.
        called: Function that was called, for `tell_compiling`.
    """
    function, arrays, outputs = flat
    with _open_folder(folder) as place:
        ahead = _STORE.ahead.pop(name, None)
        kept = _read_program(place, name)() if ahead is None else ahead.result()
        if kept is not None:
            # A program of another jaxlib may lack a function.
            with contextlib.suppress(jax.errors.JaxRuntimeError):
                return kept, kept(arrays)
        with _compiling(called):
            lowered = jax.jit(function).lower(*arrays)
            libraries = _libraries(lowered)
            keep = place is not None and all(x.startswith("lapack_") for x in libraries)
            compiled = _compile(lowered, options, keep)
        if keep:
            devices = max((len(array.devices()) for array in arrays), default=1)
            more = len(arrays), outputs[0], bool(libraries), devices
            _keep(place, name, compiled, *more)

    def run(arrays):
        return _fill(outputs[0], compiled(*arrays))

    return run, run(arrays)


def _flatten_function(
    function: Callable, arguments: tuple
) -> tuple[Callable, list[jax.Array], list]:
    """A function of arrays that returns a list of arrays, as executables are.

    Args:
        function: Function of a module of this package.
        arguments: Nested modules, tuples, dicts; their arrays are traced.

    Returns:
        The function; its arguments; a list that takes up, when the function is
        traced, what is returned with a `_Place` for every array.
    """
    leaves, tree = jax.tree.flatten(arguments)
    traced = [eqx.is_array(leaf) for leaf in leaves]
    arrays = [leaf for leaf, yes in zip(leaves, traced, strict=True) if yes]
    outputs: list[Any] = []

    def flat(*arrays):
        ahead = iter(arrays)
        mixed = [
            next(ahead) if yes else leaf
            for leaf, yes in zip(leaves, traced, strict=True)
        ]
        returned = function(*jax.tree.unflatten(tree, mixed))
        found, shape = jax.tree.flatten(returned)
        values = [leaf for leaf in found if eqx.is_array(leaf)]
        count = iter(range(len(values)))
        marked = [_Place(next(count)) if eqx.is_array(leaf) else leaf for leaf in found]
        outputs.append(jax.tree.unflatten(shape, marked))
        return values

    return flat, arrays, outputs


def _libraries(lowered) -> set[str]:
    """Functions outside of XLA that a program calls: LAPACK, or back into Python."""
    return set(re.findall(r"custom_call @(\w+)", lowered.as_text()))


def _fill(outputs: Any, values: list) -> Any:
    def is_place(leaf):
        return isinstance(leaf, _Place)

    return jax.tree.map(
        lambda leaf: values[leaf.number] if is_place(leaf) else leaf,
        outputs,
        is_leaf=is_place,
    )


_ANEW = {
    "jax_persistent_cache_min_compile_time_secs": float("inf"),
    "jax_compilation_cache_include_metadata_in_key": True,
}
"""Settings with which JAX's own cache neither takes up a program nor has it: what comes
from there lacks functions when it is kept once more (jaxlib 0.10)."""


def _compile(lowered, options: dict, keep: bool):
    """Compile, once in this process; kept programs bypass JAX's own cache."""
    before = {name: jax.config.values[name] for name in _ANEW}
    for name, value in _ANEW.items() if keep else ():
        jax.config.update(name, value)
    try:
        return lowered.compile(compiler_options=options)
    except jax.errors.JaxRuntimeError:
        # Another version of XLA, which does not know an option.
        return lowered.compile()
    finally:
        for name, value in before.items():
            jax.config.update(name, value)


def _name(function: Callable, arguments: tuple) -> str | None:
    """Name of the file of a program, or `None` if no name identifies it reliably."""
    try:
        words = [_structure(function, arguments), *_surroundings()]
    except UnknownStructure:
        return None
    return hashlib.sha256("\n".join(words).encode()).hexdigest()


def _structure(function: Callable, arguments: tuple) -> str:
    """Return `structure` of a call, which is remembered: it takes longer than many a
    program."""
    leaves, tree = jax.tree.flatten(arguments)
    kinds = [
        (x.shape, x.dtype, x.weak_type) if isinstance(x, jax.Array) else (type(x), x)
        for x in leaves
    ]
    met = function, tree, tuple(kinds)
    try:
        known = _STORE.structures.get(met)
    except TypeError:  # something that has no hash
        return structure((function, arguments))
    if known is None:
        known = _STORE.structures[met] = structure((function, arguments))
    return known


def _surroundings() -> Iterator[str]:
    """Other inputs of the compilation: sources, versions, settings, machine."""
    yield _sources()
    yield _versions()
    places = ("jax_compilation_cache_dir", "jax_logging_level")
    yield repr(sorted((k, v) for k, v in jax.config.values.items() if k not in places))
    yield os.environ.get("XLA_FLAGS", "")
    yield repr((OPTIONS, _STORE.few_calls))
    yield repr([device.device_kind for device in jax.devices()])
    yield _processor()


@functools.cache
def _versions() -> str:
    names = ("bearingjax", "jax", "jaxlib", "equinox", "numpy")
    return " ".join((sys.version, *map(version, names)))


@functools.cache
def _sources() -> str:
    """Digest of the sources of this package."""
    top = Path(__file__).parents[2]
    digest = hashlib.sha256()
    for path in sorted(top.rglob("*.py")):
        text = path.read_bytes()
        digest.update(f"{path.relative_to(top)} {len(text)}\n".encode() + text)
    return digest.hexdigest()


@functools.cache
def _processor() -> str:
    """Features of the processor, or a description of the machine."""
    names = ("vendor_id", "cpu family", "model", "stepping", "flags", "Features")
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            first = [line for line in iter(lines.readline, "\n") if line]
    except OSError:
        return repr(platform.uname())
    described = [line for line in first if line.split("\t")[0].split(":")[0] in names]
    return platform.machine() + "".join(described)


@contextlib.contextmanager
def _open_folder(folder: Path) -> Iterator[int | None]:
    """A folder that the user alone can write, as a file descriptor; else `None`."""
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with contextlib.suppress(FileExistsError):
            folder.mkdir(mode=0o700)
        place = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except (OSError, AttributeError):  # such flags there are not on every system
        yield None
        return
    try:
        yield place if is_private(os.fstat(place)) else None
    finally:
        os.close(place)


def is_private(status: os.stat_result) -> bool:
    """Whether a file or folder is the user's own and no other user can write it.

    Args:
        status: Status of the file or folder; of a link, which is none, from `os.lstat`.
    """
    shared = stat.S_IWGRP | stat.S_IWOTH
    kind = stat.S_ISREG(status.st_mode) or stat.S_ISDIR(status.st_mode)
    return kind and status.st_uid == os.geteuid() and not status.st_mode & shared


def _read_program(place: int | None, name: str) -> Callable[[], Callable | None]:
    """Read a kept program; return what loads it as a function of a list of arrays.

    That returns `None` if there is none, and may be called in a thread.
    """
    try:
        content = None if place is None else _read(place, name)
        if content is None:
            return lambda: None
        from jax.experimental.serialize_executable import deserialize_and_load

        program: _Program = pickle.loads(content)
        if program.lapack:
            lapack.prepare()
    except Exception:  # a damaged file may raise anything
        return lambda: None

    def load():
        inputs = jax.tree.structure((tuple(range(program.inputs)), {}))
        outputs = jax.tree.structure([0] * program.n_outputs)
        devices = jax.devices()[: program.devices]
        try:
            with _silence_xla():
                run = deserialize_and_load(
                    program.executable, inputs, outputs, execution_devices=devices
                )
        except Exception:
            return None
        return lambda arrays: _fill(program.outputs, run(*arrays))

    return load


_LOCK = threading.Lock()


@contextlib.contextmanager
def _silence_xla():
    """Silence XLA, which takes preferences of its own for features that the CPU lacks.

    The name of a kept program has the CPU in it: its features are the same.
    """
    with _LOCK:
        level = getattr(jax.config, "jax_logging_level")  # noqa: B009
        jax.config.update("jax_logging_level", "CRITICAL")
        try:
            yield
        finally:
            jax.config.update("jax_logging_level", level)


def _read(place: int, name: str) -> bytes | None:
    """Content of a kept file, if it is whole and the user's own."""
    file = os.open(name, os.O_RDONLY | os.O_NOFOLLOW, dir_fd=place)
    with open(file, "rb") as stream:
        status = os.fstat(file)
        if not is_private(status):
            return None
        whole = stream.read()
        os.utime(file)  # used just now
    size = len(_MARK) + hashlib.sha256().digest_size
    head, content = whole[:size], whole[size:]
    return content if head == _MARK + hashlib.sha256(content).digest() else None


def _keep(place, name, compiled, inputs, outputs, *more) -> None:
    """Keep a program; without a word if it cannot be, as on a full disk."""
    from jax.experimental.serialize_executable import serialize

    with contextlib.suppress(Exception):
        executable, _, tree = serialize(compiled)
        program = _Program(executable, inputs, outputs, tree.num_leaves, *more)
        _write(place, name, pickle.dumps(program))


def _write(place: int, name: str, content: bytes) -> None:
    """Keep a file whole, or not at all."""
    temporary = f"{name}.{os.getpid()}"
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
    with contextlib.suppress(OSError):
        file = os.open(temporary, flags, 0o600, dir_fd=place)
        try:
            with open(file, "wb") as stream:
                stream.write(_MARK + hashlib.sha256(content).digest() + content)
            os.replace(temporary, name, src_dir_fd=place, dst_dir_fd=place)
            _drop_oldest(place)
        except OSError:
            os.unlink(temporary, dir_fd=place)


def _drop_oldest(place: int) -> None:
    """Remove the least recently used files until the rest is small enough."""
    found = []
    for name in os.listdir(place):
        with contextlib.suppress(OSError):  # another run may drop it at the same time
            status = os.stat(name, dir_fd=place, follow_symlinks=False)
            found.append((status.st_mtime, status.st_size, name))
    total = 0
    for _, size, name in sorted(found, reverse=True):
        total += size
        if total > LARGEST_STORE:
            with contextlib.suppress(OSError):
                os.unlink(name, dir_fd=place)
