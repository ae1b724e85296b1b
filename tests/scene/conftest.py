"""The command line in this process, without touching JAX's settings."""

from typing import NamedTuple

import pytest

from bearingjax import cli
from bearingjax.cli import jax_settings


class Run(NamedTuple):
    """What one call of the command line did."""

    status: int
    out: str
    err: str


@pytest.fixture
def run(monkeypatch, capsys):
    """Call `bearingjax` with arguments; programs are those of this process."""
    monkeypatch.setattr(jax_settings, "configure", lambda options: None)
    monkeypatch.setattr(jax_settings, "programs", lambda: None)

    def call(*arguments):
        status = cli.main([str(a) for a in arguments])
        return Run(status, *capsys.readouterr())

    return call
