"""What the tests share: the example study on disk, and a fit of it."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

import trimtab


@pytest.fixture(autouse=True, scope="session")
def interruptible() -> None:
    # A shell starts what it puts in the background with Ctrl-C ignored; the tests are of what a terminal starts.
    signal.signal(signal.SIGINT, signal.default_int_handler)


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
