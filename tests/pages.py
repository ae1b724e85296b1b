"""Pages of reports, beside the terminal."""

import re


def missing_on_page(page, out):
    """Cells and sentences of the terminal that a page lacks."""
    page = page.replace("\xa0", " ")
    cells = [
        cell
        for line in out.splitlines()
        if set(line) != {"-"}  # between sections
        for cell in re.split(" {2,}", line.removeprefix("warning: ").strip())
    ]
    return [cell for cell in cells if cell not in page]
