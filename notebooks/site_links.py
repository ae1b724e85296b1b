"""Links of the site: from names in backticks, and whether all lead somewhere."""

import re
from pathlib import Path
from urllib.parse import unquote

from docutils import nodes
from latex2mathml.converter import convert
from site_pages import homes
from sphinx.addnodes import pending_xref
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util import logging
from sphinx.util.nodes import find_pending_xref_condition, make_refnode

LOGGER = logging.getLogger(__name__)
WHOLE = "class", "data", "exception", "function", "module"
"""Kinds of names that may stand alone; a method or field needs its class before it."""


def target_of(env, text, package=""):
    """Full name of the public object that a text in backticks means, or `None`.

    Args:
        env: Sphinx's environment.
        text: `solve_load`, `bj.solve_load(element, load)` or `statics.solve_load`.
        package: Whose own names come first, and may be any words; elsewhere a bare
            lower-case word is one of a scene or a command, unless it has a `bj.`.
    """
    objects = env.domains.python_domain.objects
    name = re.sub(r"^(bj|bearingjax)\.|\(.*\)$", "", text, flags=re.S)
    if not package and re.fullmatch("[a-z]+", text):
        return None
    for full in (f"{package}.{name}", f"bearingjax.{name}"):
        if full in objects:
            return full
    if not hasattr(env, "names_by_end"):
        env.names_by_end = {}
        for full, one in objects.items():
            parts = [] if one.aliased else full.split(".")
            for k in range(1, len(parts) - (one.objtype not in WHOLE)):
                env.names_by_end.setdefault(".".join(parts[k:]), []).append(full)
    fitting = env.names_by_end.get(name, [])
    return fitting[0] if len(fitting) == 1 else None


def linked(app, full, content):
    """The content as a link to an object."""
    entry = app.env.domains.python_domain.objects[full]
    page = app.env.current_document.docname
    return make_refnode(app.builder, page, entry.docname, entry.node_id, content, full)


class NamesAsLinks(SphinxPostTransform):
    """A public name in backticks is a link, in docstrings and in prose."""

    default_priority = 20

    def run(self, **options):
        page = self.env.current_document.docname
        package = page.removeprefix("_generated/api/") if "/api/" in page else ""
        for node in list(self.document.findall(nodes.literal)):
            full = target_of(self.env, node.astext(), package)
            inside = isinstance(node.parent, nodes.reference | nodes.title)
            if full and not inside and "_generated/keys" not in page:
                node.replace_self(linked(self.app, full, node.deepcopy()))


def plain_types(app, document):
    """Leave links of signatures to our names: axes of arrays are no types."""
    known = {name.rpartition(".")[2] for name in homes()}
    for node in list(document.findall(pending_xref)):
        if node.get("refspecific") and node["reftarget"].split(".")[-1] not in known:
            short = find_pending_xref_condition(node, "resolved") or node
            node.replace_self(short.children)
    for node in [one for one in document.findall(nodes.Text) if "jaxlib." in one]:
        node.parent.replace(node, nodes.Text(node.replace("jaxlib._jax.", "")))


def resolve(app, env, node, content):
    """Find what a role such as {func}`bearingjax.solve_load` means, or warn."""
    name = node["reftarget"] if node.get("refdomain") == "py" else "-"
    full = target_of(env, f"bj.{name.removeprefix('bearingjax.')}")
    if name.startswith("bearingjax.") and not full and "/api/" not in node["refdoc"]:
        LOGGER.warning("nothing public is called %s", name, location=node)
    return linked(app, full, content) if full else None


def math(self, node):
    """Write a formula as MathML, which browsers draw without script or fonts."""
    block = isinstance(node, nodes.math_block)
    source = re.sub(r"\\arg(?![a-z])", r"\\operatorname{arg}", node.astext())
    source = re.sub(r"\{(align|gather)\}", r"{\1*}", source)  # numbers are Sphinx's
    made = convert(source, display="block" if block else "inline")
    if "\\" in made:
        LOGGER.warning("formula not understood: %s", source, location=node)
    if block:
        number = (
            f'<span class="eqno">({node["number"]})</span>' if node["number"] else ""
        )
        where = "".join(f' id="{name}"' for name in node["ids"][:1])
        made = f'<div class="math"{where}>{made}{number}</div>'
    self.body.append(made)
    raise nodes.SkipNode


def check_links(app, error):
    """Warn about every link of the built pages that leads nowhere."""
    root = Path(app.outdir).resolve()
    pages = {page: page.read_text("utf-8") for page in root.rglob("*.html")}
    places = {page: set(re.findall(r'\bid="([^"]+)"', t)) for page, t in pages.items()}
    for page, text in pages.items():
        for link in set(re.findall(r'\b(?:href|src)="(?![a-z]+:)([^"]*)"', text)):
            path, _, anchor = unquote(link).partition("#")
            to = (page.parent / path.partition("?")[0]).resolve() if path else page
            if not to.exists() or (anchor and anchor not in places.get(to, {anchor})):
                LOGGER.warning("%s: dead link %s", page.relative_to(root), link)


def setup(app):
    app.add_post_transform(NamesAsLinks)
    app.connect("doctree-read", plain_types)
    app.connect("missing-reference", resolve)
    app.connect("build-finished", check_links)
    app.add_html_math_renderer("mathml", (math, None), (math, None))
