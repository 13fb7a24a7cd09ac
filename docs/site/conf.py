"""Settings of Sphinx. Nothing is taken from the network: neither fonts nor scripts."""
import os
import re
import sys

import granperi

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))  # mathml.py

project = "granperi"
copyright = "the granperi contributors"
version = release = granperi.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "mathml"]
html_math_renderer = "mathml"
source_suffix = {".rst": "restructuredtext", ".md": "markdown"}
exclude_patterns = []
myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath"]
myst_dmath_allow_labels = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True
add_module_names = False
python_use_unqualified_type_names = True
nitpick_ignore_regex = [("c:identifier", r"u?int(32|64)_t|size_t|MPI_Comm"),  # what other documents describe
                        ("py:class", r"(numpy|np|os|matplotlib|typing)\..*|Unpack.*|\w+Values|Engine|granperi\._.*")]
html_theme = "furo"
html_title = "granperi " + release
html_show_sourcelink = False
html_copy_source = False
html_static_path = ["static"]
html_css_files = ["granperi.css"]
highlight_language = "none"
pygments_style = "default"
html_theme_options = {"navigation_with_keys": True}


def plain(app, what, name, thing, options, lines):
    """Docstrings are plain text: marks of reStructuredText are taken literally, indented lines are code."""
    out, code = [], False
    for line in lines:
        if line.startswith("    ") and not code and (not out or not out[-1]):
            out += ["::", ""]
            code = True
        elif line and not line.startswith(" "):
            code = False
        out.append(line if code else re.sub(r"([\\*`|_])", r"\\\1", line))
    lines[:] = out


def setup(app):
    app.add_object_type("fortran", "fortran", "pair: %s; Fortran", objname="Fortran")
    app.connect("autodoc-process-docstring", plain)
