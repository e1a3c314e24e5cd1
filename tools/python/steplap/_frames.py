"""Conversion of runs and samples to data frames, figures and pictures."""
import html
import json
from collections import abc
from typing import Any

from ._steplap import Model, Run, _samples

# Style that hides everything on a run's page except the picture and the clock.
_PICTURE_ONLY = "<style>header, footer, #verdict, #near, #plots, #results, #sheets, #more { display: none }</style>"


class Picture:
    """A self-contained HTML page, which notebooks show as the result of a cell. `html` is its text."""

    def __init__(self, page: str, height: int) -> None:
        self.html = page
        self._height = height

    def _repr_html_(self) -> str:
        return f'<iframe style="width:100%;height:{self._height}px;border:0" srcdoc="{html.escape(self.html)}"></iframe>'


def show(self: Run, height: int = 620) -> Picture:
    """Returns an animated picture of the machine, as on the page of the run. `height`: pixels."""
    return Picture(self.page().replace("</head>", _PICTURE_ONLY + "</head>", 1), height)


def repr_html(self: Run) -> str:
    """Returns the page of the run for a notebook."""
    return Picture(self.page(), 900)._repr_html_()


def summary(self: Run) -> dict[str, Any]:
    """Returns summary.json as a dictionary."""
    found: dict[str, Any] = json.loads(self.json())
    return found


def drawing(self: Model) -> dict[str, Any]:
    """Returns the drawing of the machine, as in drawing.json: bodies with poses and outlines, elements, sheets; SI."""
    found: dict[str, Any] = json.loads(self.drawing_text)
    return found


def to_pandas(self: Run) -> Any:
    """Returns a copy of all samples as a pandas.DataFrame, indexed by time in s. Columns are channels in SI; attrs["units"] has their units."""
    import pandas
    frame = pandas.DataFrame(self.values[:, 1:], index=pandas.Index(self.t, name="t [s]"), columns=self.names[1:], copy=True)
    frame.attrs["units"] = dict(zip(self.names[1:], self.units[1:]))
    return frame


def plot(self: Run, *channels: str, axes: Any = None) -> Any:
    """Plots channels over time with matplotlib. Returns the axes."""
    import matplotlib.pyplot as plt
    axes = axes if axes is not None else plt.subplots()[1]
    units = dict(zip(self.names, self.units))
    for channel in channels:
        axes.plot(self.t, self[channel], label=f"{channel} [{units[channel]}]" if units[channel] else channel)
    axes.set_xlabel("t [s]")
    axes.legend()
    return axes


def samples(self: Model, values: abc.Mapping[str, Any], responses: abc.Sequence[tuple[str, str]], estimate: str = "cheap", threads: int = 0) -> Any:
    """Runs the model with many values on all processors. Returns a pandas.DataFrame with one row per run.

    `values`: arrays by path, SI, or a data frame with such columns; a number applies to all runs. `responses`: (channel, "low" | "high" |
    "first" | "final"). `estimate` as for `run`; `threads`: 0 all processors, the numbers are the same for any.

    Columns: the paths; each response, "tank.x high", with "error of tank.x high" (not-a-number: unknown); "verdict"; and "trouble": why a
    run has no numbers or is not to be trusted, or "". attrs["units"] has the units. Ctrl-C ends it. Raises ModelError, ValueError.
    """
    import numpy
    import pandas
    given = dict(values)
    columns = [numpy.atleast_1d(numpy.asarray(column, dtype=float)) for column in given.values()]
    longest = max((column.size for column in columns), default=0)
    if longest == 0 or any(column.ndim != 1 or column.size not in (1, longest) for column in columns):
        raise ValueError("values: one or more paths, each with a number or a row of numbers, all of one length")
    columns = numpy.broadcast_arrays(*columns)
    numbers, verdicts, troubles = _samples(self, list(given), numpy.column_stack(columns), list(responses), threads, estimate)
    named = [f"{channel} {which}" for channel, which in responses]
    frame = pandas.DataFrame(dict(zip(given, columns)))
    for i, name in enumerate(named):
        frame[name] = numbers[:, i]
        frame[f"error of {name}"] = numbers[:, len(named) + i]
    frame["verdict"], frame["trouble"] = verdicts, troubles
    frame.attrs["units"] = {path: self.unit(path) for path in given}
    for name, (channel, _) in zip(named, responses):
        frame.attrs["units"][name] = frame.attrs["units"][f"error of {name}"] = self.channels[channel]
    return frame


for _name, _value in {"show": show, "_repr_html_": repr_html, "to_pandas": to_pandas, "plot": plot, "summary": property(summary)}.items():
    setattr(Run, _name, _value)
for _name, _value in {"samples": samples, "drawing": property(drawing)}.items():
    setattr(Model, _name, _value)
