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
            f"{name}: expected a table with columns (a pandas DataFrame, or a dictionary of columns), and got {kind}; "
            'several tables go into a dictionary by name, {"monday": table, "tuesday": table}'
        )
    own = {column: channel for channel, column in columns.items()}
    known = [str(key) for key in table.keys()]
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


def _has_all(tables: Mapping[str, Any], columns: Mapping[str, str]) -> None:
    """Each column that the caller names is in a table."""
    known = list(dict.fromkeys(str(key) for table in tables.values() if hasattr(table, "keys") for key in table.keys()))
    for channel, column in columns.items():
        if column in known or not known:
            continue
        owner, its = (f"{next(iter(tables))} has", "its") if len(tables) == 1 else ("the tables have", "their")
        turned = f'; columns={{channel: column}}, such as {{"{column}": "{channel}"}}' if channel in known else ""
        raise KeyError(f"{owner} no column `{column}` for {channel}{turned}; {its} columns are {', '.join(known)}")


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
    antenna: tuple[float, float] | None = None,
    session_gap: float | None = None,
    bridge: float | None = None,
) -> Study:
    """See `Study.from_dataframe`."""
    # A dictionary of tables has tables as values, a dictionary of columns has not.
    several = isinstance(data, Mapping) and all(hasattr(table, "keys") for table in data.values())
    tables: dict[str, Any] = dict(data) if several else {"log": data}
    if not tables:
        raise ValueError("there is no table: give a DataFrame, or a dictionary of name and DataFrame with one or more")
    for title in tables:
        if Path(str(title)).name != str(title):
            raise ValueError(f"the table `{title}` becomes a recording of this name: give it a name that a file can have")
    _has_all(tables, columns or {})
    kept = None if folder is not None else tempfile.TemporaryDirectory(prefix="trimtab-")
    place = Path(kept.name if kept is not None else os.fspath(folder or ""))
    place.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as logs:
        files = []
        for title, table in tables.items():
            path = Path(logs, f"{title}.csv")
            _write(path, title, table, columns or {})
            files.append(path)
        # The columns bear the names of their channels by now; the import says if there is no such channel.
        study = import_log(
            files,
            place,
            ship=ship,
            model=model,
            columns={channel: channel for channel in columns or {}},
            units=units,
            antenna=antenna,
            name=name or "study",
            session_gap=session_gap,
            bridge=bridge,
            split=split,
        )
    return Study.load(study.path, _folder=kept, _imported=True)
