"""Contact of a rolling element, or of a ring's land, with the cage.

Source: Kurushin, Kurushin, Zhilnikov, Murashkin, Vestnik SGAU (2011), which prints
    F = ((d - c Fⁿ)/a)ᵐ and solves it by repeated substitution. That converges only
    where m n c Fⁿ < a F^(1/m), for contacts that carry next to nothing.
"""

import equinox as eqx
import jax.numpy as jnp
from jax import lax

from ...design.checks import positive
from ...numerics.implicit import attach_roots, stop_gradient
from ...numerics.types import Real, Reals, Scalar
from ...numerics.units import real

_STEPS = 12
"""Newton steps; the slope of the equation changes once, from 1/m to n."""
_LEAST, _FORCES = -6.0, 128
"""Forces at which the largest stiffness is sought: powers of ten, number."""


class CageContact(eqx.Module):
    """Force over approach: d = c Fⁿ + a F^(1/m), with F in newton.

    The first part is the elastic cage; the second is a film of the thickness a,
    through which the surfaces come near without much force, up to where it ends.

    Attributes:
        film: a, approach at 1 N by the film alone [m].
        elastic: c, approach at 1 N by the cage alone [m]; that of the source, for
            duralumin, printed as 2.81e5 mm for 2.81e-5 mm.
        elastic_exponent: n [1].
        film_exponent: m [1].

    Traced: all fields.
    """

    film: Real = eqx.field(**real("m"))
    elastic: Real = eqx.field(**real("m"), default=2.81e-8)
    elastic_exponent: Real = eqx.field(**real("1"), default=1.29)
    film_exponent: Real = eqx.field(**real("1"), default=40.0)

    def __check_init__(self):
        for name in ("film", "elastic", "elastic_exponent", "film_exponent"):
            positive(self, name)

    def force(self, approach: Reals) -> Reals:
        """Return the contact force, zero where the parts are apart (...) [N].

        Finite, with three derivatives, for every approach that is.

        Args:
            approach: Approach of the surfaces, positive where they meet (...) [m].
        """
        # Nearer to zero the third power of an approach has no inverse.
        apart = approach <= jnp.finfo(approach.dtype).tiny ** 0.25
        closed = jnp.where(apart, 1.0, approach)
        root = _logarithm(self, stop_gradient(closed))
        root = attach_roots(_excess, root, (self, closed))
        # Beyond the largest number there is none; such an approach is none either.
        most = 0.99 * jnp.log(jnp.finfo(approach.dtype).max)
        return jnp.where(apart, 0.0, jnp.exp(jnp.minimum(root, most)))

    def approach(self, force: Reals) -> Reals:
        """Return the approach under a positive force, the inverse of `force` [m].

        Args:
            force: (...) [N].
        """
        elastic = self.elastic * force**self.elastic_exponent
        return elastic + self.film * force ** (1.0 / self.film_exponent)

    def stiffest(self, force: Scalar) -> Scalar:
        """Return the largest stiffness dF/dd under forces up to a given one [N/m].

        A film that ends stiffens it, an elastic exponent above 1 makes it softer again.

        Args:
            force: Above 0 [N].
        """
        forces = force * jnp.logspace(_LEAST, 0.0, _FORCES)
        n, m = self.elastic_exponent, self.film_exponent
        elastic = self.elastic * n * forces ** (n - 1.0)
        film = self.film / m * forces ** (1.0 / m - 1.0)
        return jnp.max(1.0 / (elastic + film))


def _excess(y, args):
    """Return ln((c Fⁿ + a F^(1/m))/d) with y = ln F: increasing and convex."""
    contact, approach = args
    elastic = jnp.log(contact.elastic) + contact.elastic_exponent * y
    film = jnp.log(contact.film) + y / contact.film_exponent
    return jnp.logaddexp(elastic, film) - jnp.log(approach)


def _logarithm(contact, approach):
    """Return the root of `_excess`, from above: no step overshoots it."""
    contact = stop_gradient(contact)
    logarithm = jnp.log(approach)
    elastic = (logarithm - jnp.log(contact.elastic)) / contact.elastic_exponent
    film = (logarithm - jnp.log(contact.film)) * contact.film_exponent

    def step(_, y):
        parts = contact.elastic_exponent, 1.0 / contact.film_exponent
        left = jnp.log(contact.elastic) + parts[0] * y
        right = jnp.log(contact.film) + parts[1] * y
        share = jnp.exp(left - jnp.logaddexp(left, right))
        slope = share * parts[0] + (1.0 - share) * parts[1]
        return y - _excess(y, (contact, approach)) / slope

    return lax.fori_loop(0, _STEPS, step, jnp.minimum(elastic, film))
