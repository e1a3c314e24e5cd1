"""The stubs say what the module has: names, properties, arguments and defaults, by mypy's stubtest; signatures are those of Python.

usage: as test_module.py
"""
import importlib.util
import inspect
import pathlib
import subprocess
import sys

import pytest

import steplap


def test_stubs_agree_with_the_module(tmp_path):
    if not importlib.util.find_spec("mypy"):
        pytest.skip("mypy is not installed")
    package = pathlib.Path(steplap.__file__).parent
    assert (package / "_steplap.pyi").exists() and (package / "py.typed").exists()
    config = tmp_path / "mypy.ini"
    config.write_text("[mypy]\nignore_missing_imports = True\n")  # Debian's pandas and matplotlib have no stubs
    found = subprocess.run([sys.executable, "-m", "mypy.stubtest", "steplap", "--mypy-config-file", str(config)], capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr


def test_every_public_function_has_a_signature_and_a_docstring():
    things = [getattr(steplap, name) for name in steplap.__all__ if name != "__version__"]
    classes = [thing for thing in things if inspect.isclass(thing) and not issubclass(thing, BaseException)]
    functions = [thing for thing in things if inspect.isroutine(thing)]
    functions += [member for cls in classes for name, member in inspect.getmembers(cls, inspect.isroutine) if not name.startswith("_")]
    assert len(classes) >= 13 and len(functions) >= 20
    for function in functions:
        assert inspect.signature(function) and function.__doc__, function
