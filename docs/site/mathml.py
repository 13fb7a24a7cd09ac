"""Equations as MathML, which browsers typeset themselves: nothing is loaded, and no picture is made.

The numbers are those of the sources: \\tag{3.1} stands at the right margin.
"""
import re

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml


def visit_inline(self, node):
    self.body.append(tex2mathml(node.astext(), inline=True))
    raise nodes.SkipNode


def visit_block(self, node):
    text = node.astext()
    tag = re.search(r"\\tag\{([^}]*)\}", text)
    text = re.sub(r"\\tag\{[^}]*\}", "", text).strip()
    number = '<span class="number">(%s)</span>' % tag.group(1) if tag else ""
    self.body.append('<div class="equation">%s%s</div>\n' % (tex2mathml(text, inline=False), number))
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
