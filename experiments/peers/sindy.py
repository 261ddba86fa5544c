"""Sparse regression on smoothed residual accelerations, as a peer of the diagnosis on the same recordings.

A user of PySINDy would do this today: differentiate, remove the part that the base model's terms explain, and let STLSQ choose
columns. It gets more than a user would have: columns for each mechanism, and kinematic equations for the sensors.
It is not part of the product and no test needs it.

    python3 -m venv venv && venv/bin/pip install pysindy
    venv/bin/python experiments/peers/sindy.py CASE

CASE is a folder with study/study.toml, as `conceal`, `campaign --keep` and `injected --keep` write it. Prints the name of the mechanism whose columns
explain most of the part that STLSQ kept, or "nothing".
"""

import csv
import sys
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pysindy as ps
from scipy.signal import savgol_filter

WINDOW = 11  # rows of the Savitzky-Golay filter: 22 s at a step of 2 s
EVERY = 4  # where the study names no runs for the test, every fourth takes their place
THRESHOLDS = (0.05, 0.1, 0.2, 0.4)


def read(path, step, start, end):
    """Columns of the part of a recording between two times by name, on an even grid of a step, or else of its own; a channel's missing
    values are bridged by straight lines."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    names = [h.split(" ")[0] for h in rows[0]]
    data = np.array([[float(v) if v else np.nan for v in r] for r in rows[1:]])
    t = data[:, 0]
    data = data[(t >= start) & (t <= end)]
    t = data[:, 0]
    step = step or np.median(np.diff(t))
    grid = np.arange(t[0], t[-1] + 0.5 * step, step)
    out = {}
    for name, values in zip(names, data.T):
        there = np.isfinite(values)
        if there.any():
            known = np.unwrap(values[there]) if name == "psi" else values[there]
            out[name] = np.interp(grid, t[there], known)
    return out


def features(run, terms):
    """Targets, base columns and mechanism columns of one run, by equation; the load of a term that the base model has is a base column."""
    t = run["t"]
    slope = ps.SmoothedFiniteDifference(smoother_kws={"window_length": WINDOW, "polyorder": 3})
    rate = {k: slope._differentiate(run[k][:, None], t)[:, 0] for k in ("x", "y", "psi", "u", "v", "r", "n", "delta")}
    u, v, r, psi, n, d = (run[k] for k in ("u", "v", "r", "psi", "n", "delta"))
    speed = np.hypot(u, v)
    thrust = n * np.abs(n)
    cos, sin = np.cos(psi), np.sin(psi)
    astern = np.where(n < 0, thrust, 0.0)
    none = np.zeros_like(u)
    one = np.ones_like(u)
    heading = np.unwrap(psi)
    lateral = [speed * v, u * r, speed * r, v * abs(v), v * abs(r), r * abs(r), thrust, one * u * u,
               thrust * d, u * abs(u) * d, thrust * d * d, u * abs(u) * d * d, d**3 * u * abs(u)]
    base = {
        "X": [u, u * u, u**3, v * r, r * r, thrust, n * u, u * abs(u) * d * d, thrust * d * d, thrust * d],
        "Y": lateral,
        "N": lateral,
        "east": [], "north": [], "turn": [],
    }
    north, east = u * cos - v * sin, u * sin + v * cos
    targets = {
        "X": rate["u"], "Y": rate["v"], "N": rate["r"],
        "north": rate["x"] - north, "east": rate["y"] - east, "turn": np.gradient(heading, t) - r,
    }
    lag = np.gradient(d, t)
    mechanisms = {
        "current": {"X": [speed * cos, speed * sin], "Y": [speed * cos, speed * sin], "N": [speed * cos, speed * sin]},
        "mean_wind": {"X": [cos, sin], "Y": [cos, sin], "N": [np.cos(2 * psi), np.sin(2 * psi)]},
        "propeller_walk_astern": {"Y": [astern], "N": [astern]},
        "wake_drift": {"X": [thrust * np.minimum((v / np.maximum(speed, 0.5)) ** 2, 1.0)]},
        "engine_lag": {"X": [np.abs(n) * np.gradient(n, t)]},
        "rudder_lag": {"Y": [lag * thrust, lag * u * abs(u)], "N": [lag * thrust, lag * u * abs(u)]},
        "rudder_stall": {"Y": [np.where(abs(d) > 0.45, thrust * d, 0.0)], "N": [np.where(abs(d) > 0.45, thrust * d, 0.0)]},
        "crossflow": {"Y": [abs(v) ** 3 * np.sign(v), abs(r) * v * abs(v)], "N": [abs(v) * v * abs(r), r * v * v]},
        "sternway": {"Y": [np.where(u < 0, u * v, 0.0)], "N": [np.where(u < 0, u * v, 0.0)], "X": [np.where(u < 0, u * u, 0.0)]},
        "roll": {"Y": [np.gradient(speed**3 * r, t)], "N": [np.gradient(speed**3 * r, t)]},
        "heading_bias": {"north": [-east], "east": [north]},
        "compass_deviation": {"north": [-east * cos, -east * sin], "east": [north * cos, north * sin]},
        "log_scale": {"north": [-north], "east": [-east]},
        "sway_log_bias": {"north": [sin], "east": [-cos]},
        "antenna": {"north": [-r * sin, -r * cos], "east": [r * cos, -r * sin]},
        "time_skew": {"north": [np.gradient(north, t)], "east": [np.gradient(east, t)]},
        "water_log": {"north": [one, none], "east": [none, one]},
        "yaw_rate_bias": {"turn": [one]},
    }
    if "thruster" in run:
        side = run["thruster"] / (1 + (u / 1.3) ** 2)
        mechanisms["thruster"] = {"Y": [side], "N": [side]}
    if "bank_starboard" in run:
        close = u * u * (1 / run["bank_starboard"] - 1 / run["bank_port"])
        mechanisms["bank"] = {"Y": [close], "N": [close]}
    if "wind_speed" in run:
        along = run["wind_speed"] ** 2 * np.cos(run["wind_direction"] - psi)
        across = run["wind_speed"] ** 2 * np.sin(run["wind_direction"] - psi)
        mechanisms["wind"] = {"X": [along], "Y": [across], "N": [across, along * across]}
    if "wave_height" in run:
        angle = run["wave_direction"] - psi
        high = run["wave_height"] ** 2
        mechanisms["waves"] = {"X": [high * np.cos(angle)], "Y": [high * np.sin(angle)], "N": [high * np.sin(angle)]}
    for term in [m for m in mechanisms if m in terms]:
        for equation, columns in mechanisms.pop(term).items():
            base[equation] = base[equation] + columns
    # What is compared with a smoothed derivative is smoothed alike, or whatever is fast is found to be missing.
    smooth = lambda columns: [savgol_filter(c, WINDOW, 3) for c in columns]
    base = {equation: smooth(columns) for equation, columns in base.items()}
    mechanisms = {m: {e: smooth(c) for e, c in by.items()} for m, by in mechanisms.items()}
    # Velocities are targets where they are compared with the rates of position.
    for equation in ("north", "east", "turn"):
        targets[equation] = savgol_filter(targets[equation], WINDOW, 3)
    return targets, base, mechanisms


def stack(runs, equation):
    """Target, base columns and candidate columns of one equation over all runs, with the candidates' names."""
    names = [m for m, columns in runs[0][2].items() for _ in columns.get(equation, [])]
    target = np.concatenate([targets[equation] for targets, _, _ in runs])
    base = np.hstack([np.ones((len(target), 0 if equation in ("north", "east", "turn") else 1)),
                      *[np.concatenate([b[equation][i] for _, b, _ in runs])[:, None] for i in range(len(runs[0][1][equation]))]])
    pick = [(m, i) for m, columns in runs[0][2].items() for i in range(len(columns.get(equation, [])))]
    columns = [np.concatenate([mechanisms[m][equation][i] for _, _, mechanisms in runs]) for m, i in pick]
    return target, base, np.array(columns).T, names


def without(base, values):
    """What is left of `values` when the base columns are projected out."""
    if base.shape[1] == 0:
        return values
    return values - base @ np.linalg.lstsq(base, values, rcond=None)[0]


def name(train, held_out):
    """The mechanism that explains most of the targets' variance, the threshold chosen on held-out runs for each equation."""
    weight = {}
    for equation in ("X", "Y", "N", "north", "east", "turn"):
        target, base, columns, names = stack(train, equation)
        if columns.size == 0:
            continue
        whole = np.sqrt(np.mean(columns**2, axis=0))
        target, columns = without(base, target), without(base, columns)
        scale, unit = np.sqrt(np.mean(target**2)), np.sqrt(np.mean(columns**2, axis=0))
        # What the base can mimic all but a hundredth of is noise once it is scaled up again.
        live = unit > np.maximum(0.1 * whole, 1e-9)
        if not live.any():
            continue
        columns, names, unit = columns[:, live], [n for n, k in zip(names, live) if k], unit[live]
        held_target, held_base, held_columns, _ = stack(held_out, equation)
        held_target, held_columns = without(held_base, held_target), without(held_base, held_columns)[:, live]
        # To keep nothing is a law too.
        best, kept = np.mean((held_target / scale) ** 2), np.zeros(len(names))
        for threshold in THRESHOLDS:
            optimizer = ps.STLSQ(threshold=threshold, alpha=1e-6)
            optimizer.fit(columns / unit, (target / scale)[:, None])
            coefficients = optimizer.coef_[0]
            error = np.mean((held_target / scale - held_columns / unit @ coefficients) ** 2)
            # A sparser law wins when it is as good within one per cent.
            if error < best * (1.01 if np.count_nonzero(coefficients) < np.count_nonzero(kept) else 1.0):
                best, kept = error, coefficients
        for mechanism in set(names):
            own = [i for i, n in enumerate(names) if n == mechanism]
            # Jointly: two columns that cancel each other explain nothing.
            explained = np.mean((columns[:, own] / unit[own] @ kept[own]) ** 2)
            weight[mechanism] = weight.get(mechanism, 0.0) + explained
    weight = {m: w for m, w in weight.items() if w > 0}
    return max(weight, key=weight.get) if weight else "nothing"


def main():
    """Reads a case and prints one name."""
    # STLSQ warns whenever a threshold removes every column, which here is an answer.
    warnings.filterwarnings("ignore", message="Sparsity parameter is too big")
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    study = Path(sys.argv[1]) / "study" / "study.toml"
    content = tomllib.loads(study.read_text())
    terms = tomllib.loads(study.with_name(content["model"]).read_text()).get("terms", [])
    sides = {"train": [], "test": []}
    for run in content["runs"]:
        part = read(study.with_name(run["file"]), content.get("step"), run.get("from", -np.inf), run.get("to", np.inf))
        # Of fewer rows than the filter has there are no derivatives.
        if len(part["t"]) > WINDOW:
            sides[run["split"]].append(features(part, terms))
    if not sides["test"]:
        runs = sides["train"]
        sides = {"train": [r for i, r in enumerate(runs) if i % EVERY], "test": runs[::EVERY]}
    print(name(sides["train"], sides["test"]))


if __name__ == "__main__":
    main()
