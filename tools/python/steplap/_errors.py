"""Exceptions of steplap, which the compiled module raises, too."""
import errno
import os
import re
from collections import abc
from typing import Any


class Error(Exception):
    """Base class of all exceptions of steplap."""

    __module__ = "steplap"


class ModelError(Error):
    """The model has errors, which `diagnostics` lists."""

    __module__ = "steplap"

    def __init__(self, message: str = "", diagnostics: abc.Sequence[Any] = ()) -> None:
        super().__init__(message)
        self.diagnostics = list(diagnostics)


class NumericalFailure(Error):
    """A computation failed or was stopped."""

    __module__ = "steplap"


class FileError(Error):
    """A file cannot be read or written. `path`, and `line` from 1; 0: the whole file."""

    __module__ = "steplap"

    def __init__(self, message: str = "", path: str = "", line: int = 0) -> None:
        super().__init__(message)
        self.path = path
        self.line = line


class MissingFileError(ModelError, FileError, FileNotFoundError):
    """A model file, or a file that it names, does not exist. See `path` and `diagnostics`."""

    __module__ = "steplap"
    errno = errno.ENOENT  # of OSError, as `filename`

    def __init__(self, message: str = "", diagnostics: abc.Sequence[Any] = (), path: str = "") -> None:
        super().__init__(message, diagnostics)
        self.path = path

    @property
    def filename(self) -> str:  # type: ignore[override]
        """The missing file."""
        return self.path


def model_error(message: str, diagnostics: abc.Sequence[Any]) -> ModelError:
    """Returns the exception for errors of a model: MissingFileError if a file is missing, otherwise ModelError."""
    for diagnostic in diagnostics:
        missing = re.match(f"cannot read .*?'(.*)': {re.escape(os.strerror(errno.ENOENT))}", diagnostic.message, re.S)
        if missing:
            return MissingFileError(message, diagnostics, missing[1])
    return ModelError(message, diagnostics)
