"""STUB"""
import equinox as eqx, jax.numpy as jnp
from ..numerics.types import as_real
class AbstractProfile(eqx.Module):
    def check(self,l,d): pass
    def kinks(self,l): return ()
class Straight(AbstractProfile):
    def drop(self,s,l,d): return 0*s
class CircularCrown(AbstractProfile):
    crown_radius: object = eqx.field(converter=as_real)
    def drop(self,s,l,d): return s**2/(self.crown_radius+jnp.sqrt(self.crown_radius**2-s**2))
class CrownedEnds(AbstractProfile):
    straight_length: object = eqx.field(converter=as_real)
    crown_radius: object = eqx.field(converter=as_real)
    def drop(self,s,l,d):
        x=jnp.maximum(jnp.abs(s)-self.straight_length/2,0)
        return x**2/(self.crown_radius+jnp.sqrt(self.crown_radius**2-x**2))
    def kinks(self,l): return (-self.straight_length/2,self.straight_length/2)
class Logarithmic(AbstractProfile):
    coefficient: object = eqx.field(converter=as_real, default=0.00035)
    def drop(self,s,l,d):
        x=2*s/l; g=(1-x)*(1+x); t=1e-300
        return -self.coefficient*d*jnp.log(jnp.where(g<t,t,g))
FujiwaraKawase=JohnsGohar=Tabulated=Straight
