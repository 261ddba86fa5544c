"""Natural mistakes: each is told in words from which it can be mended, as an exception, and none as a panic."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import trimtab

START = [0.0, 0.0, 0.0, 5.0, 0.0, 0.0]


def told(words: str) -> str:
    return re.escape(words)


def test_a_study_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(trimtab.StudyError, match="study.toml.*cannot read"):
        trimtab.Study.load(tmp_path / "study.toml")


def test_an_unknown_parameter(study: trimtab.Study) -> None:
    with pytest.raises(trimtab.ModelError, match=told("did you mean `rudder.lift1`?")):
        study.model["rudder.lift_1"]
    with pytest.raises(trimtab.ModelError, match="unknown parameter"):
        study.model.fix("lift99")
    with pytest.raises(KeyError, match="was not fitted"):
        study.fit(max_iterations=1)["hull.Yvdot"]


def test_a_rudder_angle_in_degrees(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match=told('inputs["delta"][0] = 35 is outside -1.6 to 1.6') + ".*numpy.radians"):
        study.model.simulate({"n": 2.0, "delta": np.full(20, 35.0)}, START, dt=1.0)


def test_a_propeller_rate_in_rpm(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match="divide rpm by 60"):
        study.model.simulate({"n": 120.0, "delta": np.zeros(20)}, START, dt=1.0)


def test_a_heading_in_degrees(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match=told("initial_state[2] = 270") + ".*in rad"):
        study.model.simulate({"n": 2.0, "delta": np.zeros(20)}, [0, 0, 270, 5, 0, 0], dt=1.0)


def test_a_list_for_an_array_is_taken_and_a_text_is_told(study: trimtab.Study) -> None:
    track = study.model.simulate({"n": [2] * 20, "delta": [0] * 20}, (0, 0, 0, 5, 0, 0), dt=1.0)
    assert track.states.shape == (20, 6)
    with pytest.raises(TypeError, match=told('inputs["delta"]: expected numbers')):
        study.model.simulate({"n": 2.0, "delta": ["a"] * 20}, START, dt=1.0)
    with pytest.raises(TypeError, match="expected a dictionary or a table"):
        study.model.simulate(np.zeros((20, 2)), START, dt=1.0)


def test_a_gap_in_the_inputs(study: trimtab.Study) -> None:
    delta = np.zeros(20)
    delta[7] = np.nan
    with pytest.raises(ValueError, match=told('inputs["delta"][7] = NaN is not a finite number; fill the gap')):
        study.model.simulate({"n": 2.0, "delta": delta}, START, dt=1.0)


def test_no_sample_period_and_uneven_times(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match="give the sample period `dt`"):
        study.model.simulate({"n": 2.0, "delta": np.zeros(20)}, START)
    t = np.arange(20.0)
    t[10:] += 3.0
    with pytest.raises(ValueError, match="numpy.interp"):
        study.model.simulate({"t": t, "n": 2.0, "delta": np.zeros(20)}, START)


def test_an_unknown_input_and_columns_of_unequal_length(study: trimtab.Study) -> None:
    with pytest.raises(KeyError, match="unknown input `rudder`"):
        study.model.simulate({"n": 2.0, "rudder": np.zeros(20)}, START, dt=1.0)
    with pytest.raises(ValueError, match="another input has 20"):
        study.model.simulate({"n": np.full(19, 2.0), "delta": np.zeros(20)}, START, dt=1.0)


def test_a_state_of_five_values(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match="has 5 values, and 6 are needed.*psi"):
        study.model.simulate({"n": 2.0, "delta": np.zeros(20)}, START[:5], dt=1.0)


def test_theta_of_another_length_or_not_finite(study: trimtab.Study) -> None:
    objective = study.objective()
    with pytest.raises(ValueError, match="theta has 3 values, and 11 are needed, in this order: resistance.linear"):
        objective.f([1.0, 2.0, 3.0])
    x = objective.x0
    x[4] = np.nan
    with pytest.raises(ValueError, match=told("theta[4] (rudder.lift0) = NaN")):
        objective.grad(x)
    with pytest.raises(TypeError, match="theta: expected numbers in one dimension"):
        objective.f(np.zeros((2, 11)))


def test_words_for_settings_that_there_are_not(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match="hessian|unknown variant"):
        study.fit(hessian="bfgs")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="max_iteration"):
        study.fit(settings={"max_iteration": 3})
    with pytest.raises(ValueError, match="tolerance"):
        study.fit(tolerance=-1.0)
    with pytest.raises(ValueError, match="by likelihood"):
        study.objective(objective="likelihood")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match='give "train", "test" or "all"'):
        study.windows("training")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="there is no fault `x`"):
        study.fit(accept=["x"])
    with pytest.raises(ValueError, match="no mechanism"):
        study.diagnose(withhold=["curent"])
    with pytest.raises(ValueError, match='no trial "turn".*turning'):
        study.model.trial("turn")  # type: ignore[arg-type]


def test_a_float_for_a_whole_number(study: trimtab.Study) -> None:
    with pytest.raises(TypeError):
        study.fit(max_iterations=10.5)  # type: ignore[arg-type]


def test_a_value_outside_its_bounds_changes_nothing(study: trimtab.Study) -> None:
    before = study.model["rudder.drag0"]
    with pytest.raises(trimtab.ModelError, match="within the bounds"):
        study.model.bound("rudder.drag0", lower=5.0, upper=6.0)
    with pytest.raises(ValueError, match="needs both mean and sd"):
        study.model.prior("rudder.drag0", mean=1.0)
    assert study.model["rudder.drag0"] == before


def test_nothing_free(study: trimtab.Study) -> None:
    study.model.fix("resistance", "rudder", "propeller")
    for ask in (study.fit, study.objective):
        with pytest.raises(trimtab.FitError, match="no parameter is free"):
            ask()


def test_recordings_that_contradict_themselves_stop_a_fit_by_name(folder: Path) -> None:
    text = (folder / "study.toml").read_text()
    runs = (folder / "runs.csv").read_text().splitlines()
    for run in runs[1:]:
        path = folder / run.split(",")[0]
        header, *rows = path.read_text().splitlines()
        at = [name.split(" ")[0] for name in header.split(",")].index("r")
        turned = [",".join(f"-{v}" if i == at else v for i, v in enumerate(row.split(","))).replace("--", "") for row in rows]
        copy = folder / "turned" / path.relative_to(folder)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text("\n".join([header, *turned]) + "\n")
    for name in ("ship.toml", "model.toml", "baseline.toml", "runs.csv"):
        (folder / "turned" / name).write_text((folder / name).read_text())
    (folder / "turned" / "study.toml").write_text(text)
    study = trimtab.Study.load(folder / "turned")
    with pytest.raises(trimtab.RecordingsError, match=told('accept=["sign_error"]')):
        study.fit()
    assert any(issue["fault"] == "sign_error" for issue in study.check())
    assert study.fit(accept=["sign_error"], max_iterations=20).cost > 0.0


def test_a_ship_of_an_unknown_type_or_without_length() -> None:
    with pytest.raises(ValueError, match="unknown type `coster`.*coaster"):
        trimtab.Ship.estimate(lpp=85, breadth=13.5, draught=4.2, type="coster")
    with pytest.raises(trimtab.ShipError, match="hull.lpp"):
        trimtab.Ship.estimate(lpp=-85, breadth=13.5, draught=4.2, type="coaster")


def test_every_error_is_one_to_catch() -> None:
    for error in (trimtab.StudyError, trimtab.ShipError, trimtab.ModelError, trimtab.FitError, trimtab.RecordingsError):
        assert issubclass(error, trimtab.TrimtabError) and issubclass(error, ValueError)
