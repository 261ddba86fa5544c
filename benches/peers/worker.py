"""One tool in a process of its own: compiles, checks its answers against trimtab's, then times what it is asked for.

It is started by `run.py`, reads one request a line and answers each with one line of JSON.
"""

import importlib
import json
import math
import os
import sys
import time
from pathlib import Path

import numpy as np

from case import Case

# A sample of a short evaluation lasts at least this long [s], as in `export.rs`.
BATCH_SECONDS = 0.1


def relative(found, expected, unit=1.0):
    """Largest difference over the largest expected entry, both in units in which the entries are of one kind."""
    found, expected = np.asarray(found) * unit, np.asarray(expected) * unit
    return float(np.abs(found - expected).max() / np.abs(expected).max())


def check(case, tool):
    """How far each answer is from trimtab's, relative."""
    start, scale = case.expected["start"], case.scale
    value, gradient = tool.gradient(case.start)
    _, same_gradient, matrix = tool.quadratic(case.start)
    p, iterations = tool.fit()
    optimum = case.expected["optimum"]["cost"]
    return {
        "cost": max(relative(tool.cost(case.start), start["cost"]), relative(value, start["cost"])),
        "gradient": max(relative(g, start["gradient"], scale) for g in (gradient, same_gradient)),
        "gradient+Gauss-Newton": relative(matrix, start["gauss_newton"], np.outer(scale, scale)),
        "full fit": tool.cost(p) / optimum - 1,
        "violation": case.violation(p),
        "iterations": iterations,
        "one_thread": busiest_share(lambda: tool.quadratic(case.start)),
    }


def processor_by_thread():
    """Processor time of each thread of this process so far, in ticks of the system's clock."""
    times = {}
    for task in Path("/proc/self/task").iterdir():
        fields = (task / "stat").read_text().rpartition(")")[2].split()
        times[task.name] = int(fields[11]) + int(fields[12])
    return times


def busiest_share(evaluate):
    """Share of the busiest thread in the processor time of a second of evaluations: 1 where one thread does all."""
    before, clock = processor_by_thread(), time.process_time()
    while time.process_time() - clock < 1.0:
        evaluate()
    spent = [after - before.get(name, 0) for name, after in processor_by_thread().items()]
    return max(spent) / sum(spent)


def sample(evaluate):
    """Wall and processor time of one evaluation [s], over a batch that lasts long enough to be measured."""
    clock = time.perf_counter()
    evaluate()
    count = max(1, math.ceil(BATCH_SECONDS / (time.perf_counter() - clock)))
    wall, processor = time.perf_counter(), time.process_time()
    for _ in range(count):
        evaluate()
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    return {"wall": wall / count, "processor": processor / count}


def compiled(make):
    """What `make` gives, with the wall and the processor time it took [s], those of the compilers it started included."""
    spent = lambda: sum(os.times()[:4])
    wall, processor = time.perf_counter(), spent()
    made = make()
    return made, {"wall": time.perf_counter() - wall, "processor": spent() - processor}


def main(module, name, data, scratch):
    case = Case(data)
    make = getattr(importlib.import_module(module), name)
    tool, seconds = compiled(lambda: make(case, scratch))
    evaluations = {
        "cost": lambda: tool.cost(case.start),
        "gradient": lambda: tool.gradient(case.start),
        "gradient+Gauss-Newton": lambda: tool.quadratic(case.start),
        "full fit": tool.fit,
    }
    answer = lambda value: print(json.dumps(value), flush=True)
    about = {"label": tool.label, "versions": tool.versions, "compile": seconds}
    answer({**about, "check": check(case, tool)})
    for line in sys.stdin:
        answer(sample(evaluations[line.strip()]))


if __name__ == "__main__":
    main(*sys.argv[1:])
