"""Two bones solved exactly."""
