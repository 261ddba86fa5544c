"""Natural mistakes: each raises an exception whose message says how to correct it, and none is a panic."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trimtab
from trimtab import _frames

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


def test_a_channel_of_an_actuator_that_is_left_out(study: trimtab.Study) -> None:
    simulate = study.model.simulate
    with pytest.raises(ValueError, match=literal("there is no `n` (propeller rate)") + ".*" + literal('as in "n": 0.0 for what stands still')):
        simulate({"delta": np.zeros(20)}, START, dt=1.0)
    with pytest.raises(ValueError, match=literal("no `n` (propeller rate) and no `delta` (rudder angle)")):
        simulate({"t": np.arange(20.0)}, START)
    still = simulate({"n": 0.0, "delta": np.zeros(20)}, START, dt=1.0)
    assert still.u[-1] < simulate({"n": 2.0, "delta": np.zeros(20)}, START, dt=1.0).u[-1]


def test_a_channel_of_a_named_actuator_that_is_left_out() -> None:
    ship = trimtab.Ship.from_toml(
        'name = "cat"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 15.0\n'
        '[[actuator]]\nname = "port"\ny = -0.3\nangle = 0\nlaw = "thruster"\n'
        '[[actuator]]\nname = "azi"\nx = -0.5\nlaw = "thruster"\n'
    )
    model, rest = trimtab.Model.from_toml('name = "cat"\nform = "general"\n', ship), [0.0] * 6
    rate = {"port.rate": np.full(20, 10.0)}
    with pytest.raises(ValueError, match=literal("no `azi.rate` (rate of the actuator azi) and no `azi.angle`") + '.*"azi.rate": 0.0'):
        model.simulate(rate, rest, dt=0.1)
    with pytest.raises(KeyError, match=literal("unknown input `azi.rat`, did you mean `azi.rate`?")):
        model.simulate({**rate, "azi.rat": 0.0}, rest, dt=0.1)
    with pytest.raises(ValueError, match=literal('inputs["port.rate"][0] = 1200 is outside') + ".*divide rpm by 60"):
        model.simulate({"port.rate": np.full(20, 1200.0), "azi.rate": 0.0, "azi.angle": 0.0}, rest, dt=0.1)
    track = model.simulate({**rate, "azi.rate": 0.0, "azi.angle": 0.0}, rest, dt=0.1)
    # It pushes ahead, on the port side: the craft turns to starboard.
    assert track.u[-1] > 0.0 and track.r[-1] > 0.0
    ahead = model.simulate({"port.rate": np.zeros(20), "azi.rate": 10.0, "azi.angle": 0.0}, rest, dt=0.1)
    assert ahead.u[-1] > 0.0 and abs(ahead.r[-1]) < 1e-9


def test_theta_of_another_length_or_not_finite(study: trimtab.Study) -> None:
    objective = study.objective()
    with pytest.raises(ValueError, match="theta has 3 values, and 11 are needed, in this order: resistance.linear"):
        objective.f([1.0, 2.0, 3.0])
    x = objective.x0
    x[4] = np.nan
    # An optimiser may ask there; a model is none.
    with pytest.raises(ValueError, match=literal("theta[4] (rudder.lift0) = NaN")):
        objective.model_at(x)
    with pytest.raises(TypeError, match="theta: expected numbers in one dimension"):
        objective.f(np.zeros((2, 11)))


def test_words_for_settings_that_there_are_not(study: trimtab.Study) -> None:
    with pytest.raises(ValueError, match=literal("unknown word `bfgs`; it must be one of `gauss-newton`, `exact`")):
        study.fit(hessian="bfgs")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="max_iteration"):
        study.fit(settings={"max_iteration": 3})
    with pytest.raises(ValueError, match="tolerance"):
        study.fit(tolerance=-1.0)
    with pytest.raises(ValueError, match="unknown word `posterior`.*`likelihood`"):
        study.objective(objective="posterior")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match='give "train", "test" or "all"'):
        study.windows("training")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="there is no fault `x`"):
        study.fit(accept=["x"])
    with pytest.raises(ValueError, match="no mechanism"):
        study.diagnose(withhold=["curent"])
    with pytest.raises(ValueError, match='no trial "turn".*turning'):
        study.model.trial("turn")  # type: ignore[arg-type]


def test_a_word_that_is_misspelt_comes_with_the_one_that_was_meant(study: trimtab.Study) -> None:
    inputs = {"n": 2.0, "delta": np.zeros(20)}
    wrong: list[tuple[Callable[[], object], str]] = [
        (lambda: study.fit(hessian="gauss_nweton"), "gauss-newton"),  # type: ignore[arg-type]
        (lambda: study.fit(objective="likelyhood"), "likelihood"),  # type: ignore[arg-type]
        (lambda: study.objective(objective="trajectorys"), "trajectory"),  # type: ignore[arg-type]
        (lambda: study.fit(settings={"derivatives": "finite-diferences"}), "finite-differences"),
        (lambda: study.fit(settings={"constraints": {"thrust": {"onn": True}}}), "on"),
        (lambda: study.fit(settings={"max_iteration": 3}), "max_iterations"),
        (lambda: study.fit(accept="sign_eror"), "sign_error"),
        (lambda: study.windows("tran"), "train"),  # type: ignore[arg-type]
        (lambda: study.diagnose(withhold="curent"), "current"),
        (lambda: study.model.trial("turnin"), "turning"),  # type: ignore[arg-type]
        (lambda: study.model.simulate(inputs, START, dt=1.0, method="eulr"), "euler"),  # type: ignore[arg-type]
        (lambda: study.ship.model(form="paperr"), "paper"),  # type: ignore[arg-type]
        (lambda: study.ship.model(terms="curent"), "current"),
    ]
    for mistake, meant in wrong:
        with pytest.raises(ValueError, match=literal(f"did you mean `{meant}`?")):
            mistake()
    with pytest.raises(TypeError, match=literal("Study.fit() got an unexpected keyword argument 'max_iter', did you mean `max_iterations`?")):
        study.fit(max_iter=3)  # type: ignore[call-arg]


def test_a_word_alone_is_a_list_of_one(study: trimtab.Study) -> None:
    assert "current" in study.ship.model(terms="current").terms
    assert study.objective(accept="sign_error").size == study.objective(accept=["sign_error"]).size
    with pytest.raises(TypeError, match="Sequence"):
        study.objective(accept=3)  # type: ignore[arg-type]


def test_a_number_of_things_below_the_least(study: trimtab.Study) -> None:
    model, inputs = study.model, {"n": 2.0, "delta": np.zeros(20)}
    wrong: list[tuple[Callable[[], object], str]] = [
        (lambda: study.fit(max_iterations=-1), "`max_iterations` = -1 must be between 1 and 1000000: iterations of the solver"),
        (lambda: study.fit(max_iterations=0), "`max_iterations` = 0 must be between 1 and 1000000: iterations of the solver"),
        (lambda: study.fit(max_iterations=10**30), "must be between 1 and 1000000: iterations of the solver"),
        (lambda: study.fit(settings={"max_iterations": -1}), "found the number `-1`, but it must be a whole number of 0 or more"),
        (lambda: trimtab.set_threads(-1), "count = -1 must be between 1 and 1024"),
        (lambda: trimtab.set_threads(0), "count = 0 must be between 1 and 1024"),
        (lambda: trimtab.set_threads(2000), "count = 2000 must be between 1 and 1024"),
        (lambda: model.simulate(inputs, START, dt=1.0, substeps=-1), "`substeps` = -1 must be between 1 and 1000"),
        (lambda: model.trial("turning", draws=-1), "draws = -1 must be 0 or more"),
        (lambda: model.trial("turning", seed=-1), "seed = -1 must be between 0 and"),
        (lambda: study.diagnose(seed=-1), "seed = -1 must be between 0 and"),
    ]
    for mistake, words in wrong:
        with pytest.raises(ValueError, match=literal(words)):
            mistake()
    assert model.simulate(inputs, START, dt=1.0, substeps=np.int64(2)).diverged_at is None


def test_a_folder_that_is_not_there(tmp_path: Path, study: trimtab.Study) -> None:
    path = tmp_path / "none" / "model.toml"
    for save in (study.model.save, study.ship.save):
        with pytest.raises(trimtab.TrimtabError, match=literal(f"{path}: there is no folder {path.parent}; make the folder first")):
            save(path)
    path.parent.mkdir()
    study.model.save(path)


def test_what_a_function_takes_is_seen_in_its_signature() -> None:
    made, shown = inspect.signature(_frames.from_dataframe), inspect.signature(trimtab.Study.from_dataframe)
    assert {p.name: p.default for p in made.parameters.values()} == {p.name: p.default for p in shown.parameters.values()}
    assert not any(p.kind is p.VAR_KEYWORD for f in (trimtab.Study.fit, trimtab.import_log) for p in inspect.signature(f).parameters.values())
    assert "max_iterations" in inspect.signature(trimtab.Study.fit).parameters


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
    assert study.fit(accept="sign_error", max_iterations=1).cost > 0.0


def test_a_ship_of_an_unknown_type_or_without_length() -> None:
    with pytest.raises(ValueError, match="unknown type `coster`.*coaster"):
        trimtab.Ship.estimate(lpp=85, breadth=13.5, draught=4.2, type="coster")
    with pytest.raises(trimtab.ShipError, match="hull.lpp"):
        trimtab.Ship.estimate(lpp=-85, breadth=13.5, draught=4.2, type="coaster")


def test_every_error_is_one_to_catch() -> None:
    for error in (trimtab.StudyError, trimtab.ShipError, trimtab.ModelError, trimtab.FitError, trimtab.RecordingsError):
        assert issubclass(error, trimtab.TrimtabError) and issubclass(error, ValueError)


def test_a_study_of_tables_names_the_argument_that_is_wrong(study: trimtab.Study) -> None:
    table, ship = study.windows()[0].to_frame(), study.ship
    units = {"psi": "rad", "r": "rad/s", "delta": "rad", "n": "rps"}
    helm = table.rename(columns={"delta": "helm"})

    def made(data: Any = table, **more: Any) -> trimtab.Study:
        return trimtab.Study.from_dataframe(data, **{"ship": ship, "units": units, "split": False, **more})

    wrong: list[tuple[Callable[[], object], str]] = [
        (lambda: made(helm, columns={"helm": "delta"}), 'such as {"delta": "helm"}'),
        (lambda: made(columns={"ruder": "delta"}), 'columns={"ruder": ...}: there is no `ruder`'),
        (lambda: made(units={**units, "psi": "degres"}), 'units={"psi": "degres"}: `degres` is none of rad, deg'),
        (lambda: made(units={**units, "HDG": "deg"}), 'units={"HDG": ...}: there is no `HDG`'),
        (lambda: made(bridge=-1), "bridge=-1: give a positive number of seconds"),
        (lambda: made([table, table]), "several tables go into a dictionary by name"),
        (lambda: made({"a/b": table}), "give it a name that a file can have"),
        (lambda: made(ship={"lpp": 85}), "ship: expected a Ship or the path of a ship file, and got dict"),
        (lambda: made(antenna=(1, 2, 3)), "antenna has 3 values: give two"),
        (lambda: made(unit={}), "from_dataframe() got an unexpected keyword argument 'unit'"),
        (lambda: made(table.assign(u="fast")), "needed: column `u` contains what is no number, such as `fast` in line 2, and is not used"),
        (lambda: made(table.drop(columns=["x", "u", "v"])), 'name it with `columns={"lat": "NAME", "lon": "NAME"}`, `columns={"x": "NAME", "y": "NAME"}` (north and east) or `columns={"cog"'),
        (lambda: made(helm.assign(helm="x"), columns={"delta": "helm"}), "contains what is no number, such as `x` in line 2; write numbers there"),
    ]
    for mistake, words in wrong:
        with pytest.raises((ValueError, TypeError, KeyError), match=literal(words)):
            mistake()
    # A column that one of several tables has.
    parts = {"nav": table[["t", "x", "y", "psi", "u", "v", "r"]], "bridge": helm[["t", "n", "helm"]]}
    assert len(made(parts, columns={"delta": "helm"}).runs) == 1


def test_what_the_audit_asks_of_tables_are_arguments(study: trimtab.Study) -> None:
    units = {"psi": "rad", "r": "rad/s", "delta": "rad", "n": "rps"}

    def made(change: Callable[[Any], Any]) -> trimtab.Study:
        tables = {window.recording: change(window.to_frame()) for window in study.windows()[:6]}
        return trimtab.Study.from_dataframe(tables, ship=study.ship, units=units, split=False)

    degrees = made(lambda table: table.assign(r=np.degrees(table["r"])))
    with pytest.raises(trimtab.RecordingsError, match=literal("correct `unit` or `sign` of `r` or `psi` by `units={...}`; mend it")):
        degrees.objective()
    assert any("by `units={...}`" in issue["next_step"] for issue in degrees.check())
    # A study that is read from its file is mended in its files.
    with pytest.raises(trimtab.RecordingsError, match="in a column map"):
        trimtab.Study.load(degrees.path).objective()
    turned = made(lambda table: table.assign(v=-table["v"]))
    with pytest.raises(trimtab.RecordingsError, match=literal("set `sign = -1` for `v` in columns.toml beside the study")):
        turned.objective()


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
