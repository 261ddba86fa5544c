"""The notebooks run from beginning to end, and report no failure."""

from __future__ import annotations

from pathlib import Path

import pytest

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")
pytest.importorskip("matplotlib")

NOTEBOOKS = sorted(Path(__file__).parents[1].joinpath("notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path, tmp_path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    client = nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    text = str(notebook)
    assert "Traceback" not in text
    if path.stem.startswith("2_"):
        assert "confirmed on unseen runs" in text and (tmp_path / "report.html").is_file()


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) == 3
