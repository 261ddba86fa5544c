"""A fit from Python: what it gives, how it is stopped, and that it is the fit of the command."""

from __future__ import annotations

import json
import logging
import os
import re
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import trimtab


def test_a_fit_gives_estimates_with_their_uncertainty(fitted: trimtab.Fit) -> None:
    assert fitted.converged and not fitted.interrupted and fitted.status == "solved"
    assert len(fitted.estimates) == 11 and fitted.cost < fitted.start_cost
    lift = fitted["rudder.lift1"]
    assert fitted["p5"].name == lift.name and lift.symbol == "p5" and lift.unit == "1/rad"
    drag = fitted["resistance.quadratic"]
    assert drag.interval is not None and drag.interval[0] < drag.value < drag.interval[1]
    i = [e.name for e in fitted.estimates].index(drag.name)
    assert fitted.covariance.shape == (11, 11)
    assert np.sqrt(fitted.covariance[i, i]) == pytest.approx(drag.standard_error)
    assert fitted.model["resistance.quadratic"] == pytest.approx(drag.value)
    assert "rudder.lift1" in fitted.to_frame().index
    assert fitted.to_dict()["converged"] is True and "p5" in fitted.report()


def test_it_is_the_fit_of_the_command(folder: Path, fitted: trimtab.Fit) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "trimtab", "fit", str(folder / "study.toml"), "--json"], capture_output=True, text=True, check=True
    )
    result = json.loads(done.stdout)["result"]
    assert [e["value"] for e in result["estimates"]] == fitted.theta.tolist()
    assert result["cost"] == fitted.cost


def test_a_fit_by_likelihood_and_with_another_hessian(study: trimtab.Study, fitted: trimtab.Fit) -> None:
    exact = study.fit(hessian="exact")
    assert exact.cost == pytest.approx(fitted.cost, rel=1e-6)
    assert exact.to_dict()["hessian"] == "exact"
    bounded = study.fit(settings={"constraints": {"thrust": {"on": False}}}, max_iterations=2)
    assert not bounded.converged and "max_iterations" in bounded.status


def test_progress_is_told_and_false_stops_the_fit_with_the_best_point(study: trimtab.Study, fitted: trimtab.Fit) -> None:
    seen: list[trimtab.FitProgress] = []

    def stop_at_three(progress: trimtab.FitProgress) -> bool:
        seen.append(progress)
        return len(seen) < 3

    stopped = study.fit(progress=stop_at_three)
    assert len(seen) >= 3 and seen[0].iteration == 0 and seen[1].cost > 0.0
    assert not stopped.converged and "stopped by the caller" in stopped.status and not stopped.interrupted
    assert stopped.cost > fitted.cost and "best feasible point" in stopped.status


def test_progress_says_which_solve_an_iteration_belongs_to(study: trimtab.Study, fitted: trimtab.Fit) -> None:
    seen: list[trimtab.FitProgress] = []
    study.fit(progress=lambda p: seen.append(p))
    begins = [b for a, b in zip(seen, seen[1:]) if b.solve != a.solve]
    assert seen[0].solve == 1 and all(p.iteration == 0 for p in begins)
    assert {p.part for p in seen} <= {"all runs", "a few runs", "pieces of the runs", "check"}
    assert seen[-1].part == "check"
    whole = [p.cost for p in seen if p.part == "all runs"]
    assert min(whole) >= fitted.cost + fitted.prior_cost - 1e-6 * fitted.cost


def test_ctrl_c_stops_a_fit_with_the_best_point(study: trimtab.Study) -> None:
    def press(progress: trimtab.FitProgress) -> None:
        if progress.iteration == 2:
            signal.raise_signal(signal.SIGINT)

    stopped = study.fit(progress=press)
    assert stopped.interrupted and not stopped.converged and "best feasible point" in stopped.status


def test_ctrl_c_without_a_callback_stops_it_too(study: trimtab.Study) -> None:
    # Read and audited: Ctrl-C before the fit itself is a KeyboardInterrupt.
    study.fit(max_iterations=1, accept=["unit_error"])
    stopped = threading.Event()

    def press() -> None:
        while not stopped.is_set():
            time.sleep(0.05)
            os.kill(os.getpid(), signal.SIGINT)
            return

    thread = threading.Thread(target=press)
    thread.start()
    # Long enough for a signal to come while it runs: the exact Hessian of all runs in each of its iterations.
    fit = study.fit(hessian="exact", tolerance=1e-12, accept=["unit_error"])
    stopped.set()
    thread.join()
    assert fit.interrupted


def test_fits_of_several_threads_take_turns_and_are_the_same(study: trimtab.Study) -> None:
    with ThreadPoolExecutor(4) as threads:
        fits = list(threads.map(lambda _: study.fit(), range(6)))
    assert {fit.cost for fit in fits} == {fits[0].cost} and all(fit.converged for fit in fits)


def test_an_exception_of_the_callback_comes_out_of_the_fit(study: trimtab.Study) -> None:
    def fail(progress: trimtab.FitProgress) -> None:
        raise LookupError("no table for the progress")

    with pytest.raises(LookupError, match="no table"):
        study.fit(progress=fail)


def test_parameters_are_freed_fixed_bounded_and_given_priors_by_name(study: trimtab.Study) -> None:
    model = study.model
    model.fix("rudder.drag0", value=0.06)
    model.fix("p9")
    model.free("flow.asymmetry")
    model.bound("p10", lower=0.5, upper=2.5)
    model.prior("p5", mean=3.0, sd=0.3)
    assert "rudder.drag0" not in model.free_names and "flow.asymmetry" in model.free_names
    assert (model.parameter("p10").lower, model.parameter("p10").upper) == (0.5, 2.5)
    assert model.parameter("p5").prior == (3.0, 0.3)
    fit = study.fit()
    assert 0.5 <= fit["p10"].value <= 2.5
    assert fit.model["rudder.drag0"] == 0.06
    assert fit.prior_weight > 0.0 and fit.prior_cost > 0.0
    assert model.to_frame().loc["rudder.lift1", "prior_mean"] == 3.0


def test_a_fitted_model_is_saved_read_and_pickled_with_its_covariance(
    tmp_path: Path, study: trimtab.Study, fitted: trimtab.Fit
) -> None:
    import pickle

    fitted.save(tmp_path / "fitted.toml")
    read = trimtab.Model.load(tmp_path / "fitted.toml", study.ship)
    again = pickle.loads(pickle.dumps(fitted.model))
    for model in (read, again):
        np.testing.assert_array_equal(model.values(), fitted.model.values())
        assert model.trial("turning", speed=6.0, draws=20)[0].intervals["advance"][0] > 0.0
    used = trimtab.Study.load(study.path, model=tmp_path / "fitted.toml")
    assert used.model["p5"] == fitted.model["p5"]


def test_a_fit_is_judged_on_runs_it_has_not_seen(study: trimtab.Study, fitted: trimtab.Fit) -> None:
    evaluation = study.evaluate(model=fitted.model)
    summary = evaluation.summary("test")
    assert summary is not None and summary["runs_better"] == 8 and summary["cvdm_improvement"]["value"] > 0.5
    assert evaluation.summary("no such group") is None
    assert len(evaluation.to_frame()) == 40


def test_warnings_of_recordings_go_to_the_logger(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    text = (folder / "study.toml").read_text()
    path = folder / "far.toml"
    path.write_text(re.sub(r"max_yaw_rate = \S+", "max_yaw_rate = 1.8", text))
    with caplog.at_level(logging.WARNING, logger="trimtab"):
        trimtab.Study.load(path).objective()
    assert "max_yaw_rate" in caplog.text and "write 0.0314" in caplog.text
