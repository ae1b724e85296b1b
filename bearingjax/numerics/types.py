"""Number types shared by every layer."""

from typing import TYPE_CHECKING, Any, TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from jax.core import Tracer
from jaxtyping import Array, Bool, Float, Int

Count = Int[Array, ""]
Flag = Bool[Array, ""]
Ring = Float[Array, "12"]
RingStiffness = Float[Array, "12 12"]
T = TypeVar("T")

if TYPE_CHECKING:
    Scalar = Float[Array, ""]

    class Real:
        """Number of a field that `as_real` converts: set from any, read as an array."""

        def __get__(self, owner: Any, kind: Any = None) -> Array: ...

        def __set__(self, owner: Any, value: Any) -> None: ...

    class RealOrNone:
        """The same of a field that may be `None`."""

        def __get__(self, owner: Any, kind: Any = None) -> Array | None: ...

        def __set__(self, owner: Any, value: Any) -> None: ...

else:
    # A design or result that was brought to NumPy has its numbers there.
    Scalar = Float[Array | np.ndarray | np.floating, ""]
    Real = Scalar
    RealOrNone = Scalar | None

Number = Scalar | float
"""One number as users write it: of Python, or an array without axes."""
Reals = Float[Array, "..."]
"""Real numbers in an array of any shape."""
Vector = Float[Array, " n"]
Square = Float[Array, "n n"]
"""Row of n numbers, and matrix of n rows; in one function all have the same n."""


def array_namespace(*arrays: Any) -> Any:
    """Return NumPy for its own arrays, to avoid compilation; `jax.numpy` for others.

    Args:
        arrays: Any arrays or scalars of one of them; NumPy's only if all are.
    """
    known = all(isinstance(array, np.ndarray | np.generic) for array in arrays)
    return np if known else jnp


def in_numpy(tree: T) -> T:
    """Return the same with its known numbers in NumPy, to avoid compilation.

    Args:
        tree: Modules, tuples, dicts; what is traced stays as it is.
    """

    def to_numpy(leaf):
        is_known = isinstance(leaf, jax.Array) and not isinstance(leaf, Tracer)
        return np.asarray(leaf) if is_known else leaf

    return jax.tree.map(to_numpy, tree)


def as_real(value: Any) -> Any:
    """Converter of every real field: a floating array, never a Python float.

    A Python float in a Module would be static under `jit`: a new value would
    recompile and have no gradient.

    Args:
        value: Number or array-like [any unit].

    Returns:
        float64 array when JAX has 64 bit enabled, float32 otherwise; arrays that
        are floating already keep their dtype, never a weak one. Values that are not
        real numbers (text, bools, `None`, complex numbers, other objects) are returned
        unchanged: the check of the field then names them.
    """
    if isinstance(value, jax.Array) and jnp.issubdtype(value.dtype, jnp.floating):
        # jnp.array(0.43) is of weak type, for which `jit` would recompile.
        return jnp.asarray(value, dtype=value.dtype) if value.weak_type else value
    if value is None or isinstance(value, str | bytes | bool | complex):
        return value
    if getattr(getattr(value, "dtype", None), "kind", "f") in "bc":
        return value
    try:
        return as_array(value, jax.dtypes.canonicalize_dtype(float))
    except (TypeError, ValueError):
        return value


def as_array(value: Any, dtype: Any) -> Array:
    """`jnp.asarray`; values without JAX arrays are cast by NumPy, without compilation.

    Args:
        value: Number or array-like [any unit].
        dtype: Dtype of the result.
    """
    if isinstance(value, jax.Array) and value.dtype == dtype and not value.weak_type:
        return value
    if not any(isinstance(leaf, jax.Array) for leaf in jax.tree.leaves(value)):
        value = np.asarray(value)
        if value.dtype.kind in "biuf":
            value = value.astype(dtype)
    return jnp.asarray(value, dtype=dtype)


def as_count(value: Any) -> Any:
    """Converter of every count: a Python integer, which is static under `jit`.

    Args:
        value: Whole number; NumPy's become Python's, all else comes back unchanged
            for the check of the field to name.
    """
    return int(value) if isinstance(value, np.integer) else value


def with_fields(module: T, **changes: Any) -> T:
    """Return a module with other fields, whose checks are not run anew.

    Args:
        module: Module whose fields were checked.
        changes: Fields that are as valid.
    """
    new = object.__new__(type(module))
    for name, value in {**vars(module), **changes}.items():
        object.__setattr__(new, name, value)
    return new
