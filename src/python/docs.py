"""Writes the stubs from stubs.pyi, and their docstrings as C++ constants: docs.py TEMPLATE LOOKS STUBS HEADER.

The template says each keyword once: "names: type = default,  # text". Lines that are comments alone go on with the text.
It becomes a line in the docstring of the function or class, after the first paragraph. A function in capitals is a
group: **GROUP stands for its keywords, with their texts; with one text for all; or, if that ends with a colon, with a
list of names and their texts. **LOOKS are the numbers of the looks, which the file LOOKS lists (list_looks.cpp). A member
of a class that has a text becomes a property.

In the header, the docstring of the stubs themselves becomes doc::module. The docstring of the function gather becomes
doc::gather; of the class View, doc::View::text; and of its member z, doc::View::z. The constants of functions, and of
classes that can be called, begin with the signature in the form that inspect reads."""
import ast
import re
import sys
import textwrap


def looks(path):
    """What each number of a look may be, by its keyword: "0 to 1" for "a number from 0 to 1"."""
    with open(path, encoding="utf-8") as file:
        lines = [line.rstrip("\n").split("\t") for line in file]
    return [(f"{name}: Optional[float] = None,", re.sub("^a number (?:from|of) ", "", words)) for name, words in lines]


def wrapped(text, indent, further=""):
    return textwrap.fill(text, 120, initial_indent=indent, subsequent_indent=indent + further, break_on_hyphens=False)


def entries(lines):
    """Pairs of code and its text."""
    joined = re.sub(r"\n *# ", " ", lines)
    return [line.strip().partition("  # ")[::2] for line in joined.splitlines()]


def each(code):
    """The code for each of its names."""
    names, colon, rest = code.partition(":")
    return [name + colon + rest for name in names.split(", ")]


def spelled_out(keywords, groups):
    """The code of all keywords, and the lines of a docstring on them."""
    codes, lines = [], []
    for code, text in keywords:
        more, names = each(code), code.partition(":")[0]
        said = [f"{names}: {text}"] if text else []
        if code.startswith("**"):
            group = groups[code[2:-1]]
            more, of_group = spelled_out(group, groups)
            names = ", ".join(keyword.partition(":")[0] for keyword in more)
            brackets = ", ".join(f"{keyword.partition(':')[0]} ({what})" for keyword, what in group)
            said = [text, "  " + brackets] if text.endswith(":") else [f"{names}: {text}"] if text else of_group
        codes += more
        lines += said
    return codes, lines


def member(found):
    (code, text), = entries(found[0])
    if not text:
        return "".join(f"    {one}\n" for one in each(code))
    name, type = code.split(": ")
    return f'    @property\n    def {name}(self) -> {type}:\n' + wrapped(f'"""{text}"""', " " * 8) + "\n"


def statement(text, groups):
    """A function or class of the template, as in the stubs."""
    lines = []

    def arguments(found):
        codes, said = spelled_out(entries(found[3]), groups)
        lines.extend(said)
        return found[1] + "".join(f"{found[2]}    {code}\n" for code in codes) + found[2] + ")"

    if text.startswith("class "):
        text = re.sub(r"^    \w+(?:, \w+)*: .*\n(?:    # .*\n)*", member, text, flags=re.M)
        name = re.split(r"\W", text)[1]
        text = text.replace("\n    ) -> None: ...\n", f'\n    ) -> None:\n        """See help(sparselens.{name})."""\n')
    text = re.sub(r"^(( *)def \w+\(\n)(.*?)^ *\)", arguments, text, flags=re.M | re.S)
    added = "".join("\n" + wrapped(line, "    ", "  ") for line in ["", *lines] if lines)
    return re.sub(r'(""".*?)(\n\n|""")', lambda found: found[1] + added + found[2], text, count=1, flags=re.S)


def filled(template, groups):
    """The stubs."""
    def group(found):
        groups[found[1]] = entries(found[2])
        return ""

    template = re.sub(r"^def ([A-Z]+)\(\n(.*?)^\): \.\.\.\n", group, template, flags=re.M | re.S)
    first, *others = re.split(r"^(?=class |def )", template, flags=re.M)
    return first + "".join(statement(text, groups) for text in others)


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
    stubs = filled(template.read(), {"LOOKS": looks(sys.argv[2])})
with open(sys.argv[3], "w", encoding="utf-8") as file:
    file.write(stubs)
tree = ast.parse(stubs)
with open(sys.argv[4], "w", encoding="utf-8") as header:
    header.write("#pragma once\nnamespace sparselens::python::doc {\n" + constant("module", ast.get_docstring(tree)))
    header.writelines(constants(node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))))
    header.write("} // namespace sparselens::python::doc\n")
