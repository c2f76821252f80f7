"""Sets of solutions: curves and surfaces of configurations that all reach the same targets."""
