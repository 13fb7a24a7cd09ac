"""Comments of the sources as reStructuredText."""
import re

SPECIAL = re.compile(r"([\\*`|_])")
NAME = re.compile(r"\b(?:gp_[a-z0-9_]+(?:\.[a-z_0-9]+)?|GP_[A-Z0-9_]*[A-Z0-9])\b")


def lines_of(comment):
    """The lines of a C comment without its marks, from a common left edge; "" for a line that only parts the file."""
    lines = [re.sub(r"^\s*\* ?", "", line).rstrip() for line in comment[2:-2].split("\n")]
    lines[0] = lines[0].strip()
    return "" if lines[0].startswith("---") else "\n".join(lines).strip()


def escape(text):
    return SPECIAL.sub(r"\\\1", text)


def linked(text, roles):
    """Escaped, with names that roles knows (name -> role) as links, and `this` as code."""
    parts = re.split(r"`([^`]+)`", text)
    return "".join("``%s``" % part if k % 2 else with_links(part, roles) for k, part in enumerate(parts))


def with_links(text, roles):
    pieces, end = [], 0
    for name in NAME.finditer(text):
        role = roles.get(name.group(0))
        if role:
            # An escaped blank ends the markup where a letter or a bracket follows.
            pieces += [escape(text[end:name.start()]), "\\ :%s:`%s`\\ " % (role, name.group(0))]
            end = name.end() + 2 * (role == "c:func" and text.startswith("()", name.end()))  # Sphinx writes them, too
    return "".join(pieces) + escape(text[end:])


def paragraphs(text, roles=None):
    """Lines of reStructuredText: a line that is indented begins an item of a list, one that is indented more goes on with it."""
    out, indent, blank = [], None, True
    for line in text.split("\n"):
        depth, words = len(line) - len(line.lstrip()), line.strip()
        if not words:
            out.append("")
            blank, indent = True, None
            continue
        if depth and (indent is None or depth <= indent):
            indent = depth
            if out and not out[-1].startswith(("- ", "  ")) and not blank:
                out.append("")
            out.append("- " + linked(re.sub(r"^- ", "", words), roles or {}))
        elif depth:
            out.append("  " + linked(words, roles or {}))
        else:
            if indent is not None:
                out.append("")
            indent = None
            out.append(linked(words, roles or {}))
        blank = False
    return out


def titled(text, mark="="):
    return [text, mark * len(text), ""]


def indented(lines, by=3):
    return [" " * by + line if line else "" for line in lines]
