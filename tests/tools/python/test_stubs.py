"""The stubs say what the module has: every class, property, method, argument and default, and nothing else.

usage: as test_module.py
"""
import ast
import inspect
import pathlib
import re

import steplap

STUBS = pathlib.Path(steplap.__file__).with_name("__init__.pyi")
TREE = ast.parse(STUBS.read_text(encoding="utf-8"))
CLASSES = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef)}
# Of exceptions the fields are there once one is raised.
RAISED = {"ModelError": {"diagnostics"}, "FileError": {"path", "line"}}


def own_names(cls):
    inherited = {"__init__", "__repr__", "__str__", "__doc__", "__module__", "__weakref__", "__dict__", "__new__"}
    return {name for name in vars(cls) if name not in inherited and not name.startswith("_pybind11")}


def stubbed_names(node):
    names = {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
    return names | {part.target.id for part in node.body if isinstance(part, ast.AnnAssign)}


def test_the_stubs_are_installed_beside_the_module():
    assert STUBS.exists() and STUBS.with_name("py.typed").exists()


def test_names_of_the_module():
    functions = {node.name for node in TREE.body if isinstance(node, ast.FunctionDef)}
    values = {node.target.id for node in TREE.body if isinstance(node, ast.AnnAssign)} - {"__all__"}
    assert set(CLASSES) | functions | values == set(steplap.__all__)


def test_members_of_the_classes():
    for name, node in CLASSES.items():
        assert stubbed_names(node) == own_names(getattr(steplap, name)) | RAISED.get(name, set()), name


def test_properties_are_properties():
    for name, node in CLASSES.items():
        for part in node.body:
            if not isinstance(part, ast.FunctionDef):
                continue
            is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in part.decorator_list)
            assert is_property == isinstance(inspect.getattr_static(getattr(steplap, name), part.name), property), (name, part.name)


def arguments_of(node):
    """Names with the text of their defaults, None where there is none; self left out."""
    names = [a.arg for a in node.args.args]
    defaults = [None] * (len(names) - len(node.args.defaults)) + [ast.unparse(d) for d in node.args.defaults]
    return [pair for pair in zip(names, defaults) if pair[0] != "self"]


def documented_arguments(function):
    """The same from the first line of what pybind11 says: "run(self: …, method: Optional[str] = None, …) -> …"."""
    signature = function.__doc__.splitlines()[0]
    inside = signature[signature.index("(") + 1 : signature.rindex(") ->")]
    parts, depth, part = [], 0, ""
    for c in inside:
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += c
    pairs = []
    for text in parts + [part]:
        found = re.match(r"\s*(\w+)(?:: [^=]*?)?(?: = (.*))?$", text)
        if found and found[1] not in ("self", "arg0"):
            pairs.append((found[1], found[2]))
    return pairs


def test_arguments_and_defaults():
    checked = 0
    methods = [(getattr(steplap, c), part) for c, node in CLASSES.items() for part in node.body if isinstance(part, ast.FunctionDef) and not part.decorator_list]
    functions = [(steplap, node) for node in TREE.body if isinstance(node, ast.FunctionDef)]
    for owner, node in methods + functions:
        real = inspect.getattr_static(owner, node.name)
        real = getattr(owner, node.name) if not inspect.isfunction(real) else real
        if inspect.isfunction(real):  # written in Python
            names = [p for p in inspect.signature(real).parameters if p != "self"]
            assert names == [a.arg for a in node.args.args if a.arg != "self"] + ([node.args.vararg.arg] if node.args.vararg else []) + [a.arg for a in node.args.kwonlyargs] \
                or set(names) == {a for a, _ in arguments_of(node)} | ({node.args.vararg.arg} if node.args.vararg else set()) | {a.arg for a in node.args.kwonlyargs}, node.name
        else:
            assert arguments_of(node) == documented_arguments(real), (owner, node.name)
        checked += 1
    assert checked >= 14
