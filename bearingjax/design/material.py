"""STUB"""
import equinox as eqx
from ..numerics.types import as_real
class Material(eqx.Module):
    elastic_modulus: object = eqx.field(converter=as_real, default=206e9)
    poisson_ratio: object = eqx.field(converter=as_real, default=0.3)
    density: object = eqx.field(converter=as_real, default=7850.0)
def contact_modulus(a,b): return 1/((1-a.poisson_ratio**2)/a.elastic_modulus+(1-b.poisson_ratio**2)/b.elastic_modulus)
