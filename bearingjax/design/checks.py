"""STUB - to be replaced."""
import jax, numbers
import jax.numpy as jnp
def is_traced(x): return isinstance(x, jax.core.Tracer)
def check(owner, name, value, unit, ok, allowed):
    if is_traced(ok) or is_traced(value): return
    if not bool(jnp.all(ok)): raise ValueError(f"{type(owner).__name__}: `{name}` is {value} {unit}; it must be {allowed}.")
def number(owner, name, value, unit): check(owner,name,value,unit, jnp.isfinite(value), "finite")
def positive(owner, name, value, unit): check(owner,name,value,unit, value>0, "above 0")
def non_negative(owner, name, value, unit): check(owner,name,value,unit, value>=0, "at least 0")
def in_range(owner,name,value,unit,low,high,include_low=False): check(owner,name,value,unit,(value<high)&((value>=low) if include_low else (value>low)),f"between {low} and {high}")
def count(owner,name,value): check(owner,name,value,"", value>=1, "at least 1")
