"""The objective: its derivatives are those of its values, it is what a fit minimises, and it goes where an optimiser takes it."""

from __future__ import annotations

import multiprocessing
import pickle
import threading
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import LinearConstraint, least_squares, minimize

import trimtab


@pytest.fixture
def objective(study: trimtab.Study) -> trimtab.Objective:
    # Priors on one of the terms, so that their rows are tested as well.
    study.model.free("flow.asymmetry")
    return study.objective()


def test_its_derivatives_are_those_of_its_values(objective: trimtab.Objective) -> None:
    x, scales = objective.x0, objective.scales
    grad, jacobian = objective.grad(x), objective.jacobian(x)
    hessian = objective.hessian(x)
    for j in range(len(x)):
        step = np.zeros_like(x)
        step[j] = 1e-5 * scales[j]
        above, below = x + step, x - step
        width = above[j] - below[j]
        slope = (objective.f(above) - objective.f(below)) / width
        assert abs(slope - grad[j]) * scales[j] <= 1e-6 * objective.f(x)
        column = (objective.residuals(above) - objective.residuals(below)) / width
        np.testing.assert_allclose(column, jacobian[:, j], atol=1e-6 * np.abs(jacobian[:, j]).max())
        row = (objective.grad(above) - objective.grad(below)) / width
        size = np.sqrt(np.abs(hessian[j, j] * np.diag(hessian)))
        np.testing.assert_allclose(row / size, hessian[j] / size, atol=1e-5)


def test_values_gradient_and_matrix_follow_from_the_residuals(objective: trimtab.Objective) -> None:
    x = objective.x0 + 0.01 * objective.scales
    r, jacobian = objective.residuals(x), objective.jacobian(x)
    assert r.shape == (objective.size,) and jacobian.shape == (objective.size, len(x))
    assert r @ r == pytest.approx(objective.f(x), rel=1e-12)
    value, grad = objective.f_and_grad(x)
    assert value == objective.f(x) == objective(x)
    np.testing.assert_allclose(2 * jacobian.T @ r, grad, rtol=1e-8, atol=1e-9 * np.abs(grad).max())
    matrix = objective.gauss_newton(x)
    np.testing.assert_allclose(2 * jacobian.T @ jacobian, matrix, rtol=1e-8, atol=1e-9 * np.abs(matrix).max())


def test_labels_say_what_each_residual_compares(objective: trimtab.Objective, study: trimtab.Study) -> None:
    labels, r = objective.labels(), objective.residuals(objective.x0)
    assert len(labels) == objective.size and labels[-1] == ("prior", None, "flow.asymmetry")
    window = study.windows("train")[0]
    run, sample, channel = labels[7]
    assert (run, channel) == (window.name, "y")
    measured = window.states[sample, 1]
    simulated = study.model.simulate(window.inputs, window.initial_state).y[sample]
    # The residual is the difference by the path length and the root of the number of runs: the sign is that of recorded - simulated.
    assert np.sign(r[7]) == np.sign(measured - simulated)


def test_it_is_what_a_fit_minimises(study: trimtab.Study, fitted: trimtab.Fit) -> None:
    objective = study.objective()
    assert objective.names == [e.name for e in fitted.estimates]
    assert objective.f(objective.x0) == fitted.start_cost
    assert objective.f(fitted.theta) == fitted.cost
    constraints = objective.constraints()
    size = np.linalg.norm(constraints.matrix * objective.scales, axis=1)
    assert (constraints.violation(fitted.theta) <= 1e-6 * size).all()
    lower, upper = objective.bounds
    assert (fitted.theta >= lower - 1e-7 * objective.scales).all() and (fitted.theta <= upper).all()


def test_scipy_finds_the_optimum_of_the_fit_with_it(study: trimtab.Study, fitted: trimtab.Fit) -> None:
    objective = study.objective()
    c = objective.constraints()
    scales = objective.scales
    lower, upper = objective.bounds
    # In units of the scales, as every optimiser likes it.
    found = minimize(
        lambda z: objective.f(z * scales),
        np.clip(objective.x0, lower, upper) / scales,
        jac=lambda z: objective.grad(z * scales) * scales,
        hess=lambda z: objective.gauss_newton(z * scales) * np.outer(scales, scales),
        method="trust-constr",
        bounds=list(zip(lower / scales, upper / scales)),
        constraints=[LinearConstraint(c.matrix * scales, c.lower, c.upper)],
        options={"maxiter": 300},
    )
    assert found.fun == pytest.approx(fitted.cost, rel=2e-3)


def test_least_squares_takes_residuals_and_jacobian(study: trimtab.Study) -> None:
    # Few parameters, so that an optimum exists without the constraints.
    study.model.fix("resistance", "rudder.lift2", "rudder.lift3", "rudder.drag0", "rudder.drag1")
    objective = study.objective()
    exact = least_squares(objective.residuals, objective.x0, jac=objective.jacobian, x_scale=objective.scales, ftol=1e-14)
    assert exact.success
    assert exact.cost == pytest.approx(objective.f(exact.x) / 2)
    assert exact.cost < objective.f(objective.x0) / 2
    assert np.abs(objective.grad(exact.x) * objective.scales).max() < 1e-3 * objective.f(exact.x)


def test_where_a_simulation_diverges_the_cost_is_infinite(objective: trimtab.Objective) -> None:
    x = objective.x0.copy()
    x[objective.names.index("rudder.lift1")] = 1e9
    assert objective.f(x) == np.inf
    assert np.isnan(objective.grad(x)).all() and np.isinf(objective.residuals(x)).all()
    assert objective.residuals(x).shape == (objective.size,)
    assert np.isnan(objective.jacobian(x)).all() and np.isnan(objective.gauss_newton(x)).all()


def test_out_of_the_numbers_nothing_is_raised(objective: trimtab.Objective) -> None:
    # L-BFGS-B asks at NaN after an infinite value, and goes back where the answer is infinite too.
    for value in (np.nan, np.inf, -np.inf):
        x = objective.x0.copy()
        x[3] = value
        assert objective.f(x) == objective(x) == np.inf and objective.f_and_grad(x)[0] == np.inf
        assert np.isinf(objective.residuals(x)).all() and objective.residuals(x).shape == (objective.size,)
        for derivatives in (objective.grad, objective.jacobian, objective.gauss_newton, objective.hessian):
            assert np.isnan(derivatives(x)).all()
        assert objective.jacobian(x).shape == (objective.size, len(x)) and objective.hessian(x).shape == (len(x), len(x))
    x[3] = np.nan
    assert np.isnan(objective.constraints().violation(x)).any()
    with pytest.raises(ValueError, match="is not a finite number"):
        objective.model_at(x)


def test_priors_are_rows_of_their_own_and_their_weight_can_be_set(study: trimtab.Study) -> None:
    study.model.prior("rudder.lift1", mean=3.0, sd=0.2)
    light, heavy = study.objective(prior_weight=0.0), study.objective(prior_weight=5.0)
    x = light.x0
    at = x[light.names.index("rudder.lift1")]
    assert light.size + 1 == heavy.size
    assert heavy.f(x) - light.f(x) == pytest.approx(5.0 * ((at - 3.0) / 0.2) ** 2)
    assert study.objective().prior_weight > 0.0


def test_a_pickled_objective_is_the_same_function(objective: trimtab.Objective) -> None:
    again = pickle.loads(pickle.dumps(objective))
    x = objective.x0 + 0.02 * objective.scales
    assert again.names == objective.names and again.prior_weight == objective.prior_weight
    assert again.f(x) == objective.f(x)
    np.testing.assert_array_equal(again.jacobian(x), objective.jacobian(x))


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_other_processes_evaluate_it(objective: trimtab.Objective, method: str) -> None:
    points = [objective.x0 + k * 0.01 * objective.scales for k in range(3)]
    here = [objective.f(x) for x in points]
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map_async(objective.f, points).get(timeout=120) == here


def test_it_releases_the_lock_of_the_interpreter(objective: trimtab.Objective) -> None:
    # Another thread counts while this one is in Rust: while that held the lock, it could not.
    counted, done = [0], threading.Event()

    def count() -> None:
        while not done.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    try:
        before = counted[0]
        objective.hessian(objective.x0)
        during = counted[0] - before
    finally:
        done.set()
        thread.join()
    assert during > 1000


def test_the_number_of_threads_changes_no_bit(objective: trimtab.Objective) -> None:
    x = objective.x0 + 0.03 * objective.scales
    grads = []
    for threads in (1, 3, None):
        trimtab.set_threads(threads)
        grads.append(objective.grad(x + 0.0))
        objective.grad(objective.x0)
    np.testing.assert_array_equal(grads[0], grads[1])
    np.testing.assert_array_equal(grads[0], grads[2])


def test_a_study_in_a_temporary_folder_says_why_it_is_not_pickled(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="folder"):
        pickle.dumps(trimtab.example())


@pytest.fixture(scope="module")
def likelihood(folder: Path) -> trimtab.Objective:
    return trimtab.Study.load(folder).objective(objective="likelihood")


def test_the_derivatives_of_a_likelihood_are_those_of_its_values(likelihood: trimtab.Objective) -> None:
    # Off the point of the gains, within the bounds.
    x, scales = likelihood.x0 + 0.02 * likelihood.scales, likelihood.scales
    grad, jacobian = likelihood.grad(x), likelihood.jacobian(x)
    for j in range(len(x)):
        step = np.zeros_like(x)
        step[j] = 1e-5 * scales[j]
        above, below = x + step, x - step
        width = above[j] - below[j]
        slope = (likelihood.f(above) - likelihood.f(below)) / width
        assert abs(slope - grad[j]) <= 1e-5 * max(abs(grad[j]), np.sqrt(likelihood.f(x)) / scales[j])
        column = (likelihood.residuals(above) - likelihood.residuals(below)) / width
        np.testing.assert_allclose(column, jacobian[:, j], atol=1e-4 * np.abs(jacobian[:, j]).max())


def test_value_gradient_and_matrix_of_a_likelihood_follow_from_its_innovations(likelihood: trimtab.Objective) -> None:
    x = likelihood.x0 + 0.01 * likelihood.scales
    r, jacobian = likelihood.residuals(x), likelihood.jacobian(x)
    assert r.shape == (likelihood.size,) and jacobian.shape == (likelihood.size, len(x))
    assert r @ r / 2 == pytest.approx(likelihood.f(x), rel=1e-10)
    value, grad = likelihood.f_and_grad(x)
    assert value == pytest.approx(likelihood(x), rel=1e-12)
    np.testing.assert_allclose(jacobian.T @ r, grad, atol=1e-9 * np.linalg.norm(jacobian, axis=0).max() * np.linalg.norm(r))
    matrix = likelihood.gauss_newton(x)
    size = np.sqrt(np.diag(matrix))
    np.testing.assert_allclose(jacobian.T @ jacobian / np.outer(size, size), matrix / np.outer(size, size), atol=1e-9)
    labels = likelihood.labels()
    priors = [name for run, _, name in labels if run == "prior"]
    assert len(labels) == likelihood.size and "hull.Yvdot" in priors and likelihood.prior_weight == 0.5
    # Standardised: about one, were the model right.
    assert 0.5 < np.sqrt(np.mean(r**2)) < 2.0


def test_a_likelihood_is_what_a_fit_by_likelihood_minimises(study: trimtab.Study) -> None:
    settings = {"constraints": {"off": True}}
    fit = study.fit(objective="likelihood", settings=settings)
    start = study.objective(objective="likelihood", settings=settings)
    assert start.kind == "likelihood" and start.names == [e.name for e in fit.estimates]
    assert fit.noise is not None
    there = start.renewed(fit.theta, noise=fit.noise)
    np.testing.assert_array_equal(there.x0, fit.theta)
    # With noise and gains of where it ended a Newton step of the parameters at no bound gains next to nothing.
    away = np.minimum(*(np.abs(fit.theta - bound) for bound in there.bounds)) > 1e-2 * there.scales
    grad, matrix = (there.grad(fit.theta) * there.scales)[away], there.gauss_newton(fit.theta) * np.outer(there.scales, there.scales)
    gain = 0.5 * grad @ np.linalg.solve(matrix[np.ix_(away, away)], grad)
    assert 0.0 <= gain < 0.5 and away.sum() > 20
    assert there.f(fit.theta) < there.f(start.x0)
    assert there.noise == fit.noise and len(fit.noise["sensors"]) == 4
    assert there.model_at(fit.theta).free_names == study.model.free_names


def test_gains_are_renewed_where_one_says(study: trimtab.Study) -> None:
    first = study.objective(objective="likelihood", uncertain=False)
    assert first.names == study.model.free_names
    second = first.renewed(first.x0 + 0.3 * first.scales)
    assert first.noise != second.noise and second.names == first.names
    x = first.x0
    assert first.f(x) != second.f(x)
    again = pickle.loads(pickle.dumps(second))
    assert again.f(x) == second.f(x) and again.noise == second.noise and again.kind == "likelihood"
    np.testing.assert_array_equal(again.x0, second.x0)
    free_of_priors = study.objective(objective="likelihood", prior_weight=0.0)
    assert free_of_priors.size + len(free_of_priors.names) > study.objective(objective="likelihood").size
    with pytest.raises(ValueError, match="no gains to renew.*objective=\"likelihood\""):
        study.objective().renewed(x)
    with pytest.raises(ValueError, match="give what Objective.noise or Fit.noise gives"):
        first.renewed(x, noise={"position": 1.0})
    with pytest.raises(ValueError, match="finite numbers above 0"):
        first.renewed(x, noise={**(first.noise or {}), "force_time": 0.0})
    with pytest.raises(ValueError, match="use gauss_newton"):
        first.hessian(x)
    x[first.names.index("rudder.lift1")] = 1e12
    assert first.f(x) == np.inf and np.isnan(first.grad(x)).all() and np.isinf(first.residuals(x)).all()
    with pytest.raises(trimtab.FitError, match="diverges"):
        first.renewed(x)


def test_twenty_starts_of_pypesto_end_where_one_does(study: trimtab.Study) -> None:
    optimize = pytest.importorskip("pypesto.optimize")
    import pypesto

    study.model.fix("resistance", "rudder.lift2", "rudder.lift3", "rudder.drag0", "rudder.drag1")
    objective = study.objective()
    scales, n = objective.scales, len(objective.names)
    # In units of the scales, about the start: pyPESTO draws its starts between bounds.
    lower, upper = (np.clip(side, objective.x0 - 3 * scales, objective.x0 + 3 * scales) / scales for side in objective.bounds)
    problem = pypesto.Problem(
        pypesto.Objective(fun=lambda z: objective.f(z * scales), grad=lambda z: objective.grad(z * scales) * scales),
        lb=lower,
        ub=upper,
        x_names=objective.names,
    )
    np.random.seed(1)
    result = optimize.minimize(
        problem, optimizer=optimize.ScipyOptimizer("L-BFGS-B"), n_starts=20, progress_bar=False, filename=None
    )
    values = np.array(result.optimize_result.fval)
    assert len(values) == 20 and np.isfinite(values).sum() >= 15
    best = least_squares(
        lambda z: objective.residuals(z * scales),
        np.clip(objective.x0 / scales, lower, upper),
        jac=lambda z: objective.jacobian(z * scales) * scales,
        bounds=(lower, upper),
    )
    assert n == len(best.x) and values.min() <= 2 * best.cost * (1 + 1e-6)
    # Most starts find the same optimum.
    assert (values <= values.min() * (1 + 1e-3)).sum() >= 10
