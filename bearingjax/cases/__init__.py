"""Many load cases: sweeps over loads, speeds and designs, and load spectra.

`sweep` solves loads, displacements, speeds and designs by the thousand, in batches that
fit the cache, over all devices and processes of JAX; each case has its own result code,
and a bad one spoils no other. `outputs` are fields of a solution, or `peak_pressure`,
`largest_load`, `n_loaded`, `iterations`, `residual`; outputs that are not named are not
computed. Each case starts from the nearest one that is solved by then
(`Batches(near=True)`).
Designs: `stack_designs([...])`, or an element made under `jax.vmap`.
`jax.config.update("jax_num_cpu_devices", 2)` before all else uses two cores.
`Batches(stop=...)` is asked between blocks.

Derivatives of many cases
-------------------------

First a sweep, then `solve_case`, mapped over the cases, from the displacements that it
found (`start=sweep.displacement[k, 6:]`): derivatives then cost one evaluation of each
case, and none of the search. `benchmarks/life_spectrum.py` takes the gradient of a life
so, batch by batch.

Many devices in a program of your own
-------------------------------------

`sweep` spreads its cases itself, and cannot be traced. `jax.shard_map` of a mapped
`solve_load` over a `jax.sharding.Mesh` needs `check_vma=False`: derivative rules know
of no axes of a mesh. A batch of a size that is left open (`jax.export.symbolic_shape`)
goes through `jax.lax.map`, not through `jax.vmap`, which divides a batch by its size.

A program that waits for ever, without load on the processor
------------------------------------------------------------

jaxlib 0.10 hands a large batch of matrices (`jax.vmap` of `solve` or `eig` of
`jnp.linalg`) to LAPACK in parts, on XLA's threads, by a thread that waits for the
others. As many such batches at once as there are cores, and none is left to do the
work: on two cores two batches that do not depend on each other are enough. The package
passes one matrix after the other. In functions of your own that are mapped
`jax.lax.map` in place of `jax.vmap` avoids it; so does, with one device, `PJRT_NPROC=1`
in the environment (one thread; `XLA_FLAGS=--xla_cpu_multi_thread_eigen=false` does
not).

Names
-----

- Sweeps: `sweep`, `Sweep`, `Cases`, `Batches`, `solve_case`, `stack_designs`.
- Load spectra: `spectrum_life`, `SpectrumLife`.
- Records in time: `series_cases`, `Series`, `series_life`, `SeriesLife`,
  `SERIES_OUTPUTS`.
"""

from .batches import Batches
from .cases import Cases, solve_case
from .series import SERIES_OUTPUTS, Series, SeriesLife, series_cases, series_life
from .spectrum import SpectrumLife, spectrum_life
from .sweep import Sweep, stack_designs, sweep

__all__ = [
    "sweep", "Sweep", "Cases", "Batches", "solve_case", "stack_designs",
    "spectrum_life", "SpectrumLife",
    "series_cases", "Series", "series_life", "SeriesLife", "SERIES_OUTPUTS",
]  # fmt: skip
