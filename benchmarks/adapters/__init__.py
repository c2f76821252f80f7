"""One file per peer that lets it solve, and the worker that runs it inside the peer's own environment.

An adapter is a class made with an arm as JSON (`comparison.arms.Arm.as_json`) and the peer's options. What a user
would write once beforehand belongs into `__init__`, `target` and `start`; only `solve` is timed:

    target(matrix)        a 4×4 placement of the tip in the base, as the peer takes it
    start(q)              joint values (n,), as the peer takes them
    solve(target, start)  the peer's own call
    answer(solved)        its result as joint values (n,) in the arm's order, or None

A batch adapter has `solve_all(targets, starts)` in the place of `solve`, and `answers(solved)`, which gives the
joint values and the time of each target [s]. Files here import nothing of pinik's or each other's: they run where
only their peer is installed.
"""
