"""The parts of a study as pandas, Polars and DuckDB read them: one table, the same in each."""

import argparse
import shutil
import subprocess
from pathlib import Path

import duckdb
import pandas
import polars

PLAN, RUNS = "examples/studies/usgs-records.toml", 3000

COLUMNS = ["run", "record", "scale", "peak_sliding_displacement_m", "status"]


def frame(table):
    return list(table.columns), list(zip(*(table[name].to_list() for name in COLUMNS)))


def duck(parts):
    table = duckdb.sql(f"from read_parquet('{parts}/*.parquet')")
    return table.columns, table.select(", ".join(COLUMNS)).fetchall()


READERS = {
    "pandas": (pandas.__version__, lambda parts: frame(pandas.read_parquet(parts))),
    "Polars": (polars.__version__, lambda parts: frame(polars.read_parquet(parts))),
    "DuckDB": (duckdb.__version__, duck),
}


def as_one_table(parts, runs):
    """Each reader takes the folder as one table with every run once, the same values as the others."""
    names, rows = None, None
    for reader, (_, read) in READERS.items():
        found, values = read(parts)
        values.sort()
        if [row[0] for row in values] != list(range(runs)):
            raise SystemExit(f"{reader} finds {len(values)} rows in {parts}, expected {runs} runs")
        if rows is not None and (found, values) != (names, rows):
            raise SystemExit(f"{reader} reads other values in {parts} than those before it")
        names, rows = found, values
    versions = [f"{reader} {version}" for reader, (version, _) in READERS.items()]
    return {
        "readers": ", ".join(versions[:-1]) + " and " + versions[-1],
        "columns": len(names),
        "rows": len(rows),
        "ok": sum(row[-1] == "ok" for row in rows),
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--slipstick", required=True)
    parser.add_argument("--folder", required=True, type=Path)
    options = parser.parse_args()
    shutil.rmtree(options.folder, ignore_errors=True)
    command = [options.slipstick, "study", PLAN, "--out", str(options.folder), "-q"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    found = as_one_table(options.folder / "parts", RUNS)
    print(f"{found['readers']} open {PLAN} as one table: "
          f"{found['rows']} rows, {found['ok']} of them ok, {found['columns']} columns")


if __name__ == "__main__":
    main()
