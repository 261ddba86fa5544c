"""Ships, simulations and trials; studies from tables and logs; the command that the package installs."""

from __future__ import annotations

import math
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import trimtab


def test_a_ship_is_estimated_with_source_and_spread() -> None:
    ship = trimtab.Ship.estimate(lpp=85.0, breadth=13.5, draught=4.2, type="coaster", given={"hull.mass": 3.4e6})
    assert (ship.lpp, ship.mass) == (85.0, 3.4e6)
    area = next(e for e in ship.entries if e["key"] == "rudder.area")
    assert area["origin"] == "estimated" and area["spread"] > 0 and "Det Norske Veritas" in area["source"]
    model = ship.model(form="regular")
    assert len(model.free_names) == 11 and model.parameter("resistance.quadratic").prior is not None
    again = pickle.loads(pickle.dumps(ship))
    assert again.particulars == ship.particulars


def test_a_positive_rudder_turns_the_ship_to_starboard() -> None:
    model = trimtab.Ship.estimate(lpp=85.0, breadth=13.5, draught=4.2, type="coaster").model()
    track = model.simulate({"n": 2.0, "delta": np.full(61, 0.3)}, [0, 0, 0, 5, 0, 0], dt=1.0)
    assert track.r[-1] > 0 and track.psi[-1] > 0.5 and track.y[-1] > 0 and track.x[10] > 0
    assert track.t[-1] == 60.0 and len(track) == 61 and track.diverged_at is None
    finer = model.simulate({"n": 2.0, "delta": np.full(61, 0.3)}, [0, 0, 0, 5, 0, 0], dt=1.0, method="rk4", substeps=2)
    assert np.abs(finer.x - track.x).max() < 0.05 * track.x.max()
    assert list(track.to_frame().columns) == ["t", "x", "y", "psi", "u", "v", "r"]


def test_a_table_of_inputs_is_taken_with_its_times() -> None:
    model = trimtab.Ship.estimate(lpp=85.0, breadth=13.5, draught=4.2, type="coaster").model()
    table = pd.DataFrame({"t": 100.0 + 2.0 * np.arange(30), "n": 2.0, "delta": 0.1})
    track = model.simulate(table, [0, 0, 0, 5, 0, 0])
    assert track.t[0] == 100.0 and track.dt == 2.0


def test_trials_have_measures_and_a_track(fitted: trimtab.Fit) -> None:
    starboard, port = fitted.model.trial("turning", speed=6.0, draws=30)
    assert (starboard.side, port.side) == ("starboard", "port")
    measures, interval = starboard.measures, starboard.intervals["tactical_diameter"]
    assert interval[0] < measures["tactical_diameter"] < interval[1]
    assert starboard.states.shape == (len(starboard.t), 6) and starboard.delta.max() == pytest.approx(math.radians(35.0))
    assert {c["verdict"] for c in starboard.criteria} <= {"met", "not_met", "open", "not_applicable"}
    assert len(fitted.model.trial("zigzag", angle_deg=10.0, draws=0)) == 2
    assert "track_reach" in fitted.model.trial("stopping", draws=0)[0].measures


def test_a_study_is_made_of_tables(study: trimtab.Study, tmp_path: Path) -> None:
    tables = {}
    for window in study.windows()[:6]:
        table = window.to_frame()
        table["psi"] = np.degrees(table["psi"])
        table["n"] *= 60.0
        tables[window.recording] = table.rename(columns={"psi": "HDT"})
    made = trimtab.Study.from_dataframe(
        tables, ship=study.ship, units={"psi": "deg", "n": "rpm"}, columns={"psi": "HDT"}, folder=tmp_path / "mine", split=False
    )
    assert len(made.runs) == 6 and (tmp_path / "mine" / "study.toml").is_file()
    own = {w.recording: w for w in study.windows()}
    for window in made.windows():
        expected = own[window.recording].states
        # A heading may begin a turn lower or higher.
        np.testing.assert_allclose(np.delete(window.states, 2, axis=1), np.delete(expected, 2, axis=1), atol=1e-9)
        np.testing.assert_allclose(np.exp(1j * window.states[:, 2]), np.exp(1j * expected[:, 2]), atol=1e-9)
        np.testing.assert_allclose(window.inputs["n"], own[window.recording].inputs["n"])
    assert pickle.loads(pickle.dumps(made)).name == made.name


def test_a_table_without_a_column_is_told(study: trimtab.Study) -> None:
    table = study.windows()[0].to_frame()
    with pytest.raises(KeyError, match="no column `HDT` for psi"):
        trimtab.Study.from_dataframe(table, ship=study.ship, columns={"psi": "HDT"})
    with pytest.raises(trimtab.TrimtabError, match="delta"):
        trimtab.Study.from_dataframe(table.drop(columns=["delta"]), ship=study.ship)
    with pytest.raises(TypeError, match="expected a table with columns"):
        trimtab.Study.from_dataframe([1, 2, 3], ship=study.ship)


def test_a_log_is_imported(study: trimtab.Study, tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    study.windows()[0].to_frame().to_csv(log, index=False)
    made = trimtab.import_log(log, tmp_path / "study", ship=study.ship, units={"n": "rps", "delta": "rad"}, split=False)
    assert len(made.runs) == 1 and made.ship.lpp == study.ship.lpp
    with pytest.raises(trimtab.TrimtabError, match=r'unit of column `delta`.*`units={"delta": "deg or rad"}`'):
        trimtab.import_log(log, tmp_path / "asked", ship=study.ship)
    with pytest.raises(trimtab.TrimtabError, match="nothing.csv"):
        trimtab.import_log(tmp_path / "nothing.csv", tmp_path / "other")


def test_the_command_is_installed() -> None:
    program = Path(sys.executable).with_name("trimtab")
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    assert version.stdout.strip() == f"trimtab {trimtab.__version__}"
    wrong = subprocess.run([program, "fit", "no/study.toml"], capture_output=True, text=True)
    assert wrong.returncode == 2 and "no/study.toml" in wrong.stderr and not wrong.stdout


def test_a_diagnosis_names_what_was_concealed(tmp_path: Path) -> None:
    # A ship that is set to starboard by a current which the model does not know.
    ship = trimtab.Ship.estimate(lpp=85.0, breadth=13.5, draught=4.2, type="coaster")
    model, random = ship.model(), np.random.default_rng(1)
    sd = np.array([0.5, 0.5, 0.002, 0.02, 0.02, 2e-4])
    tables = {}
    for k in range(12):
        t = 2.0 * np.arange(121)
        delta = 0.35 * np.sin(t / (15.0 + k) + k) if k % 2 else np.full(121, 0.05 * (k - 5))
        inputs = {"t": t, "n": 2.0 + 0.2 * np.sin(t / 50.0 + k), "delta": delta}
        around = {"current_north": 0.5, "current_east": -0.4}
        track = model.simulate({**inputs, **around}, [0, 0, 0.5 * k, 5.0, 0, 0], method="rk4", substeps=4)
        noisy = track.states + sd * random.standard_normal(track.states.shape)
        tables[f"run_{k:02}"] = pd.DataFrame({**inputs, **dict(zip(["x", "y", "psi", "u", "v", "r"], noisy.T))})
    study = trimtab.Study.from_dataframe(tables, ship=ship, units={"psi": "rad", "delta": "rad", "n": "rps"}, split=False)
    steps: list[str] = []
    diagnosis = study.diagnose(progress=steps.append)
    assert diagnosis.findings[0]["mechanism"] == "current" and len(steps) > 3
    found = diagnosis.to_frame()
    assert set(found["mechanism"]) == {"current"}
    values = dict(zip(found["parameter"], found["value"]))
    assert values["current.north"] == pytest.approx(0.5, abs=0.1) and values["current.east"] == pytest.approx(-0.4, abs=0.1)
    diagnosis.report(tmp_path / "x.html")
    assert "<html" in (tmp_path / "x.html").read_text()[:300]
    assert diagnosis.improved["current.north"] == pytest.approx(values["current.north"])


def test_a_diagnosis_ends_at_false_with_keyboard_interrupt(study: trimtab.Study) -> None:
    with pytest.raises(KeyboardInterrupt):
        study.diagnose(progress=lambda step: False)
