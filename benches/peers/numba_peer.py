"""The fit in SciPy and numba: compiled loops over runs and steps, one thread.

Derivatives by forward differences, as such a user writes first, or by sensitivities whose local derivatives are written by
hand; both under SciPy's optimisers and, for comparison, under Ipopt. It shares no equation with the other tools.
"""

import math

import numba
import numpy as np
import scipy

import solve

TURN = 2 * math.pi
# Forward differences: this share of each parameter's scale, near the square root of the rounding error.
DIFFERENCE = 1e-7


def compile_simulation(case):
    """`step` and `local`: the state after one step, and also the derivatives of the accelerations.

    Constants of the ship are constants of the compiled code. Parameters are in the order of `case.names`.
    """
    k, dt = case.constants, case.dt
    rho, small, lpp, diameter, eta = k.rho, k.small, k.lpp, k.diameter, k.eta
    tiny, lever = small**2, k.lever * k.lpp
    wake, deduction, kt0, kt1, kt2, kt_astern = k.wake, k.thrust_deduction, k.kt0, k.kt1, k.kt2, k.astern
    race_ahead, race_astern, wake_ratio, straightening = k.race, k.race_astern, k.wake_ratio, k.straightening
    mass, moment = k.mass, k.mass * k.x_g
    xvr, xrr = k.mass + k.Xvr - k.Yvdot, k.mass * k.x_g - k.Yrdot
    yv, yr, nv, nr, yvv, yvr, yrr = k.Yv, k.Yr, k.Nv, k.Nr, k.Yvv, k.Yvr, k.Yrr
    nrr, nrrv, nvvr = k.Nrr, k.Nrrv, k.Nvvr
    propeller_x, rudder_x, half_area = k.propeller_x, k.rudder_x, k.pressure
    curve_limit, plate_limit, plate_normal = k.curve_limit, k.plate_limit, k.plate_normal
    determinant = k.sway * k.yaw - k.sway_yaw * k.yaw_sway
    per_surge = 1 / k.surge
    # (v', r') of a sway force and of a yaw moment.
    v_y, v_n, r_y, r_n = k.yaw / determinant, -k.sway_yaw / determinant, -k.yaw_sway / determinant, k.sway / determinant
    at = {name: case.position(name) for name in case.names}
    r1, r2, r3 = at["resistance.linear"], at["resistance.quadratic"], at["resistance.cubic"]
    side_at = at["propeller.side_force"]
    c0, c1, c2, c3 = (at[f"rudder.lift{i}"] for i in range(4))
    d0, d1, d2 = (at[f"rudder.drag{i}"] for i in range(3))
    compile = numba.njit(fastmath=True, error_model="numpy", inline="always")

    @compile
    def propeller(u, n):
        """Advance velocity, thrust, and both by u."""
        abs_u = math.sqrt(u * u + tiny)
        ahead = (u / abs_u + 1) * 0.5
        advance = (1 - wake * ahead) * u
        advance_u = 1 - wake * ahead - wake * 0.5 * tiny / (abs_u * abs_u * abs_u) * u
        k0 = kt0 * (kt_astern if n < 0 else 1.0)
        k1 = kt1 * (0.3 if n < 0 else 1.0)
        root = math.sqrt(advance * advance + 1e-2 * tiny)
        linear = k1 * diameter**3 * abs(n)
        thrust = rho * (k0 * diameter**4 * n * abs(n) + linear * advance + kt2 * diameter**2 * advance * root)
        slope = rho * (linear + kt2 * diameter**2 * (root + advance * advance / root))
        return advance, advance_u, thrust, slope * advance_u

    @compile
    def inflow(advance, advance_u, thrust, thrust_u):
        """Axial inflow of the rudder, and its derivative by u."""
        scale = 8 / (math.pi * rho * diameter * diameter)
        load, load_u = thrust * scale, thrust_u * scale
        eps = 1e-2 * tiny
        ahead, astern = (load, 0.0) if load > 0 else (0.0, -load)
        root, root_astern = math.sqrt(advance * advance + ahead + eps), math.sqrt(astern + eps)
        ahead_u, astern_u = (load_u, 0.0) if load > 0 else (0.0, -load_u)
        sign = -1.0 if advance < 0 else 1.0
        a = advance + race_ahead * (root - abs(advance)) - race_astern * (root_astern - 0.1 * small)
        a_u = advance_u + race_ahead * ((advance * advance_u + 0.5 * ahead_u) / root - sign * advance_u)
        a_u -= race_astern * 0.5 * astern_u / root_astern
        square = a * abs(a) * eta + advance * abs(advance) * (1 - eta)
        square_u = 2 * abs(a) * a_u * eta + 2 * abs(advance) * advance_u * (1 - eta)
        sum_of_squares = square * square + 1e-2 * tiny * tiny
        q = wake_ratio / math.sqrt(math.sqrt(sum_of_squares))
        return square * q, square_u * q * (1 - 0.5 * square * square / sum_of_squares)

    @compile
    def curves(p, angle):
        """Lift and drag, their derivatives by the angle, the angle at which the polynomials are taken, and their share."""
        inside = min(max(angle, -plate_limit), plate_limit)
        t = (abs(angle) - curve_limit) / (plate_limit - curve_limit)
        t = min(max(t, 0.0), 1.0)
        plate = t * t * t * ((t * 6 - 15) * t + 10)
        lift = p[c0] + inside * (p[c1] + inside * (p[c2] + inside * p[c3]))
        drag = p[d0] + inside * (p[d1] + inside * p[d2])
        within = 1.0 if abs(angle) < plate_limit else 0.0
        lift_a = (p[c1] + inside * (2 * p[c2] + inside * 3 * p[c3])) * within
        drag_a = (p[d1] + inside * 2 * p[d2]) * within
        if plate > 0:
            sign = -1.0 if angle < 0 else 1.0
            plate_a = 30 * t * t * (1 - t) * (1 - t) * sign / (plate_limit - curve_limit)
            sin, cos = math.sin(angle), math.cos(angle)
            flat_lift, flat_drag = sin * cos * plate_normal, sin * sin * plate_normal
            lift_a += (plate_normal * (cos * cos - sin * sin) - lift_a) * plate + (flat_lift - lift) * plate_a
            drag_a += (plate_normal * 2 * sin * cos - drag_a) * plate + (flat_drag - drag) * plate_a
            lift += (flat_lift - lift) * plate
            drag += (flat_drag - drag) * plate
        return lift, drag, lift_a, drag_a, inside, 1 - plate

    @compile
    def angle_of_attack(delta, rudder_u, rudder_v):
        angle = delta - math.atan2(rudder_v, rudder_u)
        return angle - TURN * np.rint(angle / TURN)

    @compile
    def step(p, x, n, delta):
        """Moves the state x by one step."""
        psi, u, v, r = x[2], x[3], x[4], x[5]
        speed = math.sqrt(u * u + v * v + tiny)
        abs_v, abs_r = math.sqrt(v * v + tiny), math.sqrt(r * r + tiny / lpp**2)
        advance, _, thrust, _ = propeller(u, n)
        propulsion = thrust * (1 - (deduction if thrust > 0 else 0.0))
        rudder_u, _ = inflow(advance, 0.0, thrust, 0.0)
        rudder_v = -(v + lever * r) * straightening
        lift, drag, _, _, _, _ = curves(p, angle_of_attack(delta, rudder_u, rudder_v))
        pressure = math.sqrt(rudder_u * rudder_u + rudder_v * rudder_v + 1e-12) * half_area
        rudder_y = (drag * rudder_v - lift * rudder_u) * pressure
        side = p[side_at] * propulsion
        force = xvr * v * r + xrr * r * r + propulsion - u * (p[r1] + u * (p[r2] + u * p[r3]))
        force -= (drag * rudder_u + lift * rudder_v) * pressure
        sway = yv * speed * v + yvv * v * abs_v + yvr * v * abs_r + yr * speed * r + yrr * r * abs_r - mass * u * r
        sway += side + rudder_y
        yaw = nv * speed * v + nvvr * v * v * r / speed + nr * speed * r + nrr * r * abs_r + nrrv * r * r * v / speed
        yaw += side * propeller_x + rudder_y * rudder_x - moment * u * r
        sin, cos = math.sin(psi), math.cos(psi)
        x[0] += dt * (u * cos - v * sin)
        x[1] += dt * (u * sin + v * cos)
        x[2] += dt * r
        x[3] += dt * force * per_surge
        x[4] += dt * (sway * v_y + yaw * v_n)
        x[5] += dt * (sway * r_y + yaw * r_n)

    @compile
    def local(p, x, n, delta, a, b):
        """Moves the state x by one step; `a` is dt times (u', v', r') by (u, v, r), and `b` dt times them by p."""
        psi, u, v, r = x[2], x[3], x[4], x[5]
        speed = math.sqrt(u * u + v * v + tiny)
        abs_v, abs_r = math.sqrt(v * v + tiny), math.sqrt(r * r + tiny / lpp**2)
        advance, advance_u, thrust, thrust_u = propeller(u, n)
        share = 1 - (deduction if thrust > 0 else 0.0)
        propulsion, propulsion_u = thrust * share, thrust_u * share
        rudder_u, rudder_u_u = inflow(advance, advance_u, thrust, thrust_u)
        rudder_v, rudder_v_r = -(v + lever * r) * straightening, -lever * straightening
        lift, drag, lift_a, drag_a, inside, polynomial = curves(p, angle_of_attack(delta, rudder_u, rudder_v))
        square = rudder_u * rudder_u + rudder_v * rudder_v
        root = math.sqrt(square + 1e-12)
        pressure = root * half_area
        # Along and across the ship before the pressure, and by the inflow (u_R, v_R); the angle turns by (v_R, -u_R)/U_R^2.
        along, across = -(drag * rudder_u + lift * rudder_v), drag * rudder_v - lift * rudder_u
        along_a, across_a = -(drag_a * rudder_u + lift_a * rudder_v), drag_a * rudder_v - lift_a * rudder_u
        # Without inflow there is no force, and nothing to turn.
        turn = 1 / max(square, 1e-300)
        x_ru = (-drag + along_a * rudder_v * turn + along * rudder_u / (square + 1e-12)) * pressure
        x_rv = (-lift - along_a * rudder_u * turn + along * rudder_v / (square + 1e-12)) * pressure
        y_ru = (-lift + across_a * rudder_v * turn + across * rudder_u / (square + 1e-12)) * pressure
        y_rv = (drag - across_a * rudder_u * turn + across * rudder_v / (square + 1e-12)) * pressure
        rudder_y = across * pressure

        side = p[side_at] * propulsion
        force = xvr * v * r + xrr * r * r + propulsion - u * (p[r1] + u * (p[r2] + u * p[r3])) + along * pressure
        sway = yv * speed * v + yvv * v * abs_v + yvr * v * abs_r + yr * speed * r + yrr * r * abs_r - mass * u * r
        sway += side + rudder_y
        yaw = nv * speed * v + nvvr * v * v * r / speed + nr * speed * r + nrr * r * abs_r + nrrv * r * r * v / speed
        yaw += side * propeller_x + rudder_y * rudder_x - moment * u * r

        speed_u, speed_v, abs_v_v, abs_r_r = u / speed, v / speed, v / abs_v, r / abs_r
        per_speed = (nvvr * v * v * r + nrrv * r * r * v) / (speed * speed)
        x_u = propulsion_u - (p[r1] + u * (2 * p[r2] + u * 3 * p[r3])) + x_ru * rudder_u_u
        x_v = xvr * r - x_rv * straightening
        x_r = xvr * v + 2 * xrr * r + x_rv * rudder_v_r
        damping = yv * v + yr * r
        y_u = damping * speed_u - mass * r + p[side_at] * propulsion_u + y_ru * rudder_u_u
        y_v = damping * speed_v + yv * speed + yvv * (abs_v + v * abs_v_v) + yvr * abs_r - y_rv * straightening
        y_r = yvr * v * abs_r_r + yr * speed + yrr * (abs_r + r * abs_r_r) - mass * u + y_rv * rudder_v_r
        damping = nv * v + nr * r - per_speed
        n_u = damping * speed_u - moment * r
        n_u += p[side_at] * propulsion_u * propeller_x + y_ru * rudder_u_u * rudder_x
        n_v = damping * speed_v + nv * speed + (2 * nvvr * v * r + nrrv * r * r) / speed
        n_v -= y_rv * straightening * rudder_x
        n_r = nr * speed + nrr * (abs_r + r * abs_r_r) + (nvvr * v * v + 2 * nrrv * r * v) / speed - moment * u
        n_r += y_rv * rudder_v_r * rudder_x
        a[0, 0], a[0, 1], a[0, 2] = dt * x_u * per_surge, dt * x_v * per_surge, dt * x_r * per_surge
        a[1, 0], a[1, 1], a[1, 2] = dt * (y_u * v_y + n_u * v_n), dt * (y_v * v_y + n_v * v_n), dt * (y_r * v_y + n_r * v_n)
        a[2, 0], a[2, 1], a[2, 2] = dt * (y_u * r_y + n_u * r_n), dt * (y_v * r_y + n_v * r_n), dt * (y_r * r_y + n_r * r_n)

        b[0, r1], b[0, r2], b[0, r3] = -dt * u * per_surge, -dt * u * u * per_surge, -dt * u * u * u * per_surge
        b[1, side_at] = dt * propulsion * (v_y + propeller_x * v_n)
        b[2, side_at] = dt * propulsion * (r_y + propeller_x * r_n)
        x_lift, y_lift = -rudder_v * pressure * polynomial * dt, -rudder_u * pressure * polynomial * dt
        x_drag, y_drag = -rudder_u * pressure * polynomial * dt, rudder_v * pressure * polynomial * dt
        to_v, to_r = v_y + rudder_x * v_n, r_y + rudder_x * r_n
        power = 1.0
        for c in (c0, c1, c2, c3):
            b[0, c], b[1, c], b[2, c] = x_lift * power * per_surge, y_lift * power * to_v, y_lift * power * to_r
            power *= inside
        power = 1.0
        for c in (d0, d1, d2):
            b[0, c], b[1, c], b[2, c] = x_drag * power * per_surge, y_drag * power * to_v, y_drag * power * to_r
            power *= inside

        sin, cos = math.sin(psi), math.cos(psi)
        x[0] += dt * (u * cos - v * sin)
        x[1] += dt * (u * sin + v * cos)
        x[2] += dt * r
        x[3] += dt * force * per_surge
        x[4] += dt * (sway * v_y + yaw * v_n)
        x[5] += dt * (sway * r_y + yaw * r_n)

    return step, local


class _Numba:
    """What the ways share: the compiled cost and residuals, and data as arrays."""

    versions = f"numba {numba.__version__}, scipy {scipy.__version__}"
    solver = staticmethod(solve.slsqp)

    def __init__(self, case, directory):
        self.case = case
        self._compile()
        self.cost(case.start), self.gradient(case.start), self.quadratic(case.start)

    def fit(self):
        return self.solver(self.case, self)

    def cost(self, p):
        e = self._cost(p)
        return e / self.case.runs


class Differences(_Numba):
    """Gradient and matrix from forward differences of the residuals."""

    label = "numba, forward differences, SciPy SLSQP"

    def _compile(self):
        case = self.case
        step, _ = compile_simulation(case)
        n, delta, measured, initial = case.n, case.delta, case.measured, case.initial
        root = np.sqrt(case.weights)

        @numba.njit(fastmath=True, error_model="numpy")
        def residuals(p, out):
            x = np.empty(6)
            for run in range(n.shape[0]):
                x[:] = initial[run]
                for k in range(n.shape[1]):
                    for c in range(6):
                        e = measured[run, k, c] - x[c]
                        if c == 2:
                            e -= TURN * np.rint(e / TURN)
                        out[run, k, c] = root[run, c] * e
                    step(p, x, n[run, k], delta[run, k])

        @numba.njit(fastmath=True, error_model="numpy")
        def cost(p):
            x, total = np.empty(6), 0.0
            for run in range(n.shape[0]):
                x[:] = initial[run]
                for k in range(n.shape[1]):
                    for c in range(6):
                        e = measured[run, k, c] - x[c]
                        if c == 2:
                            e -= TURN * np.rint(e / TURN)
                        e *= root[run, c]
                        total += e * e
                    step(p, x, n[run, k], delta[run, k])
            return total

        self._residuals, self._cost = residuals, cost
        self._e = np.empty(measured.shape)
        self._jacobian = np.empty((case.start.size, *measured.shape))

    def differences(self, p):
        """Residuals and their derivatives, one row a parameter."""
        self._residuals(p, self._e)
        e = self._e.reshape(-1)
        for j, row in enumerate(self._jacobian):
            moved = p.copy()
            moved[j] += DIFFERENCE * self.case.scale[j]
            self._residuals(moved, row)
            row -= self._e
            row /= moved[j] - p[j]
        return e, self._jacobian.reshape(p.size, -1)

    def gradient(self, p):
        e, jacobian = self.differences(p)
        return e @ e / self.case.runs, 2 * (jacobian @ e) / self.case.runs

    def quadratic(self, p):
        e, jacobian = self.differences(p)
        runs = self.case.runs
        return e @ e / runs, 2 * (jacobian @ e) / runs, 2 * (jacobian @ jacobian.T) / runs


class DifferencesIpopt(Differences):
    """The same derivatives under Ipopt with the Gauss-Newton matrix."""

    label = "numba, forward differences, cyipopt"
    solver = staticmethod(solve.ipopt)


class ByHand(_Numba):
    """Gradient and matrix from sensitivities with local derivatives written by hand."""

    label = "numba, sensitivities by hand, SciPy SLSQP"

    def _compile(self):
        case = self.case
        step, local = compile_simulation(case)
        n, delta, measured, initial, weights = case.n, case.delta, case.measured, case.initial, case.weights
        dt, size = case.dt, case.start.size
        pairs = size * (size + 1) // 2

        @numba.njit(fastmath=True, error_model="numpy")
        def cost(p):
            x, total = np.empty(6), 0.0
            for run in range(n.shape[0]):
                x[:] = initial[run]
                for k in range(n.shape[1]):
                    for c in range(6):
                        e = measured[run, k, c] - x[c]
                        if c == 2:
                            e -= TURN * np.rint(e / TURN)
                        total += weights[run, c] * e * e
                    step(p, x, n[run, k], delta[run, k])
            return total

        def sums(with_matrix):
            @numba.njit(fastmath=True, error_model="numpy")
            def sums(p):
                total, gradient, matrix = 0.0, np.zeros(size), np.zeros(pairs)
                x, s, a, b = np.empty(6), np.empty((6, size)), np.empty((3, 3)), np.zeros((3, size))
                for run in range(n.shape[0]):
                    x[:] = initial[run]
                    s[:] = 0.0
                    for k in range(n.shape[1]):
                        for c in range(6):
                            e = measured[run, k, c] - x[c]
                            if c == 2:
                                e -= TURN * np.rint(e / TURN)
                            w = weights[run, c]
                            total += w * e * e
                            for j in range(size):
                                gradient[j] += w * e * s[c, j]
                        if with_matrix:
                            at = 0
                            for i in range(size):
                                f0, f1, f2 = weights[run, 0] * s[0, i], weights[run, 1] * s[1, i], weights[run, 2] * s[2, i]
                                f3, f4, f5 = weights[run, 3] * s[3, i], weights[run, 4] * s[4, i], weights[run, 5] * s[5, i]
                                for j in range(i + 1):
                                    part = f0 * s[0, j] + f1 * s[1, j] + f2 * s[2, j]
                                    matrix[at + j] += part + f3 * s[3, j] + f4 * s[4, j] + f5 * s[5, j]
                                at += i + 1
                        u, v, cos, sin = x[3], x[4], dt * math.cos(x[2]), dt * math.sin(x[2])
                        north, east = u * cos - v * sin, u * sin + v * cos
                        local(p, x, n[run, k], delta[run, k], a, b)
                        for j in range(size):
                            s_psi, s_u, s_v, s_r = s[2, j], s[3, j], s[4, j], s[5, j]
                            s[0, j] += s_u * cos - s_v * sin - s_psi * east
                            s[1, j] += s_u * sin + s_v * cos + s_psi * north
                            s[2, j] += dt * s_r
                            s[3, j] += a[0, 0] * s_u + a[0, 1] * s_v + a[0, 2] * s_r + b[0, j]
                            s[4, j] += a[1, 0] * s_u + a[1, 1] * s_v + a[1, 2] * s_r + b[1, j]
                            s[5, j] += a[2, 0] * s_u + a[2, 1] * s_v + a[2, 2] * s_r + b[2, j]
                return total, gradient, matrix

            return sums

        self._cost, self._gradient, self._quadratic = cost, sums(False), sums(True)
        self._triangle = np.tril_indices(size)

    def gradient(self, p):
        total, gradient, _ = self._gradient(p)
        return total / self.case.runs, -2 * gradient / self.case.runs

    def quadratic(self, p):
        total, gradient, packed = self._quadratic(p)
        runs, matrix = self.case.runs, np.zeros((p.size, p.size))
        matrix[self._triangle] = packed
        matrix = matrix + np.tril(matrix, -1).T
        return total / runs, -2 * gradient / runs, 2 * matrix / runs


class ByHandIpopt(ByHand):
    """The same derivatives under Ipopt with the Gauss-Newton matrix."""

    label = "numba, sensitivities by hand, cyipopt"
    solver = staticmethod(solve.ipopt)
