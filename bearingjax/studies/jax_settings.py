"""JAX settings of the command line, and its cache of compiled programs."""

import contextlib
import os
import sys
import warnings
from argparse import Namespace
from pathlib import Path

from .status import complain


def configure(options: Namespace) -> None:
    """Enable float64, and the cache of compiled programs between runs."""
    # Matrices are small: LAPACK threads would only wait for each other, thirty times as
    # long on a busy machine. Read when SciPy is first imported.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if options.command == "noise":
        # Its steps of some microseconds take 1.4 times as long if a thread hands them
        # to another. Read when JAX first runs something.
        os.environ.setdefault("PJRT_NPROC", "1")

    import jax

    from ..numerics.compiled.programs import keep_programs, user_cache

    # XLA prints false warnings about CPU features when it loads a cached program.
    jax.config.update("jax_logging_level", "CRITICAL")

    jax.config.update("jax_enable_x64", True)
    if options.command == "sweep":
        count = devices(options)
        with contextlib.suppress(RuntimeError):  # JAX runs already, in a test
            jax.config.update("jax_num_cpu_devices", count)
    # Source locations of operations are of no use to a user.
    jax.config.update("jax_include_full_tracebacks_in_locations", False)
    if getattr(jax.config, "jax_compilation_cache_dir", None) is None:
        cache = user_cache() / "jax"
        # JAX would warn of every program that it cannot cache.
        with contextlib.suppress(OSError):
            cache.mkdir(mode=0o700, parents=True, exist_ok=True)
            if os.access(cache, os.W_OK | os.X_OK) and not _is_shared(cache):
                jax.config.update("jax_compilation_cache_dir", str(cache))
    message = ".*persistent compilation cache.*"  # such as of a full disk
    warnings.filterwarnings("ignore", message)
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", 0)
    keep = jax.config.values["jax_enable_compilation_cache"]
    keep_programs(keep=keep, few_calls=True)


def devices(options: Namespace) -> int:
    """Return the number of CPU devices of a sweep: as requested, or all cores."""
    from ..files import SceneError

    linux = sys.platform == "linux"
    cores = len(os.sched_getaffinity(0)) if linux else os.cpu_count() or 1
    count = cores if options.devices is None else options.devices
    if not 1 <= count <= cores:
        allowed = f"it must be at least 1 and at most {cores}, the cores that there are"
        raise SceneError(f"--devices is {count}; {allowed}")
    return count


def _is_shared(folder: Path) -> bool:
    """Whether others can write to the program cache; prints a warning if so."""
    from ..numerics.compiled.programs import is_private

    shared = hasattr(os, "geteuid") and not is_private(folder.lstat())
    if shared:
        problem = "is not yours alone to write, so no compiled programs are kept there"
        complain(f"{folder}: {problem}")
    return shared
