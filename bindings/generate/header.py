"""Reads the public C header: preprocesses it with the C compiler and parses what it declares, comments included.

It knows the C that the header is written in: enums, constants by #define, structs of numbers and pointers, callback types
and functions. Anything else is an error: a declaration that is not understood is never left out in silence.
"""

import collections
import os
import re
import subprocess

# base: C name of the type without const and stars; const: of what a pointer points to; pointers: number of stars
CType = collections.namedtuple("CType", "base const pointers")
# length: of an array, else None; doc: the comment, "" if there is none
Field = collections.namedtuple("Field", "name type length doc")
Parameter = collections.namedtuple("Parameter", "name type")
# Constants of an enum, or (is_enum False) #defines that follow each other; values: [(name, value, doc)]
Constants = collections.namedtuple("Constants", "values is_enum doc")
Struct = collections.namedtuple("Struct", "name fields doc")
Opaque = collections.namedtuple("Opaque", "name doc")  # a struct that only the library knows
Alias = collections.namedtuple("Alias", "name type doc")
Callback = collections.namedtuple("Callback", "name result parameters doc")  # pointer to a function
Function = collections.namedtuple("Function", "name result parameters doc")

EXPORT = "gp_exported"  # what the export macro becomes, so that functions can be told
TOKEN = re.compile(r"(?P<comment>/\*.*?\*/)|(?P<define>^\#define[^\n]*)|(?P<other_directive>^\#[^\n]*)|"
                   r"(?P<number>\d\w*)|(?P<word>[A-Za-z_]\w*)|(?P<mark>[{}();,*=\[\]-])|(?P<blank>\s+)|(?P<unknown>.)",
                   re.S | re.M)


class HeaderError(Exception):
    pass


class Header:
    """declarations: everything the header declares, in its order."""

    def __init__(self, declarations):
        self.declarations = declarations

    def of(self, kind):
        return [declaration for declaration in self.declarations if isinstance(declaration, kind)]

    def struct(self, name):
        return next((struct for struct in self.of(Struct) if struct.name == name), None)

    def function(self, name):
        return next((function for function in self.of(Function) if function.name == name), None)


def read_header(path, cc=("cc",), words_of=None):
    """words_of: what makes the documentation of a comment; without, its words in one line."""
    return Header(Parser(preprocess(path, cc), words_of or tidy).parse())


def preprocess(path, cc):
    """The header's own part of the preprocessed text: what it includes is left out by the line markers."""
    path = os.path.abspath(path)
    command = [*cc, "-E", "-CC", "-dD", "-DGP_API=" + EXPORT, path]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    if result.returncode != 0:
        raise HeaderError("%s:\n%s" % (" ".join(command), result.stderr))
    lines, inside = [], False
    for line in result.stdout.splitlines():
        marker = re.match(r'# \d+ "(.*?)"', line)
        if marker:
            inside = marker.group(1) == path
        elif inside:
            lines.append(line)
    if not lines:
        raise HeaderError("%s left nothing of %s" % (" ".join(command), path))
    return "\n".join(lines)


def tidy(comment):
    """A comment's words in one line; "" for a line that only parts the file."""
    text = " ".join(re.sub(r"^\s*\*", " ", comment[2:-2], flags=re.M).split())
    return "" if text.startswith("---") else text


class Parser:
    def __init__(self, text, words_of=tidy):
        self.words_of = words_of
        self.tokens = []
        for match in TOKEN.finditer(text):
            if match.lastgroup != "blank":
                self.tokens.append((match.lastgroup, match.group(0), match.start()))
        self.text = text
        self.position = 0
        self.values = {}  # of the constants so far

    # ------------------------------------------------------------------------------------------------ tokens

    def error(self, what):
        start = self.tokens[min(self.position, len(self.tokens) - 1)][2]
        raise HeaderError("%s at: %s" % (what, " ".join(self.text[start:start + 100].split())))

    def comments(self):
        """Steps over comments; the last one is returned."""
        doc = ""
        while self.position < len(self.tokens) and self.tokens[self.position][0] == "comment":
            doc = self.words_of(self.tokens[self.position][1])
            self.position += 1
        return doc

    def peek(self):
        position = self.position
        while position < len(self.tokens) and self.tokens[position][0] == "comment":
            position += 1
        return self.tokens[position][1] if position < len(self.tokens) else None

    def take(self, expected=None):
        self.comments()
        if self.position == len(self.tokens):
            self.error("the header ends early, after")
        kind, text, _ = self.tokens[self.position]
        if expected is not None and text != expected:
            self.error("expected %r" % expected)
        self.position += 1
        return text if expected is not None else (kind, text)

    def word(self):
        kind, text = self.take()
        if kind != "word":
            self.position -= 1
            self.error("expected a name")
        return text

    # ------------------------------------------------------------------------------------------ declarations

    def parse(self):
        declarations = []
        while True:
            doc = self.comments()
            if self.position == len(self.tokens):
                return declarations
            kind, text, _ = self.tokens[self.position]
            if kind == "define":
                self.position += 1
                constant = self.define(text)
                previous = declarations[-1] if declarations else None
                if constant and isinstance(previous, Constants) and not previous.is_enum and not doc:
                    previous.values.append(constant)
                elif constant:
                    declarations.append(Constants([constant], False, doc))
            elif kind == "other_directive":
                self.position += 1
            elif text == "enum":
                declarations.append(self.enum(doc))
            elif text == "typedef":
                declarations.append(self.typedef(doc))
            elif text == EXPORT:
                self.take(EXPORT)
                result, name = self.type(), self.word()
                declarations.append(Function(name, result, self.parameters(), doc))
                self.take(";")
            else:
                self.error("not understood")

    def define(self, line):
        match = re.match(r"#define (GP_\w+) +(.+)", line)
        if not match or match.group(1) == "GP_API":
            return None  # include guard, macros with arguments
        name, expression = match.groups()
        self.values[name] = self.evaluate(re.sub(r"/\*.*?\*/", "", expression))
        return (name, self.values[name], "")

    def evaluate(self, expression):
        """An integer constant expression of literals, earlier constants and + - * / | & ^ ~ << >> ( )."""
        known = re.sub(r"\b(0[xX][0-9a-fA-F]+|\d+)[uUlL]*\b", r"\1", expression)
        known = re.sub(r"\b[A-Za-z_]\w*\b", lambda name: str(self.values.get(name.group(0), name.group(0))), known)
        if not re.fullmatch(r"[\s\dxXa-fA-F()+*|&^~<>-]+", known):
            self.error("the constant %r is not understood" % expression)
        return int(eval(known, {"__builtins__": {}}))  # nothing but digits and operators is left

    def enum(self, doc):
        self.take("enum")
        self.take("{")
        values, following = [], 0
        while self.peek() != "}":
            name = self.word()
            if self.peek() == "=":
                self.take("=")
                expression = []
                while self.peek() not in (",", "}"):
                    expression.append(self.take()[1])
                following = self.evaluate(" ".join(expression))
            if self.peek() == ",":
                before = self.comments()
                self.take(",")
            else:
                before = ""
            self.values[name] = following
            values.append((name, following, self.comments() or before))
            following += 1
        self.take("}")
        self.take(";")
        return Constants(values, True, doc)

    def type(self):
        words, pointers = [], 0
        while True:
            text = self.peek()
            if text == "const" or text == "struct" or not words or words == ["const"]:
                words.append(self.word())
            elif text == "*":
                self.take("*")
                pointers += 1
            else:
                break
        base = [word for word in words if word not in ("const", "struct")]
        if len(base) != 1:
            self.error("a type of one word was expected before")
        return CType(base[0], "const" in words, pointers)

    def parameters(self):
        self.take("(")
        found = []
        while self.peek() != ")":
            kind = self.type()
            if kind == CType("void", False, 0):
                break
            found.append(Parameter(self.word(), kind))
            if self.peek() == ",":
                self.take(",")
        self.take(")")
        return found

    def typedef(self, doc):
        self.take("typedef")
        if self.peek() == "struct":
            self.take("struct")
            name = self.word()
            if self.peek() == "{":
                return self.struct(name, doc)
            self.take(name)
            self.take(";")
            return Opaque(name, doc)
        kind = self.type()
        if self.peek() != "(":
            name = self.word()
            self.take(";")
            return Alias(name, kind, doc)
        self.take("(")
        self.take("*")
        name = self.word()
        self.take(")")
        parameters = self.parameters()
        self.take(";")
        return Callback(name, kind, parameters, doc)

    def struct(self, name, doc):
        self.take("{")
        fields = []
        while self.peek() != "}":
            fields.extend(self.fields())
        self.take("}")
        self.take(name)
        self.take(";")
        return Struct(name, fields, doc)

    def fields(self):
        """One declaration, which may name several fields: the comment behind it, or without one that before it, is each's."""
        before = self.comments()
        kind, found = self.type(), []
        while True:
            name, length = self.word(), None
            if self.peek() == "[":
                self.take("[")
                length = self.evaluate(self.take()[1])
                self.take("]")
            found.append((name, kind, length))
            if self.peek() != ",":
                break
            self.take(",")
            stars = 0
            while self.peek() == "*":
                self.take("*")
                stars += 1
            kind = CType(kind.base, kind.const, stars)
        self.take(";")
        doc = self.comment_in_line() or before
        return [Field(field, of, length, doc) for field, of, length in found]

    def comment_in_line(self):
        """The comment that begins in the line of the token before; "" if there is none."""
        kind, text, start = self.tokens[self.position]
        before = self.tokens[self.position - 1]
        if kind != "comment" or "\n" in self.text[before[2] + len(before[1]):start]:
            return ""
        self.position += 1
        return self.words_of(text)
