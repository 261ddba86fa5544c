"""The fit as a nonlinear program, for optimisers that are called from Python with functions of p.

Every tool is given the same program as trimtab gives to Ipopt: z = p / scale, objective divided by the mean number of
samples of a run, constraint rows divided by their size. It computes no physics.
"""

import cyipopt
import numpy as np
import scipy.optimize


class Program:
    """Objective, gradient and Gauss-Newton matrix by z, from a tool's functions of p."""

    def __init__(self, case, tool):
        self.tool, self.factor, self.scale = tool, case.factor, case.scale
        self.start = case.start / case.scale
        self.bounds = case.lower / case.scale, case.upper / case.scale
        self.rows, self.row_lower, self.row_upper = case.scaled_rows()
        self._at, self._known = None, None

    def cost(self, z):
        return self.factor * self.tool.cost(z * self.scale)

    def quadratic(self, z):
        """Objective, gradient and matrix at z, computed once for all that ask."""
        if self._at is None or not np.array_equal(self._at, z):
            value, gradient, matrix = self.tool.quadratic(z * self.scale)
            scaled = self.factor * self.scale
            self._at = z.copy()
            self._known = self.factor * value, scaled * gradient, matrix * np.outer(scaled, self.scale)
        return self._known

    def value_and_gradient(self, z):
        value, gradient = self.tool.gradient(z * self.scale)
        return self.factor * value, self.factor * self.scale * gradient


class _Ipopt(Program):
    """The program as cyipopt wants it."""

    def __init__(self, case, tool):
        super().__init__(case, tool)
        self.place = np.nonzero(self.rows)
        self.entries = self.rows[self.place]
        self.triangle = np.tril_indices(len(self.start))
        self.iterations = 0

    def objective(self, z):
        return self.cost(z)

    def gradient(self, z):
        return self.quadratic(z)[1]

    def constraints(self, z):
        return self.rows @ z

    def jacobianstructure(self):
        return self.place

    def jacobian(self, z):
        return self.entries

    def hessianstructure(self):
        return self.triangle

    def hessian(self, z, multipliers, factor):
        return factor * self.quadratic(z)[2][self.triangle]

    def intermediate(self, mode, iteration, *rest):
        self.iterations = iteration
        return True


# As trimtab sets Ipopt.
IPOPT = {
    "sb": "yes",
    "print_level": 0,
    "tol": 1e-8,
    "nlp_scaling_method": "none",
    "mu_strategy": "adaptive",
    "jac_d_constant": "yes",
}


def ipopt(case, tool):
    """The fit by Ipopt with the Gauss-Newton matrix; gradient and matrix come from one evaluation."""
    program = _Ipopt(case, tool)
    (lower, upper), start = program.bounds, program.start
    problem = cyipopt.Problem(
        len(start), len(program.rows), program, lower, upper, program.row_lower, program.row_upper
    )
    for name, value in IPOPT.items():
        problem.add_option(name, value)
    z, info = problem.solve(start)
    assert info["status"] == 0, info["status_msg"]
    return z * case.scale, program.iterations


def slsqp(case, tool, tolerance=1e-10):
    """The fit by SciPy's sequential least squares programming, from cost and gradient."""
    program = Program(case, tool)
    low, high = np.isfinite(program.row_lower), np.isfinite(program.row_upper)
    matrix = np.vstack([program.rows[low], -program.rows[high]])
    limit = np.concatenate([program.row_lower[low], -program.row_upper[high]])
    constraint = {"type": "ineq", "fun": lambda z: matrix @ z - limit, "jac": lambda z: matrix}
    result = scipy.optimize.minimize(
        program.value_and_gradient,
        program.start,
        jac=True,
        method="SLSQP",
        constraints=[constraint],
        options={"ftol": tolerance, "maxiter": 500},
    )
    assert result.success, result.message
    return result.x * case.scale, result.nit
