"""Runs the recipes for clusters: a Slurm array in a simulated environment and HyperQueue, with 1, 2 and 4 parts, and MPI with 1, 2 and 4 ranks,
of which some are killed; and reads the rows with pyarrow, pandas and polars.

    python3 workshop/cluster/check.py

Every way has to leave the files of a run in one part, to the bit. Needs `cargo build --release -p guen-measure --bin sweeps`; `check.py mpi` runs MPI
alone, without it. What cannot be installed here is left out, said so, and ends with status 77.
"""

import fcntl
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
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


# As root, with more ranks than processors, and without the system call that containers refuse.
OPEN_MPI = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
}
MPI_MOTIONS = 1200
# The seconds that a run to be killed takes: some records are written before its end.
MPI_SECONDS = 6


def mpi_program():
    """The example of guen-mpi; none where MPI cannot be installed."""
    installed = subprocess.run(["bash", HERE / "install_mpi"]).returncode
    if installed == 77:
        return None
    assert installed == 0, "install_mpi has failed"
    manifest = HERE.parent.parent / "guen-mpi" / "Cargo.toml"
    run("cargo", "test", "--quiet", "--manifest-path", manifest, "--target-dir", TARGET, stdout=subprocess.DEVNULL)
    return TARGET / "debug" / "examples" / "mpi_sweep"


def ranks(number, *command, **settings):
    """So many ranks of a program, started."""
    words = [str(word) for word in ["mpirun", "-n", number, *command]]
    pipe = subprocess.PIPE
    return subprocess.Popen(words, env=os.environ | OPEN_MPI, text=True, stdout=pipe, stderr=pipe, **settings)


def ended(job, seconds=300):
    """What a job has printed, and the words of its errors; an endless one is an error."""
    out, errors = job.communicate(timeout=seconds)
    return job.returncode, out, errors


def files(folder):
    """All files but locks, with their contents."""
    all = [path for path in sorted(folder.rglob("*")) if path.is_file() and not path.name.startswith(".")]
    return {str(path.relative_to(folder)): path.read_bytes() for path in all}


def recorded(folder):
    """The files of the chunks that the record counts."""
    record = folder / "part-0-of-1.txt"
    lines = record.read_text().splitlines() if record.exists() else []
    numbers = [int(line.split()[1]) for line in lines if line.startswith("chunk ")]
    return [folder / "rows" / f"chunk-{number:08}.csv" for number in numbers]


def finished(program, number, motions, folder, expected):
    """Runs what is missing in a folder, and looks at all files: only what is missing may be written."""
    before = {path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in recorded(folder)}
    status, out, errors = ended(ranks(number, program, "ranks", motions, folder))
    assert status == 0, errors
    chunks = len(recorded(folder))
    report = f"found {len(before)} computed {chunks - len(before)} rewritten 0"
    assert report in out.splitlines(), (report, out)
    shares = [int(line.split()[4]) for line in out.splitlines() if line.startswith("rank ")]
    assert len(shares) == number and sum(shares) == chunks - len(before), out
    for path, stamp in before.items():
        assert stamp == (path.stat().st_mtime_ns, path.stat().st_ino), f"{path} was written again"
    found = files(folder)
    assert found == expected, [name for name in found.keys() | expected if found.get(name) != expected.get(name)]
    return len(before), chunks


class TooQuick(Exception):
    """All chunks of a run were written before a rank was killed."""


def kill(job, chosen):
    """Kills one of the ranks, and waits until MPI has ended the others."""
    children = pathlib.Path(f"/proc/{job.pid}/task/{job.pid}/children")
    while job.poll() is None and not children.read_text():
        time.sleep(0.01)
    if job.poll() is None:
        os.kill(int(chosen.choice(children.read_text().split())), signal.SIGKILL)
    status, _, _ = ended(job)
    if status == 0:
        raise TooQuick


def killed(program, motions, folder, number, again, expected, chosen):
    """Kills a rank before there is a record, perhaps, and once there is one; and lets another number of ranks finish."""
    for waits in [False, True]:
        job = ranks(number, program, "ranks", motions, folder)
        while waits and job.poll() is None and not recorded(folder):
            time.sleep(0.01)
        time.sleep(chosen.uniform(0.0, 1.0))
        kill(job, chosen)
    # The ranks stay for a moment when the last chunk is there: one that is killed then has left nothing to compute.
    if len(recorded(folder)) == sum(name.startswith("rows/") for name in expected):
        raise TooQuick
    found, chunks = finished(program, again, motions, folder, expected)
    assert 0 < found < chunks
    print(f"of {number} ranks one killed, twice: {again} ranks found {found} chunks, computed {chunks - found}: the same files")


def refuses_two(program, folder):
    """A folder in which another coordinator, or a worker of one, is at work."""
    for name, kind in [(".part-0-of-1.lock", fcntl.LOCK_EX), (".workers.lock", fcntl.LOCK_SH)]:
        with open(folder / name) as lock:
            fcntl.flock(lock, kind)
            status, _, errors = ended(ranks(2, program, "ranks", MPI_MOTIONS, folder))
            assert status != 0 and "another process is at work" in errors, errors


def mpi(program, place):
    one = place / "mpi-one"
    start = time.monotonic()
    run(program, "one", MPI_MOTIONS, one, stdout=subprocess.DEVNULL)
    took = time.monotonic() - start
    expected = files(one)
    for number in PROCESSES:
        finished(program, number, MPI_MOTIONS, place / f"mpi-{number}", expected)
    print(f"MPI with {PROCESSES} ranks: the same files, to the bit")

    # A chunk that cannot be written, and a closure that panics: all ranks end, and what is finished is not lost.
    faulty = place / "mpi-faulty"
    blocked = faulty / "rows" / "chunk-00000005.unfinished"
    blocked.mkdir(parents=True)
    status, _, errors = ended(ranks(3, program, "ranks", MPI_MOTIONS, faulty))
    assert status != 0 and "chunk-00000005.csv" in errors and "has ended the run" in errors, errors
    blocked.rmdir()
    status, _, errors = ended(ranks(3, program, "panics", MPI_MOTIONS, faulty))
    assert status != 0 and "the last motion panics" in errors, errors
    found, chunks = finished(program, 2, MPI_MOTIONS, faulty, expected)
    print(f"after a chunk that could not be written and a panic, {found} of {chunks} chunks were kept, and the files are the same")

    refuses_two(program, faulty)

    seed = time.time_ns()
    chosen = random.Random(seed)
    print(f"kills at instants of the seed {seed}")
    motions = int(MPI_MOTIONS * MPI_SECONDS / took)
    for number, again in [(4, 4), (2, 3)]:
        while True:
            many, folder = place / f"mpi-{motions}", place / f"mpi-{motions}-killed-{number}"
            if not many.exists():
                run(program, "one", motions, many, stdout=subprocess.DEVNULL)
            try:
                killed(program, motions, folder, number, again, files(many), chosen)
                break
            except TooQuick:
                motions *= 2


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
declaration = metadata[b"guen.declaration"].decode()
assert len(declaration) == 16 and "declaration: " + declaration in metadata[b"guen.sweep"].decode().splitlines()
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


def over_mpi(place, left_out):
    """The checks of MPI, where it can be had."""
    built = mpi_program()
    if built:
        mpi(built, place)
    else:
        left_out.append("MPI")


def told(left_out):
    """Ends with 77 if something was left out."""
    if left_out:
        print("left out, for they cannot be installed here: " + "; ".join(left_out))
        sys.exit(77)


def main():
    left_out = []
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        over_mpi(place, left_out)
        if sys.argv[1:] == ["mpi"]:
            return told(left_out)
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
    told(left_out)


if __name__ == "__main__":
    main()
