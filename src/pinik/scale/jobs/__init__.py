"""Jobs: work in numbered chunks that can be killed and resumed, in this process or on a Dask cluster.

Nothing in this room knows what the work is about. A job is run in four steps:

1. Describe it: `job.Job(fingerprint, chunks, payload, work)`. The fingerprint says by name what the results depend on;
   `payload(number)` reads what one chunk needs, in this process; `work(payload, pause)` computes the chunk's `Result`
   (bytes, and notes that are added up), in any thread, process or machine.
2. Choose where it runs: `threads.Threads(count)`, or `cluster.Cluster(scheduler=…)` or `Cluster(workers=…)`.
3. `run.run(job, output, assemble, runner, resume=…)` keeps each finished chunk as a file in the folder OUTPUT.parts,
   and lets `assemble(parts, file)` write the output from all of them. Only then does the output appear, whole, and the
   folder goes. With `resume`, finished chunks are taken from the folder; a folder of another fingerprint is refused.
4. Or `run.stream(job, put, runner)` hands the results on in their order, and keeps nothing.
"""
