"""Strict JAX for every test: float64, no silent promotion, typed calls."""

import gc
import os

# Every operation with the calls that led to it: slow to write, and not read here.
# Processes that the tests start do without too.
os.environ.setdefault("JAX_INCLUDE_FULL_TRACEBACKS_IN_LOCATIONS", "false")

import hypothesis
import jax
import jaxtyping
import pytest
from jaxtyping import install_import_hook

# The tests spend much of their time in the compiler. They do without LLVM's optimiser,
# the newer emitters, and programs in parts for threads that other tests need as well.
# `XLA_FLAGS= pytest` tests the programs as users compile them. A flag that XLA does not
# know ends the process: the later ones only where they were tried.
FLAGS = "--xla_backend_optimization_level=0"
if jax.__version__ == "0.10.1":
    FLAGS += " --xla_cpu_use_fusion_emitters=false"
    FLAGS += " --xla_cpu_parallel_codegen_split_count=1"
os.environ.setdefault("XLA_FLAGS", FLAGS)
# One thread within a program. Two may wait for each other for ever: jaxlib 0.10 divides
# a batch of matrices among the threads by one of them, which waits for the others.
os.environ.setdefault("PJRT_NPROC", "1")

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_numpy_rank_promotion", "raise")
jax.config.update("jax_numpy_dtype_promotion", "strict")

# Tracing makes many small objects; searching them for cycles took a sixth of the time.
gc.set_threshold(1_000_000, 10, 50)

# Shapes and dtypes of annotated functions are checked at every call of the tests.
install_import_hook("bearingjax", "type_hook.check_types").__enter__()

# Properties: the same examples in every run, but for `--hypothesis-profile=random`. No
# deadline, as a first example compiles.
for name, examples, same in (
    ("fast", 25, True),
    ("long", 150, True),
    ("random", 1000, False),
):
    hypothesis.settings.register_profile(
        name,
        max_examples=examples,
        derandomize=same,
        deadline=None,
        database=None,
        print_blob=not same,
        suppress_health_check=[hypothesis.HealthCheck.too_slow],
    )
hypothesis.settings.load_profile("fast")


def pytest_addoption(parser):
    parser.addoption(
        "--write-golden", action="store_true", help="write golden files anew"
    )


LONGEST = (
    "test_readme.py",
    "test_identities.py",
    "test_benchmarks.py",
    "test_notebooks.py",
    "test_steady.py",
    "test_rollers.py",
    "test_skidding_bearing.py",
    "test_skid_study.py",
    "test_load.py",
)
"""Begun first: at the end one of them would keep one worker at work alone."""


def pytest_configure(config):
    # pytest-xdist would begin with the files of many tests, not the long ones.
    if hasattr(config.option, "loadscopereorder"):
        config.option.loadscopereorder = False


def pytest_collection_modifyitems(items):
    items.sort(key=lambda item: item.path.name not in LONGEST)


def pytest_collection_finish():
    # What the imports made stays: after each module it took 0.3 s to look there.
    gc.collect()
    gc.freeze()


MOST_MAPS = 10_000


def _memory_maps():
    """Of this process; on systems without a list of them: too many."""
    try:
        with open("/proc/self/maps") as maps:
            return sum(1 for _ in maps)
    except OSError:
        return MOST_MAPS + 1


@pytest.fixture(scope="module", autouse=True)
def _drop_compiled_programs():
    """Every compiled program holds memory maps, of which Linux grants 65 530 a process;
    beyond them the compiler dies of a segmentation fault. A module makes some thousand;
    what several modules call stays compiled as long as there is room."""
    yield
    if _memory_maps() > MOST_MAPS:
        jax.clear_caches()
        gc.collect()


@pytest.fixture(scope="session", autouse=True)
def _no_progress():
    """Runs of commands here do not say what they are at, however long it takes."""
    from bearingjax.studies import outcome

    outcome.PATIENCE = float("inf")


@pytest.fixture
def untyped():
    """As users run the package: without the type checks of the tests' conftest."""
    before = jaxtyping.config.jaxtyping_disable
    jaxtyping.config.update("jaxtyping_disable", True)
    yield
    jaxtyping.config.update("jaxtyping_disable", before)
