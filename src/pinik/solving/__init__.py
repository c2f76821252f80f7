"""Solve: from targets and options to a solution."""
