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
        if len(antenna) != 2:
            raise ValueError(f"antenna has {len(antenna)} values: give two, in m forward and to starboard of midship")
        arguments.append(f"--antenna={float(antenna[0])},{float(antenna[1])}")
    if name is not None:
        arguments.append(f"--name={name}")
    if session_gap is not None:
        arguments.append(f"--session-gap={float(session_gap)}")
    if bridge is not None:
        arguments.append(f"--bridge={float(bridge)}")
    if not split:
        arguments.append("--no-split")
    with tempfile.TemporaryDirectory() as folder:
        for option, given, kind in (("ship", ship, Ship), ("model", model, Model)):
            if isinstance(given, kind):
                path = Path(folder, f"{option}.toml")
                given.save(path)
                arguments.append(f"--{option}={path}")
            elif isinstance(given, (str, os.PathLike)):
                arguments.append(f"--{option}={os.fspath(given)}")
            elif given is not None:
                made = "trimtab.Ship.estimate makes one" if kind is Ship else "ship.model() makes one"
                wrong = type(given).__name__
                raise TypeError(f"{option}: expected a {kind.__name__} or the path of a {option} file, and got {wrong}; {made}")
        try:
            text, _ = import_files(arguments)
        except TrimtabError as error:
            raise type(error)(_of_a_call(str(error))) from None
    logging.getLogger("trimtab").info("%s", text)
    return Study.load(Path(out, "study.toml"), _imported=True)


def _arguments(options: re.Match[str]) -> str:
    """Options of the command as arguments of a call: those of one kind are one dictionary."""
    found: dict[str, list[str]] = {}
    for kind, quantity, value in re.findall(r"--(unit|column|actuator) ([\w.]+)=(.*?)(?= --|$)", options[1]):
        found.setdefault("units" if kind == "unit" else "columns", []).append(f'"{quantity}": "{value}"')
    given = [f"{argument}={{{', '.join(entries)}}}" for argument, entries in found.items()]
    return f"`{', '.join(given)}`"


def _of_a_call(words: str) -> str:
    """The words of the command, which asks for options, with the arguments of a call."""
    words = re.sub(r"`(--(?:unit|column|actuator) [\w.]+=[^`]*)`", _arguments, words)
    words = re.sub(r"^--(unit|column) ([^=]*)=\.\.\.:", r'\1s={"\2": ...}:', words)
    words = re.sub(r"^--(unit|column) ([^=]*)=([^:]*):", r'\1s={"\2": "\3"}:', words)
    words = re.sub(r"^--(session-gap|bridge) ([^:]*):", lambda found: f"{found[1].replace('-', '_')}={found[2]}:", words)
    return words.replace(" (--out)", "")


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
