"""Strict JAX for every test: float64, no silent promotion, typed calls."""

import jax
from jaxtyping import install_import_hook

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_numpy_rank_promotion", "raise")
jax.config.update("jax_numpy_dtype_promotion", "strict")

# Shapes and dtypes of annotated functions are checked at every call of the tests.
install_import_hook("bearingjax", "beartype.beartype").__enter__()
