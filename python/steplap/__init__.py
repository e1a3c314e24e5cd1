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

from ._steplap import (Criterion, Diagnostic, Error, Event, FileError, Finding, Model, ModelError, NumericalFailure, Run,
                       __version__, load)

__all__ = ["Criterion", "Diagnostic", "Error", "Event", "FileError", "Finding", "Model", "ModelError", "NumericalFailure",
           "Run", "__version__", "load"]


def _summary(self):
    """summary.json as a dictionary."""
    return _json.loads(self.json())


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


Run.summary = property(_summary)
Run.to_pandas = _to_pandas
Run.plot = _plot
Run._repr_html_ = _repr_html
