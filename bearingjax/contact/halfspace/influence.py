"""Surface displacement by pressure on a grid: products with the influence matrix.

The matrix depends on the distance across the roller only, so that a transform across
makes of it one small matrix along the roller for each frequency. Zero padding makes the
product exact, not periodic. Along the roller cells of one size allow a second
transform; graded ones take the small matrices as they are.

The transform's circulant is filled with true influences, not zeros, where padding
leaves room: convex and falling as they are, its eigenvalues stay positive, and their
inverse is a preconditioner with which the iterations no longer depend on the grid.

Source: zero padding: Liu, Wang, Liu, Wear 243 (2000); preconditioning by the inverse
    circulant: Vollebregt, J. Comput. Phys. 257 (2014). The mixed form is our own.
"""

import abc
from collections.abc import Callable
from functools import partial
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ...numerics.types import Number, as_real
from .grid import Grid
from .love import corner, namespace, strip

_HALVINGS = 7
"""Halvings of the nearest cell across, where the mirrored weight varies."""


class AbstractInfluence(eqx.Module):
    """Displacement of both bodies' surfaces together by pressure on a grid.

    Attributes:
        grid: The cells.
        kernel: Influence for each frequency across, any form [m/Pa].
        inverse_kernel: Kernel of the approximate inverse [Pa/m].

    Traced: all fields.
    """

    grid: Grid
    kernel: Float[Array, "f ..."]
    inverse_kernel: Float[Array, "f ..."]

    def __call__(self, pressure: Float[Array, "... m n"]) -> Float[Array, "... m n"]:
        """Displacement at every cell [m].

        Args:
            pressure: On every cell kept [Pa]; more axes in front are independent.
        """
        return self._apply(self.kernel, pressure)

    def estimate(
        self, displacement: Float[Array, "... m n"]
    ) -> Float[Array, "... m n"]:
        """Pressure that approximately causes this displacement [Pa].

        Self-adjoint and positive, with the areas of the cells as weights.
        """
        return self._apply(self.inverse_kernel, displacement)

    def _apply(self, kernel, field):
        across = _Cosines if self.grid.symmetric else _Waves
        transform = across(self.grid, field.dtype)
        return transform.from_waves(self._multiply(kernel, transform.to_waves(field)))

    @abc.abstractmethod
    def _multiply(self, kernel, waves) -> Any:
        """Products along the roller, frequency by frequency (..., f, n)."""


class EvenInfluence(AbstractInfluence):
    """Influence of cells of one size: values at their centres, by two transforms."""

    def _multiply(self, kernel, waves):
        n = self.grid.shape[1]
        padded = padded_size(n)
        if jnp.iscomplexobj(waves):
            spectrum = jnp.fft.fft(waves, padded, axis=-1)
            both = jnp.concatenate([kernel, kernel[:, -2:0:-1]], axis=1)
            both = both.astype(spectrum.dtype)
            return jnp.fft.ifft(spectrum * _expand(both, spectrum), axis=-1)[..., :n]
        spectrum = jnp.fft.rfft(waves, padded, axis=-1)
        product = spectrum * _expand(kernel.astype(spectrum.dtype), spectrum)
        return jnp.fft.irfft(product, padded, axis=-1)[..., :n]


class GradedInfluence(AbstractInfluence):
    """Influence of cells of unlike lengths: mean values over them, by one transform.

    The mean keeps the matrix symmetric (the influence of a cell on another's load is
    mutual), which point values of unlike cells are not.
    """

    def _multiply(self, kernel, waves):
        kernel = kernel.astype(waves.dtype)
        return jnp.einsum("fjk,...fk->...fj", kernel, waves)


def influence(
    grid: Grid, modulus: Number, mirrored: Callable[..., Any] | None = None
) -> AbstractInfluence:
    """Influence of pressure on a grid.

    Args:
        grid: The cells; the kernel of a graded grid has about n_across·n_along²
            numbers.
        modulus: Contact modulus E* of both bodies [Pa].
        mirrored: Weight with which the pressure acts once more, mirrored at both ends
            of the grid, a function as `MirroredWeight` of `FreeEnds`; `None`: none.
            With it the kernel of an even grid is that of a graded one.
    """
    modulus = as_real(modulus)
    leaves = jax.tree.leaves(mirrored)
    xp = namespace(grid.half_width, grid.edges, modulus, *leaves)
    even = grid.even and mirrored is None
    table = _even_table if even else partial(_graded_table, mirrored=mirrored)
    dtype = grid.half_width.dtype
    # NumPy's double precision where nothing is traced, whatever JAX's.
    work = np.dtype(float) if xp is np else dtype
    half_x, edges, modulus = (
        xp.asarray(v, dtype=work) for v in (grid.half_x, grid.edges, modulus)
    )
    across = padded_size(grid.n_across)
    lags = across // 2 + 1
    values = table(xp, lags, half_x, edges).reshape(lags, -1)
    kernel = xp.asarray(cosine_sums(across), work) @ values / (np.pi * modulus)
    if even:
        along = padded_size(grid.shape[1])
        kernel = kernel @ xp.asarray(cosine_sums(along), work).T
        least = 1e-6 * xp.max(kernel, axis=1, keepdims=True)
        inverse, kind = 1.0 / xp.maximum(kernel, least), EvenInfluence
    else:
        n = grid.shape[1]
        kernel = kernel.reshape(lags, n, n)
        inverse, kind = xp.linalg.inv(kernel), GradedInfluence
    return kind(grid, jnp.asarray(kernel, dtype), jnp.asarray(inverse, dtype))


def _expand(kernel, spectrum):
    """The kernel with as many axes as a stack of spectra."""
    return kernel.reshape((1,) * (spectrum.ndim - 2) + kernel.shape)


def _even_table(xp, lags, half_x, edges):
    """∫∫ dA/r at middles of cells, for distances of cells across and along."""
    n = len(edges) - 1
    half_y = 0.5 * (edges[-1] - edges[0]) / n
    u = half_x * _cell_ends(xp, lags, half_x.dtype)
    v = half_y * _cell_ends(xp, padded_size(n) // 2 + 1, half_x.dtype)
    table = corner(u[:, None], v[None], xp)
    table = table[1:] - table[:-1]
    return table[:, 1:] - table[:, :-1]


def _graded_table(xp, lags, half_x, edges, mirrored=None):
    """Means of ∫∫ dA/r over cells, for distances across and pairs of cells along."""
    total = _strips(xp, half_x * _cell_ends(xp, lags, half_x.dtype), edges, edges)
    if mirrored is None:
        return total
    # The weight goes by distance across over that from the end, which may be much less
    # than a cell is wide: the nearest cell in parts, both of its halves alike.
    fine = 0.5 ** np.arange(_HALVINGS, 0, -1)
    ends = np.concatenate([-fine[:1], fine, 2.0 * np.arange(lags) + 1.0])
    u = half_x * xp.asarray(ends, half_x.dtype)
    x = 0.5 * (u[1:] + u[:-1])[:, None, None]
    middles = 0.5 * (edges[1:] + edges[:-1])
    parts = 2.0 * np.ones(_HALVINGS + 1)
    parts[0] = 1.0
    parts = xp.asarray(parts, half_x.dtype)[:, None, None]
    for end in (edges[0], edges[-1]):
        image = _strips(xp, u, edges, 2.0 * end - edges[::-1])[..., ::-1]
        y = xp.abs(middles - end)
        image = mirrored(x, y[None, :, None], y[None, None, :], xp) * image
        nearest = xp.sum(parts * image[: _HALVINGS + 1], axis=0)
        total = total + xp.concatenate([nearest[None], image[_HALVINGS + 1 :]])
    return total


def _strips(xp, u, edges, sources):
    """Means over cells along, of pressure on cells across and along (u-1, n, n)."""
    table = strip(u[:, None, None], (edges[:, None] - sources[None, :])[None], xp)
    table = table[1:] - table[:-1]
    table = table[:, 1:] - table[:, :-1]
    return (table[..., :-1] - table[..., 1:]) / xp.diff(edges)[None, :, None]


def _cell_ends(xp, count, dtype):
    """Ends of cells at distances 0 to count - 1, in half cells: -1, 1, 3, ..."""
    return xp.asarray(2.0 * np.arange(count + 1) - 1.0, dtype)


def padded_size(n: int) -> int:
    """Even length, at least 2n, of factors 2, 3 and 5."""
    size = 2 * n
    while not _is_smooth(size):
        size += 2
    return size


def _is_smooth(n):
    for factor in (2, 3, 5):
        while n % factor == 0:
            n //= factor
    return n == 1


def cosine_sums(size: int) -> np.ndarray:
    """Transform of an even sequence, given from distance 0 to size/2 (f, lag)."""
    lag = np.arange(size // 2 + 1)
    twice = np.where((lag == 0) | (lag == size // 2), 1.0, 2.0)
    return twice * np.cos(2.0 * np.pi / size * (np.outer(lag, lag) % size))


class _Cosines:
    """Transform across of fields symmetric about x = 0: products with cosines."""

    def __init__(self, grid, dtype):
        size = padded_size(grid.n_across)
        m = grid.shape[0]
        # Twice the place in cells, a whole number for odd and even counts.
        place = 2 * np.arange(m) + 1 - grid.n_across % 2
        frequency = np.arange(size // 2 + 1)
        phase = np.outer(frequency, place) % (2 * size)
        wave = np.cos(np.pi / size * phase)
        ends = (frequency == 0) | (frequency == size // 2)
        twice = np.where(place == 0, 1.0, 2.0)
        self.forward = jnp.asarray(wave * twice, dtype)
        back = wave * np.where(ends, 1.0, 2.0)[:, None] / size
        self.backward = jnp.asarray(back.T, dtype)

    def to_waves(self, field):
        return self.forward @ field

    def from_waves(self, waves):
        return self.backward @ waves


class _Waves:
    """Transform across of any field."""

    def __init__(self, grid, dtype):
        self.size, self.count = padded_size(grid.n_across), grid.n_across

    def to_waves(self, field):
        return jnp.fft.rfft(field, self.size, axis=-2)

    def from_waves(self, waves):
        return jnp.fft.irfft(waves, self.size, axis=-2)[..., : self.count, :]
