"""The checks of annotated arguments and results that run as tests run."""

from beartype import BeartypeConf, beartype

check_types = beartype(conf=BeartypeConf(is_pep484_tower=True))
"""An int is a float, as PEP 484 and pyright have it; an array is none."""
