"""Writes the stubs from stubs.pyi, and their docstrings as C++ constants: docs.py TEMPLATE LOOKS STUBS HEADER.

In the template, LENS stands for the lens values that many functions take, as keywords (**LENS) or in a docstring, and
LOOKS for the numbers of the looks, which the file LOOKS lists (module.cpp). In the header, the docstring of the stubs themselves becomes doc::module. The docstring of the function gather becomes doc::gather; of
the class View, doc::View::text; and of its member z, doc::View::z. The constants of functions, and of classes that can be
called, begin with the signature in the form that inspect reads."""
import ast
import re
import sys
import textwrap

LENS = {"focal_length": "mm", "sensor_width": "mm, spans the display window", "fstop": "a number, or inf",
        "lens_radius": "scene units, instead of fstop", "focus_distance": "scene units, or inf", "scene_unit": "metres"}


def looks(path):
    """What each number of a look may be, by its keyword: "0 to 1" for "a number from 0 to 1"."""
    with open(path, encoding="utf-8") as file:
        return {name: re.sub("^a number (?:from|of) ", "", words) for name, words in (line.rstrip("\n").split("\t") for line in file)}


def filled(template, **groups):
    for group, values in groups.items():
        keywords = "".join(rf"\1{name}: Optional[float] = None,\n" for name in values)
        text = ", ".join(f"{name} ({what})" for name, what in values.items())
        template = re.sub(rf"^( +)\*\*{group},\n", keywords, template, flags=re.M)
        template = re.sub(rf"^( +){group}$", lambda found: textwrap.fill(text, 118, initial_indent=found[1], subsequent_indent=found[1]),
                          template, flags=re.M)
    return template


def signature(name, function):
    arguments = function.args
    arguments.args = [argument for argument in arguments.args if argument.arg != "self"]
    for argument in arguments.args + arguments.kwonlyargs:
        argument.annotation = None
    return f"{name}({ast.unparse(arguments)})\n--\n\n"


def constant(name, text):
    return f'inline constexpr const char *{name} = R"doc({text})doc";\n'


def constants(nodes):
    for node in nodes:
        text, name = ast.get_docstring(node), node.name
        if isinstance(node, ast.ClassDef):
            members = [member for member in node.body if isinstance(member, ast.FunctionDef)]
            call = "".join(signature(name, member) for member in members if member.name == "__init__")
            yield f"namespace {name.strip('_')} {{\n{constant('text', call + text) if text else ''}"
            yield from (constant(member.name.strip("_"), ast.get_docstring(member)) for member in members if ast.get_docstring(member))
            yield "}\n"
        elif text:
            yield constant(name, signature(name, node) + text)


with open(sys.argv[1], encoding="utf-8") as template:
    stubs = filled(template.read(), LENS=LENS, LOOKS=looks(sys.argv[2]))
with open(sys.argv[3], "w", encoding="utf-8") as file:
    file.write(stubs)
tree = ast.parse(stubs)
with open(sys.argv[4], "w", encoding="utf-8") as header:
    header.write("#pragma once\nnamespace sparselens::python::doc {\n" + constant("module", ast.get_docstring(tree)))
    header.writelines(constants(node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))))
    header.write("} // namespace sparselens::python::doc\n")
