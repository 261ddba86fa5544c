"""A force of one's own in Python: the same answers as the term of the catalogue with the same equation."""

from __future__ import annotations

import numpy as np
import pytest

import trimtab

CALLS: list[tuple[int, ...]] = []


def quadratic_drag(at: dict[str, np.ndarray], p: dict[str, np.ndarray]) -> tuple[np.ndarray, float, np.ndarray]:
    """X = -k u |u|, N = a delta u^2: something smooth enough that the catalogue has in another form."""
    CALLS.append(at["u"].shape)
    u = at["u"]
    return -p["k"] * u * np.sqrt(u * u + 1e-4), 0.0, p["a"] * at["delta"] * u * u


def term() -> trimtab.Term:
    parameters = {
        "k": {"scale": 500.0, "unit": "N s2/m2", "sd": 2000.0, "about": "drag per squared speed"},
        "a": {"scale": 1e4, "unit": "N m s2/m2", "lower": -1e6, "upper": 1e6},
    }
    return trimtab.Term("my_drag", quadratic_drag, parameters, title="a drag of my own", equation="X = -k u abs(u)")


def test_it_acts_as_its_equation_says(study: trimtab.Study) -> None:
    window = study.windows()[0]
    before = study.model.simulate(window.inputs, window.initial_state)
    study.model.add_term(term())
    assert "my_drag" in study.model.terms
    without = study.model.simulate(window.inputs, window.initial_state)
    np.testing.assert_array_equal(without.states, before.states)
    # The same as more of the quadratic resistance, for a ship that sails ahead.
    study.model["my_drag.k"] = 300.0
    own = study.model.simulate(window.inputs, window.initial_state)
    study.model["my_drag.k"] = 0.0
    study.model["resistance.quadratic"] = study.model["resistance.quadratic"] + 300.0
    other = study.model.simulate(window.inputs, window.initial_state)
    np.testing.assert_allclose(own.states, other.states, atol=1e-3)
    assert np.abs(own.x - before.x).max() > 0.1


def test_the_derivatives_of_an_objective_are_those_of_its_values(study: trimtab.Study) -> None:
    study.model.add_term(term())
    study.model["my_drag.k"] = 200.0
    study.model.free("my_drag")
    assert study.model.parameter("my_drag.k").prior == (0.0, 2000.0) and study.model.parameter("my_drag.k").scale == 500.0
    objective = study.objective()
    x = objective.x0
    grad, jacobian = objective.grad(x), objective.jacobian(x)
    for name in ("my_drag.k", "my_drag.a", "rudder.lift1", "resistance.quadratic"):
        j = objective.names.index(name)
        step = np.zeros_like(x)
        step[j] = 1e-5 * objective.scales[j]
        slope = (objective.f(x + step) - objective.f(x - step)) / (2 * step[j])
        assert abs(slope - grad[j]) * objective.scales[j] <= 1e-6 * objective.f(x)
        column = (objective.residuals(x + step) - objective.residuals(x - step)) / (2 * step[j])
        np.testing.assert_allclose(column, jacobian[:, j], atol=1e-5 * np.abs(jacobian[:, j]).max())


def test_it_is_fitted_beside_all_else(study: trimtab.Study, fitted: trimtab.Fit) -> None:
    study.model.add_term(term())
    study.model.free("my_drag.a")
    fit = study.fit()
    assert fit.converged and fit.cost <= fitted.cost * (1 + 1e-9)
    assert fit["my_drag.a"].unit == "N m s2/m2"
    assert any(len(shape) == 1 and shape[0] > 4 for shape in CALLS)


def test_an_exception_in_it_comes_out(study: trimtab.Study) -> None:
    def broken(at: dict[str, np.ndarray], p: dict[str, np.ndarray]) -> tuple[float, float, float]:
        raise ZeroDivisionError("no such force")

    study.model.add_term(trimtab.Term("broken", broken, {"k": {"scale": 1.0}}))
    window = study.windows()[0]
    with pytest.raises(ZeroDivisionError, match="no such force"):
        study.model.simulate(window.inputs, window.initial_state)
    with pytest.raises(ZeroDivisionError, match="no such force"):
        study.fit()
    # And is not raised again by what has nothing to do with it.
    assert study.ship.model().simulate(window.inputs, window.initial_state).diverged_at is None


def test_what_it_gives_and_what_is_told_of_it_are_checked(study: trimtab.Study) -> None:
    window = study.windows()[0]
    short = trimtab.Term("short", lambda at, p: (at["u"][:1], at["u"], at["u"][:0]), {"k": {"scale": 1.0}})
    study.model.add_term(short)
    with pytest.raises(ValueError, match="X, Y and N must have the shape"):
        study.model.simulate(window.inputs, window.initial_state)
    with pytest.raises(ValueError, match="another name"):
        trimtab.Term("wind", quadratic_drag, {"k": {"scale": 1.0}})
    with pytest.raises(ValueError, match="give `scale`"):
        trimtab.Term("mine", quadratic_drag, {"k": {}})
    with pytest.raises(ValueError, match="unknown `units`.*did you mean `unit`"):
        trimtab.Term("mine", quadratic_drag, {"k": {"scale": 1.0, "units": "N"}})
    with pytest.raises(TypeError, match="expected a function"):
        trimtab.Term("mine", 3.0, {"k": {"scale": 1.0}})  # type: ignore[arg-type]
