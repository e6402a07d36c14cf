"""One row for each log of a folder: mapped over a cluster with Ray where it is installed, else in this process.

python many_logs.py LOGS SCENE TABLE.csv          (or TABLE.parquet, which needs pyarrow)

On one machine without Ray, `recon batch LOGS --scene SCENE -o OUT` does the same on all cores, with a report for each log.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import recon


def estimate(log: str, scene: str) -> dict[str, Any]:
    """What one log tells; a broken one says why, and the others go on. Numbers are nan where nothing is known."""
    unknown = {"state": "skipped", "samples": 0, "lower_volume_m3": float("nan"), "upper_volume_m3": float("nan")}
    unknown |= {name: float("nan") for name in ("mass_kg", "std_mass_kg", "cmx_last", "cmy_last", "cmz_last")}
    row = {"log": Path(log).name, **unknown}
    try:
        result = recon.reconstruct(log, scene, identify=True)
    except recon.ReconError as error:
        return row | {"why": str(error)}
    lower, upper = result.lower_bound, result.upper_bound
    row |= {"state": "relied on" if result.reliable else "not relied on", "why": result.verdict, "samples": len(result)}
    row |= {"mass_kg": result.mass, "std_mass_kg": result.mass_std}
    row |= {f"cm{axis}_last": float(value) for axis, value in zip("xyz", result.position[-1])}
    row |= {f"{name}_volume_m3": bound.volume for name, bound in (("lower", lower), ("upper", upper)) if bound is not None}
    return row


def in_one_process(logs: list[str], scene: str) -> list[dict[str, Any]]:
    """The rows, in the order of the logs."""
    return [estimate(log, scene) for log in logs]


def with_ray(logs: list[str], scene: str) -> list[dict[str, Any]]:
    """The same by Ray, whose workers need `recon` installed and see the same files.

    Each log is a task of its own. If a node is lost, what it was at is done again: a log may be estimated twice, but has one row.
    """
    import ray.data

    items = [{"place": k, "path": log} for k, log in enumerate(logs)]
    rows = ray.data.from_items(items, override_num_blocks=max(1, len(items)))
    made = rows.map(lambda row: {"place": row["place"], **estimate(row["path"], scene)}).take_all()
    # Ray keeps no order.
    return [{name: row[name] for name in row if name != "place"} for row in sorted(made, key=lambda row: row["place"])]


def write(rows: list[dict[str, Any]], table: str) -> None:
    """The rows as CSV, or as Parquet if the name ends so."""
    if table.endswith(".parquet"):
        import pyarrow
        import pyarrow.parquet

        pyarrow.parquet.write_table(pyarrow.Table.from_pylist(rows), table)
        return
    import csv

    with open(table, "w", newline="", encoding="utf-8") as to:
        writer = csv.DictWriter(to, fieldnames=list(rows[0]) if rows else ["log"])
        writer.writeheader()
        writer.writerows(rows)


def main(folder: str, scene: str, table: str) -> None:
    logs = [str(path) for path in sorted(Path(folder).glob("*.csv"))]
    try:
        import ray.data  # noqa: F401
    except ImportError:
        write(in_one_process(logs, scene), table)
    else:
        write(with_ray(logs, scene), table)


if __name__ == "__main__":
    main(*sys.argv[1:])
