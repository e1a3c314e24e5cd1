"""Pickling of the compiled classes by any protocol: pybind11's own way aborts the interpreter for protocols 0 and 1."""
import copyreg
from typing import Any

from ._steplap import Criterion, Diagnostic, Event, Finding, Joint, Mode, Model, Run


def _reduce(self: Any) -> tuple[Any, ...]:
    if not hasattr(self, "__setstate__"):
        raise TypeError(f"cannot pickle '{type(self).__name__}': pickle its model")
    return getattr(copyreg, "__newobj__"), (type(self),), self.__getstate__()


for _class in (Criterion, Diagnostic, Event, Finding, Joint, Mode, Model, Run):
    setattr(_class, "__reduce__", _reduce)
