"""A study from tables in memory: each is written as a recording, and then imported like a log."""

from __future__ import annotations

import csv
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ._logs import PathLike, import_log
from ._trimtab import Model, Ship, Study


def _write(path: Path, name: str, table: Any, columns: Mapping[str, str]) -> None:
    """Writes the columns of a table, under the names of the channels they are taken for, where the caller says so."""
    if not hasattr(table, "keys"):
        kind = type(table).__name__
        raise TypeError(
            f"{name}: expected a table with columns (a pandas DataFrame, or a dictionary of columns), and got {kind}"
        )
    own = {column: channel for channel, column in columns.items()}
    known = [str(key) for key in table.keys()]
    for channel, column in columns.items():
        if column not in known:
            raise KeyError(f"{name} has no column `{column}` for {channel}; its columns are {', '.join(known)}")
    header, values = [], []
    for key in known:
        header.append(own.get(key, key))
        values.append([_text(value) for value in table[key]])
    lengths = {column: len(entries) for column, entries in zip(header, values)}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{column}: {length}" for column, length in lengths.items())
        raise ValueError(f"{name}: the columns are of unequal length ({listed}); give each a value for every row")
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(zip(*values))


def _text(value: Any) -> str:
    """A value as a field: nothing where there is none, a time as ISO 8601."""
    if value is None or value != value:
        return ""
    return str(value.isoformat() if hasattr(value, "isoformat") else value)


def from_dataframe(
    data: Any,
    *,
    ship: Ship | PathLike,
    units: Mapping[str, str] | None = None,
    columns: Mapping[str, str] | None = None,
    model: Model | PathLike | None = None,
    folder: PathLike | None = None,
    name: str | None = None,
    split: bool = True,
    **more: Any,
) -> Study:
    """See `Study.from_dataframe`."""
    # A dictionary of tables has tables as values, a dictionary of columns has not.
    several = isinstance(data, Mapping) and all(hasattr(table, "keys") for table in data.values())
    tables: dict[str, Any] = dict(data) if several else {"log": data}
    if not tables:
        raise ValueError("there is no table: give a DataFrame, or a dictionary of name and DataFrame with one or more")
    kept = None if folder is not None else tempfile.TemporaryDirectory(prefix="trimtab-")
    place = Path(kept.name if kept is not None else os.fspath(folder or ""))
    place.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as logs:
        files = []
        for title, table in tables.items():
            path = Path(logs, f"{title}.csv")
            _write(path, title, table, columns or {})
            files.append(path)
        study = import_log(files, place, ship=ship, model=model, units=units, name=name or "study", split=split, **more)
    return Study.load(study.path, _folder=kept)
