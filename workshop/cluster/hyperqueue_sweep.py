"""A sweep on HyperQueue: one task for each part, all into one folder.

    python3 hyperqueue_sweep.py PROGRAM FOLDER PARTS [CORES]

PROGRAM runs a part when it is called as `PROGRAM part FOLDER PART PARTS`. With CORES a server and a worker with so many cores are started
here for the time of the sweep; without it the tasks go to the server that `hq` uses. HyperQueue starts a task again whose worker is lost;
the part then goes on where it was.
"""

import contextlib
import sys

import hyperqueue
from hyperqueue.cluster import LocalCluster, WorkerConfig


def main(program, folder, parts, cores=None):
    job = hyperqueue.Job(max_fails=0)
    for part in range(int(parts)):
        job.program(
            [program, "part", folder, str(part), parts],
            stdout=f"{folder}.part-{part}.out",
            stderr=f"{folder}.part-{part}.err",
        )
    with contextlib.ExitStack() as stack:
        if cores is None:
            client = hyperqueue.Client()
        else:
            client = stack.enter_context(LocalCluster(worker_config=WorkerConfig(cores=int(cores)))).client()
        client.wait_for_jobs([client.submit(job)])


if __name__ == "__main__":
    main(*sys.argv[1:])
