"""The fit in JAX: one thread of the CPU, double precision, under Ipopt by cyipopt with the Gauss-Newton matrix.

Two ways to the sensitivities: `jacfwd` through the whole simulation, as one writes first, and the local Jacobians of each
step carried along by a second scan, which is several times faster. It shares no equation with the other tools.
"""

import math

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

import solve

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_platforms", "cpu")

TURN = 2 * math.pi


def rates(k, value, state, n, delta):
    """Time derivative of the state (x, y, psi, u, v, r) in trimtab's paper form, see `Flow::new` and the terms there.

    Every entry may be a number or an array over runs; `value` is the parameters by name.
    """
    _, _, psi, u, v, r = state
    tiny = k.small**2
    speed = jnp.sqrt(u * u + v * v + tiny)
    abs_u = jnp.sqrt(u * u + tiny)
    abs_v = jnp.sqrt(v * v + tiny)
    abs_r = jnp.sqrt(r * r + tiny / k.lpp**2)

    # Propeller.
    d, abs_n, reverse = k.diameter, jnp.abs(n), n < 0
    advance = (1 - k.wake * (u / abs_u + 1) * 0.5) * u
    k0 = k.kt0 * jnp.where(reverse, k.astern, 1.0)
    k1 = k.kt1 * jnp.where(reverse, 0.3, 1.0)
    away = advance * jnp.sqrt(advance * advance + 1e-2 * tiny)
    thrust = k.rho * (k0 * d**4 * n * abs_n + k1 * d**3 * abs_n * advance + k.kt2 * d**2 * away)
    positive = thrust > 0
    propulsion = thrust * (1 - jnp.where(positive, k.thrust_deduction, 0.0))

    # Inflow of the rudder.
    load = thrust * (8 / (math.pi * k.rho * d * d))
    ahead, astern = jnp.where(positive, load, 0.0), jnp.where(positive, 0.0, -load)
    race = k.race * (jnp.sqrt(advance * advance + ahead + 1e-2 * tiny) - jnp.abs(advance))
    race -= k.race_astern * (jnp.sqrt(astern + 1e-2 * tiny) - 0.1 * k.small)
    a = advance + race
    square = a * jnp.abs(a) * k.eta + advance * jnp.abs(advance) * (1 - k.eta)
    rudder_u = k.wake_ratio * square / jnp.sqrt(jnp.sqrt(square * square + 1e-2 * tiny * tiny))
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
    angle = wrap(delta - jnp.arctan2(rudder_v, rudder_u))
    inside = jnp.clip(angle, -k.plate_limit, k.plate_limit)
    t = jnp.clip((jnp.abs(angle) - k.curve_limit) / (k.plate_limit - k.curve_limit), 0, 1)
    plate = t * t * t * ((t * 6 - 15) * t + 10)
    lift0, lift1, lift2, lift3 = (value[f"rudder.lift{i}"] for i in range(4))
    drag0, drag1, drag2 = (value[f"rudder.drag{i}"] for i in range(3))
    lift = lift0 + inside * (lift1 + inside * (lift2 + inside * lift3))
    drag = drag0 + inside * (drag1 + inside * drag2)
    sin, cos = jnp.sin(angle), jnp.cos(angle)
    lift += (sin * cos * k.plate_normal - lift) * plate
    drag += (sin * sin * k.plate_normal - drag) * plate
    pressure = jnp.sqrt(rudder_u * rudder_u + rudder_v * rudder_v + 1e-12) * k.pressure
    rudder_y = (drag * rudder_v - lift * rudder_u) * pressure
    x -= (drag * rudder_u + lift * rudder_v) * pressure
    y += rudder_y
    yaw += rudder_y * k.rudder_x

    determinant = k.sway * k.yaw - k.sway_yaw * k.yaw_sway
    sin, cos = jnp.sin(psi), jnp.cos(psi)
    return (
        u * cos - v * sin,
        u * sin + v * cos,
        r,
        x / k.surge,
        (y * k.yaw - yaw * k.sway_yaw) / determinant,
        (yaw * k.sway - y * k.yaw_sway) / determinant,
    )


def wrap(angle):
    return angle - TURN * jnp.round(angle / TURN)


def residual(measured, state):
    """Measured less simulated, channel by channel, the heading wrapped."""
    e = [m - s for m, s in zip(measured, state)]
    e[2] = wrap(e[2])
    return e


class _Jax:
    """What both ways share: arrays with the runs last, the cost, its gradient by reverse mode, and the fit."""

    versions = f"jax {jax.__version__}"

    def __init__(self, case, directory):
        self.case, self.k, self.runs = case, case.constants, case.runs
        self.samples = (jnp.array(case.n.T), jnp.array(case.delta.T), jnp.array(case.measured.transpose(1, 2, 0)))
        self.initial = tuple(jnp.array(case.initial.T))
        self.weights = jnp.array(case.weights.T)
        self._functions = {
            "cost": jax.jit(self.cost_of),
            "gradient": jax.jit(jax.value_and_grad(self.cost_of)),
            "quadratic": jax.jit(self.quadratic_of),
        }
        for function in self._functions.values():
            jax.block_until_ready(function(jnp.array(case.start)))

    def rates(self, p, state, n, delta):
        return rates(self.k, dict(zip(self.case.names, p)), state, n, delta)

    def advance(self, p, state, n, delta):
        return tuple(s + self.case.dt * d for s, d in zip(state, self.rates(p, state, n, delta)))

    def cost_of(self, p):
        """The cost, summed run by run while the runs are simulated side by side."""
        p = [p[j] for j in range(p.size)]

        def body(carried, sample):
            (state, total), (n, delta, measured) = carried, sample
            total += sum(w * e * e for w, e in zip(self.weights, residual(measured, state)))
            return (self.advance(p, state, n, delta), total), None

        (_, total), _ = lax.scan(body, (self.initial, jnp.zeros(self.runs)), self.samples)
        return total.sum() / self.runs

    def cost(self, p):
        return float(self._functions["cost"](p))

    def gradient(self, p):
        value, gradient = self._functions["gradient"](p)
        return float(value), np.asarray(gradient)

    def quadratic(self, p):
        value, gradient, matrix = self._functions["quadratic"](p)
        return float(value), np.asarray(gradient), np.asarray(matrix)

    def fit(self):
        return solve.ipopt(self.case, self)


class WholeJax(_Jax):
    """Sensitivities by `jacfwd` of the residuals of all runs, `vmap` over runs of a `scan` over steps."""

    label = "JAX, jacfwd of vmap of scan, cyipopt"

    def residuals(self, p):
        def run(initial, root, n, delta, measured):
            def body(state, sample):
                n, delta, measured = sample
                e = [w * e for w, e in zip(root, residual(measured, state))]
                return self.advance(p, state, n, delta), e

            return lax.scan(body, initial, (n, delta, measured))[1]

        n, delta, measured = self.samples
        e = jax.vmap(run, (-1, -1, -1, -1, -1))(self.initial, jnp.sqrt(self.weights), n, delta, measured)
        return jnp.stack(e).ravel()

    def quadratic_of(self, p):
        twice = lambda p: (lambda e: (e, e))(self.residuals(p))
        jacobian, e = jax.jacfwd(twice, has_aux=True)(p)
        return e @ e / self.runs, 2 * (e @ jacobian) / self.runs, 2 * (jacobian.T @ jacobian) / self.runs


class LocalJax(_Jax):
    """Sensitivities S of a run by `S <- S + dt (A S + B)` in a second scan, A and B from `jvp` in the first.

    In one scan XLA fuses the local derivatives into each of the eleven columns and computes them eleven times; results of a
    scan are stored, so that the second one reads them.
    """

    label = "JAX, local Jacobians in two scans, cyipopt"

    def local(self, p, state, n, delta):
        """Rates and their derivatives: by u, v and r of (u', v', r'), and by each parameter."""
        one = jnp.ones(self.runs)

        def by_velocity(i):
            moved = lambda s: self.rates(p, state[:i] + (s,) + state[i + 1 :], n, delta)[3:]
            return jax.jvp(moved, (state[i],), (one,))[1]

        def by_parameter(j):
            moved = lambda q: self.rates(p[:j] + [q] + p[j + 1 :], state, n, delta)[3:]
            return jax.jvp(moved, (p[j],), (jnp.ones(()),))[1]

        velocities = [by_velocity(i) for i in (3, 4, 5)]
        return self.rates(p, state, n, delta), velocities, [by_parameter(j) for j in range(len(p))]

    def quadratic_of(self, p):
        size, dt, runs = p.size, self.case.dt, self.runs
        p = [p[j] for j in range(size)]
        acts = lambda i, j: not self.case.names[j].startswith("propeller" if i == 0 else "resistance")

        def simulate(carried, sample):
            (state, total), (n, delta, measured) = carried, sample
            e = residual(measured, state)
            weighted = [w * e for w, e in zip(self.weights, e)]
            rate, velocities, parameters = self.local(p, state, n, delta)
            sin, cos = jnp.sin(state[2]), jnp.cos(state[2])
            a = [[velocities[j][i] for j in range(3)] for i in range(3)]
            # Entries that are zero for every state are not stored.
            b = [[parameters[j][i] for j in range(size) if acts(i, j)] for i in range(3)]
            total += sum(e * w for e, w in zip(e, weighted))
            state = tuple(s + dt * d for s, d in zip(state, rate))
            return (state, total), (weighted, (rate[0], rate[1], sin, cos), a, b)

        def spread(carried, local):
            slopes, gradient, matrix = carried
            weighted, (north, east, sin, cos), a, b = local
            gradient += sum(s * w for s, w in zip(slopes, weighted))
            scaled = [s * w for s, w in zip(slopes, self.weights)]
            matrix = [h + sum(s[j:] * w[j] for s, w in zip(slopes, scaled)) for j, h in enumerate(matrix)]
            x, y, psi, u, v, r = slopes
            after = [x + dt * (u * cos - v * sin - psi * east), y + dt * (u * sin + v * cos + psi * north), psi + dt * r]
            for i in range(3):
                column = iter(b[i])
                direct = jnp.stack([next(column) if acts(i, j) else jnp.zeros(runs) for j in range(size)])
                after.append(slopes[3 + i] + dt * (a[i][0] * u + a[i][1] * v + a[i][2] * r + direct))
            return (tuple(after), gradient, matrix), None

        (_, total), local = lax.scan(simulate, (self.initial, jnp.zeros(runs)), self.samples)
        none = jnp.zeros((size, runs))
        start = ((none,) * 6, none, [none[j:] for j in range(size)])
        (_, gradient, triangle), _ = lax.scan(spread, start, local)
        matrix = jnp.zeros((size, size))
        for j, column in enumerate(triangle):
            matrix = matrix.at[j:, j].set(column.sum(axis=1)).at[j, j:].set(column.sum(axis=1))
        return total.sum() / runs, -2 * gradient.sum(axis=1) / runs, 2 * matrix / runs
