"""Reports of runs as data, and the pages made of them.

Names
-----

- Reports as data: `Report`, `Grid`, `Column`.
- Pages: `report_page`, `Origin`.
"""

from .html_report import Origin, report_page
from .report_model import Column, Grid, Report

__all__ = [
    "Report", "Grid", "Column", "report_page", "Origin",
]  # fmt: skip
