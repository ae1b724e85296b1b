"""Strict JAX for every test: float64, no silent promotion, typed calls."""

import gc
import os

import jax
import pytest
from jaxtyping import install_import_hook

# The tests spend their time in the compiler: 40 % less of it without LLVM's optimiser.
# `XLA_FLAGS= pytest` tests the programs as users compile them.
os.environ.setdefault("XLA_FLAGS", "--xla_backend_optimization_level=0")

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_numpy_rank_promotion", "raise")
jax.config.update("jax_numpy_dtype_promotion", "strict")

# Shapes and dtypes of annotated functions are checked at every call of the tests.
install_import_hook("bearingjax", "beartype.beartype").__enter__()


@pytest.fixture(scope="module", autouse=True)
def _drop_compiled_programs():
    """Every compiled program holds memory maps, of which Linux grants 65 530 a process;
    beyond them the compiler dies of a segmentation fault."""
    yield
    jax.clear_caches()
    gc.collect()
