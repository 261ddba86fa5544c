"""Natural mistakes: each raises an exception whose message says how to correct it, and none is a panic."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trimtab

START = [0.0, 0.0, 0.0, 5.0, 0.0, 0.0]


def literal(words: str) -> str:
    return re.escape(words)


def test_a_study_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(trimtab.StudyError, match="study.toml.*cannot read"):
        trimtab.Study.load(tmp_path / "study.toml")


def test_an_unknown_parameter(study: trimtab.Study) -> None:
    with pytest.raises(trimtab.ModelError, match=literal("did you mean `rudder.lift1`?")):
        study.model["rudder.lift_1"]
    with pytest.raises(trimtab.ModelError, match="unknown parameter"):
        study.model.fix("lift99")
    with pytest.raises(KeyError, match="was not fitted"):
        study.fit(max_iterations=1)["hull.Yvdot"]


def test_a_rudder_angle_in_degrees(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match=literal('inputs["delta"][0] = 35 is outside -1.6 to 1.6') + ".*numpy.radians"):
        study.model.simulate({"n": 2.0, "delta": np.full(20, 35.0)}, START, dt=1.0)


def test_a_propeller_rate_in_rpm(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match="divide rpm by 60"):
        study.model.simulate({"n": 120.0, "delta": np.zeros(20)}, START, dt=1.0)


def test_a_heading_in_degrees(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match=literal("initial_state[2] = 270") + ".*in rad"):
        study.model.simulate({"n": 2.0, "delta": np.zeros(20)}, [0, 0, 270, 5, 0, 0], dt=1.0)


def test_a_list_for_an_array_is_taken_and_a_text_is_told(study: trimtab.Study) -> None:
    track = study.model.simulate({"n": [2] * 20, "delta": [0] * 20}, (0, 0, 0, 5, 0, 0), dt=1.0)
    assert track.states.shape == (20, 6)
    with pytest.raises(TypeError, match=literal('inputs["delta"]: expected numbers')):
        study.model.simulate({"n": 2.0, "delta": ["a"] * 20}, START, dt=1.0)
    with pytest.raises(TypeError, match="expected a dictionary or a table"):
        study.model.simulate(np.zeros((20, 2)), START, dt=1.0)


def test_a_gap_in_the_inputs(study: trimtab.Study) -> None:
    delta = np.zeros(20)
    delta[7] = np.nan
    with pytest.raises(ValueError, match=literal('inputs["delta"][7] = NaN is not a finite number; fill the gap')):
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
    with pytest.raises(ValueError, match=literal("theta[4] (rudder.lift0) = NaN")):
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
    with pytest.raises(ValueError, match="unknown variant `posterior`.*`likelihood`"):
        study.objective(objective="posterior")  # type: ignore[arg-type]
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
    with pytest.raises(trimtab.RecordingsError, match=literal('accept=["sign_error"]')):
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


RADIANS = {"n": "rps", "delta": "rad"}
STRAIGHT = {"n": 2.0, "delta": np.zeros(20)}
GAP = np.where(np.arange(20) == 7, np.nan, 0.0)

# What a newcomer writes, the message, and what he then writes from that alone; `s` is the example study, `t` one of its recordings as a table.
MISTAKES: dict[str, tuple[Callable[[Any, Any], Any], str, Callable[[Any, Any], Any]]] = {
    "wrong unit": (
        lambda s, t: s.model.simulate({**STRAIGHT, "n": 120.0}, START, dt=1.0),
        "divide rpm by 60",
        lambda s, t: s.model.simulate({**STRAIGHT, "n": 120.0 / 60}, START, dt=1.0),
    ),
    "a list of texts for an array": (
        lambda s, t: s.model.simulate({**STRAIGHT, "delta": ["port 10"] * 20}, START, dt=1.0),
        "expected numbers in one dimension (a list, a numpy array, a column of a table)",
        lambda s, t: s.model.simulate({**STRAIGHT, "delta": [0.1] * 20}, START, dt=1.0),
    ),
    "NaN": (
        lambda s, t: s.model.simulate({**STRAIGHT, "delta": GAP}, START, dt=1.0),
        'inputs["delta"][7] = NaN is not a finite number; fill the gap',
        lambda s, t: s.model.simulate({**STRAIGHT, "delta": np.nan_to_num(GAP)}, START, dt=1.0),
    ),
    "missing column": (
        lambda s, t: trimtab.Study.from_dataframe(t.rename(columns={"psi": "HDT_true"}), ship=s.ship, columns={"psi": "HDT"}, split=False),
        "no column `HDT` for psi; its columns are t, x, y, HDT_true",
        lambda s, t: trimtab.Study.from_dataframe(
            t.rename(columns={"psi": "HDT_true"}), ship=s.ship, columns={"psi": "HDT_true"}, units={**RADIANS, "psi": "rad"}, split=False
        ),
    ),
    "unknown parameter": (
        lambda s, t: s.model["rudder.lift_1"],
        "did you mean `rudder.lift1`?",
        lambda s, t: s.model["rudder.lift1"],
    ),
    "psi in degrees": (
        lambda s, t: s.model.simulate(STRAIGHT, [0, 0, 270, 5, 0, 0], dt=1.0),
        "initial_state[2] = 270 is outside -126 to 126; it is the heading, clockwise from north",
        lambda s, t: s.model.simulate(STRAIGHT, [0, 0, np.radians(270), 5, 0, 0], dt=1.0),
    ),
    "float index": (
        lambda s, t: s.fit(max_iterations=1.0),
        "'float' object cannot be interpreted as an integer\nwhile processing 'max_iterations'",
        lambda s, t: s.fit(max_iterations=1),
    ),
    "wrong shape": (
        lambda s, t: s.objective().f([s.objective().x0]),
        "theta: expected numbers in one dimension",
        lambda s, t: s.objective().f(s.objective().x0),
    ),
    "unknown keyword": (
        lambda s, t: s.fit(max_iteration=1),
        "unexpected keyword argument 'max_iteration'",
        lambda s, t: s.fit(max_iterations=1),
    ),
    "file not found": (
        lambda s, t: trimtab.Study.load(s.path.with_name("studie.toml")),
        "studie.toml",
        lambda s, t: trimtab.Study.load(s.path),
    ),
}

@pytest.mark.parametrize("name", MISTAKES)
def test_each_of_ten_mistakes_is_mended_from_its_message(name: str, study: trimtab.Study) -> None:
    wrong, words, right = MISTAKES[name]
    table = study.windows()[0].to_frame()
    with pytest.raises((ValueError, TypeError, KeyError), match=literal(words)) as raised:
        wrong(study, table)
    assert not isinstance(raised.value, SystemError) and "panicked" not in str(raised.value)
    assert right(study, table) is not None
