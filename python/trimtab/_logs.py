"""Studies from what ships and loggers write, and the example study: files in, a study folder out."""

from __future__ import annotations

import logging
import os
import re
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path

from ._trimtab import Model, Ship, Study, TrimtabError, example_files, import_files

PathLike = str | os.PathLike[str]


def import_log(
    files: PathLike | Iterable[PathLike],
    out: PathLike,
    *,
    ship: Ship | PathLike | None = None,
    model: Model | PathLike | None = None,
    columns: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    antenna: tuple[float, float] | None = None,
    name: str | None = None,
    session_gap: float | None = None,
    bridge: float | None = None,
    split: bool = True,
) -> Study:
    """Makes a study folder `out` of logs (CSV, NMEA 0183, Parquet) and loads it, as `trimtab import` does.

    What each column is taken for, its unit and its sign are found from names and data, with the evidence at level INFO of the logger
    "trimtab". What they do not show is asked for in one message: by `columns`, as in `{"delta": "helm_fb"}`, and `units`, as in
    `{"n": "rpm"}`. `antenna` is its position in m forward and to starboard of midship. A gap longer than `session_gap` [s] ends a
    recording; drop-outs up to `bridge` [s] are bridged by straight lines. `split=False` lists each recording as one run instead of
    cutting it into straight runs, turns, zigzags and stops.

    `ship` is a Ship or a ship file; without one `out` has a form to fill in, and loading says what is missing.
    """
    listed = [files] if isinstance(files, (str, os.PathLike)) else list(files)
    arguments = [os.fspath(file) for file in listed] + [f"--out={os.fspath(out)}"]
    arguments += [f"--column={quantity}={column}" for quantity, column in (columns or {}).items()]
    arguments += [f"--unit={quantity}={unit}" for quantity, unit in (units or {}).items()]
    if antenna is not None:
        x, y = antenna
        arguments.append(f"--antenna={x},{y}")
    if name is not None:
        arguments.append(f"--name={name}")
    if session_gap is not None:
        arguments.append(f"--session-gap={session_gap}")
    if bridge is not None:
        arguments.append(f"--bridge={bridge}")
    if not split:
        arguments.append("--no-split")
    with tempfile.TemporaryDirectory() as folder:
        for option, given in (("ship", ship), ("model", model)):
            if isinstance(given, (Ship, Model)):
                path = Path(folder, f"{option}.toml")
                given.save(path)
                arguments.append(f"--{option}={path}")
            elif given is not None:
                arguments.append(f"--{option}={os.fspath(given)}")
        try:
            text, _ = import_files(arguments)
        except TrimtabError as error:
            # The command asks for options, a call for arguments.
            words = re.sub(r"`--(unit|column) (\w+)=([^`]*)`", r'`\1s={"\2": "\3"}`', str(error))
            raise type(error)(words) from None
    logging.getLogger("trimtab").info("%s", text)
    return Study.load(Path(out, "study.toml"))


def example(folder: PathLike | None = None) -> Study:
    """The example study: forty recordings of a container ship of 85 m, made by a simulator that knows more physics than the model.

    Its files are written into `folder`, or into a temporary one that lasts as long as the study.
    """
    kept = None if folder is not None else tempfile.TemporaryDirectory(prefix="trimtab-")
    place = Path(kept.name if kept is not None else os.fspath(folder or ""))
    for file, text in example_files():
        path = place / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return Study.load(place / "study.toml", _folder=kept)
