"""The types in the stubs are those of the module."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mypy")


def test_the_stubs_are_those_of_the_module(tmp_path: Path) -> None:
    allowed = tmp_path / "allowed"
    # A list that the extension module has of itself.
    allowed.write_text("trimtab._trimtab.__all__\n")
    check = [sys.executable, "-m", "mypy.stubtest", "trimtab", "--ignore-disjoint-bases", "--allowlist", str(allowed)]
    done = subprocess.run(check, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_program_of_the_readme_is_typed(tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(
        "import trimtab\n"
        "study = trimtab.Study.load('study.toml')\n"
        "fit = study.fit(hessian='exact', progress=lambda p: p.iteration < 9)\n"
        "value: float = fit['p5'].value\n"
        "grad = study.objective().grad(fit.theta)\n"
        "reveal_type(grad)\n"
        "study.fit(hessian='bfgs')\n"
    )
    check = [sys.executable, "-m", "mypy", "--strict", str(program)]
    done = subprocess.run(check, capture_output=True, text=True, cwd=tmp_path)
    assert "numpy.ndarray" in done.stdout and "arg-type" in done.stdout, done.stdout
    assert done.stdout.count("error") == 2, done.stdout
