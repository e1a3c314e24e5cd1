"""Planar multibody dynamics with exact friction.

    import steplap
    run = steplap.load("models/paper/interference.toml").run()
    print(run.verdict, run.extremes("front joint.margin"))
    run["tank.x"]        # an array of numpy, SI
    run.to_pandas()      # all channels, indexed by time
    run.show()           # in a notebook: the machine in motion; `run` alone: its page
"""
from collections import abc
from typing import TYPE_CHECKING, Any

from . import _compiled, _frames, _steplap
from ._commands import Assessment, LoadCases, Result, Study, assess, cases, command, study
from ._errors import Error, FileError, MissingFileError, ModelError, NumericalFailure
from ._frames import Picture
from ._steplap import Criterion, Diagnostic, Event, Finding, Joint, Mode, Model, Run, __version__
from ._toml import toml_file as _toml_file

if TYPE_CHECKING:
    from ._steplap import _Path, _Values

__all__ = ["Assessment", "Criterion", "Diagnostic", "Error", "Event", "FileError", "Finding", "Joint", "LoadCases", "MissingFileError",
           "Mode", "Model", "ModelError", "NumericalFailure", "Picture", "Result", "Run", "Study", "__version__", "assess", "build", "cases",
           "command", "load", "loads", "study"]


def load(path: "_Path", values: "_Values" = None) -> Model:
    """Reads a model file. `values` override those of the file, by path. Raises ModelError with all errors, MissingFileError, FileError."""
    return _steplap.load(path, values)


def loads(text: str, values: "_Values" = None, path: "_Path" = "model.toml") -> Model:
    """Reads a model from a text. `values` as for `load`. Raises ModelError.

    `path`: name for messages and results, and the file to which paths in the text are relative; it is not read.
    """
    return _steplap.loads(text, values, path)


def build(model: abc.Mapping[str, Any], values: "_Values" = None, path: "_Path" = "model.toml") -> Model:
    """Makes a model from dictionaries and lists with the structure of a model file: build({"body": [{"name": "box", "mass": "2 t", ...}]}).

    `values` and `path` as for `loads`. The model's `text` is the equivalent file. Raises ModelError, TypeError.
    """
    return loads(_toml_file(model), values, path)
