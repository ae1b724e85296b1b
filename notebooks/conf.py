"""How the site is built, offline and with warnings as errors:

sphinx-build -W --keep-going notebooks notebooks/_build

What follows from the code is written into `_generated` first (`site_pages.py`). The
notebooks show the outputs that are stored in them; the tests run them.
"""

import os
import sys
from pathlib import Path

HERE = Path(__file__).parent
os.environ |= {"MPLBACKEND": "Agg", "JAX_PLATFORMS": "cpu"}
sys.path[:0] = [str(HERE.parent), str(HERE)]

import jax  # noqa: E402

jax.config.update("jax_enable_x64", True)
import site_docstrings  # noqa: E402
import site_links  # noqa: E402
import site_pages  # noqa: E402

import bearingjax  # noqa: E402

project = "bearingjax"
author = "the authors of bearingjax"
version = release = bearingjax.__version__
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
extensions += ["sphinx_copybutton"]
exclude_patterns = [
    "_build",
    "types",
    "validation_head.md",
    "jupyter_execute",
    "**/.ipynb_checkpoints",
]
default_role = "literal"  # backticks of docstrings; `site_links` links them

nb_execution_mode = "off"
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 4

autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 80
add_module_names = False
smartquotes_action = "De"  # dashes and dots, and quotes as they are
toc_object_entries = False  # a page has the subjects of a package; else it takes long
napoleon_numpy_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False

html_theme = "furo"
html_title = f"bearingjax {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = html_show_sourcelink = html_show_copyright = False
html_math_renderer = "mathml"


def setup(app):
    app.connect("builder-inited", lambda app: site_pages.write_pages())
    app.connect("autodoc-process-signature", site_docstrings.short_signature)
    app.connect("source-read", site_pages.lead_to_pages)
    # Before napoleon, which reads the sections of Google's style.
    app.connect("autodoc-process-docstring", site_docstrings.to_rst, priority=400)
    app.connect("autodoc-process-docstring", site_docstrings.short_types, priority=600)
    site_links.setup(app)
