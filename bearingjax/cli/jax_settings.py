"""How the command line sets JAX up, and where it keeps compiled programs."""

import contextlib
import os
import sys
import warnings
from pathlib import Path

from .status import complain


def configure(options) -> None:
    """float64, and compiled programs kept from one run to the next."""
    # Matrices here are small: threads of LAPACK would only wait for each other, and
    # thirty times as long beside other work. Read when SciPy is first imported.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

    import jax

    from ..numerics.programs import keep_programs, user_cache

    # XLA prints a page of false alarms about CPU features when it loads a kept program.
    jax.config.update("jax_logging_level", "CRITICAL")

    jax.config.update("jax_enable_x64", True)
    if options.command == "sweep":
        count = devices(options)
        with contextlib.suppress(RuntimeError):  # JAX runs already, in a test
            jax.config.update("jax_num_cpu_devices", count)
    # Where in the sources an operation was written is of no use to a user.
    jax.config.update("jax_include_full_tracebacks_in_locations", False)
    if getattr(jax.config, "jax_compilation_cache_dir", None) is None:
        cache = user_cache() / "jax"
        # JAX would warn of every program that it cannot keep, among our own warnings.
        with contextlib.suppress(OSError):
            cache.mkdir(mode=0o700, parents=True, exist_ok=True)
            if os.access(cache, os.W_OK | os.X_OK) and not _is_shared(cache):
                jax.config.update("jax_compilation_cache_dir", str(cache))
    message = ".*persistent compilation cache.*"  # such as of a full disk
    warnings.filterwarnings("ignore", message)
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", 0)
    keep_programs(keep=jax.config.values["jax_enable_compilation_cache"])


def devices(options) -> int:
    """Parts of the processor that a sweep uses: as many as asked for, or all cores."""
    from ..scene import SceneError

    linux = sys.platform == "linux"
    cores = len(os.sched_getaffinity(0)) if linux else os.cpu_count() or 1
    count = cores if options.devices is None else options.devices
    if not 1 <= count <= cores:
        allowed = f"it must be at least 1 and at most {cores}, the cores that there are"
        raise SceneError(f"--devices is {count}; {allowed}")
    return count


def _is_shared(folder: Path) -> bool:
    """Whether others can write what would be run from there; says so."""
    from ..numerics.programs import is_private

    shared = hasattr(os, "geteuid") and not is_private(folder.lstat())
    if shared:
        problem = "is not yours alone to write, so no compiled programs are kept there"
        complain(f"{folder}: {problem}")
    return shared
