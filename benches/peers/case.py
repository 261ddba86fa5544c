"""The exported fit as numpy arrays, and the one nonlinear program that every tool hands to its optimiser.

It computes no physics: each tool writes the equations in its own idiom from the constants read here.
"""

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np

STATES = ["x", "y", "psi", "u", "v", "r"]


class Case:
    """Recordings, constants and constraint rows, see `export.rs` for the files."""

    def __init__(self, directory):
        directory = Path(directory)
        constants = json.loads((directory / "constants.json").read_text())
        self.expected = json.loads((directory / "expected.json").read_text())
        self.dt = constants["dt"]

        free = constants["free"]
        self.names = [f["name"] for f in free]
        self.start = np.array([f["start"] for f in free])
        self.scale = np.array([f["scale"] for f in free])
        unbounded = lambda x, infinity: infinity if x is None else x
        self.lower = np.array([unbounded(f["lower"], -np.inf) for f in free])
        self.upper = np.array([unbounded(f["upper"], np.inf) for f in free])

        runs = _table(directory / "runs.csv")
        samples = _table(directory / "samples.csv")
        self.runs = len(runs["run"])
        self.steps = len(samples["run"]) // self.runs
        by_run = lambda name: samples[name].reshape(self.runs, self.steps)
        # Arrays by [run, step] and, for states and weights, [run, (step,) channel].
        self.n = by_run("n")
        self.delta = by_run("delta")
        self.measured = np.stack([by_run(f"measured_{s}") for s in STATES], axis=-1)
        self.initial = np.stack([runs[f"initial_{s}"] for s in STATES], axis=-1)
        self.weights = np.stack([runs[f"weight_{s}"] for s in STATES], axis=-1)

        rows = np.loadtxt(directory / "constraints.csv", delimiter=",", skiprows=1)
        self.rows, self.row_lower, self.row_upper = rows[:, :-2], rows[:, -2], rows[:, -1]

        self.constants = self._constants(constants)
        self.factor = constants["objective_factor"]

    @staticmethod
    def _constants(constants):
        """The numbers in the equations that no fit moves, by short names."""
        ship, value = constants["ship"], constants["parameters"]
        flow = {k.removeprefix("flow."): v for k, v in value.items() if k.startswith("flow.")}
        hull = {k.removeprefix("hull."): v for k, v in value.items() if k.startswith("hull.")}
        assert flow["asymmetry"] == 0.0, "the tools leave out the port-starboard difference of the flow straightening"
        return SimpleNamespace(
            rho=ship["water_density"],
            lpp=ship["lpp"],
            small=ship["small_speed"],
            diameter=ship["propeller_diameter"],
            eta=min(ship["propeller_diameter"] / ship["rudder_span"], 1.0),
            propeller_x=ship["propeller_x"],
            rudder_x=ship["rudder_x"],
            pressure=0.5 * ship["water_density"] * ship["rudder_area"],
            curve_limit=constants["rudder_curve_limit"],
            plate_limit=constants["rudder_plate_limit"],
            plate_normal=constants["rudder_plate_normal"],
            surge=hull["mass"] - hull["Xudot"],
            sway=hull["mass"] - hull["Yvdot"],
            sway_yaw=hull["mass"] * hull["x_g"] - hull["Yrdot"],
            yaw_sway=hull["mass"] * hull["x_g"] - hull["Nvdot"],
            yaw=hull["inertia"] - hull["Nrdot"],
            **flow,
            **hull,
        )

    def position(self, name):
        """Place of a parameter among the free ones, by its dotted name."""
        return self.names.index(name)

    def row_size(self):
        """Size of each constraint row over a change of one scale in every parameter: its unit in the program."""
        return np.sqrt(((self.rows * self.scale) ** 2).sum(axis=1))

    def scaled_rows(self):
        """Constraint rows by z = p / scale with their limits, each divided by its size, as trimtab gives them to Ipopt."""
        size = self.row_size()
        return self.rows * self.scale / size[:, None], self.row_lower / size, self.row_upper / size

    def violation(self, p):
        """Largest violation of a constraint, in the rows' units."""
        a, lower, upper = self.scaled_rows()
        value = a @ (p / self.scale)
        return max(0.0, (lower - value).max(), (value - upper).max())


def _table(path):
    table = np.genfromtxt(path, delimiter=",", names=True)
    return {name: np.ascontiguousarray(table[name]) for name in table.dtype.names}
