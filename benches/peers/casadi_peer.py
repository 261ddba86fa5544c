"""The fit in CasADi: symbols, generated C compiled by gcc, and CasADi's own Ipopt with a Gauss-Newton Hessian.

One step of a run is one symbolic function with state and sensitivities side by side; `fold` repeats it over the steps of a
run and `map` over the runs, both as loops in the generated C. It shares no equation with the other tools.
"""

import math
import subprocess

import casadi as ca
import numpy as np

import solve

TURN = 2 * math.pi
# Flags that were fastest on the machine of the results, each tried on each function: vectorising straight-line code (SLP)
# helps the sums of the Gauss-Newton matrix and hinders the rest.
FLAGS = {
    "cost": "-O3 -march=native -ffast-math -fno-tree-slp-vectorize",
    "gradient": "-O3 -march=native -ffast-math -fno-tree-slp-vectorize",
    "quadratic": "-O3 -march=native",
}


def rates(case, state, n, delta, p):
    """Time derivative of the state [x, y, psi, u, v, r] in trimtab's paper form, see `Flow::new` and the terms there."""
    k = case.constants
    value = dict(zip(case.names, ca.vertsplit(p)))
    psi, u, v, r = (state[i] for i in range(2, 6))
    tiny = k.small**2
    speed = ca.sqrt(u * u + v * v + tiny)
    abs_u = ca.sqrt(u * u + tiny)
    abs_v = ca.sqrt(v * v + tiny)
    abs_r = ca.sqrt(r * r + tiny / k.lpp**2)

    # Propeller.
    d, abs_n, reverse = k.diameter, ca.fabs(n), n < 0
    advance = (1 - k.wake * (u / abs_u + 1) * 0.5) * u
    k0 = k.kt0 * ca.if_else(reverse, k.astern, 1.0)
    k1 = k.kt1 * ca.if_else(reverse, 0.3, 1.0)
    away = advance * ca.sqrt(advance * advance + 1e-2 * tiny)
    thrust = k.rho * (k0 * d**4 * n * abs_n + k1 * d**3 * abs_n * advance + k.kt2 * d**2 * away)
    positive = thrust > 0
    propulsion = thrust * (1 - ca.if_else(positive, k.thrust_deduction, 0.0))

    # Inflow of the rudder.
    load = thrust * (8 / (math.pi * k.rho * d * d))
    ahead, astern = ca.if_else(positive, load, 0.0), ca.if_else(positive, 0.0, -load)
    race = k.race * (ca.sqrt(advance * advance + ahead + 1e-2 * tiny) - ca.fabs(advance))
    race -= k.race_astern * (ca.sqrt(astern + 1e-2 * tiny) - 0.1 * k.small)
    a = advance + race
    square = a * ca.fabs(a) * k.eta + advance * ca.fabs(advance) * (1 - k.eta)
    rudder_u = k.wake_ratio * square / ca.sqrt(ca.sqrt(square * square + 1e-2 * tiny * tiny))
    rudder_v = -(v + k.lever * k.lpp * r) * k.straightening

    # Hull, resistance and propeller.
    x = (k.mass + k.Xvr - k.Yvdot) * v * r + (k.mass * k.x_g - k.Yrdot) * r * r + propulsion
    x -= u * (value["resistance.linear"] + u * (value["resistance.quadratic"] + u * value["resistance.cubic"]))
    side = value["propeller.side_force"] * propulsion
    y = k.Yv * speed * v + k.Yvv * v * abs_v + k.Yvr * v * abs_r + k.Yr * speed * r + k.Yrr * r * abs_r
    y += side - k.mass * u * r
    yaw = k.Nv * speed * v + k.Nvvr * v * v * r / speed + k.Nr * speed * r + k.Nrr * r * abs_r
    yaw += k.Nrrv * r * r * v / speed - k.mass * k.x_g * u * r + side * k.propeller_x

    # Rudder.
    angle = _wrap(delta - ca.atan2(rudder_v, rudder_u))
    inside = ca.fmin(ca.fmax(angle, -k.plate_limit), k.plate_limit)
    t = (ca.fabs(angle) - k.curve_limit) / (k.plate_limit - k.curve_limit)
    t = ca.fmin(ca.fmax(t, 0), 1)
    plate = t * t * t * ((t * 6 - 15) * t + 10)
    lift0, lift1, lift2, lift3 = (value[f"rudder.lift{i}"] for i in range(4))
    drag0, drag1, drag2 = (value[f"rudder.drag{i}"] for i in range(3))
    lift = lift0 + inside * (lift1 + inside * (lift2 + inside * lift3))
    drag = drag0 + inside * (drag1 + inside * drag2)
    sin, cos = ca.sin(angle), ca.cos(angle)
    lift += (sin * cos * k.plate_normal - lift) * plate
    drag += (sin * sin * k.plate_normal - drag) * plate
    pressure = ca.sqrt(rudder_u * rudder_u + rudder_v * rudder_v + 1e-12) * k.pressure
    rudder_y = (drag * rudder_v - lift * rudder_u) * pressure
    x -= (drag * rudder_u + lift * rudder_v) * pressure
    y += rudder_y
    yaw += rudder_y * k.rudder_x

    determinant = k.sway * k.yaw - k.sway_yaw * k.yaw_sway
    sin, cos = ca.sin(psi), ca.cos(psi)
    return ca.vertcat(
        u * cos - v * sin,
        u * sin + v * cos,
        r,
        x / k.surge,
        (y * k.yaw - yaw * k.sway_yaw) / determinant,
        (yaw * k.sway - y * k.yaw_sway) / determinant,
    )


def _wrap(angle):
    return angle - TURN * ca.floor(angle / TURN + 0.5)


class CasADi:
    """Cost, gradient and Gauss-Newton matrix as compiled C, and the fit by `nlpsol`."""

    label = "CasADi, generated C, Ipopt"
    versions = f"casadi {ca.__version__}"

    def __init__(self, case, directory):
        self.case = case
        size = case.start.size
        functions = {"cost": 0, "gradient": 1, "quadratic": 2}
        self.compiled = {name: self._compile(name, order, directory) for name, order in functions.items()}
        # Packed upper triangle by columns, as `_run` fills it.
        self.packed = [(i, j) for j in range(size) for i in range(j + 1)]
        self.solver, self.limits = self._solver()

    def _run(self, name, order):
        """The sums over one run: squares (order 0), and by the parameters (1), and the Gauss-Newton matrix (2)."""
        case, size, sx = self.case, self.case.start.size, ca.SX.sym
        state, n, delta, p, measured, weight = sx("x", 6), sx("n"), sx("delta"), sx("p", size), sx("m", 6), sx("w", 6)
        after = state + case.dt * rates(case, state, n, delta, p)
        e = measured - state
        e[2] = _wrap(e[2])
        square = sx("square")
        carried, result = [state, square], [after, square + ca.dot(e, weight * e)]
        if order > 0:
            slope, gradient = sx("S", 6, size), sx("g", size)
            next_slope = ca.jacobian(after, state) @ slope + ca.jacobian(after, p)
            carried += [ca.vec(slope), gradient]
            result += [ca.vec(next_slope), gradient - 2 * slope.T @ (weight * e)]
        if order > 1:
            matrix, product = sx("H", size * (size + 1) // 2), 2 * slope.T @ (slope * ca.repmat(weight, 1, size))
            carried.append(matrix)
            result.append(matrix + ca.vertcat(*[product[i, j] for j in range(size) for i in range(j + 1)]))
        # What is summed goes last, so that the sums of a run are the end of its result.
        position = lambda vectors: ca.vertcat(vectors[0], *vectors[2:3], vectors[1], *vectors[3:])
        inputs = [position(carried), ca.vertcat(n, delta, measured), weight, p]
        step = ca.Function(f"{name}_step", inputs, ca.cse([position(result)]), {"cse": True})
        start, data = ca.MX.sym("start", inputs[0].numel()), ca.MX.sym("data", 8, case.steps)
        weight, p = ca.MX.sym("w", 6), ca.MX.sym("p", size)
        end = step.fold(case.steps)(start, data, ca.repmat(weight, 1, case.steps), ca.repmat(p, 1, case.steps))
        return ca.Function(f"{name}_run", [start, data, weight, p], [end])

    def _compile(self, name, order, directory):
        """The mean over all runs as a function of p, written as C, compiled and loaded."""
        case, size = self.case, self.case.start.size
        run = self._run(name, order)
        start = np.zeros((run.size1_in(0), case.runs))
        start[:6] = case.initial.T
        data = np.concatenate([case.n[..., None], case.delta[..., None], case.measured], axis=2).reshape(-1, 8).T
        p = ca.MX.sym("p", size)
        ends = run.map(case.runs)(start, data, case.weights.T, ca.repmat(p, 1, case.runs))
        sums = ca.sum2(ends[6 if order == 0 else 6 + 6 * size :, :]) / case.runs
        generator = ca.CodeGenerator(f"{name}.c")
        generator.add(ca.Function(name, [p], [sums]))
        source = generator.generate(f"{directory}/")
        library = f"{directory}/{name}.so"
        subprocess.run(["gcc", *FLAGS[name].split(), "-shared", "-fPIC", source, "-o", library, "-lm"], check=True)
        return ca.external(name, library)

    def _solver(self):
        """Ipopt on the scaled program, with the compiled functions as objective, gradient and Hessian."""
        case, size = self.case, self.case.start.size
        rows, lower, upper = case.scaled_rows()
        z, scale = ca.MX.sym("z", size), ca.DM(case.scale)
        p_lagrange, factor, multipliers = ca.MX.sym("p", 0), ca.MX.sym("factor"), ca.MX.sym("lambda", len(rows))
        cost = case.factor * self.compiled["cost"](scale * z)
        rows = ca.sparsify(ca.DM(rows))
        values = rows @ z
        sums = case.factor * self.compiled["gradient"](scale * z)
        gradient = scale * sums[1:]
        packed = self.compiled["quadratic"](scale * z)[1 + size :]
        hessian = ca.MX(ca.Sparsity.upper(size), packed) * ca.triu(scale @ scale.T) * (factor * case.factor)
        options = {
            "grad_f": ca.Function("nlp_grad_f", [z, p_lagrange], [sums[0], gradient], ["x", "p"], ["f", "grad_f_x"]),
            "jac_g": ca.Function("nlp_jac_g", [z, p_lagrange], [values, rows], ["x", "p"], ["g", "jac_g_x"]),
            "hess_lag": ca.Function(
                "nlp_hess_l",
                [z, p_lagrange, factor, multipliers],
                [hessian],
                ["x", "p", "lam_f", "lam_g"],
                ["triu_hess_gamma_x_x"],
            ),
            "print_time": False,
            "no_nlp_grad": True,
            "ipopt": {
                "sb": "yes",
                "print_level": 0,
                "tol": 1e-8,
                "nlp_scaling_method": "none",
                "mu_strategy": "adaptive",
                "jac_d_constant": "yes",
            },
        }
        return ca.nlpsol("fit", "ipopt", {"x": z, "f": cost, "g": values}, options), (lower, upper)

    def cost(self, p):
        return float(self.compiled["cost"](p))

    def gradient(self, p):
        sums = self.compiled["gradient"](p).full().ravel()
        return sums[0], sums[1:]

    def quadratic(self, p):
        sums = self.compiled["quadratic"](p).full().ravel()
        size = p.size
        matrix = np.zeros((size, size))
        for (i, j), h in zip(self.packed, sums[1 + size :]):
            matrix[i, j] = matrix[j, i] = h
        return sums[0], sums[1 : 1 + size], matrix

    def fit(self):
        case = self.case
        lower, upper = self.limits
        solution = self.solver(
            x0=case.start / case.scale,
            lbx=case.lower / case.scale,
            ubx=case.upper / case.scale,
            lbg=lower,
            ubg=upper,
        )
        stats = self.solver.stats()
        assert stats["success"], stats["return_status"]
        return solution["x"].full().ravel() * case.scale, stats["iter_count"]


class SharedCasADi(CasADi):
    """The same compiled functions under cyipopt, which lets gradient and matrix share one evaluation."""

    label = "CasADi, generated C, cyipopt"

    def fit(self):
        return solve.ipopt(self.case, self)
