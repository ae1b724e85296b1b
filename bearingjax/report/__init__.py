"""Reports of runs as data, and the pages made of them."""

from .html_report import Origin as Origin
from .html_report import report_page as report_page
from .json_output import write_numbers as write_numbers
from .report_model import Column as Column
from .report_model import Grid as Grid
from .report_model import Report as Report
