"""Paths of balls, and the frames that chase the balls."""
