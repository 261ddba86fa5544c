"""Results of trimtab as pandas DataFrames: python3 read_results.py RESULTS, the folder that fit, evaluate and diagnose were given with --out.
Each CSV is one tidy table: units are in the column name, `cvdm [%]`, or in a column `unit`; a cell without a value is empty."""
import json, sys
from pathlib import Path
import pandas as pd

folder = Path(sys.argv[1])
tables = {f.stem: pd.read_csv(f) for f in folder.glob("*.csv") if f.stem in ("parameters", "summary", "trajectories")}
diagnosis = folder / "diagnosis.json"
if diagnosis.exists():
    result = json.loads(diagnosis.read_text())
    tables |= {name: pd.json_normalize(result[name]) for name in ("findings", "withdrawn", "ranking")}
for name, table in tables.items():
    print(f"{name}: {len(table)} rows, {list(table.columns)}\n{table.head()}\n")
