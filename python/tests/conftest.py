"""What the tests share: the example study on disk, and a fit of it."""

from __future__ import annotations

from pathlib import Path

import pytest

import trimtab


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("example")
    trimtab.example(place)
    return place


@pytest.fixture
def study(folder: Path) -> trimtab.Study:
    return trimtab.Study.load(folder / "study.toml")


@pytest.fixture(scope="session")
def fitted(folder: Path) -> trimtab.Fit:
    return trimtab.Study.load(folder).fit()
