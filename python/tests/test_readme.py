"""The programs of the README of the package run as they are printed."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import LinearConstraint, least_squares, minimize

import trimtab

README = Path(__file__).parents[1] / "README.md"
PROGRAMS = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)


def test_a_table_to_a_current_in_twelve_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Forty minutes of turns, zigzags and steps of the propeller, as a logger writes them: degrees and revolutions a minute.
    ship = trimtab.Ship.estimate(lpp=85, breadth=13.5, draught=4.2, type="coaster")
    random = np.random.default_rng(2)
    t = np.arange(0.0, 2400.0, 2.0)
    delta = np.select([t % 600 < 200, t % 600 < 400], [np.radians(20) * np.sign(np.sin(t / 25)), np.radians(15)], 0.0)
    n = 2.0 + 0.3 * np.sin(t / 170)
    # A current to the north-west that the model does not know.
    around = {"n": n, "delta": delta, "current_north": 0.5, "current_east": -0.4}
    states = ship.model().simulate(around, [0, 0, 0.3, 5, 0, 0], dt=2.0, method="rk4", substeps=2).states
    states = states + [0.3, 0.3, 0.002, 0.02, 0.02, 1e-4] * random.standard_normal(states.shape)
    x, y, psi, u, v, r = states.T
    columns = {"t": t, "x": x, "y": y, "psi": np.degrees(psi) % 360, "u": u, "v": v, "r": r}
    log = pd.DataFrame({**columns, "n": 60 * n, "delta": np.degrees(delta)})
    log.to_csv(tmp_path / "log.csv", index=False)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(PROGRAMS[0], names)
    assert names["fit"].cost < names["fit"].start_cost
    assert len([line for line in PROGRAMS[0].splitlines() if line.strip()]) <= 12
    first = names["diagnosis"].findings[0]
    assert first["mechanism"] == "current", names["diagnosis"].headline
    assert names["diagnosis"].improved["current.north"] == pytest.approx(0.5, abs=0.1)
    assert names["diagnosis"].improved["current.east"] == pytest.approx(-0.4, abs=0.1)
    assert (tmp_path / "report.html").is_file()


def test_the_other_programs_run() -> None:
    study = trimtab.example()
    names: dict[str, Any] = {"trimtab": trimtab, "study": study, "np": np, "delta": np.full(60, 0.2)}
    names.update(least_squares=least_squares, minimize=minimize, LinearConstraint=LinearConstraint)
    for program in PROGRAMS[1:]:
        names["study"] = trimtab.example()
        exec(program, names)
    assert len(PROGRAMS) == 5
