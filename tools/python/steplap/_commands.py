"""Studies, load cases and assessments: runs the installed program `steplap` and converts its `--json` output to data frames of pandas.

A separate process gives the same numbers, checks and resumable stores as the command line, without further bindings.
"""
import io
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import warnings
from collections import abc
from contextlib import contextmanager
from typing import Any

from ._errors import Error, FileError, NumericalFailure, model_error
from ._steplap import Diagnostic, Model, __version__
from ._toml import overrides, toml_file

_SECONDS_TO_STOP = 10.0  # time for a stopped program to save its results before it is killed, s


def _program() -> str:
    found = os.environ.get("STEPLAP") or shutil.which("steplap")
    if not found:
        raise FileError("the program 'steplap' is not found: install the package steplap (studies: steplap-study), or set STEPLAP to its path")
    return found


def _diagnostics(message: str) -> list[Diagnostic]:
    """Returns the errors in a message, "file:line:column: error: text", or "error: text"."""
    found = re.findall(r"^(?:(.*?):(\d+):(\d+): )?error: (.*)$", message, re.M)
    return [Diagnostic(what, file, int(line or 0), int(column or 0)) for file, line, column, what in found]


def _fail(code: int, message: str) -> None:
    message = message.strip() or f"steplap ended with code {code}"
    if code == 2:
        raise FileError(message)
    if code == 3:
        raise model_error(message, _diagnostics(message))
    raise (NumericalFailure if code == 4 else Error)(message)


def _call(arguments: abc.Sequence[str], accepted: abc.Sequence[int]) -> tuple[int, str, str]:
    """Runs the program. Returns its exit code, output and messages. KeyboardInterrupt stops the program, too."""
    process = subprocess.Popen([_program(), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
    try:
        output, messages = process.communicate()
    except BaseException:
        process.terminate()
        try:
            process.communicate(timeout=_SECONDS_TO_STOP)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
        raise
    if process.returncode not in accepted:
        _fail(process.returncode, messages)
    return process.returncode, output, messages


@contextmanager
def _files(given: abc.Sequence[Any]) -> abc.Iterator[list[str]]:
    """Yields the paths of the given files and models; models are written to temporary files."""
    with tempfile.TemporaryDirectory(prefix="steplap-") as folder:
        paths = []
        for i, one in enumerate(given):
            if isinstance(one, Model):
                path = pathlib.Path(folder, str(i), pathlib.Path(one.path).name)
                path.parent.mkdir()
                path.write_text(one.text, encoding="utf-8")
                paths.append(str(path))
            else:
                paths.append(os.fspath(one))
        yield paths


def _option(name: str, value: Any) -> list[str]:
    """Returns an option of the command line: time_unit="ms" is --time-unit ms, force=True is --force, a list repeats the option."""
    flag = "--" + name.replace("_", "-")
    if value is None or value is False:
        return []
    if value is True:
        return [flag]
    if isinstance(value, (list, tuple)):
        return [part for item in value for part in _option(name, item)]
    return [flag, os.fspath(value) if hasattr(value, "__fspath__") else str(value)]


def _options(options: abc.Mapping[str, Any]) -> list[str]:
    return [part for name, value in options.items() for part in _option(name, value)]


def _set(values: Any) -> list[str]:
    return [part for text in overrides(values) for part in ("--set", text)]


def frame(rows: Any) -> Any:
    """Converts a table of the program to a pandas.DataFrame. Units are in `attrs["units"]`; if a column has several, in a column "unit of X"."""
    import pandas
    if isinstance(rows, abc.Mapping):
        rows = [{"name": name, **(cell if isinstance(cell, abc.Mapping) else {"value": cell, "unit": ""})} for name, cell in rows.items()]
    units: dict[str, list[str | None]] = {}
    plain = []
    for row in rows:
        values = {}
        for name, cell in row.items():
            is_quantity = isinstance(cell, abc.Mapping) and "unit" in cell
            values[name] = cell["value"] if is_quantity else cell
            units.setdefault(name, []).append(cell["unit"] if is_quantity else None)
        plain.append(values)
    table = pandas.DataFrame(plain)
    known = {name: {unit for unit in all_units if unit is not None} for name, all_units in units.items()}
    table.attrs["units"] = {name: next(iter(some)) for name, some in known.items() if len(some) == 1}
    for name, some in known.items():
        if len(some) > 1:
            table[f"unit of {name}"] = units[name]
    return table


class Result:
    """Output of a command: `text` (lines outside tables), `tables` (data frames by name), `data` (the JSON)."""

    def __init__(self, data: abc.Mapping[str, Any]) -> None:
        self.data = dict(data)
        self.text: list[str] = list(data.get("text", []))
        self.tables: dict[str, Any] = {name: frame(rows) for name, rows in data.get("tables", {}).items()}

    def __repr__(self) -> str:
        return "\n".join(self.text) or f"<steplap.Result {self.data.get('about', '')}>"


def _checked(output: str) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(output)
    if data.get("version", __version__) != __version__:
        raise Error(f"'{_program()}' is steplap {data['version']}, this module {__version__}: set STEPLAP to the program of the same version")
    return data


def command(name: str, *files: Any, values: Any = None, **options: Any) -> list[Result]:
    """Runs a command of the program that has --json, such as command("equilibrium", model). Returns one result per model, in order.

    `files`: paths or models. `values` override those of the models, as for `load`. `options`: of the command line, wrench="53 kN,0,0". Raises
    ModelError, NumericalFailure, FileError.
    """
    with _files(files) as paths:
        _, output, _ = _call([name, *paths, "--json", *_set(values), *_options(options)], (0,))
    return [Result(one) for one in _checked(output)["results"]]


class LoadCases:
    """Verdict on all load cases of a model: `verdict`, `reason`; data frames `cases`, and `limits` with errors of the utilisations."""

    def __init__(self, data: abc.Mapping[str, Any]) -> None:
        self.data = dict(data)
        self.verdict: str = data["verdict"]
        self.reason: str = data["reason"]
        columns = ("name", "plane", "source", "verdict", "reason", "governing_limit")
        self.cases = frame([{name: case.get(name) for name in columns} for case in data["cases"]])
        self.limits = frame([{"case": case["name"], **limit} for case in data["cases"] for limit in case["limits"]])

    def __repr__(self) -> str:
        return f"<steplap.LoadCases: {self.verdict}. {self.reason}>"


def cases(model: Any, values: Any = None, estimate_error: bool = False) -> LoadCases:
    """Runs all [[case]]s of a model (a Model, or the path of its file) as `steplap cases` does, or of two models of different planes in a
    list. Raises ModelError, NumericalFailure."""
    with _files(model if isinstance(model, list) else [model]) as paths:
        _, output, _ = _call(["cases", *paths, "--json", *_set(values), *_option("estimate-error", estimate_error)], (0,))
    return LoadCases(_checked(output)["results"][0]["load_cases"])


class Study:
    """Results of a study. `findings`: one row per result, with its interval `low` to `high`. `samples`: one row per run, with its error.

    `is_reached`: False if the required accuracy was not reached, or if there is no result. `text`: output of the program.
    """

    def __init__(self, text: abc.Sequence[str], findings: Any, samples: Any, is_reached: bool) -> None:
        self.text = list(text)
        self.findings = findings
        self.samples = samples
        self.is_reached = is_reached

    def __repr__(self) -> str:
        return "\n".join([*self.text, str(self.findings)])


def _exported(store: str, *options: str) -> Any:
    import pandas
    return pandas.read_csv(io.StringIO(_call(["study", "export", store, *options], (0, 5))[1]), keep_default_na=False, na_values=["", "nan"])


def study(what: Any, store: Any = None, threads: int | None = None, restart: bool = False, changed: bool = False) -> Study:
    """Runs a study. `what`: path of its file, or a dictionary with the structure of the file, whose `model` may be a Model.

    `store`: file for the samples, from which an interrupted study continues; default: samples are not kept. `threads`: default all processors.
    Raises ModelError for the study or its model, FileError for a store that cannot be used, NumericalFailure for an answer that is not to
    be trusted. Warns if the required accuracy was not reached, or if there is no result.
    """
    is_written = isinstance(what, abc.Mapping)
    with _files([what["model"]] if is_written and "model" in what else []) as models, tempfile.TemporaryDirectory(prefix="steplap-") as folder:
        path = os.path.join(folder, "study.toml") if is_written else os.fspath(what)
        if is_written:
            text = toml_file({**what, **({"model": os.path.abspath(models[0])} if models else {})})
            pathlib.Path(path).write_text(text, encoding="utf-8")
        kept = os.fspath(store) if store is not None else os.path.join(folder, "study.sqlite")
        options = _options({"output": kept, "threads": threads, "restart": restart, "changed": changed})
        code, output, messages = _call(["study", "run", path, "--json", *options], (0, 5))
        text = _checked(output)["results"][0]["text"]
        samples = _exported(kept)
        samples.attrs["units"] = dict(_exported(kept, "--variables").fillna("").set_index("name")["unit"])
        found = Study(text, _exported(kept, "--findings"), samples, code == 0)
    if not found.is_reached:
        warnings.warn(messages.strip() or "the study did not reach the wanted accuracy, or found nothing", stacklevel=2)
    return found


_DECISIONS = {0: "energise", 10: "inspect", 11: "return", 12: "open"}


class Assessment:
    """The decision on a transport: `decision` ("energise", "inspect", "return" or "open"), `reason`; data frames `reasons` and `events`.

    `data`: assessment.json.
    """

    def __init__(self, data: abc.Mapping[str, Any]) -> None:
        self.data = dict(data)
        self.decision: str = data["decision"]
        self.reason: str = data["reason"]
        self.reasons = frame(data["reasons"])
        columns = ("number", "record", "time", "begin", "end", "duration")
        self.events = frame([{name: event.get(name) for name in columns} for event in data["events"]])
        self.events.attrs["units"] = {"time": "s", "begin": "s", "end": "s", "duration": "s"}

    def __repr__(self) -> str:
        return f"<steplap.Assessment: {self.decision}. {self.reason}>"


def assess(*records: Any, models: abc.Sequence[Any], values: Any = None, output: Any = None, **options: Any) -> Assessment:
    """Makes a decision from recorder files and models (paths, or Models with a [[recorder]]), like `steplap assess`.

    `output`: folder for the assessment, from which it can continue and which `steplap report` prints; default: not kept. `options`:
    those of the command line, gravity="z", cfc=60, voyage="0,10", samples=0. Raises FileError for a record or an option, ModelError,
    NumericalFailure.
    """
    with _files(models) as paths, tempfile.TemporaryDirectory(prefix="steplap-") as folder:
        kept = os.fspath(output) if output is not None else os.path.join(folder, "assessment")
        named = [part for path in paths for part in ("--model", path)]
        arguments = ["assess", *map(os.fspath, records), *named, "--output", kept, "--json", *_set(values), *_options(options)]
        code, said, _ = _call(arguments, tuple(_DECISIONS))
    found = Assessment(_checked(said))
    if found.decision != _DECISIONS[code]:
        raise Error(f"steplap assess says '{found.decision}' and ends with code {code}, which is '{_DECISIONS[code]}'")
    return found
