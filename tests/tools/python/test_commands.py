"""Studies, load cases and assessments from Python: the same numbers as those of the program, and its exit codes as exceptions.

usage: as test_module.py; STEPLAP leads to the program
"""
import json
import math
import os
import pathlib
import signal
import subprocess
import threading
import time

import pytest

import steplap

pandas = pytest.importorskip("pandas", reason="python3-pandas is not installed")
MODELS = pathlib.Path(os.environ["STEPLAP_MODELS"]).resolve()
PROGRAM = os.environ["STEPLAP"]


def said(*arguments):
    return json.loads(subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, text=True).stdout)


def test_tables_of_a_command_are_frames_with_units():
    path = MODELS / "machines/stacked_blocks.toml"
    (rest,) = steplap.command("equilibrium", steplap.load(path))
    poses = rest.tables["poses"]
    assert poses.attrs["units"]["x"] == "m" and poses.attrs["units"]["angle"] == "rad"
    own = steplap.load(path).equilibrium()
    assert set(poses["body"]) == set(own)
    for _, row in poses.iterrows():
        assert (row["x"], row["y"], row["angle"]) == own[row["body"]]
    # All that stands on the deck weighs on the lowest block.
    reactions = rest.tables["reactions"].set_index("name")
    lowest = reactions.value["bottom rear.force"] + reactions.value["bottom front.force"]
    assert math.isclose(lowest, reactions.value["bottom friction.normal"], rel_tol=1e-9) and reactions.unit["bottom rear.force"] == "N"


def test_values_are_laid_over_and_several_models_have_several_results():
    path = MODELS / "machines/ladder.toml"
    light, = steplap.command("equilibrium", path, values={"body.ladder.mass": "7 kg"})
    (heavy, again) = steplap.command("equilibrium", path, steplap.load(path))
    force = [result.tables["reactions"].set_index("name").value["foot.force"] for result in (light, heavy, again)]
    assert math.isclose(2.0 * force[0], force[1], rel_tol=1e-5) and force[1] == force[2]  # weight; the pose gives way by force over stiffness


def test_a_study_has_its_estimates_with_intervals_and_its_samples(tmp_path):
    path, store = MODELS / "studies/critical_pressure.toml", tmp_path / "critical.sqlite"
    study = steplap.study(path, store=store)
    (finding,) = study.findings.to_dict("records")
    (shown,) = said("study", "show", store, "--json")["results"][0]["tables"]["findings"]
    assert finding["value"] == shown["value"] and finding["low"] <= finding["value"] <= finding["high"] and study.is_reached
    assert len(study.samples) == finding["samples"] and study.samples.attrs["units"]["pressure"] == "Pa"
    # At the critical pressure the margin is 1, which lies between those of its neighbours.
    below, above = (study.samples[side(study.samples["pressure"], finding["value"])] for side in (pandas.Series.lt, pandas.Series.gt))
    assert below["margin"].max() < 1.0 < above["margin"].min()
    assert steplap.study(path, store=store).findings.equals(study.findings)  # goes on, with nothing left to do


def test_a_study_from_a_dictionary_is_that_of_its_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    model = steplap.load(MODELS / "studies/transformer.toml")
    made = steplap.study({"title": "Critical pressure", "kind": "critical", "model": model,
                          "critical": {"variable": "pressure", "expression": "margin - 1", "points": 9, "tolerance": 1e-6},
                          "variable": [{"name": "pressure", "path": "core.core.pressure", "range": ["24 kPa", "0.1 MPa"]}],
                          "response": [{"name": "margin", "channel": "* joint.margin", "what": "lowest"}]})
    assert made.findings.equals(steplap.study(MODELS / "studies/critical_pressure.toml").findings)
    assert not list(tmp_path.iterdir())  # without a store nothing is left


def test_what_a_study_did_not_reach_is_a_warning():
    # The record of the golf ball does not fit within its noise: exit code 5.
    with pytest.warns(UserWarning):
        assert not steplap.study(MODELS / "studies/golf_ball_fit.toml").is_reached


def test_load_cases_have_a_verdict_and_limits_with_errors():
    cases = steplap.cases(MODELS / "cases/lorry.toml")
    data = said("cases", MODELS / "cases/lorry.toml", "--json")["results"][0]["load_cases"]
    assert cases.verdict == data["verdict"] and list(cases.cases["name"]) == [case["name"] for case in data["cases"]]
    assert len(cases.limits) == sum(len(case["limits"]) for case in data["cases"]) and (cases.limits["utilisation_error"] >= 0.0).all()
    # A heavier transformer needs more of the chains.
    harder = steplap.cases(steplap.load(MODELS / "cases/lorry.toml"), {"body.transformer.mass": "40 t"})
    worst = [one.limits[one.limits["limit"] == "chains"]["utilisation"].max() for one in (cases, harder)]
    assert worst[1] > worst[0]


def test_exit_codes_are_exceptions(tmp_path, monkeypatch):
    bad = tmp_path / "bad.toml"
    bad.write_text('kind = "x"\n')
    with pytest.raises(steplap.ModelError) as caught:
        steplap.study(bad)
    (problem,) = caught.value.diagnostics
    assert (problem.file, problem.line) == (str(bad), 1) and "'sweep'" in problem.message
    with pytest.raises(FileNotFoundError):
        steplap.study(tmp_path / "nowhere.toml")
    with pytest.raises(steplap.FileError):
        steplap.command("equilibrium", MODELS / "machines/ladder.toml", nonsense=True)
    with pytest.raises(steplap.NumericalFailure):  # friction below 1/(2 tan a): the ladder does not rest
        steplap.command("equilibrium", MODELS / "machines/ladder.toml", values={"element.foot friction.static_friction": 0.25})
    monkeypatch.delenv("STEPLAP")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(steplap.FileError, match="set STEPLAP"):
        steplap.cases(MODELS / "cases/lorry.toml")


def test_a_program_of_another_version_is_refused(tmp_path, monkeypatch):
    other = tmp_path / "steplap"
    other.write_text('#!/bin/sh\necho \'{"version": "0.0.1", "results": []}\'\n')
    other.chmod(0o755)
    monkeypatch.setenv("STEPLAP", str(other))
    with pytest.raises(steplap.Error, match="steplap 0.0.1"):
        steplap.command("equilibrium", MODELS / "machines/ladder.toml")


def test_ctrl_c_stops_a_study_and_its_program(tmp_path):
    # A study of a million samples; the store shows that the program ended, since another one may open it.
    endless = {"title": "endless", "kind": "sample", "model": steplap.load(MODELS / "studies/transformer.toml"), "sample": {"samples": 1000000},
               "variable": [{"name": "pressure", "path": "core.core.pressure", "range": ["24 kPa", "0.1 MPa"]}],
               "response": [{"name": "margin", "channel": "* joint.margin", "what": "lowest"}]}
    timer = threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    began = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            steplap.study(endless, store=tmp_path / "endless.sqlite")
    finally:
        timer.cancel()
    assert time.monotonic() - began < 30.0  # far below the hours that it takes, on a busy machine, too
    ended = subprocess.run(["pgrep", "-f", str(tmp_path)], capture_output=True, text=True)
    assert ended.returncode == 1, ended.stdout
