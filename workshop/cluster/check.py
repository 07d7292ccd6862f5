"""Runs the recipes for clusters: a Slurm array in a simulated environment and HyperQueue, with 1, 2 and 4 parts; and reads the rows with
pyarrow, pandas and polars.

    python3 workshop/cluster/check.py

Every way has to leave the files of a run in one part, to the bit. Needs `cargo build --release -p guen-measure --bin sweeps`. What cannot be
installed here is left out, said so, and ends with status 77.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import venv

HERE = pathlib.Path(__file__).resolve().parent
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", HERE.parent.parent / "target"))
PROGRAM = TARGET / "release" / "sweeps"
SYSTEM, MOTIONS = "hoop", "3000"
PROCESSES = [1, 2, 4]


def run(*command, **settings):
    return subprocess.run([str(word) for word in command], check=True, text=True, **settings)


def program(folder):
    """A program of the form that the recipes call."""
    path = folder / "program"
    path.write_text(
        "#!/usr/bin/env bash\nset -eu\nwhat=$1\nshift\n"
        f'exec "{PROGRAM}" "$what" {SYSTEM} {MOTIONS} "$@"\n'
    )
    path.chmod(0o755)
    return path


def merged(command, folder):
    run(command, "merge", folder, stdout=subprocess.DEVNULL)
    run("sha256sum", "--check", "--quiet", "SHA256SUMS", cwd=folder)
    # The record and the manifest of a folder say in how many parts it was run; all else is the same.
    lines = (folder / "SHA256SUMS").read_text().splitlines()
    return [line for line in lines if "part-" not in line]


def slurm(command, folder, parts):
    """The jobs of an array, side by side, with the variables that Slurm sets."""
    run("bash", "-n", HERE / "array.sbatch")
    jobs = []
    for part in range(parts):
        variables = {
            "SLURM_ARRAY_TASK_ID": str(part),
            "SLURM_ARRAY_TASK_MIN": "0",
            "SLURM_ARRAY_TASK_MAX": str(parts - 1),
            "SLURM_ARRAY_TASK_COUNT": str(parts),
        }
        job = ["bash", HERE / "array.sbatch", command, folder]
        jobs.append(subprocess.Popen(job, env=os.environ | variables, stdout=subprocess.DEVNULL))
    assert all(job.wait() == 0 for job in jobs), "a job of the array failed"


def refuses_an_array_from_one(command, folder):
    variables = {"SLURM_ARRAY_TASK_ID": "1", "SLURM_ARRAY_TASK_MIN": "1", "SLURM_ARRAY_TASK_MAX": "4"}
    job = ["bash", HERE / "array.sbatch", command, folder]
    done = subprocess.run(job, env=os.environ | variables | {"SLURM_ARRAY_TASK_COUNT": "4"}, capture_output=True)
    assert done.returncode == 2 and not folder.exists(), done


READ = """
import pathlib, sys
import pyarrow.parquet, pyarrow.dataset, pandas, polars
folder = pathlib.Path(sys.argv[1])
files = sorted((folder / "rows").glob("*.parquet"))
table = pyarrow.dataset.dataset(folder / "rows").to_table().to_pandas().sort_values("motion")
frame = pandas.concat(pandas.read_parquet(file) for file in files)
polar = polars.read_parquet(folder / "rows" / "*.parquet")
assert len(frame) == len(table) == len(polar) == int(sys.argv[2]), (len(frame), len(polar))
assert list(frame.columns) == polar.columns
assert (frame["motion"].to_numpy() == range(len(frame))).all()
good = frame["fault"].isna()
assert (frame["theta"].isna() == ~good).all() and polar["theta"].null_count() == (~good).sum()
statistics = pandas.read_csv(folder / "statistics.csv").set_index("column")
for column in ["theta", "eta3", "zeta"]:
    told, values = statistics.loc[column], frame[column][good]
    assert told["count"] == good.sum()
    assert abs(told["mean"] - values.mean()) < 1e-12
    assert abs(told["standard_deviation"] - values.std()) < 1e-12 * abs(values).max() + 1e-12
    assert (told["minimum"], told["maximum"]) == (values.min(), values.max())
    assert abs(told["quantile_0.5"] - values.median()) < 0.02 * abs(values).max()
covariance = pandas.read_csv(folder / "covariance.csv").set_index("column")
assert abs(covariance.loc["theta", "eta3"] - frame["theta"][good].cov(frame["eta3"][good])) < 1e-12
metadata = pyarrow.parquet.read_metadata(files[0]).metadata
assert len(metadata[b"guen.digest"]) == 64 and b"name: hoop" in metadata[b"guen.sweep"]
print(f"pyarrow, pandas and polars read {len(frame)} rows, {(~good).sum()} of them faults")
"""


def python_with(folder, *packages):
    """An interpreter with these packages: this one, or one in a new environment; none if they cannot be installed."""
    names = ["pyarrow" if package == "pyarrow" else package for package in packages]
    check = "import " + ", ".join(names)
    for python in [os.environ.get("GUEN_PYTHON"), sys.executable]:
        if python and subprocess.run([python, "-c", check], capture_output=True).returncode == 0:
            return python
    venv.create(folder, with_pip=True)
    python = folder / "bin" / "python"
    if subprocess.run([python, "-m", "pip", "install", "--quiet", *packages], timeout=300).returncode:
        return None
    return python


def main():
    left_out = []
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        command = program(place)
        one = place / "one"
        run(command, "part", one, 0, 1, stdout=subprocess.DEVNULL)
        expected = merged(command, one)
        refuses_an_array_from_one(command, place / "refused")
        for parts in PROCESSES:
            folder = place / f"slurm-{parts}"
            slurm(command, folder, parts)
            assert merged(command, folder) == expected, f"Slurm, {parts} parts"
        print(f"a Slurm array of {PROCESSES} jobs: the same bits")
        python = python_with(place / "hyperqueue", "hyperqueue")
        if python:
            for parts in PROCESSES:
                folder = place / f"hyperqueue-{parts}"
                run(python, HERE / "hyperqueue_sweep.py", command, folder, parts, 2, stdout=subprocess.DEVNULL)
                assert merged(command, folder) == expected, f"HyperQueue, {parts} parts"
            print(f"HyperQueue with {PROCESSES} tasks: the same bits")
        else:
            left_out.append("HyperQueue")
        shutil.rmtree(place / "hyperqueue", ignore_errors=True)
        python = python_with(place / "readers", "pyarrow", "pandas", "polars")
        if python:
            run(python, "-c", READ, one, MOTIONS)
        else:
            left_out.append("pyarrow, pandas, polars")
    if left_out:
        print("left out, for they cannot be installed here: " + "; ".join(left_out))
        sys.exit(77)


if __name__ == "__main__":
    main()
