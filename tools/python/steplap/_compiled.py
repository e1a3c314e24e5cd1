"""Prevents crashes that pybind11 permits in compiled classes: objects without contents, and pickles of protocols 0 and 1."""
from typing import Any

from ._steplap import Criterion, Diagnostic, Event, Finding, Joint, Mode, Model, Run

_MADE_BY_STEPLAP_ONLY: tuple[type, ...] = (Criterion, Event, Finding, Joint, Mode, Model, Run)
_empty = Model.__new__  # the same for all compiled classes


def _refuse(cls: type, *args: Any, **kwargs: Any) -> Any:
    raise TypeError(f"{cls.__name__}: steplap makes these, no constructor does")


def _restored(cls: type, state: Any) -> Any:
    made: Any = _empty(cls)
    made.__setstate__(state)
    return made


def _reduce(self: Any) -> tuple[Any, ...]:
    if not hasattr(self, "__setstate__"):
        raise TypeError(f"cannot pickle '{type(self).__name__}': pickle its model")
    return _restored, (type(self), self.__getstate__())


for _class in (*_MADE_BY_STEPLAP_ONLY, Diagnostic):
    setattr(_class, "__reduce__", _reduce)
for _class in _MADE_BY_STEPLAP_ONLY:
    setattr(_class, "__new__", _refuse)
