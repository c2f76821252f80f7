"""One file per peer that lets it solve, and the worker that runs it inside the peer's own environment.

An adapter is a class made with an arm as JSON (`comparison.arms.Arm.as_json`) and the peer's options. What a user
would write once beforehand belongs into `__init__`, `target` and `start`; only `solve` is timed:

    target(matrix)        a 4×4 placement of the tip in the base; moved to the frame that the peer places
    start(q)              joint values (n,), as the peer takes them
    solve(target, start)  the peer's own call, from arrays to an array
    answer(solved)        its result as joint values (n,) in the arm's order, or None

A batch adapter has instead:

    targets(matrices), starts(q)   N placements (N, 4, 4) and N rows of joint values (N, n), as the peer takes them
    solve_all(targets, starts)     the peer's own call
    answers(solved)                its results (N, …), and the time of each target [s] or None where it reports none

Files here import nothing of pinik's or each other's: they run where only their peer is installed.
"""
