"""Times trimtab's fit against the same fit in CasADi, JAX and SciPy with numba: `python3 benches/peers/run.py`.

It needs the standard library alone: it makes a virtual environment from requirements.txt, has cargo export the fit, runs each
tool in a process of its own and in turn, and writes results.csv and the table in README.md.
"""

import argparse
import csv
import datetime
import hashlib
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
EXPORT = ["cargo", "build", "--release", "-p", "trimtab", "--example", "export_peers"]

# Module and class of each tool, in the order of the table.
TOOLS = [
    ("casadi_peer", "CasADi"),
    ("casadi_peer", "SharedCasADi"),
    ("jax_peer", "LocalJax"),
    ("jax_peer", "WholeJax"),
    ("numba_peer", "Differences"),
    ("numba_peer", "DifferencesIpopt"),
    ("numba_peer", "ByHand"),
    ("numba_peer", "ByHandIpopt"),
]
WHATS = ["cost", "gradient", "gradient+Gauss-Newton", "full fit"]
# Largest relative difference from trimtab's answers. Forward differences are no exact derivatives: see `differs`.
LIMITS = {"cost": 1e-12, "gradient": 1e-9, "gradient+Gauss-Newton": 1e-9, "full fit": 1e-6, "violation": 1e-6}
COLUMNS = (
    ["date", "machine", "cores", "tool", "versions", "what", "iterations"]
    + ["processor_median_s", "processor_min_s", "wall_median_s", "wall_min_s", "ratio_to_trimtab", "difference"]
)
# One thread each: rayon, BLAS, OpenMP, numba, and XLA. XLA's pool has as many threads as NPROC says; its flags leave two.
ONE_THREAD = {
    **{f"{name}_NUM_THREADS": "1" for name in ("RAYON", "OMP", "OPENBLAS", "MKL", "NUMBA")},
    "NPROC": "1",
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false",
}
# Least share of a tool's processor time that its busiest thread has: what is left is the interpreter that waits for it.
ONE_THREAD_SHARE = 0.9


def environment():
    """One thread, and no compiled files of Python beside the sources."""
    return {**os.environ, **ONE_THREAD, "PYTHONDONTWRITEBYTECODE": "1"}


def python_with_packages(directory):
    """The interpreter of a virtual environment that has requirements.txt, made where it is missing."""
    wanted = hashlib.sha256((HERE / "requirements.txt").read_bytes()).hexdigest()
    stamp, python = directory / "installed", directory / "bin" / "python"
    if not (stamp.exists() and stamp.read_text() == wanted):
        subprocess.run([sys.executable, "-m", "venv", directory], check=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"], check=True)
        stamp.write_text(wanted)
    return python


def build_export():
    """Builds the export with cargo and gives the path of its binary."""
    command = [*EXPORT, "--message-format", "json-render-diagnostics"]
    lines = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    return next(m["executable"] for m in map(json.loads, lines) if m.get("executable"))


class Trimtab:
    """trimtab's own fit, timed by the export in a new process for each sample."""

    def __init__(self, export, data):
        self.export = export
        version = subprocess.run(
            ["git", "describe", "--always", "--dirty"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True
        )
        self.about = {"label": "trimtab", "versions": f"commit {version.stdout.strip()}", "compile": None}
        default = json.loads((data / "expected.json").read_text())
        self.check = {"iterations": default["default"]["iterations"]}
        self.check["full fit"] = default["default"]["cost"] / default["optimum"]["cost"] - 1

    def sample(self):
        output = subprocess.run(
            [self.export, "--time", "1"], env=environment(), check=True, stdout=subprocess.PIPE, text=True
        ).stdout
        rows = csv.DictReader(output.splitlines())
        return {r["what"]: {"wall": float(r["wall_s"]), "processor": float(r["processor_s"])} for r in rows}

    def close(self):
        pass


class Peer:
    """Another tool, in a process that stays."""

    def __init__(self, python, module, name, data, scratch):
        scratch.mkdir(exist_ok=True)
        command = [python, HERE / "worker.py", module, name, data, scratch]
        self.process = subprocess.Popen(
            command, env=environment(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.about = self._answer(name)
        self.check = self.about.pop("check")

    def _answer(self, asked):
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit(f"{asked}: the tool ended without an answer; its own message is above")
        return json.loads(line)

    def sample(self):
        samples = {}
        for what in WHATS:
            self.process.stdin.write(what + "\n")
            self.process.stdin.flush()
            samples[what] = self._answer(what)
        return samples

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def differs(peer):
    """What in a tool's answers is not trimtab's, in words; derivatives by differences are asked for less."""
    limits = dict(LIMITS)
    if "differences" in peer.about["label"]:
        limits["gradient"] = limits["gradient+Gauss-Newton"] = 1e-4
    found = [(what, abs(peer.check[what]), limit) for what, limit in limits.items()]
    sentences = [f"{what} differs by {value:.1e}, more than {limit:.0e}" for what, value, limit in found if value > limit]
    if peer.check["one_thread"] < ONE_THREAD_SHARE:
        sentences.append(f"its busiest thread has {peer.check['one_thread']:.0%} of its processor time: not one thread")
    return sentences


def machine():
    """The processor's name, and the number of cores."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return (names or [platform.processor() or platform.machine()])[0], os.cpu_count()


def measure(tools, rounds):
    """Samples of every tool, one of each in turn and the order turned every round, so that what else runs meets all alike."""
    samples = {tool: {what: [] for what in WHATS} for tool in tools}
    for i in range(rounds):
        print(f"round {i + 1} of {rounds}", file=sys.stderr)
        turn = i % len(tools)
        for tool in tools[turn:] + tools[:turn]:
            for what, sample in tool.sample().items():
                samples[tool][what].append(sample)
    return samples


def table(tools, samples):
    """One row a tool and evaluation: medians and minima, and the ratio of processor times to trimtab's."""
    name, cores = machine()
    first = {"date": datetime.date.today().isoformat(), "machine": name, "cores": cores}
    median = lambda tool, what, clock: statistics.median(s[clock] for s in samples[tool][what])
    rows = []
    for tool in tools:
        about = {**first, "tool": tool.about["label"], "versions": tool.about["versions"]}
        for what in WHATS:
            row = {**about, "what": what, "difference": ""}
            if what in tool.check:
                row["difference"] = f"{tool.check[what]:.1e}"
            row["iterations"] = tool.check["iterations"] if what == "full fit" else ""
            for clock in ("processor", "wall"):
                row[f"{clock}_median_s"] = f"{median(tool, what, clock):.4e}"
                row[f"{clock}_min_s"] = f"{min(s[clock] for s in samples[tool][what]):.4e}"
            ratio = median(tool, what, "processor") / median(tools[0], what, "processor")
            row["ratio_to_trimtab"] = f"{ratio:.2f}"
            rows.append(row)
        if tool.about["compile"] is not None:
            once = {c: f"{tool.about['compile'][c]:.4e}" for c in ("processor", "wall")}
            once = {f"{clock}_{kind}_s": once[clock] for clock in once for kind in ("median", "min")}
            rows.append({**about, "what": "compile", **once})
    return rows


def in_words(rows, rounds):
    """The rows as a table in Markdown."""
    by_tool = {}
    for row in rows:
        by_tool.setdefault(row["tool"], {})[row["what"]] = row
    first = rows[0]
    milliseconds = lambda row: f"{1e3 * float(row['processor_median_s']):.3g}"
    lines = [
        f"{first['machine']}, {first['cores']} cores, {first['date']}; trimtab at {first['versions']}. Processor time on one "
        f"thread, median of {rounds} rounds.",
        "",
        "| tool | cost, ms | gradient, ms | with Gauss-Newton, ms | full fit, ms | iterations | over trimtab | compiling, s |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for tool, whats in by_tool.items():
        fit = whats["full fit"]
        compiling = f"{float(whats['compile']['processor_median_s']):.1f}" if "compile" in whats else "with cargo"
        cells = [tool, *(milliseconds(whats[what]) for what in WHATS), fit["iterations"], fit["ratio_to_trimtab"], compiling]
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return "\n".join(lines)


def write(rows, words):
    with open(HERE / "results.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    readme = HERE / "README.md"
    before, rest = readme.read_text().split("<!-- table -->\n")
    after = rest.split("<!-- end of table -->\n")[1]
    readme.write_text(f"{before}<!-- table -->\n{words}\n<!-- end of table -->\n{after}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7, help="samples of each evaluation (default: 7)")
    default = Path(tempfile.gettempdir()) / "trimtab-peers"
    parser.add_argument("--work", type=Path, default=default, help=f"folder for packages and files (default: {default})")
    parser.add_argument("--only", default="", help="time the tools whose name contains this, and write no results")
    options = parser.parse_args()

    work = options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    data = work / "data"
    export = build_export()
    subprocess.run([export, data], env=environment(), check=True)
    python = python_with_packages(work / "venv")

    tools, wrong = [Trimtab(export, data)], []
    for module, name in TOOLS:
        if options.only.lower() not in f"{module}.{name}".lower():
            continue
        peer = Peer(python, module, name, data, work / name)
        print(f"{peer.about['label']}: {json.dumps(peer.check)}", file=sys.stderr)
        wrong += [f"{peer.about['label']}: {sentence}" for sentence in differs(peer)]
        tools.append(peer)
    if not wrong:
        rows = table(tools, measure(tools, options.rounds))
        words = in_words(rows, options.rounds)
        print(words)
        if not options.only:
            write(rows, words)
    for tool in tools:
        tool.close()
    if wrong:
        raise SystemExit("not the same fit:\n" + "\n".join(wrong))


if __name__ == "__main__":
    main()
