#!/usr/bin/env python3
"""Tests of what makes the reference pages: that nothing public can be left out in silence."""
import os
import sys
import tempfile
import unittest

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "docs", "site"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import c_reference  # noqa: E402
import docstrings  # noqa: E402
import fortran_calls  # noqa: E402
import fortran_reference  # noqa: E402
import make  # noqa: E402
import mpi_reference  # noqa: E402
import pages_test  # noqa: E402
import python_calls  # noqa: E402
import text  # noqa: E402

HEADER = """/* sample: a sample.
 *
 * Conventions
 *   - All is well.
 */
/* ---------------------------------------------------------------------------------- scene */
typedef struct gp_sim gp_sim;
%s
GP_API int gp_begin(gp_sim *sim);
"""


def pages_of(writer, *arguments):
    """What a writer of a reference returns, and its pages in one."""
    with tempfile.TemporaryDirectory() as work:
        names = writer(*[os.path.join(work, argument) if argument == "pages" else argument for argument in arguments])
        read = []
        for page in os.listdir(os.path.join(work, "pages")):
            with open(os.path.join(work, "pages", page), encoding="utf-8") as source:
                read.append(source.read())
        return names, "\n".join(read)


class CReference(unittest.TestCase):
    def pages(self, comment):
        with tempfile.NamedTemporaryFile("w", suffix=".h") as header:
            header.write(HEADER % comment)
            header.flush()
            return pages_of(c_reference.write_c_reference, header.name, ["cc"], "pages")

    def test_has_the_functions_and_their_comments(self):
        names, pages = self.pages("/* Begins *sim, see gp_begin. */")
        self.assertEqual(names, ["gp_begin"])
        self.assertIn(".. c:function:: int gp_begin(gp_sim *sim)", pages)
        self.assertIn("   Begins \\*sim, see \\ :c:func:`gp_begin`\\ .", pages)
        self.assertIn("- All is well.", pages)

    def test_has_what_a_reader_of_a_call_looks_for(self):
        _, pages = self.pages("/* Begins *sim. GP_E_IO if it cannot. */")
        self.assertIn("   * - ``sim``", pages)
        self.assertEqual(c_reference.member_lines("m/s, how fast; 0 .. 9 [0.5]", {}),
                         ["how fast; 0 .. 9", "", "*Unit:* m/s. *Default:* 0.5.", ""])

    def test_every_argument_of_the_header_is_described(self):
        header = c_reference.read_header(os.path.join(ROOT, "include", "granperi", "gp.h"), ["cc"])
        functions = header.of(c_reference.Function)
        for function in functions:
            c_reference.c_calls.argument_table(function, {})
        examples = [function.name for function in functions if c_reference.c_calls.example_lines(function)]
        self.assertGreater(len(examples), 0.7 * len(functions), "too few calls have an example")

    def test_examples_end_with_their_statements(self):
        self.assertEqual(c_reference.c_calls.excerpt(["a", "call f(1, &", "b, &", "c, &", "d, &", "e)", "g"], 1),
                         "a\ncall f(1, &\nb, &\nc, &\nd, &\ne)")

    def test_has_the_calls_of_several_processes(self):
        with tempfile.TemporaryDirectory() as pages:
            include = os.path.join(ROOT, "include", "granperi")
            names = mpi_reference.write_mpi_reference(os.path.join(include, "gp_mpi.h"), os.path.join(include, "gp.h"), ["cc"], pages)
            self.assertEqual(sorted(os.listdir(pages)), sorted(["mpi.rst", *(name + ".rst" for name in names)]))
            self.assertEqual(names, ["gp_create_mpi", "gp_load_mpi"])
            with open(os.path.join(pages, "gp_create_mpi.rst"), encoding="utf-8") as page:
                page = page.read()
            self.assertIn(".. c:function:: gp_status gp_create_mpi(const gp_config *config, MPI_Comm comm, gp_sim **sim)", page)
            self.assertIn("   * - ``comm``", page)

    def test_refuses_a_function_without_a_comment(self):
        with self.assertRaisesRegex(c_reference.ReferenceError_, "gp_begin has no comment"):
            self.pages("")


class FortranReference(unittest.TestCase):
    SOURCES = os.path.join(ROOT, "bindings", "fortran")
    HEADER = c_reference.read_header(os.path.join(ROOT, "include", "granperi", "gp.h"), ["cc"], text.lines_of)

    def test_has_every_bound_procedure_with_its_arguments(self):
        names, pages = pages_of(fortran_reference.write_fortran_reference, self.SOURCES, self.HEADER, "pages")
        self.assertIn("sim%plate_load", names)
        self.assertIn("sim%save", names)
        self.assertIn(".. fortran:: call sim%run(t_end, status, message)", pages)
        self.assertIn("   * - ``t_end``\n     - ``real(gp_real)``\n     - given\n     - s, where the clock is to stop; finite", pages)
        self.assertGreater(pages.count("rubric:: Example"), 0.8 * len(names), "too few calls have an example")

    def test_c_calls_know_their_procedures(self):
        found = fortran_reference.c_functions(self.SOURCES, self.HEADER)
        self.assertEqual((found["gp_load_file"], found["gp_get_state"], found["gp_copy_field"]), ("load", "state", "copy"))

    def test_refuses_a_procedure_that_nothing_describes(self):
        procedure = fortran_reference.Procedure("subroutine", "new", ["self"], None, {}, [])
        with self.assertRaisesRegex(fortran_reference.FortranError, "new has no comment"):
            fortran_reference.page_of("new", procedure, self.HEADER, {})

    def test_refuses_an_argument_that_nothing_describes(self):
        procedure = fortran_reference.Procedure("subroutine", "run", ["self", "colour"], None, {"colour": "integer, intent(in)"}, [])
        with self.assertRaisesRegex(fortran_calls.CallError, "nothing is said of colour of run"):
            fortran_reference.page_of("run", procedure, self.HEADER, {})


class PythonReference(unittest.TestCase):
    DOC = """Does it.

        More of it.

        Args:
            x, y: m, shape (n),
                finite.
            **more: others.

        Raises:
            StateError: closed.

        Example:
            if x:
                print(x)
        """

    def test_docstrings_have_parts(self):
        parts = docstrings.parts_of(self.DOC)
        self.assertEqual(parts.doc, "Does it.\n\nMore of it.")
        self.assertEqual(parts.args, [("x", "m, shape (n), finite."), ("y", "m, shape (n), finite."), ("**more", "others.")])
        self.assertEqual(parts.raises, [("StateError", "closed.")])
        self.assertEqual(docstrings.examples_in(self.DOC), ["if x:\n    print(x)"])

    def test_the_page_of_a_call(self):
        def call(x, y=0.5, **more):
            pass
        call.__doc__ = self.DOC
        page = "\n".join(python_calls.page_of("call", call, "function", {"StateError": "exc"}, []))
        self.assertIn(".. py:function:: call(x, y=0.5, **more)", page)
        self.assertIn("   * - ``y``\n     - ``array``\n     - ``0.5``\n     - m, shape (n), finite.", page)
        self.assertIn("- \\ :py:exc:`StateError <granperi.StateError>`\\ : closed.", page)

    def test_refuses_an_argument_that_the_docstring_leaves_out(self):
        def call(x, z):
            pass
        call.__doc__ = "Does it.\n\nArgs:\n    x: m."
        with self.assertRaisesRegex(python_calls.CallError, "call: Args: of its docstring names x, it takes x, z"):
            python_calls.page_of("call", call, "function", {}, [])


class Pages(unittest.TestCase):
    def test_a_missing_name_is_told(self):
        with tempfile.TemporaryDirectory() as html:
            for language, words in (("c", '<dt id="c.gp_begin">'), ("python", '<dt id="granperi.Plate">'),
                                    ("fortran", "<b>sim%run</b>(t_end)")):
                make.write(os.path.join(html, "reference", language, "page.html"), words)
            self.assertEqual(make.missing_in(html, ["gp_begin"], ["granperi.Plate"], ["sim%run"]), [])
            self.assertEqual(make.missing_in(html, ["gp_end"], ["granperi.Pl"], ["sim%ru"]), ["gp_end", "granperi.Pl", "sim%ru"])

    def test_links_lead_to_pages(self):
        self.assertEqual(make.target_of("guide/errors.md", "python.md"), "../guide/python.md")
        self.assertEqual(make.target_of("guide/errors.md", "../../include/granperi/gp.h"), "../reference/c/index.rst")
        self.assertEqual(make.target_of("guide/mpi.md", "../../include/granperi/gp_mpi.h"), "../reference/c/mpi.rst")
        self.assertEqual(make.target_of("guide/errors.md", "../../examples/c/hit_block.c"), "../examples/c/hit_block.c.md")
        self.assertIsNone(make.target_of("validation.md", "../bench/README.md"))
        with self.assertRaisesRegex(make.PageError, "there is no nowhere.md"):
            make.target_of("guide/errors.md", "nowhere.md")

    def test_faults_of_pages_are_told(self):
        with tempfile.TemporaryDirectory() as html:
            make.write(os.path.join(html, "one.html"), '<a href="two.html#there">two</a> <a href="three.html">three</a> <p id="here">'
                                                       '<a href="#gone">gone</a> <img src="none.png"> see :c:func:`gp_run` '
                                                       "<code>**this is code**</code></p>")
            make.write(os.path.join(html, "two.html"), '<p id="there"><a href="one.html#here">one</a></p>')
            faults = pages_test.faults_of(html, pages_test.read_pages(html))
        self.assertEqual(len(faults), 4, faults)
        for fault, text in zip(faults, ("three.html leads nowhere", "there is no #gone", "none.png is not there", "raw markup: ")):
            self.assertIn(text, fault)

    def test_equations_keep_the_numbers_of_their_sources(self):
        class Writer:
            body = []
        import mathml
        from docutils import nodes
        with self.assertRaises(nodes.SkipNode):
            mathml.visit_block(Writer, nodes.math_block("", r"I = \frac{2 d}{p} \tag{3.4}"))
        self.assertRegex(Writer.body[0], r'(?s)<math .*<mfrac>.*</math><span class="number">\(3.4\)</span>')

    def test_lists_of_comments_are_lists(self):
        self.assertEqual(text.paragraphs("Two:\n  - one and\n    its end\n  - two\nThen a_b."),
                         ["Two:", "", "- one and", "  its end", "- two", "", "Then a\\_b."])


if __name__ == "__main__":
    unittest.main()
