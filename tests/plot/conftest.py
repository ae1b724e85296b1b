"""Every figure that a test makes is laid out and drawn, without making its pixels."""

import matplotlib
import pytest

matplotlib.use("Agg")


@pytest.fixture(autouse=True)
def close_figures():
    import matplotlib.pyplot as plt

    yield
    for number in plt.get_fignums():
        plt.figure(number).draw_without_rendering()  # nothing may fail or warn
    plt.close("all")
