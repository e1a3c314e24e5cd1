"""Assessments written by hand, as `steplap assess` writes them: values that a test can look for on the page."""
import math

HOSTILE = "</script><script>document.title='taken'</script><b>bold</b><img src=x onerror=\"document.title='taken'\">"


def figure(peak, duration):
    times = [duration * i / 200 for i in range(201)]
    return {"times": times, "x": [peak * math.sin(math.pi * i / 200) for i in range(201)],
            "y": [0.3 * peak * math.sin(3 * math.pi * i / 200) for i in range(201)]}


def joint(name, margin, slid=0.0, total=0.0):
    return {"name": name, "slips": slid > 0.0, "margin": margin, "at": 0.121, "slid": slid, "slid_total": total,
            "overlap_left": 1.0 - 50.0 * total, "error": 1e-4}


def lengthwise(verdict, joints, chance):
    return {"model": "transformer, lengthwise", "verdict": verdict, "trust": "Errors are estimated by a finer run.", "joints": joints,
            "feet": [{"name": "rear foot", "lifts": True, "from": 0.107, "height": 0.0012}, {"name": "front foot", "lifts": False, "from": None, "height": None}],
            "reactions": [{"name": "bottom arresting", "value": -193529.3, "allowed": 300000.0, "unit": "N", "share": 0.645}],
            "worst_time": None, "poses": {"tank": [10.0, 1.5, 0.0], "active part": [10.02, 1.5, 0.0]},  # 20 mm forward in the tank
            "clearances": [{"name": "core to tank", "left": 0.012, "allowed": 0.005, "unit": "m"}],
            "findings": ["The wooden block above the rear foot closes."],
            "slip_probability": {"value": chance, "low": 0.5 * chance, "high": min(1.0, 1.5 * chance + 1e-3), "runs": 200}}


def crosswise():
    return {"model": "transformer, crosswise", "verdict": "hold", "trust": "Errors are not estimated.", "joints": [], "feet": [], "reactions": [],
            "clearances": [], "findings": [], "slip_probability": None}


def event(number, time, peak, verdict, joints, chance):
    return {"number": number, "record": "voyage.csv", "time": time, "clock": "2026-01-04T10:25:14.000", "duration": 0.1,
            "peaks": [{"axis": "x", "value": peak, "unit": "m/s^2", "bandwidth": 100, "velocity_change": 0.3},
                      {"axis": "z", "value": 0.3 * peak, "unit": "m/s^2", "bandwidth": 100, "velocity_change": 0.02}],
            "figure": figure(peak, 0.1), "models": [lengthwise(verdict, joints, chance), crosswise()]}


def drawing():
    """A tank of 4 by 3 m with an active part in it."""
    def box(name, w, h):
        return {"name": name, "label": "", "pose": [0.0, 1.5, 0.0], "fixed": False, "is_outline_given": True, "circles": [], "segments": [], "polygons": [], "holes": [],
                "outline": [[-w, -h], [w, -h], [w, h], [-w, h]]}
    return {"bodies": [box("tank", 2.0, 1.5), box("active part", 1.2, 1.0)], "ground": {"circles": [], "segments": [], "polygons": []}, "planes": [], "elements": [], "sheets": [],
            "cores": [], "plots": [], "seen_from": ""}


def assessment():
    """Three events: the second slips by 0.8 mm, the third comes near to it."""
    events = [event(1, 12.34, 9.80665, "hold", [joint("front joint", 1.62), joint("back joint", 1.66)], 0.0),
              event(2, 3601.5, 29.42, "reject", [joint("front joint", 0.97, 0.0008, 0.0008), joint("back joint", 1.08)], 0.93),
              event(3, 7000.25, 19.6, "hold", [joint("front joint", 1.21, 0.0, 0.0008), joint("back joint", 1.3)], 0.04)]
    return {
        "decision": "inspect", "reason": "The front joint slips in event 2 and stays 0.8 mm away from its place.",
        "reasons": [{"criterion": "joints hold", "outcome": "inspect", "text": "A joint that slipped has lost overlap: the core is looked at.", "source": "steplap preset 'core'"},
                    {"criterion": "3 g on each axis", "outcome": "energise", "text": "29.4 m/s² along x is within 3 g.", "source": "Chinese construction and acceptance code, clause 3.3.1"}],
        "records": [{"file": "voyage.csv", "sha256": "ab" * 32, "taken_for": ["time: column 'time', s", "unit: g, of the header"], "warnings": ["2 samples are clipped at 16 g."]}],
        "models": [{"name": "transformer, lengthwise", "file": "lengthwise.toml", "sha256": "cd" * 32, "plane": "lengthwise",
                    "recorder": {"marker": "lid recorder", "body": "tank", "x": "x", "y": "-z"}, "drawing": drawing(), "knows_not": ["bending of sheets and yokes", "torsion of the tank"],
                    "uncertain": [{"path": "element.front joint.friction", "name": "friction of the sheets", "nominal": 0.2, "unit": "", "law": "lognormal, mean 0.2, cov 0.2", "low": 0.13,
                                   "high": 0.3, "source": "assumed", "source_text": "no measured value is published", "share": 0.61},
                                  {"path": "core.core.pressure", "name": "clamping pressure", "nominal": 26000.0, "unit": "Pa", "law": "normal, mean 26 kPa, cov 0.1", "low": 21000.0,
                                   "high": 31000.0, "source": "specified", "source_text": "drawing 4711", "share": 0.3}]},
                   {"name": "transformer, crosswise", "file": "crosswise.toml", "sha256": "ef" * 32, "plane": "crosswise",
                    "recorder": {"marker": "lid recorder", "x": "y", "y": "-z"}, "knows_not": ["the pressure between packets"], "uncertain": []}],
        "shipment": {"file": "papers.toml", "transformer": "T-4711", "departure": "2026-01-04 10:00", "arrival": "2026-01-06 18:00",
                     "recorders": [{"serial": "SL-0815", "record": "voyage.csv", "calibrated": "2025-11-02", "range": "16 g", "filter": "", "place": "lid, above limb 2"}],
                     "handovers": [{"place": "Rotterdam", "time": "2026-01-05 08:00"}]},
        "recorders": [{"files": ["voyage.csv"], "covered": "The record covers 55.9 h.", "greatest": {"x": 29.42, "y": 4.9, "z": None}, "events": 3, "least_margin": 0.97,
                       "decision": "inspect", "reason": "The front joint slips in event 2."},
                      {"files": ["lid.csv"], "covered": "The record covers 55.8 h.", "greatest": {"x": 27.46, "y": 5.1, "z": 9.8}, "events": 4, "least_margin": 1.02,
                       "decision": "energise", "reason": "All 2 criteria are met."}],
        "journey": "2026-01-04 10:00, 2026-01-06 18:00", "covered": "The record covers 55.9 h.", "covered_share": 0.998,
        "events": events,
        "voyage": {"joints": [{"model": "transformer, lengthwise", "name": "front joint", "slid_total": 0.0008, "slips": 1, "overlap_left": 0.96},
                              {"model": "transformer, lengthwise", "name": "back joint", "slid_total": 0.0, "slips": 0, "overlap_left": 1.0}],
                   "damage_probability": {"value": 0.94, "low": 0.9, "high": 0.97, "runs": 200}},
        "hangs_on": ["The decision hangs on the friction of the sheets: at 0.24 instead of 0.2 the front joint holds in event 2."],
        "assumptions": ["The friction of the sheets is assumed, not measured.", "The recorder sits on the lid and is rigidly fixed."],
        "tests": ["Core insulation resistance: sheets that moved may touch a clamp.", "Frequency response against the baseline of the factory."],
        "criteria": {"name": "joints and 3 g", "file": "preset core", "text": "[[criterion]]\nname = \"joints hold\"\n"}}


def long_assessment():
    """500 events and texts without end: what a page must stand."""
    data = assessment()
    endless = "A text of many words that goes on and on, because somebody had much to say about it. " * 12
    solid = "x" * 900
    data["events"] = [event(i + 1, 10.0 * i, 5.0 + 0.05 * i, "open" if i % 7 == 3 else "hold", [joint(f"joint {k} {solid[:60]}", 1.01 + 0.001 * i + 0.1 * k) for k in range(4)], 0.001 * (i % 9))
                      for i in range(500)]
    data["decision"], data["reason"] = "open", endless
    data["reasons"] = [{"criterion": f"criterion {i} {solid[:80]}", "outcome": "open", "text": endless, "source": endless} for i in range(20)]
    data["records"] = [dict(data["records"][0], file=f"record {i} {solid}.csv", taken_for=[endless]) for i in range(12)]
    data["models"][0]["name"] += solid[:200]
    for e in data["events"]:
        e["models"][0]["model"] = data["models"][0]["name"]
    data["models"][0]["knows_not"] = [endless] * 12
    data["voyage"]["joints"] = [{"model": data["models"][0]["name"], "name": f"joint {k} {solid[:60]}", "slid_total": 0.0, "slips": 0, "overlap_left": 1.0} for k in range(40)]
    data["hangs_on"], data["assumptions"], data["tests"] = [endless] * 9, [endless + str(i) for i in range(40)], [solid] * 20
    data["criteria"]["text"] = "\n".join(["criterion = 1"] * 400)
    return data


def hostile_assessment():
    """Markup wherever a name or a text may stand."""
    def poisoned(value, key=""):
        if isinstance(value, dict):
            return {k: poisoned(v, k) for k, v in value.items()}
        if isinstance(value, list):
            return [poisoned(v, key) for v in value]
        kept = ("decision", "outcome", "verdict", "unit", "clock")
        return HOSTILE if isinstance(value, str) and key not in kept else value
    return poisoned(assessment())


def bare_assessment():
    """As little as the page is made of."""
    return {"decision": "energise", "reason": "No event was recorded.", "events": []}


def static_proofs():
    """A joint slips at 12 m/s² forwards and back, a foot lifts at 8 forwards; upwards nothing gives way."""
    polar = []
    for angle in range(0, 360, 5):
        share = abs(math.cos(math.radians(angle)))
        limits = [{"kind": "slips", "element": "front joint", "acceleration": 12.0 / share, "error": 1e-6}] if share > 0.2 else []
        if math.cos(math.radians(angle)) > 0.2:
            limits.append({"kind": "lifts", "element": "rear foot", "acceleration": 8.0 / share, "error": 1e-6})
        first = min(limits, key=lambda l: l["acceleration"]) if limits else None
        polar.append({"angle_deg": angle, "first": f"{first['element']} {first['kind']}" if first else "", "acceleration": first["acceleration"] if first else None,
                      "unit": "m/s^2", "error": 1e-6, "limits": limits})
    cases = [{"name": name, "ax": load[0], "ay": load[1] - 9.81, "load": load, "verdict": verdict, "why": why, "margin": margin, "first": first,
              "reactions": [{"name": "bottom arresting.force", "value": -193524.2, "unit": "N", "allowed": 300000, "share": 0.645}],
              "feet": [{"name": "rear foot", "lifts": name == "forward"}], "remarks": []}
             for name, load, verdict, why, margin, first in (("forward", [9.81, 0.0], "hold", "", 1.22, "rear foot lifts at 8 m/s²"), ("back", [-9.81, 0.0], "hold", "", 1.2, ""),
                                                             ("down", [0.0, -9.81], "hold", "", 2.33, ""), ("up", [0.0, 9.81], "open", "Nothing holds 'active part' upwards.", None, ""))]
    return {"static_proofs": [{"kind": "static proof", "model": "transformer, lengthwise", "plane": "lengthwise", "preset": "iec-1g", "source": "IEC 60076-1:2011, 5.7.4.2, as quoted by the trade",
                               "largest_acceleration": 98.1, "unit": "m/s^2", "cases": cases, "polar": polar, "verdict": "open", "reason": "Upwards nothing holds 'active part'.",
                               "assumptions": ["Loads act so slowly that nothing vibrates."]}]}
