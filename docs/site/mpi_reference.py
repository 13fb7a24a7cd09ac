"""The reference of gp_mpi.h beside that of gp.h: what its first comment says on a page, and one page per call."""
import os
import re
import tempfile

import text
from c_reference import Function, first_sentence, of_function, read_header, roles_of


def write_mpi_reference(header_path, gp_header_path, cc, directory):
    """The names of its functions; the page is mpi.rst in the directory of the C reference."""
    with open(header_path, encoding="utf-8") as source:
        conventions = text.lines_of(re.search(r"/\*.*?\*/", source.read(), re.S).group(0))
    with tempfile.TemporaryDirectory() as without_mpi:  # of mpi.h nothing but names is needed
        open(os.path.join(without_mpi, "mpi.h"), "w", encoding="utf-8").close()
        header = read_header(header_path, [*cc, "-I", without_mpi], text.lines_of)
    roles = {**roles_of(read_header(gp_header_path, cc, text.lines_of)), **roles_of(header)}
    functions = header.of(Function)
    lines = [*text.titled("Several processes: granperi/gp_mpi.h"), *text.paragraphs(conventions, roles), "",
             ".. list-table::", "   :widths: 30 70", ""]
    for function in functions:
        lines += ["   * - :doc:`%s`" % function.name, "     - " + text.linked(first_sentence(function.doc), roles)]
        with open(os.path.join(directory, function.name + ".rst"), "w", encoding="utf-8") as page:
            page.write("\n".join(of_function(function, roles, function, [], {})))
    lines += ["", ".. toctree::", "   :hidden:", "", *text.indented([function.name for function in functions]), "",
              "The guide has a page on it: :doc:`/guide/mpi`.", ""]
    with open(os.path.join(directory, "mpi.rst"), "w", encoding="utf-8") as page:
        page.write("\n".join(lines))
    return [function.name for function in functions]
