"""Planar multibody dynamics with exact friction.

    import steplap
    run = steplap.load("models/paper/interference.toml").run()
    print(run.verdict, run.extremes("front joint.margin"))
    run["tank.x"]        # an array of numpy, SI
    run.to_pandas()      # all channels, indexed by time
    run                  # in a notebook: the page of the run
"""
import html as _html
import json as _json

from ._steplap import (Criterion, Diagnostic, Error, Event, FileError, Finding, Joint, Mode, Model, ModelError, NumericalFailure,
                       Run, __version__, load, loads)

__all__ = ["Criterion", "Diagnostic", "Error", "Event", "FileError", "Finding", "Joint", "Mode", "Model", "ModelError",
           "NumericalFailure", "Run", "__version__", "build", "load", "loads"]


def _toml(value, where):
    """A value as TOML, in a line."""
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(item, where) for item in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_toml(str(key), where)} = {_toml(item, f'{where}.{key}')}" for key, item in value.items()) + " }"
    raise TypeError(f"'{where}' takes a number, a text such as \"12 mm\", true or false, a list or a dictionary of these")


def _is_entries(value):
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(item, dict) for item in value)


def build(model, values=None, path="model.toml"):
    """Makes a model from dictionaries and lists, as its file would be: build({"body": [{"name": "box", "mass": "2 t", ...}]}).

    `values` and `path` as for `loads`; `text` of the model is the file. Raises ModelError, TypeError.
    """
    lines = [f"{_toml(str(key), key)} = {_toml(value, key)}" for key, value in model.items() if not isinstance(value, dict) and not _is_entries(value)]
    for key, value in model.items():
        for table in [value] if isinstance(value, dict) else value if _is_entries(value) else []:
            lines += ["", ("[%s]" if isinstance(value, dict) else "[[%s]]") % _toml(str(key), key)]
            lines += [f"{_toml(str(name), key)} = {_toml(item, f'{key}.{name}')}" for name, item in table.items()]
    return loads("\n".join(lines) + "\n", values, path)


def _summary(self):
    """summary.json as a dictionary."""
    return _json.loads(self.json())


def _drawing(self):
    """What the machine looks like, as drawing.json: bodies with poses and outlines, elements, sheets; SI."""
    return _json.loads(self.drawing_text)


def _to_pandas(self):
    """All samples as a pandas.DataFrame, indexed by time in s; columns are channels in SI."""
    import pandas
    return pandas.DataFrame(self.values[:, 1:], index=pandas.Index(self.t, name="t [s]"), columns=self.names[1:], copy=False)


def _plot(self, *channels, axes=None):
    """Channels over time, with matplotlib; returns the axes."""
    import matplotlib.pyplot as plt
    axes = axes if axes is not None else plt.subplots()[1]
    units = dict(zip(self.names, self.units))
    for channel in channels:
        axes.plot(self.t, self[channel], label=f"{channel} [{units[channel]}]" if units[channel] else channel)
    axes.set_xlabel("t [s]")
    axes.legend()
    return axes


def _repr_html(self):
    """The page of the run inside a notebook."""
    return f'<iframe style="width:100%;height:900px;border:0" srcdoc="{_html.escape(self.page())}"></iframe>'


Model.drawing = property(_drawing)
Run.summary = property(_summary)
Run.to_pandas = _to_pandas
Run.plot = _plot
Run._repr_html_ = _repr_html
